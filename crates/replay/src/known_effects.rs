//! Effects that a model has beside its equations, taken out of logs: what is left is what its
//! equations are about.
//!
//! Laws of what is logged are undone: positions and rates before anything is made of them, torques
//! after their filter. What laws add to torques is computed from the filtered motion, passes the
//! filter of the torques, as laws that jump need, and is subtracted. Loads are those of the values
//! that the model gives.

use super::{DriveMotion, MotionLog};
use denavit_codegen::effect::{Channel, EffectSite, SpringSide};
use denavit_measure::condition::{Butterworth, Conditioned, STENCIL};
use denavit_measure::log::MeasuredLog;
use denavit_numerics::derivative;
use denavit_plants::effect::{AddedLaw, Drive, EffectLaw, JointSamples};
use denavit_plants::regression::{RegressionModel, StandardParameter};
use std::ops::Range;

/// Undoes laws of logged positions and rates.
pub fn undo_readings(log: &mut MeasuredLog, laws: &[AddedLaw]) {
    let t: Vec<f64> = (0..log.samples()).map(|k| log.start_s + log.step_s * k as f64).collect();
    for law in laws {
        let channel = law.law.channel();
        let joint = &log.joints[law.joint];
        let zeros = vec![0.0; t.len()];
        let qd = joint.qd.clone().unwrap_or_else(|| derivative(&joint.q, log.step_s));
        let qdd = joint.qdd.clone().unwrap_or_else(|| derivative(&qd, log.step_s));
        let tau = joint.tau.as_deref().unwrap_or(&zeros);
        let samples = JointSamples {
            t: &t,
            q: &joint.q,
            qd: &qd,
            creep: &qd,
            qdd: &qdd,
            tau_load: &zeros,
            tau_load_rate: &zeros,
            tau,
            ..JointSamples::default()
        };
        match channel {
            Some(Channel::Position) => {
                log.joints[law.joint].q = law.law.corrected(&samples, &law.values);
            }
            Some(Channel::Rate) if joint.qd.is_some() => {
                log.joints[law.joint].qd = Some(law.law.corrected(&samples, &law.values));
            }
            _ => {}
        }
    }
}

/// Undoes laws of logged torques, and takes away what laws add to torques. Readings are undone.
pub fn take_out(log: &mut Conditioned, model: &RegressionModel, laws: &[AddedLaw]) {
    if laws.is_empty() {
        return;
    }
    let stencil = if log.rates.is_some() { 0 } else { STENCIL };
    let wide = stencil..log.q.first().map_or(0, Vec::len).saturating_sub(stencil);
    let mut motion = Vec::new();
    log.motion(wide.clone(), &mut motion);
    let loads = loads(model, &motion);
    let (step_s, start_s, drives) =
        (log.step_s, log.start_s, Drive::all(model, &phi_of(model, false)));
    let moved =
        Moved { motion: &motion, loads: &loads, drives, sprung: Vec::new(), step_s, start_s };
    undo_torques(&mut log.torque, laws, &moved, &wide);
    // What springs pass on is the torque of their joints, whatever makes it.
    let adds = |law: &&AddedLaw| law.law.channel().is_none() && law.law.at != EffectSite::Spring;
    for law in laws.iter().filter(adds) {
        let [joint, other] = law.joints();
        let first = Some((&law.law, [joint, other]));
        let second = law.law.on_second().map(|own| (own, [other, joint]));
        for (own, joints) in first.into_iter().chain(second) {
            let Some(torque) = &mut log.torque[joints[0]] else { continue };
            let mut added = moved
                .with(own, joints, &[], wide.start, |samples| own.torque(samples, &law.values));
            if let Some(filter) = &log.filter {
                Butterworth::zero_phase(filter, &mut added);
            }
            torque[wide.clone()].iter_mut().zip(added).for_each(|(torque, added)| *torque -= added);
        }
    }
}

/// Undoes laws of logged torques in a log that is to be simulated again: the model that is
/// simulated has the others, whose states are found along the log. Readings are undone.
pub fn undo_logged_torques(log: &mut MotionLog, model: &RegressionModel, laws: &[AddedLaw]) {
    let n = log.q.len();
    let samples = log.q.first().map_or(0, Vec::len);
    let mut motion = log.q.clone();
    motion.extend(log.qd.iter().cloned());
    motion.extend(log.qd.iter().map(|qd| derivative(qd, log.step_s)));
    debug_assert_eq!(motion.len(), 3 * n);
    let loads = loads(model, &motion);
    let (step_s, start_s, drives) =
        (log.step_s, log.start_s, Drive::all(model, &phi_of(model, false)));
    let of = |(joint, own): (usize, &Option<DriveMotion>)| {
        own.as_ref().map(|own| Sprung::new(own, &log.q[joint], &log.qd[joint], log.step_s))
    };
    let sprung = log.drives.iter().enumerate().map(of).collect();
    let moved = Moved { motion: &motion, loads: &loads, drives, sprung, step_s, start_s };
    undo_torques(&mut log.torque, laws, &moved, &(0..samples));
    let states = |law: &AddedLaw| {
        moved.with(&law.law, law.joints(), &[], 0, |samples| law.law.states(samples, &law.values))
    };
    // A simulation has states of laws of springs behind those of joints.
    let (springs, joints): (Vec<&AddedLaw>, Vec<&AddedLaw>) = laws
        .iter()
        .filter(|law| law.law.channel().is_none())
        .partition(|law| law.law.at == EffectSite::Spring);
    log.law_states = joints.into_iter().chain(springs).flat_map(states).collect();
}

