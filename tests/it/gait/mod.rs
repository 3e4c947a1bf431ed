//! A robot that walks, from its gait through simulation to identification and diagnosis.

mod diagnosed;
mod identified;

use denavit::model::{self, Robot};
use denavit::regressor::{RegressorOptions, Unknowns};
use denavit::shipped;

fn robot(name: &str) -> Robot {
    let shipped = shipped::find(name).expect("a shipped model");
    model::read(name, shipped.text.as_bytes()).expect("shipped models are sound")
}

/// Bodies alone.
const INERTIAL: RegressorOptions = RegressorOptions {
    friction: false,
    rotor: false,
    offset: false,
    only_modelled: false,
    unknowns: Unknowns::Parameters,
};
