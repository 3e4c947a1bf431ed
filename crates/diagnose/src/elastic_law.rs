//! A drive before a spring, whose torque is logged, where the log has the position of the joint.
//!
//! The spring passes on what the bodies take, which the motion of the joint tells. So the rotor is
//! ahead of its joint by that over the stiffness, and takes what its own motion asks for:
//!
//! ```text
//! k s + d s' = load,   tau - load = I (q + s)'' + fv (q + s)' + fc sgn((q + s)')
//! ```
//!
//! Nothing is integrated along the log but the damper, so an error of the torque where the drive
//! turns around does not ring on. The load is taken up to the frequency that references drive:
//! beyond it, two derivatives are of noise.

use super::joint_law::JointLaw;
use super::law::{Asked, Motion, Response, differences};
use super::signals::Signals;
use crate::policy::elastic_law::DIFFERENCE;
use denavit_measure::condition::Butterworth;
use denavit_plants::effect::{Drive, GivesWay};

/// Order of one pass of the filter of loads.
const ORDER: usize = 4;

impl JointLaw {
    /// What a drive takes through a transmission that is a spring and a damper, without play; none
    /// of a motor that is measured, which is where it is.
    pub(super) fn through_spring(
        &self,
        motion: &Motion<'_>,
        values: &[f64],
        asked: Asked,
    ) -> Option<Response> {
        let (joint, signals) = (self.joint, motion.signals);
        if signals.motor[joint.0].is_some() {
            return None;
        }
        let filter = Butterworth::new(ORDER, signals.driven_hz(), signals.log_step_s);
        let slow = |torque: &[f64]| {
            let mut torque = signals.cell_means(torque);
            filter.iter().for_each(|filter| filter.zero_phase(&mut torque));
            torque
        };
        let drive = motion.drives[joint.0];
        let friction = signals.qd[joint.0].iter().map(|qd| drive.friction(*qd));
        let loads = [slow(&motion.load[joint.0]), slow(&friction.collect::<Vec<f64>>())];
        let of = |values: &[f64]| vec![self.ahead(signals, drive, &loads, values)];
        let step = |place: usize| self.law.parameters[place].step(values[place], DIFFERENCE);
        let torque = of(values);
        let gradient = match asked {
            Asked::Torque => Vec::new(),
            Asked::Gradient => differences(of, &torque, values, step),
        };
        Some(Response { equations: vec![joint.0], torque, gradient })
    }

    /// What a drive takes more than if it moved with its joint, whose load and friction are at the
    /// log's samples [N m, N].
    fn ahead(
        &self,
        signals: &Signals,
        drive: Drive,
        [load, friction]: &[Vec<f64>; 2],
        values: &[f64],
    ) -> Vec<f64> {
        let gives_way = self.law.gives_way(values);
        let is_soft = |own: &GivesWay| own.swing_s > 0.0 && drive.inertia > 0.0;
        let Some(way) = gives_way.filter(is_soft) else {
            return vec![0.0; signals.samples()];
        };
        let (drive, share) = (way.split(drive).0, way.joint_friction);
        let load: Vec<f64> =
            load.iter().zip(friction).map(|(load, friction)| load + share * friction).collect();
        let stiffness = drive.inertia / (way.swing_s * way.swing_s);
        let lag_s = 2.0 * way.damping * way.swing_s;
        let ahead = deflections(&load, stiffness, lag_s / signals.log_step_s);
        let [rates, accelerations] = signals.derivatives(&ahead);
        let moves = rates.iter().zip(&accelerations).zip(signals.qd[self.joint.0].iter());
        let side = |rate: f64| if rate == 0.0 { 0.0 } else { rate.signum() };
        let of = |((rate, acceleration), joint): ((&f64, &f64), &f64)| {
            let friction = side(joint + rate) - side(*joint);
            drive.inertia * acceleration + drive.viscous * rate + drive.coulomb * friction
        };
        moves.map(of).collect()
    }
}

/// How far a spring gives way under a load, with a damper that lags by so many samples.
fn deflections(load: &[f64], stiffness: f64, lag: f64) -> Vec<f64> {
    let kept = if lag > 0.0 { (-lag.recip()).exp() } else { 0.0 };
    let mut ahead = load.first().map_or(0.0, |load| load / stiffness);
    let mut before = ahead;
    let of = |load: &f64| {
        let now = load / stiffness;
        // The load is straight between samples.
        let slope = now - before;
        ahead = now - lag * slope + kept * (ahead - before + lag * slope);
        before = now;
        ahead
    };
    load.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spring_with_a_damper_follows_a_straight_load_late() {
        let load: Vec<f64> = (0..200).map(f64::from).collect();
        let ahead = deflections(&load, 50.0, 4.0);
        // k s + d s' = load: late by d / k, after that is forgotten.
        assert!((ahead[199] - (199.0 - 4.0) / 50.0).abs() < 1e-12, "{}", ahead[199]);
        assert_eq!(deflections(&load, 50.0, 0.0)[199], 199.0 / 50.0);
    }
}
