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

use super::law::{Law, Motion, Response};
use super::signals::Signals;
use crate::policy::elastic_law::DIFFERENCE;
use denavit_measure::JointIndex;
use denavit_measure::condition::Butterworth;
use denavit_plants::effect::{Drive, EffectLaw, GivesWay, LawParameter};

/// Order of one pass of the filter of loads.
const ORDER: usize = 4;

/// A transmission that is a spring and a damper.
pub(super) struct ElasticLaw {
    /// The law, without play.
    pub(super) law: EffectLaw,
    /// Its joint.
    pub(super) joint: JointIndex,
}

impl ElasticLaw {
    /// What a drive takes more than if it moved with its joint, whose load is at the log's samples
    /// [N m, N].
    fn torque(&self, signals: &Signals, drive: Drive, load: &[f64], values: &[f64]) -> Vec<f64> {
        let Some(GivesWay { swing_s, damping, .. }) = self.law.gives_way(values) else {
            return vec![0.0; signals.samples()];
        };
        if swing_s <= 0.0 || drive.inertia <= 0.0 {
            return vec![0.0; signals.samples()];
        }
        let stiffness = drive.inertia / (swing_s * swing_s);
        let lag_s = 2.0 * damping * swing_s;
        let ahead = deflections(load, stiffness, lag_s / signals.log_step_s);
        let [rates, accelerations] = signals.derivatives(&ahead);
        let moves = rates.iter().zip(&accelerations).zip(&signals.qd[self.joint.0]);
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

impl Law for ElasticLaw {
    fn parameters(&self) -> &[LawParameter] {
        &self.law.parameters
    }

    fn response(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        let (joint, signals) = (self.joint, motion.signals);
        let nothing = || vec![0.0; signals.samples()];
        // A motor that is measured is where it is.
        if signals.motor[joint.0].is_some() {
            let gradient = values.iter().map(|_| vec![nothing()]).collect();
            return Response { equations: vec![joint.0], torque: vec![nothing()], gradient };
        }
        let mut load = signals.cell_means(&motion.load[joint.0]);
        if let Some(filter) = Butterworth::new(ORDER, signals.driven_hz(), signals.log_step_s) {
            filter.zero_phase(&mut load);
        }
        let of = |values: &[f64]| self.torque(signals, motion.drives[joint.0], &load, values);
        let torque = of(values);
        let by = |place: usize| {
            let start = self.law.parameters[place].start.first().copied().unwrap_or(1.0);
            let size = if values[place] > 0.0 { values[place] } else { start };
            let mut moved = values.to_vec();
            moved[place] += DIFFERENCE * size;
            let slope = torque.iter().zip(of(&moved)).map(|(a, b)| (b - a) / (DIFFERENCE * size));
            vec![slope.collect()]
        };
        let gradient = (0..values.len()).map(by).collect();
        Response { equations: vec![joint.0], torque: vec![torque], gradient }
    }
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
