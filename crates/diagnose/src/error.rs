//! Why nothing is diagnosed.

use super::diagnosis::Request;
use denavit_codegen::model::ModelError;
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

/// What is wrong. A log is held by its name.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Cause {
    /// There is no log to search, or none to judge with.
    NoLog,
    /// A log has no torque of any joint.
    NoTorque(String),
    /// A log cannot be filtered.
    Condition(String, denavit_measure::Error),
    /// A model is not moved along logs, for a reason in words.
    NotMoved(String),
    /// Its file with what was found is not that of a model.
    Unsound(Box<ModelError>),
    /// It cannot be simulated.
    Plant(denavit_plants::Error),
    /// A log that it is moved along cannot be filtered.
    Motion(String, denavit_measure::Error),
    /// A log cannot be simulated again.
    Forward(String, denavit_replay::Error),
    /// No motion tells names apart, for a reason in words.
    NoExperiment(String),
    /// The robot has no limits to stay within, or none that let it move.
    Limits(denavit_excite::Error),
}

impl Error {
    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        match &*self.0 {
            Cause::NoLog => ErrorKind::NoLog,
            Cause::NoTorque(_) => ErrorKind::NoTorque,
            Cause::Condition(..) => ErrorKind::Condition,
            Cause::NotMoved(_)
            | Cause::Unsound(_)
            | Cause::Plant(_)
            | Cause::Motion(..)
            | Cause::Forward(..) => ErrorKind::NotMoved,
            Cause::NoExperiment(_) | Cause::Limits(_) => ErrorKind::NoExperiment,
        }
    }

    /// The name of the log that is at fault.
    pub fn log(&self) -> Option<&str> {
        match &*self.0 {
            Cause::NoTorque(file)
            | Cause::Condition(file, _)
            | Cause::Motion(file, _)
            | Cause::Forward(file, _) => Some(file),
            _ => None,
        }
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
            Cause::Condition(file, error) => match error.rows() {
                Some([samples, needed]) => write!(
                    f,
                    "{file}: {samples} rows: with its edges cut off by the filters a log needs at \
                     least {needed}\n  hint: a longer log, or one sampled faster"
                ),
                None => write!(f, "{file}: {error}"),
            },
            Cause::NotMoved(reason) | Cause::NoExperiment(reason) => write!(f, "{reason}"),
            Cause::Unsound(error) => write!(f, "{error}"),
            Cause::Plant(error) => write!(f, "{error}"),
            Cause::Motion(file, error) => write!(f, "{file}: {error}"),
            Cause::Forward(file, error) => write!(f, "{file}: {error}"),
            Cause::Limits(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &*self.0 {
            Cause::Condition(_, error) | Cause::Motion(_, error) => Some(error),
            Cause::Unsound(error) => Some(error.as_ref()),
            Cause::Plant(error) => Some(error),
            Cause::Forward(_, error) => Some(error),
            Cause::Limits(error) => Some(error),
            _ => None,
        }
    }
}

impl From<Cause> for Error {
    fn from(cause: Cause) -> Self {
        Self(Box::new(cause))
    }
}
