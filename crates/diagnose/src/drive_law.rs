//! What is between a drive, whose torque is logged, and its joint, whose position is.

use super::floor::rms;
use super::law::{Law, Motion, Response};
use crate::policy::drive_law::{LEAST_LOAD, LEAST_PASSED};
use denavit_measure::JointIndex;
use denavit_plants::effect::{EffectLaw, JointSamples, LawParameter};

/// A transmission that gives way.
///
/// The rotor is moved along the log by the torque that was measured, at the full rate; what reaches
/// the joint then is compared with what the joint takes. So what was measured is changed and not
/// what is computed, and the law has no torque where nothing was measured. It has two or three
/// numbers and no amplitude: it explains nothing but by moving the rotor as it really moved.
pub(super) struct DriveLaw {
    /// The law.
    pub(super) law: EffectLaw,
    /// Its joint.
    pub(super) joint: JointIndex,
}

impl Law for DriveLaw {
    fn parameters(&self) -> &[LawParameter] {
        &self.law.parameters
    }

    fn follows_accelerations(&self) -> bool {
        true
    }

    fn response(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        let (joint, whole) = (self.joint, motion.signals);
        let nothing = || vec![vec![0.0; motion.signals.samples()]];
        let mut response = Response {
            equations: vec![joint.0],
            torque: nothing(),
            gradient: values.iter().map(|_| nothing()).collect(),
        };
        // a motor that is measured is where it is
        let is_loaded = rms(&motion.load[joint.0]) >= LEAST_LOAD * rms(&motion.total[joint.0]);
        let is_seen = is_loaded && whole.motor[joint.0].is_none();
        let measured = whole.measured_within(joint).filter(|_| is_seen);
        let Some(measured) = measured else { return response };
        let samples = JointSamples {
            t: &whole.t,
            q: &whole.q[joint.0],
            qd: &whole.qd[joint.0],
            qdd: &whole.qdd[joint.0],
            tau: &measured,
            drive: motion.drives[joint.0],
            ..JointSamples::default()
        };
        let through = self.law.through(&samples, values);
        if let Some(through) = through.filter(|through| through.share >= LEAST_PASSED) {
            let all = std::iter::once(through.torque).chain(through.gradient);
            let mut all = all.map(|signal| vec![signal]);
            response.torque = all.next().unwrap_or_default();
            response.gradient = all.collect();
        }
        response
    }
}
