//! Why nothing is identified.

use std::fmt;

/// Why there is no answer. It is printed with what helps, where something does.
#[derive(Clone, Debug, PartialEq)]
pub struct Error(Box<Reason>);

/// What kind of reason it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Logs lack a column that is needed; [`Error::column`] has it.
    MissingColumn,
    /// Logs are too short, or nothing is left of them.
    TooShort,
    /// A log cannot be conditioned; the source says why.
    Condition,
    /// The motion does not tell parameters apart.
    NotExcited,
    /// Measurements contradict the model: another unit, perhaps. [`Error::scale`] mends a column.
    Contradicting,
    /// Robot and logs are right, and do not suit what is asked.
    Unsuitable,
    /// An iteration does not settle.
    NotSettled,
    /// A text is no piece of a log of the model.
    Piece,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
struct Reason {
    kind: ErrorKind,
    text: String,
    column: Option<String>,
    scale: Option<f64>,
    source: Option<denavit_measure::Error>,
}

impl Error {
    /// A log lacks a column of this name.
    pub fn missing_column(name: String) -> Self {
        let text = format!("the log has no column `{name}`");
        Self::new(ErrorKind::MissingColumn, text).of_column(name)
    }

    /// Of a kind, with what is printed.
    pub fn new(kind: ErrorKind, text: impl Into<String>) -> Self {
        let (column, scale, source) = (None, None, None);
        Self(Box::new(Reason { kind, text: text.into(), column, scale, source }))
    }

    /// The same with the column that it is about.
    pub fn of_column(mut self, column: String) -> Self {
        self.0.column = Some(column);
        self
    }

    /// The same with what the column is to be multiplied with.
    pub fn mended_by(mut self, scale: Option<f64>) -> Self {
        self.0.scale = scale;
        self
    }

    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        self.0.kind
    }

    /// The column of a log that is missing, or that contradicts the model.
    pub fn column(&self) -> Option<String> {
        self.0.column.clone()
    }

    /// What that column is to be multiplied with, if a known mistake explains it.
    pub fn scale(&self) -> Option<f64> {
        self.0.scale
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.text)
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.0.source.as_ref().map(|error| error as _)
    }
}

/// A log that cannot be conditioned.
impl From<denavit_measure::Error> for Error {
    fn from(error: denavit_measure::Error) -> Self {
        let mut one = Self::new(ErrorKind::Condition, error.to_string());
        one.0.source = Some(error);
        one
    }
}
