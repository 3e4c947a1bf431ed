//! The kind `primitives` of gait files.

use super::laws;
use crate::gait_plan::{Join, Primitive, PrimitivesProblem};
use denavit_codegen::model::{self, Fields, Node};
use denavit_simulate::scenario::{Cause, FieldsNumbers, NodeNumbers, Range, Report};

const KEYS: &[&str] = &[
    "hip_height_m",
    "torso_pitch_rad",
    "duration_s",
    "postures",
    "join",
    "margin_m",
    "steps",
    "kp",
    "kd",
    "fallback_friction",
];
const POSTURE_KEYS: &[&str] =
    &["name", "center_of_mass_m", "swing_foot_m", "hip_height_m", "torso_pitch_rad", "duration_s"];

pub(super) const PLACE_M: Range = Range::new(-10.0, 10.0);
pub(super) const HEIGHT_M: Range = Range::new(1e-3, 100.0);
pub(super) const LIFT_M: Range = Range::new(0.0, 10.0);
pub(super) const PITCH_RAD: Range = Range::new(-3.2, 3.2);
pub(super) const DURATION_S: Range = Range::new(1e-3, 100.0);
pub(super) const MARGIN_M: Range = Range::new(0.0, 1.0);
pub(super) const STEPS: Range = Range::new(1.0, 1e4);

/// Reads postures and how they are joined.
pub(super) fn read(node: Node<'_>, report: &mut Report) -> Option<PrimitivesProblem> {
    let given = &node.fields(KEYS, report)?;
    let before = report.count();
    let all = All {
        hip_height_m: given
            .get("hip_height_m")
            .map(|node| node.number_in(HEIGHT_M, report).unwrap_or(HEIGHT_M.most)),
        torso_pitch_rad: given.number("torso_pitch_rad", PITCH_RAD, 0.0, report),
        duration_s: given.number("duration_s", DURATION_S, 0.8, report),
    };
    let postures = given.require("postures", report);
    let items = postures.map_or_else(Vec::new, |node| node.items(report));
    if let (Some(node), true) = (postures, items.len() < 2) {
        report.push(node.at(), Cause::Gait("a step has two postures, at least".into(), FEW));
    }
    let items = items.into_iter().enumerate();
    let postures: Vec<Primitive> =
        items.filter_map(|(index, item)| posture(item, index, &all, report)).collect();
    let join = given.get("join");
    let join = join.and_then(|node| node.choice(&Join::WORDS, &Join::ALL, report));
    let problem = PrimitivesProblem {
        postures,
        join: join.unwrap_or_default(),
        margin_m: given.number("margin_m", MARGIN_M, 0.01, report),
        steps: given.count("steps", STEPS, 20, report),
        gains: laws::read(given, report),
    };
    (report.count() == before).then_some(problem)
}

const FEW: &str = "one with both feet on the ground, and one with the swing foot ahead";

/// What holds for postures that do not say otherwise.
struct All {
    hip_height_m: Option<f64>,
    torso_pitch_rad: f64,
    duration_s: f64,
}

fn posture(node: Node<'_>, index: usize, all: &All, report: &mut Report) -> Option<Primitive> {
    let given: &Fields<'_> = &node.fields(POSTURE_KEYS, report)?;
    let name = given.get("name").and_then(|node| node.text(report));
    let center_of_mass_m = given.required_number("center_of_mass_m", PLACE_M, report);
    given.require("swing_foot_m", report);
    let swing_foot_m = given.array("swing_foot_m", PLACE_M, [0.0; 2], report);
    if let (Some(node), true) = (given.get("swing_foot_m"), swing_foot_m[1] < 0.0) {
        report.push(node.at(), Cause::OutsideRange(swing_foot_m[1], Range::new(0.0, PLACE_M.most)));
    }
    let hip_height_m = match (given.get("hip_height_m"), all.hip_height_m) {
        (Some(node), _) => node.number_in(HEIGHT_M, report).unwrap_or(HEIGHT_M.most),
        (None, Some(height)) => height,
        (None, None) => {
            report.push(node.at(), model::Cause::MissingKey("hip_height_m").into());
            HEIGHT_M.most
        }
    };
    Some(Primitive {
        name: name.map_or_else(|| format!("posture {}", index + 1), str::to_owned),
        center_of_mass_m,
        swing_foot_m,
        hip_height_m,
        torso_pitch_rad: given.number("torso_pitch_rad", PITCH_RAD, all.torso_pitch_rad, report),
        duration_s: given.number("duration_s", DURATION_S, all.duration_s, report),
    })
}
