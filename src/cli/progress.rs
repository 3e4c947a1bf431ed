//! What a command is doing, on one line of standard error, where somebody can see it; or for the
//! observer of a run in another program.

use super::embedded::{Observed, observed};
use super::printed::shown;
use denavit::workflow;
use std::io::{self, IsTerminal, Write};

/// The line; it is cleared in the end.
pub(crate) struct Progress {
    is_visible: bool,
    observed: Option<Observed>,
}

impl Progress {
    /// A line, if standard error is a terminal.
    pub(crate) fn new() -> Self {
        let observed = observed();
        Self { is_visible: observed.is_none() && io::stderr().is_terminal(), observed }
    }

    /// Says what is being done now.
    pub(crate) fn show(&self, what: &str) {
        if let Some(observed) = &self.observed {
            observed.progress(what, None);
        }
        self.write(what);
    }

    /// Says what is being done now, and how much of it is done, from 0 to 1.
    pub(crate) fn show_share(&self, what: &str, share: f64) {
        if let Some(observed) = &self.observed {
            observed.progress(what, Some(share));
        }
        self.write(&format!("{what}: {:.0} %", 100.0 * share));
    }

    /// Says how far a use case has come.
    pub(crate) fn report(&self, at: &workflow::Progress<'_>) {
        match at.share {
            Some(share) => self.show_share(&at.stage.to_string(), share),
            None => self.show(&at.stage.to_string()),
        }
    }

    /// Watches a use case, and stops nothing.
    pub(crate) fn observer(&self) -> impl FnMut(&workflow::Progress<'_>) -> bool + '_ {
        |at| {
            self.report(at);
            true
        }
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
