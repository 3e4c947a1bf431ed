//! Why a mapping of columns cannot be read.

use std::fmt;

/// A mapping that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct MappingError {
    /// The file, as it was given.
    pub(crate) file: String,
    /// Line and column, from 1.
    pub(crate) at: (usize, usize),
    /// What is wrong.
    pub(crate) cause: String,
}

impl fmt::Display for MappingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, at: (line, column), cause } = self;
        write!(
            f,
            "{file}:{line}:{column}: {cause}\n  hint: as {{\"q_knee\": {{\"column\": \"deg\", \
             \"scale\": 0.0174533, \"offset\": 0}}, \"t\": \"time\", \"tau_hip\": \
             null, \"q_{{joint}}\": \"/joint_states/{{joint}}/position\"}}"
        )
    }
}
