//! Effects that stand between a position or velocity and its log.
//!
//! Play after the encoder is one: the drive is where it is read, and the joint is behind it on one
//! side of the gap or on the other, as its load is. That load is of the true motion. Taken of the
//! motion of the drive, it lacks what the deflection itself accelerates, and a joint would cross a
//! gap at once that it falls through in a tenth of a second:
//!
//! ```text
//! logged = q + D(load),   load = load of the logged motion - M d^2/dt^2 D(load)
//! ```
//!
//! with M the inertia of the bodies about the joint. Steps in time are implicit, which damps what
//! swings faster than they are.

use super::joint_law::{JointLaw, samples};
use super::law::{Motion, Response, differences};
use super::rows::PerJoint;
use super::signals::Signals;
use crate::policy::joint_law::DIFFERENCE;
use crate::policy::reading_law::REACH;
use denavit_codegen::effect::Channel;
use denavit_plants::effect::{EffectLaw, JointSamples};

impl JointLaw {
    /// What is between a position or velocity and its log: the model was given what is logged, and
    /// gives other torques for what is true.
    pub(super) fn read(&self, motion: &Motion<'_>, values: &[f64], has_gap: bool) -> Response {
        let of = |values: &[f64]| self.of_truth(motion, values, has_gap);
        let step = |place: usize| {
            let sizes = self.law.parameters[place].start.iter().map(|start| start.abs());
            let size = sizes.fold(values[place].abs(), f64::max);
            DIFFERENCE * if size > 0.0 { size } else { 1.0 }
        };
        let torque = of(values);
        let gradient = differences(of, &torque, values, step);
        Response { equations: (0..torque.len()).collect(), torque, gradient }
    }

    /// What the torques of the true motion have more than those of the logged one.
    fn of_truth(&self, motion: &Motion<'_>, values: &[f64], has_gap: bool) -> PerJoint {
        let (joint, logged) = (self.joint, motion.signals);
        let mut signals: Signals = logged.clone();
        let is_drive = self.law.is_read_at_drive() && logged.motor[joint.0].is_none();
        let truth: Vec<f64> = if is_drive && has_gap {
            let deflection = self.deflection(motion, values);
            logged.q[joint.0].iter().zip(deflection).map(|(read, by)| read - by).collect()
        } else {
            self.law.corrected(&samples(motion, joint, None), values)
        };
        if is_drive {
            let [q, qd, qdd] = [&logged.q, &logged.qd, &logged.qdd].map(|all| all[joint.0].clone());
            signals.motor[joint.0] = Some([q, qd, qdd]);
        }
        match self.law.channel() {
            Some(Channel::Position) => signals.move_joint(joint, &truth),
            _ => signals.qd[joint.0] = truth,
        }
        let mut torques = motion.torques_of(&signals);
        for (torque, own) in torques.iter_mut().flatten().zip(motion.total.iter().flatten()) {
            *torque -= own;
        }
        torques
    }

    /// How far the joint is behind its drive at each sample [rad, m].
    fn deflection(&self, motion: &Motion<'_>, values: &[f64]) -> Vec<f64> {
        let (joint, signals) = (self.joint, motion.signals);
        let load = &motion.load[joint.0];
        let most = load.iter().fold(0.0_f64, |most, load| most.max(load.abs()));
        let loads: Vec<f64> =
            (0..=2 * LOADS).map(|k| REACH * most * (k as f64 / LOADS as f64 - 1.0)).collect();
        let bends = Bends { deflections: deflections(&self.law, values, &loads), loads };
        let inertia = self.inertia(motion);
        bends.along(&signals.t, load, &inertia)
    }

    /// The inertia of the bodies about the joint at each sample [kg m^2, kg].
    fn inertia(&self, motion: &Motion<'_>) -> Vec<f64> {
        let mut faster = motion.signals.clone();
        faster.qdd[self.joint.0].iter_mut().for_each(|acceleration| *acceleration += 1.0);
        let torques = motion.torques_of(&faster).swap_remove(self.joint.0);
        let rotor = motion.drives[self.joint.0].inertia;
        let of = |(more, total): (&f64, &f64)| (more - total - rotor).max(0.0);
        torques.iter().zip(&motion.total[self.joint.0]).map(of).collect()
    }
}

/// How far a transmission gives way under loads that rest.
pub(super) fn deflections(law: &EffectLaw, values: &[f64], loads: &[f64]) -> Vec<f64> {
    let zeros = vec![0.0; loads.len()];
    let [t, q, qd, qdd, tau] = [zeros.as_slice(); 5];
    law.logged(&JointSamples { t, q, qd, qdd, tau, tau_load: loads, ..Default::default() }, values)
}

