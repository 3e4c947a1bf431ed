//! Simulation: plants against each other, runs against closed forms and published walkers.

mod added_friction;
mod before_springs;
mod closed_forms;
mod contact;
mod control;
mod drift;
mod drops;
mod in_space;
mod kneed_walker;
mod scenarios;
mod schema;
mod smooth;
mod time_stepping;
mod trajectory;
mod walkers;

use denavit_codegen::model;
use denavit_plants::{LoadedPlant, Override};
use std::path::Path;

/// The plant of a model file, by its path below `models`.
fn plant(path: &str) -> LoadedPlant {
    plant_with(path, &[])
}

fn plant_with(path: &str, overrides: &[(&str, f64)]) -> LoadedPlant {
    let file =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models").join(format!("{path}.json"));
    let robot = model::read(path, &std::fs::read(file).unwrap()).unwrap();
    let set =
        |(name, value): &(&str, f64)| Override { parameter: (*name).to_owned(), value: *value };
    LoadedPlant::new(&robot, &overrides.iter().map(set).collect::<Vec<_>>()).unwrap()
}

#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected}: off by {:.3e}, allowed {tolerance:.0e}",
        (found - expected).abs()
    );
}
