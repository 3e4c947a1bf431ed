//! What is wrong with measurements at rest.

use std::fmt;

/// Why nothing is said: one fault, or several. It is printed with what helps, where something does.
#[derive(Clone, Debug, PartialEq)]
pub struct Error(Box<Reason>);

/// What kind of reason it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Single measurements are wrong; [`Error::faults`] has them one by one.
    Measurements,
    /// Measurements together contradict the model: they are in another unit, perhaps.
    Contradicting,
}

#[derive(Clone, Debug, PartialEq)]
struct Reason {
    kind: ErrorKind,
    text: String,
    measurement: Option<usize>,
    faults: Vec<Error>,
}

impl Error {
    /// Of measurements together.
    pub(crate) fn of_all(text: String) -> Self {
        let (kind, measurement) = (ErrorKind::Contradicting, None);
        Self(Box::new(Reason { kind, text, measurement, faults: Vec::new() }))
    }

    /// A measurement, of this number from 0, is wrong.
    pub(crate) fn of_measurement(number: usize, text: impl fmt::Display) -> Self {
        let text = format!("measurement {}: {text}", number + 1);
        let (kind, measurement) = (ErrorKind::Measurements, Some(number));
        Self(Box::new(Reason { kind, text, measurement, faults: Vec::new() }))
    }

    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        self.0.kind
    }

    /// The number of the measurement that is wrong, from 0; the first of several.
    pub fn measurement(&self) -> Option<usize> {
        self.0.faults.first().map_or(self.0.measurement, Self::measurement)
    }

    /// All that is wrong, one by one.
    pub fn faults(&self) -> Vec<Self> {
        if self.0.faults.is_empty() { vec![self.clone()] } else { self.0.faults.clone() }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.text)
    }
}

impl std::error::Error for Error {}

/// All that is wrong; of the kind of the first.
impl From<Vec<Error>> for Error {
    fn from(faults: Vec<Error>) -> Self {
        let texts: Vec<&str> = faults.iter().map(|one| one.0.text.as_str()).collect();
        let kind = faults.first().map_or(ErrorKind::Measurements, Self::kind);
        Self(Box::new(Reason { kind, text: texts.join("\n"), measurement: None, faults }))
    }
}
