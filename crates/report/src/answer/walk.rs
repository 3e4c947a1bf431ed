//! Gaits and their stability.

mod balance;
mod balance_log;
mod basin;
mod capturability;
mod capture_steps;
mod comparison;
mod cycle;
mod designed;
mod gait_page;
mod push;

pub use balance::{BalanceCriterion, balance_json, balance_picture, balance_text};
pub use balance_log::{balance_events, balance_series};
pub use basin::{BasinAnswer, basin_json, basin_log, basin_picture, basin_text};
pub use capturability::{
    CapturabilityAnswer, capturability_json, capturability_picture, capturability_text,
};
pub use capture_steps::{capture_steps_json, capture_steps_text};
pub use comparison::{comparison_json, comparison_page, comparison_text};
pub use cycle::{cycle_json, cycle_text, is_stable, multipliers_picture, returns_picture};
pub use designed::{designed_json, designed_picture, designed_text};
pub use gait_page::gait_page;
pub use push::{PushAnswer, push_json, push_picture, push_text};

use denavit_plants::PlantModel;
use std::fmt::{self, Write};

/// A model that names nothing that must not touch the ground never falls, whatever it does.
fn write_what_is_no_fall(out: &mut String, model: &PlantModel) -> fmt::Result {
    if model.fall_points.is_empty() {
        let name = &model.name;
        writeln!(out, "\nnothing counts as a fall: {name} has no `bodies_that_must_not_touch`")?;
    }
    Ok(())
}
