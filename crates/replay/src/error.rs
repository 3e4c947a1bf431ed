//! Why a log is not simulated again.

use std::fmt;

/// Why a model was not moved along a log. It is printed with what helps, where something does.
#[derive(Clone, Debug, PartialEq)]
pub struct Error(Box<Reason>);

#[derive(Clone, Debug, PartialEq)]
struct Reason {
    kind: ErrorKind,
    text: String,
    column: Option<String>,
    start: Option<denavit_simulate::Error>,
}

/// What kind of reason it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The log lacks a column that is needed.
    MissingColumn,
    /// The log is shorter than one window.
    TooShort,
    /// Robot and log are right, and do not suit what is asked.
    Unsuitable,
    /// The simulation does not begin; the source says why.
    NotStarted,
    /// The simulation broke off.
    BrokeOff,
}

impl Error {
    /// The log lacks a column of this name.
    pub(crate) fn missing(column: String, text: String) -> Self {
        let mut one = Self::new(ErrorKind::MissingColumn, text);
        one.0.column = Some(column);
        one
    }

    pub(crate) fn new(kind: ErrorKind, text: impl Into<String>) -> Self {
        Self(Box::new(Reason { kind, text: text.into(), column: None, start: None }))
    }

    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        self.0.kind
    }

    /// The column of the log that is missing.
    pub fn column(&self) -> Option<&str> {
        self.0.column.as_deref()
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.text)
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.0.start.as_ref().map(|error| error as _)
    }
}

/// A simulation that does not begin.
impl From<denavit_simulate::Error> for Error {
    fn from(error: denavit_simulate::Error) -> Self {
        let mut one = Self::new(ErrorKind::NotStarted, error.to_string());
        one.0.start = Some(error);
        one
    }
}
