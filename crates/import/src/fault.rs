//! What is wrong with a file, and what was made of it that its author should know.

use denavit_codegen::model::{Explained, FileError, Report};
use std::fmt;

/// Everything that is wrong with a robot description: place, cause and hint of each fault.
pub(crate) type ImportError = FileError<Cause>;

/// The faults found so far.
pub(crate) type Faults = Report<Cause>;

/// What is wrong at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Cause {
    sentence: String,
    hint: Option<String>,
}

impl Cause {
    /// A sentence.
    pub(crate) fn new(sentence: impl Into<String>) -> Self {
        Self { sentence: sentence.into(), hint: None }
    }

    /// A sentence and the way out.
    pub(crate) fn with_hint(sentence: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { sentence: sentence.into(), hint: Some(hint.into()) }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}

impl Explained for Cause {
    fn hint(&self) -> Option<String> {
        self.hint.clone()
    }
}

/// A name or a value of a file as a message shows it.
pub(crate) fn clip(text: &str) -> String {
    const MOST: usize = 64;
    let plain = text.chars().map(|c| if c.is_control() { ' ' } else { c });
    let short: String = plain.clone().take(MOST).collect();
    if text.chars().count() > MOST { format!("{short}..") } else { short }
}

/// Names in a sentence: the first ones, and how many more there are.
pub(crate) fn listed(names: &[String]) -> String {
    const SHOWN: usize = 8;
    let shown: Vec<String> =
        names.iter().take(SHOWN).map(|name| format!("`{}`", clip(name))).collect();
    match names.len().saturating_sub(SHOWN) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}
