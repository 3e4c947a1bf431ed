//! Logs as the second stage sees them: with the torques on the loads, which springs measure.

use crate::error::{Cause, Error};
use denavit_elastic::Spring;
use denavit_measure::condition::{Conditioned, Conditioning};
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_plants::{JointModel, PlantModel, SeriesElasticModel};

/// A log whose torques are those on the loads: of elastic joints r_L (k (r_M th / N - r_L q) + F0)
/// (3.24), of stiff ones that of the drive less what its rotor takes. Filters are linear: torques
/// of springs may be found before them.
pub(super) fn conditioned(
    plant: &PlantModel,
    log: &MeasuredLog,
    springs: &[Spring],
    how: &Conditioning,
) -> Result<Conditioned, Error> {
    let joints = plant.joints.iter().zip(&log.joints).map(|(joint, own)| {
        let spring = springs.iter().find(|spring| spring.joint == joint.name);
        let tau = match (joint.drive.and_then(|drive| drive.series_elastic), spring) {
            (Some(elastic), Some(spring)) => of_spring(joint, elastic, spring, own),
            _ => own.tau.clone().ok_or_else(|| missing("tau", joint)),
        };
        Ok(JointSignals { q: own.q.clone(), tau: Some(tau?), ..JointSignals::default() })
    });
    let joints: Result<Vec<JointSignals>, denavit_identify::Error> = joints.collect();
    let failed = |error| Cause::Identify(log.file.clone(), error);
    let MeasuredLog { start_s, step_s, .. } = *log;
    let loads = MeasuredLog {
        file: log.file.clone(),
        start_s,
        step_s,
        joints: joints.map_err(failed)?,
        ..MeasuredLog::default()
    };
    let names: Vec<String> = plant.joints.iter().map(|joint| joint.name.clone()).collect();
    let conditioned = Conditioned::new(loads, &names, how);
    let mut conditioned = conditioned.map_err(|error| Cause::Condition(log.file.clone(), error))?;
    take_rotors_out(plant, &mut conditioned);
    Ok(conditioned)
}

fn missing(prefix: &str, joint: &JointModel) -> denavit_identify::Error {
    denavit_identify::Error::missing_column(format!("{prefix}_{}", joint.name))
}

fn of_spring(
    joint: &JointModel,
    elastic: SeriesElasticModel,
    spring: &Spring,
    own: &JointSignals,
) -> Result<Vec<f64>, denavit_identify::Error> {
    let gear = joint.drive.map_or(1.0, |drive| drive.gear_ratio);
    let SeriesElasticModel { motor_radius, load_radius, .. } = elastic;
    let [stiffness, preload] = [spring.stiffness.value, spring.preload.value];
    let motors = own.motor.as_ref().ok_or_else(|| missing("motor", joint))?;
    let torque = |(motor, q): (&f64, &f64)| {
        let elongation = motor_radius * motor / gear - load_radius * q;
        load_radius * (stiffness * elongation + preload)
    };
    Ok(motors.iter().zip(&own.q).map(torque).collect())
}

/// Inertias of rotors are known (thesis 3.3.1); those behind springs do not reach the load.
fn take_rotors_out(plant: &PlantModel, log: &mut Conditioned) {
    let range = log.range.clone();
    let mut motion = Vec::new();
    log.motion(range.clone(), &mut motion);
    for (joint, described) in plant.joints.iter().enumerate() {
        let stiff = described.drive.filter(|drive| drive.series_elastic.is_none());
        let (Some(drive), Some(torque)) = (stiff, &mut log.torque[joint]) else { continue };
        let reflected = drive.gear_ratio.powi(2) * drive.rotor_inertia;
        let accelerations = &motion[2 * plant.joints.len() + joint];
        for (torque, acceleration) in torque[range.clone()].iter_mut().zip(accelerations) {
            *torque -= reflected * acceleration;
        }
    }
}
