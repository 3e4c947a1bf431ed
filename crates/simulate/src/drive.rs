//! Drives: from commanded torque to the torque that reaches the joint.
//!
//! A stiff drive passes its command on; rotor and viscous friction stand in the plant's D and
//! bias. A series elastic one has a motor of its own (thesis 3.18-3.24): with motor angle th,
//! th_N = th / N behind the gear, and the spring force F = k (r_M th_N - r_L q),
//!
//! > Ia th'' = tau_M - fv th' - fc sign(th') - r_M F / N,  tau_joint = r_L F.

use super::control::Feedback;
use super::state::Parts;
use denavit_plants::{PlantModel, SeriesElasticModel};
use denavit_runtime::Transcendental;

/// How drives are modelled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DriveModelling {
    /// Commands reach the joints; series elastic joints count as stiff and frictionless.
    #[default]
    Ideal,
    /// As the model says, with the motors of series elastic joints and with Coulomb friction.
    Model,
    /// Commands are what joints need, as logs have it: friction of stiff drives is taken off, and
    /// springs of elastic ones have passed them on.
    Required,
}

/// Below this rate Coulomb friction is a steep line through 0 [rad/s, m/s], joint side, if nothing
/// else is said.
pub const STICTION_RATE: f64 = 1e-2;

/// The drives of a plant.
#[derive(Clone, Debug)]
pub(super) struct Drives {
    modelling: DriveModelling,
    /// Below this rate of a joint Coulomb friction is a steep line through 0 [rad/s, m/s].
    pub(super) stiction_rate: f64,
    /// Joint number of each series elastic motor.
    pub(super) elastic: Vec<usize>,
}

/// What the drives do at one instant.
#[derive(Clone, Debug, Default)]
pub(super) struct DriveOutput {
    /// Torque on each joint from its drive, friction taken off [N m, N].
    pub(super) torque: Vec<f64>,
    /// Acceleration of each motor [rad/s^2].
    pub(super) motor_acceleration: Vec<f64>,
    /// Power put in, and power lost to friction [W].
    pub(super) power: [f64; 2],
}

impl Drives {
    pub(super) fn new(model: &PlantModel, modelling: DriveModelling) -> Self {
        let is_elastic = |index: &usize| {
            let drive = model.joints[*index].drive;
            modelling == DriveModelling::Model
                && drive.is_some_and(|d| d.series_elastic.is_some() && d.rotor_inertia > 0.0)
        };
        let elastic = (0..model.joints.len()).filter(is_elastic).collect();
        Self { modelling, stiction_rate: STICTION_RATE, elastic }
    }

    /// The motor angle at which the spring of elastic joint number `index` is relaxed \[rad\].
    pub(super) fn relaxed(&self, model: &PlantModel, index: usize, q: &[f64]) -> f64 {
        let joint = self.elastic[index];
        model.joints[joint].drive.map_or(0.0, |drive| {
            drive.series_elastic.map_or(0.0, |elastic| {
                drive.gear_ratio * elastic.load_radius / elastic.motor_radius * q[joint]
            })
        })
    }

    /// What a controller sees of positions and rates.
    pub(super) fn measured(
        &self,
        model: &PlantModel,
        feedback: Feedback,
        parts: Parts<'_>,
        q: &mut Vec<f64>,
        qd: &mut Vec<f64>,
    ) {
        q.clear();
        q.extend_from_slice(parts.q);
        qd.clear();
        qd.extend_from_slice(parts.qd);
        if feedback == Feedback::Joint {
            return;
        }
        for (index, &joint) in self.elastic.iter().enumerate() {
            if let Some((drive, elastic)) = elastic_drive(model, joint) {
                let ratio = elastic.motor_radius / (elastic.load_radius * drive.gear_ratio);
                q[joint] = ratio * parts.motor[index];
                qd[joint] = ratio * parts.motor_rate[index];
            }
        }
    }

    pub(super) fn respond(
        &self,
        model: &PlantModel,
        command: &[f64],
        parts: Parts<'_>,
        output: &mut DriveOutput,
    ) {
        output.torque.clear();
        output.torque.extend_from_slice(command);
        output.motor_acceleration.clear();
        let [mut power, mut lost] = [0.0; 2];
        for (index, joint) in model.joints.iter().enumerate() {
            let (rate, torque) = (parts.qd[index], &mut output.torque[index]);
            power += *torque * rate;
            // what the plant's bias takes
            lost += (joint.viscous * rate + joint.offset) * rate;
            if self.modelling != DriveModelling::Ideal && joint.coulomb > 0.0 {
                let friction = joint.coulomb * (rate / self.stiction_rate).hyperbolic_tangent();
                *torque -= friction;
                lost += friction * rate;
            }
        }
        for (index, &joint) in self.elastic.iter().enumerate() {
            let Some((drive, elastic)) = elastic_drive(model, joint) else { continue };
            let (rate, gear) = (parts.motor_rate[index], drive.gear_ratio);
            let force = spring_force(gear, elastic, parts.motor[index], parts.q[joint]);
            power -= command[joint] * parts.qd[joint];
            let motor = command[joint] * elastic.motor_radius / (elastic.load_radius * gear);
            let reference = self.stiction_rate * gear.abs();
            let friction =
                drive.viscous * rate + drive.coulomb * (rate / reference).hyperbolic_tangent();
            power += motor * rate;
            lost += friction * rate;
            output.torque[joint] = elastic.load_radius * force;
            let net = motor - friction - elastic.motor_radius * force / gear;
            output.motor_acceleration.push(net / drive.rotor_inertia);
        }
        output.power = [power, lost];
    }

