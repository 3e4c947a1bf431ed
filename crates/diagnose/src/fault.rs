//! Why nothing is diagnosed.

use super::diagnosis::Request;
use denavit_measure::condition::ConditionError;
use denavit_measure::log::MeasuredLog;
use std::fmt;

/// Why nothing is diagnosed.
#[derive(Clone, Debug, PartialEq)]
pub enum DiagnosisError {
    /// There is no log to search, or none to judge with.
    NoLog,
    /// A log has no torque of any joint; holds its name.
    NoTorque(String),
    /// A log cannot be filtered.
    Condition {
        /// The log's name.
        file: String,
        /// Why.
        error: ConditionError,
    },
}

impl DiagnosisError {
    /// What keeps a request from being answered, whatever is in its logs.
    pub(super) fn check(request: &Request<'_>) -> Result<(), Self> {
        if request.train.is_empty() || request.held_out.is_empty() {
            return Err(Self::NoLog);
        }
        let is_mute = |log: &&MeasuredLog| log.joints.iter().all(|joint| joint.tau.is_none());
        match request.train.iter().chain(&request.held_out).find(is_mute) {
            Some(log) => Err(Self::NoTorque(log.file.clone())),
            None => Ok(()),
        }
    }
}

impl fmt::Display for DiagnosisError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoLog => write!(f, "a log to search and one to judge with are needed"),
            Self::NoTorque(file) => write!(
                f,
                "{file}: no joint has a torque\n  hint: give columns `tau_JOINT`, or name them \
                 with `logs.columns`"
            ),
            Self::Condition { file, error: ConditionError::TooShort { samples, needed } } => {
                write!(
                    f,
                    "{file}: {samples} rows: with its edges cut off by the filters a log needs at \
                     least {needed}\n  hint: a longer log, or one sampled faster"
                )
            }
            Self::Condition { file, error } => write!(f, "{file}: {error}"),
        }
    }
}

impl std::error::Error for DiagnosisError {}
