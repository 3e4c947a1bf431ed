//! What is between a drive, whose torque is logged, and its joint, whose position is.

use super::floor::rms;
use super::joint_law::{JointLaw, samples};
use super::law::{Asked, Motion, Response};
use crate::policy::drive_law::{LEAST_LOAD, LEAST_PASSED};
use denavit_plants::effect::JointSamples;

impl JointLaw {
    /// What passes through a transmission that gives way; none where nothing is to be compared.
    ///
    /// The rotor is moved along the log by the torque that was measured, at the full rate; what
    /// reaches the joint then is compared with what the joint takes. So what was measured is
    /// changed and not what is computed, and the law has no torque where nothing was measured. It
    /// has two or three numbers and no amplitude: it explains nothing but by moving the rotor as it
    /// really moved.
    pub(super) fn through_play(
        &self,
        motion: &Motion<'_>,
        values: &[f64],
        asked: Asked,
    ) -> Option<Response> {
        let (joint, whole) = (self.joint, motion.signals);
        // a motor that is measured is where it is
        let is_loaded = rms(&motion.load[joint.0]) >= LEAST_LOAD * rms(&motion.total[joint.0]);
        if !is_loaded || whole.motor[joint.0].is_some() {
            return None;
        }
        let measured = whole.measured_within(joint)?;
        let (tau, drive) = (measured.as_slice(), motion.drives[joint.0]);
        let samples = JointSamples { tau, drive, ..samples(motion, joint, None) };
        let through = self.law.through(&samples, values)?;
        let gradient = match asked {
            _ if through.share < LEAST_PASSED => return None,
            Asked::Torque => Vec::new(),
            Asked::Gradient => self.law.through_gradient(&samples, values, &through),
        };
        Some(Response::of(joint.0, through.torque, gradient))
    }
}
