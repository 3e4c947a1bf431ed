//! C or C++: what the two spell differently, and the names that a model has in them.

use crate::emit::names::{C, Names};

/// One of the two languages, for one model.
pub(super) struct Dialect {
    pub(super) is_cpp: bool,
    /// What the names of the model begin with; in C++ its namespace.
    pub(super) prefix: String,
    /// The same of macros.
    pub(super) upper: String,
}

impl Dialect {
    pub(super) fn c(model: &str) -> Self {
        Self::new(model, false)
    }

    pub(super) fn cpp(model: &str) -> Self {
        Self::new(model, true)
    }

    fn new(model: &str, is_cpp: bool) -> Self {
        let mut names = Names::globals(C);
        // What the global namespace has besides.
        for taken in ["main", "posix", "link", "time", "index", "abs", "div", "remove", "rename"] {
            names.claim(taken);
        }
        let prefix = names.field(&model.to_ascii_lowercase());
        let upper = prefix.to_ascii_uppercase();
        Self { is_cpp, prefix, upper }
    }

    /// The names, for templates.
    pub(super) fn filling(&self) -> [(&str, &str); 2] {
        [("prefix", &self.prefix), ("upper", &self.upper)]
    }

    /// The type of numbers in functions.
    pub(super) fn scalar(&self) -> &'static str {
        if self.is_cpp { "S" } else { "real" }
    }

    /// The first statement of a function: nothing is contracted in it.
    pub(super) fn exact(&self) -> String {
        if self.is_cpp { format!("{}_EXACT", self.upper) } else { String::new() }
    }
}
