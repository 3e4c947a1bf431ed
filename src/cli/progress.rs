//! What a command is doing, on one line of standard error, where somebody can see it.

use super::printed::shown;
use std::io::{self, IsTerminal, Write};

/// The line; it is cleared in the end.
pub(crate) struct Progress {
    is_visible: bool,
}

impl Progress {
    /// A line, if standard error is a terminal.
    pub(crate) fn new() -> Self {
        Self { is_visible: io::stderr().is_terminal() }
    }

    /// Says what is being done now.
    pub(crate) fn show(&self, what: &str) {
        self.write(what);
    }

    /// Takes the line away, so that an answer can be written.
    pub(crate) fn clear(&self) {
        self.write("");
    }

    fn write(&self, text: &str) {
        if self.is_visible {
            let mut line = io::stderr().lock();
            // progress that cannot be shown is no reason to stop
            let _ = write!(line, "\r\x1b[2K{}", shown(text)).and_then(|()| line.flush());
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.write("");
    }
}
