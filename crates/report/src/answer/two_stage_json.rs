//! Two stages as JSON.

use super::identified_json::{ConsistentJson, ParameterJson};
use denavit_elastic::{Estimate, Spring};
use denavit_workflow::TwoStageFound;
use serde::Serialize;

/// Springs, motors and load, as JSON (docs/reference/identification.md).
pub fn two_stage_json(found: &TwoStageFound) -> impl Serialize + '_ {
    let residuals = found.model.joints.iter().zip(&found.stages.residuals);
    TwoStageJson {
        model: &found.model.model,
        springs: found.stages.springs.iter().map(SpringJson::new).collect(),
        parameters: found.parameters.iter().map(ParameterJson::new).collect(),
        residual: residuals
            .map(|(joint, &[residual_rms, torque_rms])| ResidualJson {
                joint: &joint.name,
                torque_rms,
                residual_rms,
                validate: found.left_of(&joint.name),
            })
            .collect(),
        validate: found.validate.as_ref().map(|held_out| held_out.relative),
        consistent: ConsistentJson::new(&found.model, &found.bodies),
        remarks: &found.remarks,
    }
}

#[derive(Serialize)]
struct TwoStageJson<'a> {
    model: &'a str,
    springs: Vec<SpringJson<'a>>,
    parameters: Vec<ParameterJson<'a>>,
    residual: Vec<ResidualJson<'a>>,
    /// Residual over torque of the logs for validation, over all joints.
    validate: Option<f64>,
    /// theta0 of the nearest bodies that exist, and how far they are.
    consistent: ConsistentJson<'a>,
    remarks: &'a [String],
}

#[derive(Serialize)]
struct SpringJson<'a> {
    joint: &'a str,
    stiffness: EstimateJson,
    viscous: EstimateJson,
    coulomb: EstimateJson,
    /// The force of the spring where both encoders read 0.
    preload: EstimateJson,
    /// The motor's reading where the spring is relaxed and the joint reads 0.
    motor_zero: EstimateJson,
    /// Roots of the mean square of what the motor's equation misses, and of its torque \[N m\].
    residual_rms: f64,
    torque_rms: f64,
}

#[derive(Serialize)]
struct EstimateJson {
    value: f64,
    std: f64,
    unit: &'static str,
}

#[derive(Serialize)]
struct ResidualJson<'a> {
    joint: &'a str,
    torque_rms: f64,
    residual_rms: f64,
    /// Residual over torque of the logs for validation.
    validate: Option<f64>,
}

impl<'a> SpringJson<'a> {
    fn new(spring: &'a Spring) -> Self {
        let of = |Estimate { value, std }, unit| EstimateJson { value, std, unit };
        Self {
            joint: &spring.joint,
            stiffness: of(spring.stiffness, "N/m"),
            viscous: of(spring.viscous, "N m s/rad"),
            coulomb: of(spring.coulomb, "N m"),
            preload: of(spring.preload, "N"),
            motor_zero: of(spring.motor_zero, "rad"),
            residual_rms: spring.residual,
            torque_rms: spring.torque,
        }
    }
}
