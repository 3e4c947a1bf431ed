//! Scenarios from files.

use crate::error::{Cause, Error};
use crate::files::Files;
use crate::mistaken::FileKind;
use denavit_plants::shipped;
use denavit_simulate::scenario::Scenario;
use denavit_walk as walk;
use std::path::Path;

impl Files {
    /// The scenario of a path or of a shipped name.
    ///
    /// # Errors
    /// All that is wrong with it, or why it is not read.
    pub fn scenario(&self, path: &Path) -> Result<Scenario, Error> {
        let name = path.display().to_string();
        let all = shipped::SCENARIOS;
        let bytes = self.bytes_or_shipped(path, "scenario", all, FileKind::Scenario)?;
        let load = |model: &str| self.beside(path, model);
        Ok(walk::read_scenario(&name, &bytes, &load).map_err(Cause::Scenario)?)
    }
}
