//! Gaits: their postures meet their conditions, and the robot walks them.

mod balance;
mod capturability;
mod capture_step;
mod comparison;
mod foot_placement;
mod gait_file;
mod gait_plan;
mod gait_schema;
mod gait_space;
mod held_joints;
mod limit_cycle;
mod passive_walkers;
mod poincare;
mod robustness;
mod tulip_step;

use denavit_plants::shipped;
use denavit_simulate::scenario::Scenario;

/// A shipped scenario.
fn scenario(name: &str) -> Scenario {
    let load = |model: &str| {
        let shipped = shipped::find_referred(model).ok_or("no such model")?;
        Ok(shipped.text.as_bytes().to_vec())
    };
    let found = shipped::SCENARIOS.iter().find(|known| known.name == name).unwrap();
    denavit_walk::read_scenario(name, found.text.as_bytes(), &load).unwrap()
}

#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected}: off by {:.3e}, allowed {tolerance:.0e}",
        (found - expected).abs()
    );
}
