//! Why nothing is diagnosed.

use super::diagnosis::Request;
use super::experiment::NoExperiment;
use super::simulated::NotMoved;
use denavit_measure::log::MeasuredLog;
use std::fmt;

/// Why there is no answer, or no part of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Error(Box<Cause>);

/// What kind of reason it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// There is no log to search, or none to judge with.
    NoLog,
    /// A log has no torque of any joint; [`Error::log`] has its name.
    NoTorque,
    /// A log cannot be conditioned; [`Error::log`] has its name, the source says why.
    Condition,
    /// A model is not moved along logs.
    NotMoved,
    /// No motion tells names apart.
    NoExperiment,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
enum Cause {
    /// There is no log to search, or none to judge with.
    NoLog,
    /// A log has no torque of any joint; holds its name.
    NoTorque(String),
    /// A log cannot be filtered.
    Condition {
        /// The log's name.
        file: String,
        /// Why.
        error: denavit_measure::Error,
    },
    /// A model is not moved.
    Moved(NotMoved),
    /// Names are not told apart.
    Experiment(NoExperiment),
}

impl Error {
    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        match &*self.0 {
            Cause::NoLog => ErrorKind::NoLog,
            Cause::NoTorque(_) => ErrorKind::NoTorque,
            Cause::Condition { .. } => ErrorKind::Condition,
            Cause::Moved(_) => ErrorKind::NotMoved,
            Cause::Experiment(_) => ErrorKind::NoExperiment,
        }
    }

    /// The name of the log that is at fault.
    pub fn log(&self) -> Option<&str> {
        match &*self.0 {
            Cause::NoTorque(file)
            | Cause::Condition { file, .. }
            | Cause::Moved(NotMoved::Condition(file, _) | NotMoved::Forward(file, _)) => Some(file),
            _ => None,
        }
    }

    /// A log that cannot be filtered.
    pub(super) fn condition(file: String, error: denavit_measure::Error) -> Self {
        Cause::Condition { file, error }.into()
    }

    /// What keeps a request from being answered, whatever is in its logs.
    pub(super) fn check(request: &Request<'_>) -> Result<(), Self> {
        if request.train.is_empty() || request.held_out.is_empty() {
            return Err(Cause::NoLog.into());
        }
        let is_mute = |log: &&MeasuredLog| log.joints.iter().all(|joint| joint.tau.is_none());
        match request.train.iter().chain(&request.held_out).find(is_mute) {
            Some(log) => Err(Cause::NoTorque(log.file.clone()).into()),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &*self.0 {
            Cause::NoLog => write!(f, "a log to search and one to judge with are needed"),
            Cause::NoTorque(file) => write!(
                f,
                "{file}: no joint has a torque\n  hint: give columns `tau_JOINT`, or name them \
                 with `logs.columns`"
            ),
            Cause::Condition { file, error } => match error.rows() {
                Some([samples, needed]) => write!(
                    f,
                    "{file}: {samples} rows: with its edges cut off by the filters a log needs at \
                     least {needed}\n  hint: a longer log, or one sampled faster"
                ),
                None => write!(f, "{file}: {error}"),
            },
            Cause::Moved(error) => write!(f, "{error}"),
            Cause::Experiment(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &*self.0 {
            Cause::Condition { error, .. } => Some(error),
            Cause::Moved(NotMoved::Condition(_, error)) => Some(error),
            Cause::Moved(NotMoved::Plant(error)) => Some(error),
            Cause::Moved(NotMoved::Forward(_, error)) => Some(error),
            Cause::Moved(NotMoved::Unsound(error)) => Some(error.as_ref()),
            Cause::Experiment(NoExperiment::Limits(error)) => Some(error),
            _ => None,
        }
    }
}

impl From<Cause> for Error {
    fn from(cause: Cause) -> Self {
        Self(Box::new(cause))
    }
}

impl From<NotMoved> for Error {
    fn from(error: NotMoved) -> Self {
        Cause::Moved(error).into()
    }
}

impl From<NoExperiment> for Error {
    fn from(error: NoExperiment) -> Self {
        Cause::Experiment(error).into()
    }
}
