//! Why a text is no piece of a long log.

use std::fmt;

/// Why a text is no piece of a long log of a model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PieceError {
    pub(crate) reason: String,
}

impl fmt::Display for PieceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.reason)
    }
}
