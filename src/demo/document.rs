//! Files of the demo.

use serde::Serialize;
use std::fmt;
use std::path::Path;

/// A file that is to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Document {
    /// The name of the file.
    pub name: String,
    /// All of it.
    pub text: String,
    /// What it is.
    pub what: String,
}

/// A file that was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Written {
    file: String,
    bytes: usize,
    what: String,
}

impl Written {
    /// A file of so many bytes, and what it is.
    pub fn new(file: &Path, bytes: usize, what: &str) -> Self {
        Self { file: file.display().to_string(), bytes, what: what.to_owned() }
    }
}

impl fmt::Display for Written {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "wrote {} ({} kB): {}", self.file, self.bytes.div_ceil(1000), self.what)
    }
}
