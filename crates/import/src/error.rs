//! Why a description is no model, or a model no description.

use crate::fault::ImportError;
use std::fmt;

/// Why a description is no model, or a model no description.
#[derive(Clone, Debug)]
pub struct Error(Box<Cause>);

/// What kind of reason it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A description is wrong; [`Error::description`] has all faults with their places.
    Description,
    /// A description cannot say what a model says.
    Model,
}

#[derive(Clone, Debug)]
enum Cause {
    Description(ImportError),
    Model(String),
}

impl Error {
    /// A description cannot say what a model says.
    pub(crate) fn unsaid(what: String) -> Self {
        Self(Box::new(Cause::Model(what)))
    }

    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        match &*self.0 {
            Cause::Description(_) => ErrorKind::Description,
            Cause::Model(_) => ErrorKind::Model,
        }
    }

    /// All that is wrong with a description.
    pub fn description(&self) -> Option<&ImportError> {
        match &*self.0 {
            Cause::Description(error) => Some(error),
            Cause::Model(_) => None,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &*self.0 {
            Cause::Description(error) => write!(f, "{error}"),
            Cause::Model(what) => f.write_str(what),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &*self.0 {
            Cause::Description(error) => Some(error),
            Cause::Model(_) => None,
        }
    }
}

impl From<ImportError> for Error {
    fn from(error: ImportError) -> Self {
        Self(Box::new(Cause::Description(error)))
    }
}
