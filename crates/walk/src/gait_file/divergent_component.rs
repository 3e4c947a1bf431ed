//! The kind `divergent_component` of gait files.

use super::laws;
use super::primitives::{DURATION_S, HEIGHT_M, LIFT_M, MARGIN_M, PITCH_RAD, PLACE_M, STEPS};
use crate::gait_plan::{
    AnkleRolls, ContactFriction, DivergentComponentProblem, Ending, Footstep, JointGains, Side,
};
use denavit_codegen::model::{Fields, Node};
use denavit_simulate::scenario::{Cause, FieldsNumbers, NodeNumbers, Range, Report};

const KEYS: &[&str] = &[
    "step_length_m",
    "steps",
    "turn_rad",
    "footsteps",
    "ends",
    "step_s",
    "double_support_s",
    "standing_s",
    "center_of_mass_height_m",
    "lift_m",
    "step_width_m",
    "first_swing",
    "torso_pitch_rad",
    "center_of_pressure_m",
    "pressure_inward_m",
    "ankle_rolls",
    "corrections",
    "interval_s",
    "margin_m",
    "kp",
    "kd",
    "friction",
];
const FOOTSTEP_KEYS: &[&str] = &["forward_m", "left_m", "turn_rad", "width_m"];
const TURN_RAD: Range = Range::new(-100.0, 100.0);
const WIDTH_M: Range = Range::new(1e-3, 10.0);
const CORRECTIONS: Range = Range::new(0.0, 10.0);
const INTERVAL_S: Range = Range::new(1e-3, 1.0);
const GAINS: JointGains =
    JointGains { kp: 3000.0, kd: 60.0, friction: ContactFriction::Coulomb(0.8) };

/// Reads what the walk is to be.
pub(crate) fn read(node: Node<'_>, report: &mut Report) -> Option<DivergentComponentProblem> {
    let given = &node.fields(KEYS, report)?;
    let before = report.count();
    let inward = given.get("pressure_inward_m");
    let rolls = given.get("ankle_rolls");
    let rolls = rolls.and_then(|node| node.choice(&AnkleRolls::WORDS, &AnkleRolls::ALL, report));
    let ends = given.get("ends");
    let ends = ends.and_then(|node| node.choice(&Ending::WORDS, &Ending::ALL, report));
    let first = given.get("first_swing");
    let first = first.and_then(|node| node.choice(&Side::WORDS, &Side::ALL, report));
    let width = given.get("step_width_m");
    let problem = DivergentComponentProblem {
        footsteps: footsteps(given, report),
        ends: ends.unwrap_or_default(),
        step_s: given.required_number("step_s", DURATION_S, report),
        double_support_s: given.number("double_support_s", DURATION_S, 0.2, report),
        standing_s: given.array("standing_s", DURATION_S, [1.0; 2], report),
        center_of_mass_height_m: given.required_number("center_of_mass_height_m", HEIGHT_M, report),
        lift_m: given.number("lift_m", LIFT_M, 0.03, report),
        step_width_m: width.and_then(|node| node.number_in(WIDTH_M, report)),
        first_swing: first.unwrap_or(Side::Left),
        torso_pitch_rad: given.number("torso_pitch_rad", PITCH_RAD, 0.0, report),
        center_of_pressure_m: given.array("center_of_pressure_m", PLACE_M, [0.0; 2], report),
        pressure_inward_m: inward.and_then(|node| node.number_in(PLACE_M, report)),
        ankle_rolls: rolls.unwrap_or_default(),
        corrections: given.count("corrections", CORRECTIONS, 3, report),
        interval_s: given.number("interval_s", INTERVAL_S, 0.05, report),
        margin_m: given.number("margin_m", MARGIN_M, 0.01, report),
        gains: laws::read_with_friction(given, GAINS, report),
    };
    (report.count() == before).then_some(problem)
}

/// Steps one by one, or all alike, of which the last puts the feet side by side.
fn footsteps(given: &Fields<'_>, report: &mut Report) -> Vec<Footstep> {
    if let Some(node) = given.get("footsteps") {
        for key in ["step_length_m", "steps", "turn_rad"] {
            if let Some(other) = given.get(key) {
                report.push(other.at(), Cause::Gait(TWICE.to_owned(), ONE));
            }
        }
        let items = node.items(report);
        if items.is_empty() {
            report.push(node.at(), Cause::Gait("there are no steps".to_owned(), "list one"));
        }
        return items.into_iter().filter_map(|item| footstep(item, report)).collect();
    }
    if let Some(node) = given.get("ends") {
        report.push(node.at(), Cause::Gait(ALIKE.to_owned(), "list the `footsteps`"));
    }
    let forward_m = given.required_number("step_length_m", PLACE_M, report);
    let onward = given.count("steps", STEPS, 10, report).saturating_sub(1);
    let turn_rad = given.number("turn_rad", TURN_RAD, 0.0, report) / onward.max(1) as f64;
    vec![Footstep { forward_m, left_m: 0.0, turn_rad, width_m: None }; onward]
}

const ALIKE: &str = "steps that are all alike end side by side";
const TWICE: &str = "`footsteps` say all steps one by one";
const ONE: &str = "leave out `footsteps`, or this key";

fn footstep(node: Node<'_>, report: &mut Report) -> Option<Footstep> {
    let given = &node.fields(FOOTSTEP_KEYS, report)?;
    Some(Footstep {
        forward_m: given.number("forward_m", PLACE_M, 0.0, report),
        left_m: given.number("left_m", PLACE_M, 0.0, report),
        turn_rad: given.number("turn_rad", PITCH_RAD, 0.0, report),
        width_m: given.get("width_m").and_then(|node| node.number_in(WIDTH_M, report)),
    })
}
