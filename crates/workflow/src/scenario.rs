//! Scenarios from files.

use crate::error::{Cause, Error, ErrorKind};
use crate::files::Files;
use denavit_codegen::model::json::{self, Value};
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
        let bytes = match self.bytes_or_shipped(path, ("scenario", shipped::SCENARIOS)) {
            Err(error)
                if error.kind() == ErrorKind::NotFound
                    && shipped::find_referred(&name).is_some() =>
            {
                return Err(Cause::ModelForScenario(name).into());
            }
            read => read?,
        };
        if is_model(&bytes) {
            return Err(Cause::ModelForScenario(name).into());
        }
        let load = |model: &str| self.beside(path, model);
        Ok(walk::read_scenario(&name, &bytes, &load).map_err(Cause::Scenario)?)
    }
}

/// Whether a file says of itself that it is a model.
fn is_model(bytes: &[u8]) -> bool {
    let root = json::parse(bytes).ok();
    let tag = root.as_ref().and_then(|root| root.entries().iter().find(|(key, _)| key == "format"));
    let text = tag.map(|(_, tag)| &tag.value);
    matches!(text, Some(Value::Text(tag)) if tag.starts_with("denavit-model/"))
}