    /// The torque that each joint needs: what a stiff drive gives, of which its friction takes a
    /// part, and what the spring of an elastic one passes on.
    pub(super) fn required<'a>(
        &'a self,
        command: &'a [f64],
        torque: &'a [f64],
    ) -> impl Iterator<Item = f64> + 'a {
        command.iter().zip(torque).enumerate().map(|(joint, (command, torque))| {
            if self.elastic.contains(&joint) { *torque } else { *command }
        })
    }

    /// Friction of each joint, then of each elastic motor, as a factor of its rate: the torque that
    /// friction takes is factor times rate. Coulomb friction has the slope of its secant, so that
    /// taken implicitly it stops a motion and never turns it round.
    pub(super) fn friction_factors(
        &self,
        model: &PlantModel,
        parts: Parts<'_>,
        factors: &mut Vec<f64>,
    ) {
        factors.clear();
        let rubs = self.modelling != DriveModelling::Ideal;
        for (joint, rate) in model.joints.iter().zip(parts.qd) {
            let coulomb = if rubs { joint.coulomb } else { 0.0 };
            factors.push(joint.viscous + secant(coulomb, *rate, self.stiction_rate));
        }
        for (index, &joint) in self.elastic.iter().enumerate() {
            let drive = model.joints[joint].drive;
            factors.push(drive.map_or(0.0, |drive| {
                let reference = self.stiction_rate * drive.gear_ratio.abs();
                drive.viscous + secant(drive.coulomb, parts.motor_rate[index], reference)
            }));
        }
    }

    /// What a joint's rate and commanded torque are at its elastic motor: the motor's number, and
    /// joint rate per motor rate (and motor torque per joint torque) for a relaxed spring.
    pub(super) fn motor_of(&self, model: &PlantModel, joint: usize) -> Option<(usize, f64)> {
        let index = self.elastic.iter().position(|elastic| *elastic == joint)?;
        let (drive, elastic) = elastic_drive(model, joint)?;
        Some((index, elastic.motor_radius / (elastic.load_radius * drive.gear_ratio)))
    }

    /// Inertia of the rotor of an elastic motor [kg m^2].
    pub(super) fn rotor_inertia(&self, model: &PlantModel, index: usize) -> f64 {
        model.joints[self.elastic[index]].drive.map_or(0.0, |drive| drive.rotor_inertia)
    }

    /// Energy of springs and rotors of the series elastic drives \[J\].
    pub(super) fn energy(&self, model: &PlantModel, parts: Parts<'_>) -> f64 {
        let one = |(index, joint): (usize, &usize)| {
            elastic_drive(model, *joint).map_or(0.0, |(drive, elastic)| {
                let gear = drive.gear_ratio;
                let force = spring_force(gear, elastic, parts.motor[index], parts.q[*joint]);
                0.5 * force * force / elastic.stiffness
                    + 0.5 * drive.rotor_inertia * parts.motor_rate[index].powi(2)
            })
        };
        self.elastic.iter().enumerate().map(one).sum()
    }
}

/// Coulomb friction, a steep line below the reference rate, over the rate.
fn secant(coulomb: f64, rate: f64, reference: f64) -> f64 {
    if coulomb == 0.0 {
        return 0.0;
    }
    let share = rate / reference;
    // below the root of the precision the hyperbolic tangent is its argument
    let slope = if share.abs() < 1e-8 { 1.0 } else { share.hyperbolic_tangent() / share };
    coulomb * slope / reference
}

fn elastic_drive(
    model: &PlantModel,
    joint: usize,
) -> Option<(denavit_plants::DriveModel, SeriesElasticModel)> {
    model.joints[joint].drive.and_then(|drive| Some((drive, drive.series_elastic?)))
}

fn spring_force(gear: f64, elastic: SeriesElasticModel, motor: f64, q: f64) -> f64 {
    elastic.stiffness * (elastic.motor_radius * motor / gear - elastic.load_radius * q)
}
