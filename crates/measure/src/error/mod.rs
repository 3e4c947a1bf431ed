//! Why a log is not read, or cannot be conditioned.

mod condition;
mod mapping;

pub(crate) use condition::ConditionError;
pub(crate) use mapping::MappingError;

use crate::log::LogFaults;
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
enum Cause {
    Log(LogFaults),
    Mapping(MappingError),
    Condition(ConditionError),
}

impl Error {
    /// A log has fewer samples than its filters need.
    pub fn too_short(samples: usize, needed: usize) -> Self {
        ConditionError::TooShort { samples, needed }.into()
    }

    /// No filter has its cutoff there; half the sampling rate is `nyquist_hz`.
    pub fn cutoff(cutoff_hz: f64, nyquist_hz: f64) -> Self {
        ConditionError::Cutoff { cutoff_hz, nyquist_hz }.into()
    }

    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        match &*self.0 {
            Cause::Log(_) => ErrorKind::Log,
            Cause::Mapping(_) => ErrorKind::Mapping,
            Cause::Condition(error) => match error {
                ConditionError::Cutoff { .. } => ErrorKind::Cutoff,
                ConditionError::TooShort { .. } => ErrorKind::TooShort,
                ConditionError::NoRates(_) | ConditionError::NotTheDerivative { .. } => {
                    ErrorKind::Derivatives
                }
                ConditionError::NothingMoves => ErrorKind::NothingMoves,
                ConditionError::ShortPeriod { .. }
                | ConditionError::OneLap { .. }
                | ConditionError::NoPeriod
                | ConditionError::NotRepeated { .. }
                | ConditionError::OtherPeriod { .. } => ErrorKind::Laps,
            },
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
            Cause::Condition(ConditionError::TooShort { samples, needed }) => {
                Some([samples, needed])
            }
            _ => None,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &*self.0 {
            Cause::Log(faults) => write!(f, "{faults}"),
            Cause::Mapping(error) => write!(f, "{error}"),
            Cause::Condition(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for Error {}

impl From<LogFaults> for Error {
    fn from(faults: LogFaults) -> Self {
        Self(Box::new(Cause::Log(faults)))
    }
}

impl From<MappingError> for Error {
    fn from(error: MappingError) -> Self {
        Self(Box::new(Cause::Mapping(error)))
    }
}

impl From<ConditionError> for Error {
    fn from(error: ConditionError) -> Self {
        Self(Box::new(Cause::Condition(error)))
    }
}
