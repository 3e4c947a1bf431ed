//! What is between a drive, whose torque is logged, and its joint, whose position is.
//!
//! It passes on what the bodies take, which the motion of the joint tells. So the drive is ahead of
//! its joint by s (`GivesWay::ahead`), and takes what its own motion asks for:
//!
//! ```text
//! tau - load = I (q + s)'' + fv (q + s)' + fc sgn((q + s)')
//! ```
//!
//! Nothing is integrated along the log, so an error of the torque where the drive turns around does
//! not ring on. What bends a spring is the load up to the frequency that references drive: beyond
//! it, two derivatives are of noise. Which side of a play touches, and how impacts bend it, the
//! whole load says. Where noise or friction of the joint, which is unknown while it turns around,
//! hide that, a rotor is moved along the log instead, by the torque that was measured, and what
//! then reaches the joint is compared with what it takes.

use super::floor::rms;
use super::joint_law::{JointLaw, samples};
use super::law::{Asked, Motion, Response, differences};
use super::signals::Signals;
use crate::policy::drive_law::{DIFFERENCE, LEAST_LOAD, LEAST_PASSED, OF_NOISE, TOUCHES};
use crate::policy::known::RINGING;
use denavit_measure::condition::Butterworth;
use denavit_plants::effect::{Drive, JointSamples, Passing};

/// Order of one pass of the filter of loads.
const ORDER: usize = 4;

impl JointLaw {
    /// What a drive takes through a transmission that gives way; none where the load is too small
    /// to tell its sides, and of a motor that is measured, which is where it is.
    pub(super) fn through(
        &self,
        motion: &Motion<'_>,
        values: &[f64],
        asked: Asked,
    ) -> Option<Response> {
        let (joint, signals, has_play) = (self.joint, motion.signals, self.law.has_play());
        let (size, drive) = (rms(&motion.torques.load[joint.0]), motion.torques.drives[joint.0]);
        let is_loaded = size >= LEAST_LOAD * rms(&motion.total[joint.0]);
        let way = self.law.gives_way(values)?;
        if signals.motor[joint.0].is_some() || !is_loaded {
            return None;
        }
        let (least, hides) = (TOUCHES * size, way.joint_friction * drive.coulomb);
        if has_play && hides.max(OF_NOISE * self.noise_of_load(motion)) > least {
            return self.along_log(motion, values, asked);
        }
        let slow = Butterworth::new(ORDER, signals.driven_hz(), signals.log_step_s);
        let load = |torque: &[f64]| {
            let fast = signals.cell_means(torque);
            let mut both = [fast.clone(), fast];
            slow.iter().for_each(|filter| filter.zero_phase(&mut both[1]));
            both
        };
        let friction = signals.qd[joint.0].iter().map(|qd| drive.friction(*qd));
        let loads = [load(&motion.torques.load[joint.0]), load(&friction.collect::<Vec<f64>>())];
        let passing = Passing {
            step_s: signals.log_step_s,
            qd: &signals.cell_means(&signals.qd[joint.0]),
            tau: signals.measured[joint.0].as_ref()?,
            passed: [&[]; 2],
            least,
            ringing: RINGING,
            ringing_s: signals.ringing_s(),
        };
        let of = |values: &[f64]| vec![self.more(signals, drive, (&loads, &passing), values)];
        let step = |place: usize| self.law.parameters[place].step(values[place], DIFFERENCE);
        let torque = of(values);
        let gradient = match asked {
            Asked::Torque => Vec::new(),
            Asked::Gradient => differences(of, &torque, values, step),
        };
        Some(Response { equations: vec![joint.0], torque, gradient })
    }

    /// The deviation of the load by the noise of its own encoder [N m, N].
    fn noise_of_load(&self, motion: &Motion<'_>) -> f64 {
        let inertia = rms(motion.load_slopes(self.joint).inertia());
        inertia * motion.signals.acceleration_noise(self.joint)
    }

    /// The same by a rotor that the measured torque moves along the log at the full rate. What
    /// reaches the joint is compared with what reaches it through a transmission that hardly gives
    /// way; none where nothing is to be compared.
    fn along_log(&self, motion: &Motion<'_>, values: &[f64], asked: Asked) -> Option<Response> {
        let measured = motion.signals.measured_within(self.joint)?;
        let (tau, drive) = (measured.as_slice(), motion.torques.drives[self.joint.0]);
        let samples = JointSamples { tau, drive, ..samples(motion, self.joint, None) };
        let through = self.law.through(&samples, values)?;
        let gradient = match asked {
            _ if through.share < LEAST_PASSED => return None,
            Asked::Torque => Vec::new(),
            Asked::Gradient => self.law.through_gradient(&samples, values, &through),
        };
        Some(Response::of(self.joint.0, through.torque, gradient))
    }

    /// What a drive takes more than if it moved with its joint, whose load and friction are at the
    /// log's samples [N m, N].
    fn more(
        &self,
        signals: &Signals,
        drive: Drive,
        ([load, friction], passing): (&[[Vec<f64>; 2]; 2], &Passing<'_>),
        values: &[f64],
    ) -> Vec<f64> {
        let gives_way = self
            .law
            .gives_way(values)
            .filter(|way| (way.swing_s > 0.0 || way.play > 0.0) && drive.inertia > 0.0);
        let Some(way) = gives_way else { return vec![0.0; signals.samples()] };
        let (drive, share) = (way.split(drive).0, way.joint_friction);
        let passed = [0, 1].map(|of| {
            let both = load[of].iter().zip(&friction[of]);
            both.map(|(load, friction)| load + share * friction).collect::<Vec<f64>>()
        });
        let passed = passed.each_ref().map(Vec::as_slice);
        let ahead = way.ahead(drive, &Passing { passed, ..*passing });
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
