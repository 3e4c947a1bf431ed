//! Why a log is not read, or cannot be conditioned.

use crate::log::LogFaults;
use denavit_numerics::short;
use std::fmt;

/// Why a log is not read, or cannot be conditioned. It is printed with what helps.
#[derive(Clone, Debug, PartialEq)]
pub struct Error(Box<Reason>);

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

#[derive(Clone, Debug, PartialEq)]
struct Reason {
    kind: ErrorKind,
    text: String,
    faults: Option<LogFaults>,
    rows: Option<[usize; 2]>,
}

impl Error {
    pub(crate) fn new(kind: ErrorKind, text: impl Into<String>) -> Self {
        Self(Box::new(Reason { kind, text: text.into(), faults: None, rows: None }))
    }

    /// A log has fewer samples than its filters need.
    pub fn too_short(samples: usize, needed: usize) -> Self {
        let text = format!(
            "{samples} rows: this filter cuts the edges off, and at least {needed} rows are \
             needed\n  hint: `conditions.filter` with a higher cutoff, or a lower \
             `conditions.decimation`, needs fewer"
        );
        let mut one = Self::new(ErrorKind::TooShort, text);
        one.0.rows = Some([samples, needed]);
        one
    }

    /// No filter has its cutoff there; it must be below `limit_hz`.
    pub fn cutoff(cutoff_hz: f64, limit_hz: f64) -> Self {
        let [cutoff, limit] = [cutoff_hz, limit_hz].map(short);
        let text = format!(
            "no filter of order 1 to 10 has its cutoff at {cutoff} Hz: at this sampling rate it \
             must be below {limit} Hz\n  hint: `conditions.filter` with a lower cutoff"
        );
        Self::new(ErrorKind::Cutoff, text)
    }

    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        self.0.kind
    }

    /// All that is wrong with a log.
    pub fn log_faults(&self) -> Option<&LogFaults> {
        self.0.faults.as_ref()
    }

    /// The rows of a log that is too short, and the fewest that are enough.
    pub fn rows(&self) -> Option<[usize; 2]> {
        self.0.rows
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.text)
    }
}

impl std::error::Error for Error {}

impl From<LogFaults> for Error {
    fn from(faults: LogFaults) -> Self {
        let mut one = Self::new(ErrorKind::Log, faults.to_string());
        one.0.faults = Some(faults);
        one
    }
}