/// Loads of a table of deflections on either side of none.
const LOADS: usize = 2048;

/// What a transmission gives way by under loads that rise.
struct Bends {
    loads: Vec<f64>,
    deflections: Vec<f64>,
}

impl Bends {
    /// The deflections along loads that would be if the joint moved with its drive, by implicit
    /// steps of first order. These damp a joint that hits the side of its gap: it does not bounce.
    fn along(&self, t: &[f64], load: &[f64], inertia: &[f64]) -> Vec<f64> {
        let mut before = load.first().map_or(0.0, |load| self.step(*load, 0.0, 0.0));
        let (mut velocity, mut time) = (0.0, t.first().copied().unwrap_or(0.0));
        let of = |((t, load), inertia): ((&f64, &f64), &f64)| {
            let step_s = t - time;
            // without inertia what is left is the deflection under the load itself
            let per_load = if *inertia > 0.0 { step_s * step_s / inertia } else { 0.0 };
            let now = self.step(*load, before + step_s * velocity, per_load);
            velocity = if step_s > 0.0 { (now - before) / step_s } else { velocity };
            (before, time) = (now, *t);
            now
        };
        t.iter().zip(load).zip(inertia).map(of).collect()
    }

    /// The deflection D(x) = free + (load - x) per_load, which falls with x where D rises.
    fn step(&self, load: f64, free: f64, per_load: f64) -> f64 {
        let beyond = |k: usize| match per_load > 0.0 {
            true => self.deflections[k] - free - (load - self.loads[k]) * per_load,
            false => self.loads[k] - load,
        };
        let (mut low, mut high) = (0, self.loads.len() - 1);
        while high - low > 1 {
            let middle = low.midpoint(high);
            if beyond(middle) < 0.0 { low = middle } else { high = middle }
        }
        let [below, above] = [beyond(low), beyond(high)];
        let share = if above > below { (-below / (above - below)).clamp(0.0, 1.0) } else { 0.5 };
        self.deflections[low] + share * (self.deflections[high] - self.deflections[low])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bends(of: &dyn Fn(f64) -> f64) -> Bends {
        let loads: Vec<f64> = (-20_000..=20_000).map(|k| f64::from(k) * 1e-3).collect();
        Bends { deflections: loads.iter().map(|load| of(*load)).collect(), loads }
    }

    #[test]
    fn a_joint_falls_through_its_gap() {
        let (half, inertia, slope) = (0.02, 0.08, 5.0);
        let gap = bends(&|load| half * (load / 1e-4).tanh());
        let t: Vec<f64> = (0..6000).map(|k| f64::from(k) * 1e-4 - 0.3).collect();
        let load: Vec<f64> = t.iter().map(|t| slope * t).collect();
        let found = gap.along(&t, &load, &vec![inertia; t.len()]);
        // nothing is passed on in the gap: M d'' = slope t, from one side to the other
        let crosses_s = f64::cbrt(12.0 * inertia * half / slope);
        for (t, found) in t.iter().zip(&found).filter(|(t, _)| **t < crosses_s - 0.01) {
            let exact = -half + slope * t.max(0.0).powi(3) / (6.0 * inertia);
            assert!((found - exact).abs() < 0.01 * half, "{t}: {found}, not {exact}");
        }
        let caught = found.last().expect("samples");
        assert!((caught - half).abs() < 0.01 * half, "{caught}");
    }

    #[test]
    fn a_joint_on_a_spring_swings_beyond_what_its_load_alone_would_bend() {
        let (compliance, inertia, speed) = (1e-3, 0.5, 20.0);
        let spring = bends(&|load| compliance * load);
        let t: Vec<f64> = (0..100_000).map(|k| f64::from(k) * 1e-5).collect();
        let load: Vec<f64> = t.iter().map(|t| (speed * t).sin()).collect();
        let found = spring.along(&t, &load, &vec![inertia; t.len()]);
        let own = f64::sqrt(1.0 / (inertia * compliance));
        let most = compliance / (1.0 - (speed / own).powi(2));
        for (t, found) in t.iter().zip(&found) {
            let exact = most * ((speed * t).sin() - speed / own * (own * t).sin());
            assert!((found - exact).abs() < 0.02 * most, "{t}: {found}, not {exact}");
        }
    }

    #[test]
    fn without_inertia_a_deflection_is_that_of_the_load() {
        let spring = bends(&|load| 1e-3 * load);
        let (t, load) = (vec![0.0, 0.1, 0.2], vec![1.0, -2.0, 0.505]);
        let found = spring.along(&t, &load, &[0.0; 3]);
        for (found, load) in found.iter().zip(&load) {
            assert!((found - 1e-3 * load).abs() < 1e-12, "{found}");
        }
    }
}
