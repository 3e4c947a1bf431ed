//! Why a log cannot be conditioned.

use denavit_numerics::short;
use std::fmt;

/// Why a log cannot be conditioned.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ConditionError {
    /// The cutoff is not below half the rate of sampling, or the order not from 1 to 10.
    Cutoff {
        /// The cutoff \[Hz\].
        cutoff_hz: f64,
        /// Half the rate of sampling \[Hz\].
        nyquist_hz: f64,
    },
    /// Too few samples for this filter and decimation, whose edges are cut.
    TooShort {
        /// Samples of the log.
        samples: usize,
        /// The fewest that leave something.
        needed: usize,
    },
    /// The rates or accelerations of this joint were not logged.
    NoRates(String),
    /// A period has too few samples.
    ShortPeriod {
        /// The period \[s\].
        period_s: f64,
        /// The distance of samples \[s\].
        step_s: f64,
    },
    /// There is no second lap to average with.
    OneLap {
        /// The period \[s\].
        period_s: f64,
    },
    /// No joint moves further than its noise.
    NothingMoves,
    /// The motion does not repeat.
    NoPeriod,
    /// The motion does not repeat with this period.
    NotRepeated {
        /// The period \[s\].
        period_s: f64,
        /// The share of a joint's variance by which laps differ.
        misfit: f64,
    },
    /// The motion repeats better with a period that is samples away from this one.
    OtherPeriod {
        /// The period \[s\].
        period_s: f64,
        /// Whether the better one is longer.
        longer: bool,
    },
    /// A logged column is not the derivative of the positions that it is named after.
    NotTheDerivative {
        /// The column.
        column: String,
        /// What it is times the derivative, by least squares.
        factor: f64,
        /// How late it is \[s\].
        late_s: f64,
    },
}

impl fmt::Display for ConditionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cutoff { cutoff_hz, nyquist_hz } => write!(
                f,
                "no filter of order 1 to 10 has its cutoff at {} Hz: half the rate of \
                 sampling is {} Hz",
                short(*cutoff_hz),
                short(*nyquist_hz)
            ),
            Self::TooShort { samples, needed } => write!(
                f,
                "{samples} rows: this filter cuts the edges off, and at least {needed} rows are \
                 needed\n  hint: `conditions.filter` with a higher cutoff, or a lower \
                 `conditions.decimation`, needs fewer"
            ),
            Self::NoRates(joint) => {
                write!(f, "`qd_{joint}` and `qdd_{joint}` are not both in the log")
            }
            Self::ShortPeriod { period_s, step_s } => {
                let [period, step] = [*period_s, *step_s].map(short);
                write!(f, "a period of {period} s has too few samples of {step} s for a lap")
            }
            Self::OneLap { period_s } => {
                write!(f, "the log has no two whole laps of {} s", short(*period_s))
            }
            Self::NotRepeated { period_s, misfit } => write!(
                f,
                "laps of {} s do not repeat: they differ by {:.0} % of the variance of a joint\n  \
                 hint: `found` looks for the period; or do not average",
                short(*period_s),
                100.0 * misfit
            ),
            Self::OtherPeriod { period_s, longer } => write!(
                f,
                "laps of {} s do not repeat: the motion repeats with a period that is {} by a \
                 sample or more\n  hint: `found` looks for the period; or do not average",
                short(*period_s),
                if *longer { "longer" } else { "shorter" }
            ),
            Self::NotTheDerivative { column, factor, late_s } => write!(
                f,
                "`{column}` is not the derivative of the position: it is {factor:.3} times that, \
                 {late_s:.4} s late\n  hint: `logs.columns` scales columns; \
                 `conditions.derivatives=differences` takes \
                 the derivatives of the positions"
            ),
            Self::NothingMoves => write!(
                f,
                "no joint moves further than its noise\n  hint: noise is that of the steps of its \
                 encoder: `options.resolution` in rad or m, if it was given"
            ),
            Self::NoPeriod => {
                write!(f, "the motion does not repeat\n  hint: give its period, or do not average")
            }
        }
    }
}