fn undo_torques(
    torques: &mut [Option<Vec<f64>>],
    laws: &[AddedLaw],
    moved: &Moved<'_>,
    range: &Range<usize>,
) {
    // What was logged last is undone first.
    for law in laws.iter().rev().filter(|law| law.law.channel() == Some(Channel::Torque)) {
        let Some(torque) = &mut torques[law.joint] else { continue };
        let logged = torque[range.clone()].to_vec();
        let truth = moved.with(&law.law, law.joints(), &logged, range.start, |samples| {
            law.law.corrected(samples, &law.values)
        });
        torque[range.clone()].copy_from_slice(&truth);
    }
}

/// A drive before a series spring, on the side of its joint.
struct Sprung {
    rate: Vec<f64>,
    acceleration: Vec<f64>,
    /// How far it is ahead of the joint, and the rate of that.
    deflection: [Vec<f64>; 2],
}

impl Sprung {
    fn new(own: &DriveMotion, q: &[f64], qd: &[f64], step_s: f64) -> Self {
        let less = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
        Self {
            rate: own.rate.clone(),
            acceleration: derivative(&own.rate, step_s),
            deflection: [less(&own.angle, q), less(&own.rate, qd)],
        }
    }
}

/// A motion with its loads.
struct Moved<'a> {
    /// q, qd and qdd of every joint.
    motion: &'a [Vec<f64>],
    loads: &'a [Vec<f64>],
    drives: Vec<Drive>,
    /// Drives that move by themselves: one entry for each joint, or none at all.
    sprung: Vec<Option<Sprung>>,
    step_s: f64,
    start_s: f64,
}

impl Moved<'_> {
    /// What a law is evaluated on; the first sample is the log's sample `first`.
    fn with<T>(
        &self,
        law: &EffectLaw,
        [joint, other]: [usize; 2],
        tau: &[f64],
        first: usize,
        apply: impl FnOnce(&JointSamples<'_>) -> T,
    ) -> T {
        let n = self.motion.len() / 3;
        let samples = self.motion.first().map_or(0, Vec::len);
        let t: Vec<f64> =
            (0..samples).map(|k| self.start_s + self.step_s * (first + k) as f64).collect();
        let [load_rate, load_rate_2] =
            [joint, other].map(|joint| derivative(&self.loads[joint], self.step_s));
        let sprung = |joint: usize| self.sprung.get(joint).and_then(Option::as_ref);
        let rates = |joint: usize| match sprung(joint).filter(|_| law.side == SpringSide::Motor) {
            Some(own) => [&own.rate, &own.acceleration],
            None => [&self.motion[n + joint], &self.motion[2 * n + joint]],
        };
        let ([mut qd, qdd], [qd_2, qdd_2]) = (rates(joint), rates(other));
        let (mut q, rest) = (&self.motion[joint], vec![0.0; samples]);
        if law.at == EffectSite::Spring {
            let deflection = sprung(joint).map(|own| own.deflection.each_ref());
            [q, qd] = deflection.unwrap_or([&rest, &rest]);
        }
        apply(&JointSamples {
            t: &t,
            q,
            qd,
            creep: qd,
            qdd,
            tau_load: &self.loads[joint],
            tau_load_rate: &load_rate,
            tau,
            q_2: &self.motion[other],
            qd_2,
            qdd_2,
            tau_load_2: &self.loads[other],
            tau_load_rate_2: &load_rate_2,
            drive: self.drives[joint],
        })
    }
}

/// phi of the bodies alone, or of the drives alone, with the values that the model gives.
fn phi_of(model: &RegressionModel, of_bodies: bool) -> Vec<f64> {
    let value = |one: &StandardParameter| {
        if one.is_of_joint() == of_bodies { 0.0 } else { one.value.unwrap_or(0.0) }
    };
    let standard: Vec<f64> = model.standard.iter().map(value).collect();
    model.axes_of_standard(&standard)
}

/// The torques of the bodies alone, with the values that the model gives [N m, N].
fn loads(model: &RegressionModel, motion: &[Vec<f64>]) -> Vec<Vec<f64>> {
    model.torques(motion, &phi_of(model, true))
}
