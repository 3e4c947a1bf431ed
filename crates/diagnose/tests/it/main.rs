//! What a model lacks.

mod cancelling;
mod columns;
mod course;
mod elastic;
mod late_drive;
mod laws;
mod motion;
mod one_joint;
mod plainest;
mod rests;
mod ripple;
mod saturation;
mod search;
mod separate;
mod signals;
mod stops;
mod transmission;
mod turned;

use denavit_codegen::model::{self, Robot};
use denavit_plants::shipped;

/// A shipped robot.
fn robot(name: &str) -> Robot {
    let shipped = shipped::find(name).expect("a shipped model");
    model::read(name, shipped.text.as_bytes()).expect("shipped models are sound")
}
