//! Scenarios with gaits: the key `gait` is planned here, then the simulation sees references.

use crate::capture_step::read as read_capture_step;
use crate::weight_shift_step::{Gait, GaitError, WeightShiftStep, plan};
use denavit_codegen::model::{Fields, Node};
use denavit_plants::Plant;
use denavit_plants::trajectory::Reference;
use denavit_simulate::scenario::{
    Cause, FieldsNumbers, Loader, PlannedGait, Range, Report, Scenario, ScenarioError, read_planned,
};

const KEYS: &[&str] = &[
    "phases_s",
    "length_m",
    "lift_m",
    "heel_rise_rad",
    "weight_m",
    "knee_rad",
    "interval_s",
    "kp",
    "kd",
    "actuates_rolls",
];

const PHASE_S: Range = Range::new(0.0, 1e3);
const LENGTH_M: Range = Range::new(-10.0, 10.0);
const LIFT_M: Range = Range::new(0.0, 10.0);
const ANGLE_RAD: Range = Range::new(-4.0, 4.0);
const INTERVAL_S: Range = Range::new(1e-3, 10.0);

/// Reads a scenario file from its bytes, and plans the gait that it asks for. `file` is its name,
/// for messages alone.
///
/// # Errors
/// All faults of the file; where the gait cannot be planned, the posture and time at which.
pub fn read_scenario(
    file: &str,
    source: &[u8],
    load: &Loader<'_>,
) -> Result<Scenario, ScenarioError> {
    read_planned(file, source, load, Some(&planned))
}

/// Plans what stands under the key `gait`.
fn planned(gait: Node<'_>, plant: &mut dyn Plant, report: &mut Report) -> Option<PlannedGait> {
    let kinds = gait.fields(&["weight_shift_step", "capture_step"], report)?;
    match (kinds.get("weight_shift_step"), kinds.get("capture_step")) {
        (Some(node), None) => planned_step(node, plant, report),
        (None, Some(node)) => read_capture_step(node, plant, report),
        (Some(_), Some(other)) => other.wrong_kind("one kind of gait, not two", report),
        (None, None) => gait.wrong_kind("`weight_shift_step` or `capture_step`", report),
    }
}

/// Plans the step of the thesis.
fn planned_step(node: Node<'_>, plant: &mut dyn Plant, report: &mut Report) -> Option<PlannedGait> {
    let given = node.fields(KEYS, report)?;
    let before = report.count();
    let step = step(&given, report);
    let stiffness = given.number("kp", Range::GAIN, 3000.0, report);
    let damping = given.number("kd", Range::GAIN, 60.0, report);
    let actuates_rolls = given.flag("actuates_rolls", report);
    if report.count() > before {
        return None;
    }
    let gait = plan(plant, &step);
    let references = gait.and_then(|gait| Ok((references(plant, &gait, actuates_rolls)?, gait)));
    match references {
        Ok((references, gait)) => {
            let start = gait.postures.into_iter().next();
            Some(PlannedGait { references, stiffness, damping, start, planning: None })
        }
        Err(error) => {
            report.push(node.at(), Cause::Gait(error.to_string(), hint(&error)));
            None
        }
    }
}

/// What each driven joint follows; a roll without a drive follows only where it is actuated.
fn references(
    plant: &dyn Plant,
    gait: &Gait,
    actuates_rolls: bool,
) -> Result<Vec<Option<Reference>>, GaitError> {
    let joints = plant.model().joints.iter().enumerate();
    let of = |(joint, model): (usize, &denavit_plants::JointModel)| {
        let is_driven = model.drivable && (model.drive.is_some() || actuates_rolls);
        is_driven.then(|| gait.reference(joint)).transpose().map_err(GaitError::Spline)
    };
    joints.map(of).collect()
}

fn step(given: &Fields<'_>, report: &mut Report) -> WeightShiftStep {
    let absent = WeightShiftStep::default();
    WeightShiftStep {
        phases_s: given.array("phases_s", PHASE_S, absent.phases_s, report),
        length_m: given.number("length_m", LENGTH_M, absent.length_m, report),
        lift_m: given.number("lift_m", LIFT_M, absent.lift_m, report),
        heel_rise: given.number("heel_rise_rad", ANGLE_RAD, absent.heel_rise, report),
        weight_m: given.array("weight_m", LENGTH_M, absent.weight_m, report),
        knee: given.number("knee_rad", ANGLE_RAD, absent.knee, report),
        interval_s: given.number("interval_s", INTERVAL_S, absent.interval_s, report),
    }
}

fn hint(error: &GaitError) -> &'static str {
    match error {
        GaitError::Posture { .. } => {
            "a shorter or lower step, or a more bent knee, may be within reach"
        }
        GaitError::Missing(_) => "this gait is TUlip's",
        GaitError::TooMany(_) => "shorten `phases_s`, or lengthen `interval_s`",
        GaitError::Times | GaitError::Spline(_) => "`phases_s` are four times that increase",
    }
}
