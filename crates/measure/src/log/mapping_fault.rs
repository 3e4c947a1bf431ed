//! What can be wrong with a mapping of columns.

use denavit_codegen::model::{self, Explained};
use std::fmt;

/// What is wrong at a place of a mapping.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum MappingCause {
    /// A fault of form: of JSON, of keys, of kinds of values.
    Form(model::Cause),
    /// An entry of another kind; holds what it is.
    NoEntry(&'static str),
    /// A scale of 0, or about that.
    NoScale,
    /// A name without letters.
    NoName,
}

impl From<model::Cause> for MappingCause {
    fn from(cause: model::Cause) -> Self {
        Self::Form(cause)
    }
}

impl fmt::Display for MappingCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Form(cause) => write!(f, "{cause}"),
            Self::NoEntry(found) => {
                write!(f, "an entry is the name of a column, an object, or null; found {found}")
            }
            Self::NoScale => write!(f, "a scale of 0 makes every number of the column the same"),
            Self::NoName => write!(f, "the name of the column is empty"),
        }
    }
}

impl Explained for MappingCause {
    fn hint(&self) -> Option<String> {
        let example = "as {\"q_knee\": {\"column\": \"deg\", \"scale\": 0.0174533, \
                       \"offset\": 0}, \"t\": \"time\", \"tau_hip\": null, \"q_{joint}\": \
                       \"/joint_states/{joint}/position\"}";
        match self {
            Self::Form(cause) => cause.hint(),
            Self::NoEntry(_) => Some(example.to_owned()),
            Self::NoScale => None,
            Self::NoName => Some("null leaves a column out".to_owned()),
        }
    }
}
