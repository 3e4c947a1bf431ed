//! A model as `denavit` understands its file.

mod faults;
mod json;
mod text;

pub use faults::faults_json;

use super::text_of;
use crate::Values;
use denavit_codegen::model::Robot;
use serde_json::Value;

/// A robot as tables: tree, rows, masses, drives, contacts, assumptions.
pub fn model_text(robot: &Robot) -> String {
    text_of(|out| text::write(out, robot, &mut Values::new(robot)))
}

/// A robot as JSON. Values are numbers; a value that the file does not give is null.
pub fn model_json(robot: &Robot) -> Value {
    json::robot(robot, &mut Values::new(robot))
}
