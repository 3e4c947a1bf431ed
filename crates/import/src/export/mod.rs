//! Back into descriptions: values into a user's own file, or a whole file from a model.

mod into;
mod values;
mod whole;

pub use into::export_into;
pub use whole::export;

use crate::fault::ImportError;
use std::fmt;

/// A description made of a model.
#[derive(Clone, Debug)]
pub struct Exported {
    /// The text of the description.
    pub text: String,
    /// What the description does not say as the model does.
    pub notes: Vec<String>,
}

/// Why there is no description.
#[derive(Clone, Debug)]
pub enum ExportError {
    /// The description that values should go into is wrong.
    Description(ImportError),
    /// A description cannot say what the model says; holds what.
    Model(String),
}

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Description(error) => write!(f, "{error}"),
            Self::Model(what) => f.write_str(what),
        }
    }
}

impl std::error::Error for ExportError {}
