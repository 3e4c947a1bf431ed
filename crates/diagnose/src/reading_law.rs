//! Effects that stand between a position or velocity and its log: the model was given what is
//! logged, and gives other torques for what is true.

use super::joint_law::{JointLaw, samples};
use super::law::{Motion, Response, differences};
use super::rows::PerJoint;
use super::signals::Signals;
use crate::policy::joint_law::DIFFERENCE;
use denavit_codegen::effect::Channel;

impl JointLaw {
    /// What the torques of the true motion have more than those of the logged one.
    pub(super) fn read(&self, motion: &Motion<'_>, values: &[f64]) -> Response {
        let of = |values: &[f64]| self.of_truth(motion, values);
        let torque = of(values);
        let gradient = differences(of, &torque, values, |place| self.difference(place, values));
        Response { equations: (0..torque.len()).collect(), torque, gradient }
    }

    /// By how much a parameter is moved for a difference.
    pub(super) fn difference(&self, place: usize, values: &[f64]) -> f64 {
        let sizes = self.law.parameters[place].start.iter().map(|start| start.abs());
        let size = sizes.fold(values[place].abs(), f64::max);
        DIFFERENCE * if size > 0.0 { size } else { 1.0 }
    }

    fn of_truth(&self, motion: &Motion<'_>, values: &[f64]) -> PerJoint {
        let (joint, logged) = (self.joint, motion.signals);
        let mut signals: Signals = logged.clone();
        let truth = self.law.corrected(&samples(motion, joint, None), values);
        if self.law.is_read_at_drive() && logged.motor[joint.0].is_none() {
            let [q, qd, qdd] = [&logged.q, &logged.qd, &logged.qdd].map(|all| all[joint.0].clone());
            signals.motor[joint.0] = Some([q, qd, qdd]);
        }
        match self.law.channel() {
            Some(Channel::Position) => signals.move_joint(joint, &truth),
            _ => signals.qd[joint.0] = truth.into(),
        }
        let mut torques = motion.torques_of(&signals);
        for (torque, own) in torques.iter_mut().flatten().zip(motion.total.iter().flatten()) {
            *torque -= own;
        }
        torques
    }
}
