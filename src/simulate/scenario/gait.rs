//! Gaits that are planned when a scenario is read: references of all driven joints, and a start.

use super::fault::Cause;
use super::ranges;
use super::reader::{Fields, Report};
use crate::plants::Plant;
use crate::simulate::control::Control;
use crate::walk::weight_shift_step::{GaitError, WeightShiftStep, plan};

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

/// Plans the gait that a scenario asks for, if any: completes the control of the driven joints, and
/// gives the first posture.
pub(super) fn gait(
    fields: &Fields<'_>,
    plant: &mut dyn Plant,
    control: &mut Control,
    report: &mut Report,
) -> Option<Vec<f64>> {
    let kinds = fields.get("gait")?.fields(&["weight_shift_step"], report)?;
    let node = kinds.require("weight_shift_step", report)?;
    let given = node.fields(KEYS, report)?;
    let before = report.count();
    let step = step(&given, report);
    let stiffness = given.number("kp", ranges::GAIN, 3000.0, report);
    let damping = given.number("kd", ranges::GAIN, 60.0, report);
    let actuates_rolls = given.flag("actuates_rolls", report);
    if report.count() > before {
        return None;
    }
    let planned = plan(plant, &step);
    let gait = planned.map_err(|error| report.push(node.at(), Cause::Gait(error))).ok()?;
    for (joint, model) in plant.model().joints.iter().enumerate() {
        let is_driven = model.drivable && (model.drive.is_some() || actuates_rolls);
        let law = &mut control.joints[joint];
        // what the scenario says of a joint itself goes before
        if !is_driven || law.reference.is_some() {
            continue;
        }
        match gait.reference(joint) {
            Ok(reference) => law.reference = Some(reference),
            Err(error) => report.push(node.at(), Cause::Gait(GaitError::Spline(error))),
        }
        if law.stiffness == 0.0 && law.damping == 0.0 {
            (law.stiffness, law.damping) = (stiffness, damping);
        }
    }
    gait.postures.into_iter().next()
}

fn step(given: &Fields<'_>, report: &mut Report) -> WeightShiftStep {
    let absent = WeightShiftStep::default();
    WeightShiftStep {
        phases_s: given.array("phases_s", ranges::PHASE_S, absent.phases_s, report),
        length_m: given.number("length_m", ranges::LENGTH_M, absent.length_m, report),
        lift_m: given.number("lift_m", ranges::LIFT_M, absent.lift_m, report),
        heel_rise: given.number("heel_rise_rad", ranges::ANGLE_RAD, absent.heel_rise, report),
        weight_m: given.array("weight_m", ranges::LENGTH_M, absent.weight_m, report),
        knee: given.number("knee_rad", ranges::ANGLE_RAD, absent.knee, report),
        interval_s: given.number("interval_s", ranges::INTERVAL_S, absent.interval_s, report),
    }
}
