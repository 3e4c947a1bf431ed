//! Why a log is not read, or cannot be conditioned.

use crate::log::{LogFaults, MappingCause};
use denavit_codegen::model::FileError;
use denavit_numerics::short;
use std::fmt;

/// Why a log is not read, or cannot be conditioned.
#[derive(Clone, Debug, PartialEq)]
pub struct Error(Box<Cause>);

/// What kind of reason it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A log is wrong; [`Error::log_faults`] has all that is.
    Log,
    /// A mapping of columns cannot be read.
    Mapping,
    /// No filter has this cutoff.
    Cutoff,
    /// A log has fewer rows than its filter needs; [`Error::rows`] has both.
    TooShort,
    /// Logged velocities or accelerations are missing, or none of the positions.
    Derivatives,
    /// No joint moves further than its noise.
    NothingMoves,
    /// The motion does not repeat as is asked for.
    Laps,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Cause {
    Log(LogFaults),
    /// A mapping of columns cannot be read; holds all that is wrong with it.
    Mapping(FileError<MappingCause>),
    /// The cutoff is not below a limit, or the order not from 1 to 10.
    Cutoff {
        cutoff_hz: f64,
        limit_hz: f64,
    },
    /// Too few samples for this filter and decimation, whose edges are cut.
    TooShort {
        samples: usize,
        needed: usize,
    },
    /// The rates or accelerations of this joint were not logged.
    NoRates(String),
    /// A logged column is not the derivative of the positions that it is named after, but so many
    /// times that, and so late.
    NotTheDerivative {
        column: String,
        factor: f64,
        late_s: f64,
    },
    /// No joint moves further than its noise.
    NothingMoves,
    /// A period has too few samples.
    ShortPeriod {
        period_s: f64,
        step_s: f64,
    },
    /// There is no second lap of this period \[s\] to average with.
    OneLap {
        period_s: f64,
    },
    /// The motion does not repeat.
    NoPeriod,
    /// Laps of this period differ by a share of a joint's variance.
    NotRepeated {
        period_s: f64,
        misfit: f64,
    },
    /// The motion repeats better with a period that is samples away from this one.
    OtherPeriod {
        period_s: f64,
        longer: bool,
    },
}

impl Error {
    /// A log has fewer samples than its filters need.
    pub fn too_short(samples: usize, needed: usize) -> Self {
        Cause::TooShort { samples, needed }.into()
    }

    /// No filter has its cutoff there; it must be below `limit_hz`.
    pub fn cutoff(cutoff_hz: f64, limit_hz: f64) -> Self {
        Cause::Cutoff { cutoff_hz, limit_hz }.into()
    }

    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        match &*self.0 {
            Cause::Log(_) => ErrorKind::Log,
            Cause::Mapping(_) => ErrorKind::Mapping,
            Cause::Cutoff { .. } => ErrorKind::Cutoff,
            Cause::TooShort { .. } => ErrorKind::TooShort,
            Cause::NoRates(_) | Cause::NotTheDerivative { .. } => ErrorKind::Derivatives,
            Cause::NothingMoves => ErrorKind::NothingMoves,
            Cause::ShortPeriod { .. }
            | Cause::OneLap { .. }
            | Cause::NoPeriod
            | Cause::NotRepeated { .. }
            | Cause::OtherPeriod { .. } => ErrorKind::Laps,
        }
    }

    /// All that is wrong with a log.
    pub fn log_faults(&self) -> Option<&LogFaults> {
        match &*self.0 {
            Cause::Log(faults) => Some(faults),
            _ => None,
        }
    }

    /// The rows of a log that is too short, and the fewest that are enough.
    pub fn rows(&self) -> Option<[usize; 2]> {
        match *self.0 {
            Cause::TooShort { samples, needed } => Some([samples, needed]),
            _ => None,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &*self.0 {
            Cause::Log(faults) => write!(f, "{faults}"),
            Cause::Mapping(faults) => write!(f, "{faults}"),
            Cause::Cutoff { cutoff_hz, limit_hz } => write!(
                f,
                "no filter of order 1 to 10 has its cutoff at {} Hz: at this sampling rate it must \
                 be below {} Hz\n  hint: `conditions.filter` with a lower cutoff",
                short(*cutoff_hz),
                short(*limit_hz)
            ),
            Cause::TooShort { samples, needed } => write!(
                f,
                "{samples} rows: this filter cuts the edges off, and at least {needed} rows are \
                 needed\n  hint: `conditions.filter` with a higher cutoff, or a lower \
                 `conditions.decimation`, needs fewer"
            ),
            Cause::NoRates(joint) => {
                write!(f, "`qd_{joint}` and `qdd_{joint}` are not both in the log")
            }
            Cause::NotTheDerivative { column, factor, late_s } => write!(
                f,
                "`{column}` is not the derivative of the position: it is {factor:.3} times that, \
                 {late_s:.4} s late\n  hint: `logs.columns` scales columns; \
                 `conditions.derivatives=differences` takes \
                 the derivatives of the positions"
            ),
            Cause::NothingMoves => write!(
                f,
                "no joint moves further than its noise\n  hint: noise is that of the steps of its \
                 encoder: `options.resolution` in rad or m, if it was given"
            ),
            laps => laps.write_laps(f),
        }
    }
}

impl Cause {
    /// Why laps are not averaged.
    fn write_laps(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (period_s, why) = match *self {
            Self::ShortPeriod { period_s, step_s } => {
                let [period, step] = [period_s, step_s].map(short);
                return write!(
                    f,
                    "a period of {period} s has too few samples of {step} s for a lap"
                );
            }
            Self::OneLap { period_s } => {
                return write!(f, "the log has no two whole laps of {} s", short(period_s));
            }
            Self::NotRepeated { period_s, misfit } => {
                let percent = 100.0 * misfit;
                (period_s, format!("they differ by {percent:.0} % of the variance of a joint"))
            }
            Self::OtherPeriod { period_s, longer } => {
                let how = if longer { "longer" } else { "shorter" };
                let why =
                    format!("the motion repeats with a period that is {how} by a sample or more");
                (period_s, why)
            }
            _ => {
                return write!(
                    f,
                    "the motion does not repeat\n  hint: give its period, or do not average"
                );
            }
        };
        write!(
            f,
            "laps of {} s do not repeat: {why}\n  hint: `found` looks for the period; or do not \
             average",
            short(period_s)
        )
    }
}

impl std::error::Error for Error {}

impl From<LogFaults> for Error {
    fn from(faults: LogFaults) -> Self {
        Cause::Log(faults).into()
    }
}

impl From<Cause> for Error {
    fn from(cause: Cause) -> Self {
        Self(Box::new(cause))
    }
}
