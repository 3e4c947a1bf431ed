//! What was measured: logs that are read, what their channels tell apart, and when.

mod log;
mod resolution;
mod timing;

use denavit_codegen::model::{self, Robot};
use denavit_plants::shipped;

/// A shipped robot.
pub(crate) fn robot(name: &str) -> Robot {
    let shipped = shipped::find(name).expect("a shipped model");
    model::read(name, shipped.text.as_bytes()).expect("shipped models are sound")
}
