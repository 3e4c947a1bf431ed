//! Joints behind their drives, which are where the encoders are.
//!
//! Play is one reason: the drive is where it is read, and the joint is behind it. It moves by what
//! passes through the gap: a drag, and what a side that gives way a little presses with beyond half
//! the play (`GivesWay::behind`). The load is that of the logged motion, with the friction that
//! brakes the joint and not its drive.

use super::data::ModelTorques;
use super::joint_law::JointLaw;
use super::law::{Motion, Response};
use super::load_slopes::LoadSlopes;
use denavit_measure::JointIndex;
use denavit_plants::effect::GivesWay;
use std::rc::Rc;

impl JointLaw {
    /// What the torques of the joint have more than those of its drive, whose motion is logged;
    /// none of a motor that is measured, which is where it is. Its derivatives are those of a joint
    /// that is a little behind: a gap is small against what bends a robot's torques.
    pub(super) fn behind(&self, motion: &Motion<'_>, values: &[f64]) -> Option<Response> {
        let (joint, signals) = (self.joint, motion.signals);
        let (slopes, path) = self.path(motion)?;
        let deflection = path.at(self, values);
        let mut moved = signals.clone();
        let truth = signals.q[joint.0].iter().zip(&deflection).map(|(read, by)| read - by);
        moved.move_joint(joint, &truth.collect::<Vec<f64>>());
        let torque = motion.loads_beyond(&moved);
        let by = |place: usize| {
            let (mut moved, step) = (values.to_vec(), self.difference(place, values));
            moved[place] += step;
            let both = deflection.iter().zip(path.at(self, &moved));
            slopes.of(signals, &both.map(|(a, b)| (a - b) / step).collect::<Vec<f64>>())
        };
        let gradient = (0..values.len()).map(by).collect();
        Some(Response { equations: (0..torque.len()).collect(), torque, gradient })
    }

    /// The same of the joint alone, to first order and without derivatives.
    pub(super) fn behind_torque(&self, motion: &Motion<'_>, values: &[f64]) -> Option<Response> {
        let (slopes, path) = self.path(motion)?;
        let ahead: Vec<f64> = path.at(self, values).iter().map(|by| -by).collect();
        Some(Response::of(self.joint.0, slopes.of_own(motion.signals, &ahead), []))
    }

    fn path<'m>(&self, motion: &Motion<'m>) -> Option<(Rc<LoadSlopes>, Path<'m>)> {
        let (joint, signals) = (self.joint, motion.signals);
        if signals.motor[joint.0].is_some() {
            return None;
        }
        let slopes = motion.load_slopes(joint);
        // A joint on a spring without a gap is taken to follow its load, slower than it swings: one
        // that swings would take the noise of an encoder out of its position.
        let inertia = match self.law.has_play() {
            true => slopes.inertia().iter().map(|inertia| inertia.max(0.0)).collect(),
            false => vec![0.0; signals.samples()],
        };
        let at_zero = motion.inertia_at_zero(joint);
        Some((slopes, Path { motion: *motion, joint, inertia, at_zero }))
    }
}

/// What a joint goes along behind its drive.
struct Path<'m> {
    motion: Motion<'m>,
    joint: JointIndex,
    /// Of the bodies about the joint, at each sample [kg m^2, kg].
    inertia: Vec<f64>,
    /// The same where all joints are at 0.
    at_zero: f64,
}

impl Path<'_> {
    /// How far the joint is behind its drive at each sample [rad, m].
    fn at(&self, law: &JointLaw, values: &[f64]) -> Vec<f64> {
        let Motion { signals, torques: ModelTorques { load, drives, .. }, .. } = self.motion;
        let of = |way: GivesWay| {
            let (_, braked) = way.split(drives[self.joint.0]);
            let both = load[self.joint.0].iter().zip(signals.qd[self.joint.0].iter());
            let load: Vec<f64> = both.map(|(load, qd)| load + braked.friction(*qd)).collect();
            way.behind(self.at_zero, &signals.t, &load, &self.inertia)
        };
        let found = law.law.gives_way(values).filter(|_| self.at_zero > 0.0).and_then(of);
        found.unwrap_or_else(|| vec![0.0; signals.samples()])
    }
}
