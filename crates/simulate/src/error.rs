//! Why a run does not begin, why first-order changes cannot be followed, what is wrong with a log.

use super::breakdown::Breakdown;
use super::log_fault::{LogFaults, PlacedLogFault};
use super::start::StartError;
use super::variation::VariationError;
use std::fmt;

/// Why there is no run or no log. How a run ended is no error: [`Stop`](super::Stop) says it.
#[derive(Clone, Debug, PartialEq)]
pub struct Error(Box<Cause>);

/// What kind of reason it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The initial state or an option has a number that nothing can begin with.
    Options,
    /// The scheme of the run cannot do what is asked for.
    Scheme,
    /// A contact point starts below the ground; [`Error::contact`] has its name.
    Penetration,
    /// The equations have no answer at the start; [`Error::breakdown`] says why.
    Breakdown,
    /// The run stopped before its end.
    Stopped,
    /// First-order changes say nothing of this run.
    NotSmooth,
    /// A log is wrong; [`Error::log_faults`] has all that is.
    Log,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
enum Cause {
    Start(StartError),
    Variation(VariationError),
    Log(LogFaults),
}

impl Error {
    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        match &*self.0 {
            Cause::Start(StartError::Penetration(..)) => ErrorKind::Penetration,
            Cause::Start(StartError::Breakdown(_)) => ErrorKind::Breakdown,
            Cause::Start(StartError::EventSchemeOnly(_) | StartError::MoreauOnly(_)) => {
                ErrorKind::Scheme
            }
            Cause::Start(
                StartError::Length(..) | StartError::Number(_) | StartError::Steps(..),
            ) => ErrorKind::Options,
            Cause::Variation(VariationError::Stopped(..)) => ErrorKind::Stopped,
            Cause::Variation(
                VariationError::Sampled
                | VariationError::Jumps
                | VariationError::Pushed
                | VariationError::Grazing(_)
                | VariationError::Decision(_),
            ) => ErrorKind::NotSmooth,
            Cause::Log(_) => ErrorKind::Log,
        }
    }

    /// The contact point that starts below the ground.
    pub fn contact(&self) -> Option<&str> {
        match &*self.0 {
            Cause::Start(StartError::Penetration(contact, _)) => Some(contact),
            _ => None,
        }
    }

    /// Why the equations have no answer at the start.
    pub fn breakdown(&self) -> Option<Breakdown> {
        match &*self.0 {
            Cause::Start(StartError::Breakdown(breakdown)) => Some(*breakdown),
            _ => None,
        }
    }

    /// All that is wrong with a log.
    pub fn log_faults(&self) -> Option<&LogFaults> {
        match &*self.0 {
            Cause::Log(faults) => Some(faults),
            _ => None,
        }
    }

    /// The first fault of a log; for errors of reading one.
    pub(crate) fn first_log_fault(&self) -> &PlacedLogFault {
        let first = self.log_faults().and_then(|faults| faults.told().first());
        first.expect("a log that is not read has a fault")
    }

    /// Why a run does not begin.
    pub(crate) fn start(&self) -> Option<&StartError> {
        match &*self.0 {
            Cause::Start(error) => Some(error),
            _ => None,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &*self.0 {
            Cause::Start(error) => write!(f, "{error}"),
            Cause::Variation(error) => write!(f, "{error}"),
            Cause::Log(faults) => write!(f, "{faults}"),
        }
    }
}

impl std::error::Error for Error {}

impl From<StartError> for Error {
    fn from(error: StartError) -> Self {
        Self(Box::new(Cause::Start(error)))
    }
}

impl From<VariationError> for Error {
    fn from(error: VariationError) -> Self {
        Self(Box::new(Cause::Variation(error)))
    }
}

/// A log is wrong.
impl From<LogFaults> for Error {
    fn from(faults: LogFaults) -> Self {
        Self(Box::new(Cause::Log(faults)))
    }
}
