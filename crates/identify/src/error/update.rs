//! Why identified values make no model.

use denavit_codegen::model::ModelError;
use std::fmt;

/// Why identified values make no model.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum UpdateError {
    /// A value has no place in the file; holds the model's name.
    NoPlace(String),
    /// The file with the values is not that of a model.
    Unsound(ModelError),
}

impl fmt::Display for UpdateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoPlace(model) => {
                write!(f, "{model}: the identified values have no place in its file")
            }
            Self::Unsound(error) => write!(f, "{error}"),
        }
    }
}
