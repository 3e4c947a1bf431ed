//! What was identified, as JSON.

use super::Shown;
use crate::cli::failure::Failure;
use crate::cli::json::write_json;
use denavit::identify::estimate::{JointResidual, Status};
use serde::Serialize;
use std::io::Write;

#[derive(Serialize)]
struct IdentifyJson<'a> {
    model: &'a str,
    parameters: Vec<ParameterJson<'a>>,
    residual: ResidualJson<'a>,
    condition: Option<f64>,
    scaled_condition: Option<f64>,
    rank: usize,
    excited: usize,
    samples: usize,
    degrees_of_freedom: f64,
    /// theta0 of the nearest bodies that exist, and how far they are.
    consistent: ConsistentJson<'a>,
    convergence: Vec<ConvergenceJson<'a>>,
    remarks: Vec<String>,
}

#[derive(Serialize)]
struct ParameterJson<'a> {
    name: &'a str,
    expression: &'a str,
    latex: &'a str,
    value: f64,
    std: Option<f64>,
    interval: Option<[f64; 2]>,
    unit: &'a str,
    identifiable: bool,
    status: &'static str,
    model_value: Option<f64>,
}

#[derive(Serialize)]
struct ResidualJson<'a> {
    train: f64,
    validate: Option<f64>,
    /// On the logs for validation, with the values that the model had.
    before: Option<f64>,
    per_joint: Vec<JointJson<'a>>,
}

#[derive(Serialize)]
struct JointJson<'a> {
    joint: &'a str,
    train: f64,
    validate: Option<f64>,
    torque_rms: f64,
    residual_rms: f64,
    autocorrelation: &'a [f64],
}

#[derive(Serialize)]
struct ConsistentJson<'a> {
    distance: f64,
    parameters: Vec<StandardJson<'a>>,
}

#[derive(Serialize)]
struct StandardJson<'a> {
    name: &'a str,
    unit: &'a str,
    value: f64,
}

#[derive(Serialize)]
struct ConvergenceJson<'a> {
    time_s: f64,
    values: &'a [f64],
    condition: Option<f64>,
}

/// JSON has no infinity.
fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

pub(super) fn write(out: &mut dyn Write, shown: &Shown<'_>) -> Result<(), Failure> {
    let Shown { robot, model, found, remarks } = shown;
    let parameters = found.parameters.iter().map(|one| ParameterJson {
        name: &one.name,
        expression: &one.expression,
        latex: &one.latex,
        value: one.value,
        std: one.std,
        interval: one.interval.map(|half| [one.value - half, one.value + half]),
        unit: &one.unit,
        identifiable: one.status != Status::NotExcited,
        status: one.status.word(),
        model_value: one.model_value,
    });
    let held_out = |joint: &JointResidual| {
        let joints = &found.validate.as_ref()?.joints;
        joints.iter().find(|other| other.name == joint.name).map(|other| other.relative)
    };
    let joints = found.train.joints.iter().map(|joint| JointJson {
        joint: &joint.name,
        train: joint.relative,
        validate: held_out(joint),
        torque_rms: joint.torque_rms,
        residual_rms: joint.residual_rms,
        autocorrelation: &joint.autocorrelation,
    });
    let solution = &found.estimate.solution;
    let standard = model.standard.iter().zip(&found.consistent.standard);
    let convergence = found.convergence.iter().map(|point| ConvergenceJson {
        time_s: point.time_s,
        values: &point.values,
        condition: finite(point.condition),
    });
    let json = IdentifyJson {
        model: &robot.name,
        parameters: parameters.collect(),
        residual: ResidualJson {
            train: found.train.relative,
            validate: found.validate.as_ref().map(|all| all.relative),
            before: found.before,
            per_joint: joints.collect(),
        },
        condition: finite(solution.condition),
        scaled_condition: finite(solution.scaled_condition),
        rank: model.rank(),
        excited: solution.excited(),
        samples: found.train.samples,
        degrees_of_freedom: found.estimate.degrees_of_freedom,
        consistent: ConsistentJson {
            distance: found.consistent.distance,
            parameters: standard
                .map(|(one, &value)| StandardJson { name: &one.name, unit: &one.unit, value })
                .collect(),
        },
        convergence: convergence.collect(),
        remarks: remarks
            .iter()
            .map(|(file, remark)| format!("{file}: {remark}"))
            .chain(found.bias())
            .collect(),
    };
    write_json(out, &json)
}
