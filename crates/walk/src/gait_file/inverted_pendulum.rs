//! The kind `inverted_pendulum` of gait files.

use super::laws;
use super::primitives::{DURATION_S, HEIGHT_M, LIFT_M, MARGIN_M, PITCH_RAD, PLACE_M, STEPS};
use crate::gait_plan::InvertedPendulumProblem;
use denavit_codegen::model::Node;
use denavit_simulate::scenario::{FieldsNumbers, Range, Report};

const KEYS: &[&str] = &[
    "step_length_m",
    "step_s",
    "double_support_s",
    "steps",
    "center_of_mass_height_m",
    "lift_m",
    "torso_pitch_rad",
    "center_of_pressure_m",
    "standing_s",
    "interval_s",
    "margin_m",
    "kp",
    "kd",
    "fallback_friction",
];
const INTERVAL_S: Range = Range::new(1e-3, 1.0);

/// Reads what the walk is to be.
pub(super) fn read(node: Node<'_>, report: &mut Report) -> Option<InvertedPendulumProblem> {
    let given = &node.fields(KEYS, report)?;
    let before = report.count();
    let pressure = given.get("center_of_pressure_m").is_some();
    let problem = InvertedPendulumProblem {
        step_length_m: given.required_number("step_length_m", PLACE_M, report),
        step_s: given.required_number("step_s", DURATION_S, report),
        double_support_s: given.number("double_support_s", DURATION_S, 0.2, report),
        steps: given.count("steps", STEPS, 20, report),
        center_of_mass_height_m: given.required_number("center_of_mass_height_m", HEIGHT_M, report),
        lift_m: given.number("lift_m", LIFT_M, 0.03, report),
        torso_pitch_rad: given.number("torso_pitch_rad", PITCH_RAD, 0.0, report),
        center_of_pressure_m: pressure
            .then(|| given.array("center_of_pressure_m", PLACE_M, [0.0; 2], report)),
        standing_s: given.array("standing_s", DURATION_S, [1.0; 2], report),
        interval_s: given.number("interval_s", INTERVAL_S, 0.05, report),
        margin_m: given.number("margin_m", MARGIN_M, 0.01, report),
        gains: laws::read(given, report),
    };
    (report.count() == before).then_some(problem)
}
