//! Why nothing is diagnosed.

use super::diagnosis::Request;
use denavit_measure::log::MeasuredLog;
use std::fmt;
use std::sync::Arc;

/// Why there is no answer, or no part of one. It is printed with what helps.
#[derive(Clone, Debug)]
pub struct Error(Box<Reason>);

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
#[derive(Clone, Debug)]
struct Reason {
    kind: ErrorKind,
    text: String,
    log: Option<String>,
    source: Option<Arc<dyn std::error::Error + Send + Sync>>,
}

impl Error {
    pub(super) fn new(kind: ErrorKind, text: impl Into<String>) -> Self {
        Self(Box::new(Reason { kind, text: text.into(), log: None, source: None }))
    }

    /// Of another error.
    pub(super) fn of(
        kind: ErrorKind,
        source: impl std::error::Error + Send + Sync + 'static,
    ) -> Self {
        let mut one = Self::new(kind, source.to_string());
        one.0.source = Some(Arc::new(source));
        one
    }

    /// A log cannot be conditioned.
    pub(super) fn condition(error: denavit_measure::Error) -> Self {
        let rows = error.rows();
        let mut one = Self::of(ErrorKind::Condition, error);
        if let Some([samples, needed]) = rows {
            one.0.text = format!(
                "{samples} rows: with its edges cut off by the filters a log needs at least \
                 {needed}\n  hint: a longer log, or one sampled faster"
            );
        }
        one
    }

    /// The same in a log.
    pub(super) fn in_log(mut self, file: &str) -> Self {
        self.0.text = format!("{file}: {}", self.0.text);
        self.0.log = Some(file.to_owned());
        self
    }

    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        self.0.kind
    }

    /// The name of the log that is at fault.
    pub fn log(&self) -> Option<&str> {
        self.0.log.as_deref()
    }

    /// What keeps a request from being answered, whatever is in its logs.
    pub(super) fn check(request: &Request<'_>) -> Result<(), Self> {
        if request.train.is_empty() || request.held_out.is_empty() {
            let text = "a log to search and one to judge with are needed";
            return Err(Self::new(ErrorKind::NoLog, text));
        }
        let is_mute = |log: &&MeasuredLog| log.joints.iter().all(|joint| joint.tau.is_none());
        let mute = request.train.iter().chain(&request.held_out).find(is_mute);
        mute.map_or(Ok(()), |log| {
            let text = "no joint has a torque\n  hint: give columns `tau_JOINT`, or name them with \
                        `logs.columns`";
            Err(Self::new(ErrorKind::NoTorque, text).in_log(&log.file))
        })
    }
}

impl PartialEq for Error {
    fn eq(&self, other: &Self) -> bool {
        (self.0.kind, &self.0.text) == (other.0.kind, &other.0.text)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.text)
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.0.source.as_ref().map(|source| &**source as _)
    }
}
