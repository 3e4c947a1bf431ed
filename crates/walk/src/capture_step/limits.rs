//! What the robot of a scenario can do: by its controller that steps, or by its body.

use super::law::{CaptureStep, CaptureStepLaw};
use crate::capturability::StepLimits;
use crate::error::Error;
use crate::gait_plan::Walker;
use denavit_simulate::scenario::Scenario;

/// The controller of a scenario that steps onto the capture point, if it has one.
pub fn law_of(scenario: &Scenario) -> Option<&CaptureStepLaw> {
    scenario.control.planning.as_ref()?.law()
}

/// What the robot of a scenario can do: with its controller that steps, else with whole soles, the
/// height of its centre of mass at the start, and step time and length of [`CaptureStep`] where
/// nothing is said.
///
/// # Errors
/// Robots that are no planar walkers.
pub fn step_limits(scenario: &mut Scenario) -> Result<StepLimits, Error> {
    if let Some(law) = law_of(scenario) {
        return Ok(law.limits());
    }
    let plant = scenario.plant.as_mut();
    let walker = Walker::of(plant)?;
    let center = plant.center_of_mass(&scenario.initial.q);
    let height_m = plant.model().ground.height(&center);
    let numbers = CaptureStep { height_m, margin_m: 0.0, ..CaptureStep::default() };
    Ok(numbers.limits(&walker))
}
