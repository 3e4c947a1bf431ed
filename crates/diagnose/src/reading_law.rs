//! Effects that stand between a position or velocity and its log.
//!
//! Play after the encoder is one: the drive is where it is read, and the joint is behind it by s.
//! It moves by what passes through the gap: a drag, and what a side that gives way a little presses
//! with beyond half the play.
//!
//! ```text
//! M s'' = load - c s' - k (s beyond the play),   logged = q + s
//! ```
//!
//! The load is that of the logged motion, with the friction that brakes the joint and not its
//! drive, M the inertia of the bodies about the joint; k and c are over that inertia where all
//! joints are at 0, so that they do not change with the posture. Steps in time are implicit, which
//! damps what swings faster than they are.

use super::joint_law::{JointLaw, samples};
use super::law::{Motion, Response, differences};
use super::rows::PerJoint;
use super::signals::Signals;
use crate::policy::joint_law::DIFFERENCE;
use denavit_codegen::effect::Channel;
use denavit_plants::effect::GivesWay;

impl JointLaw {
    /// What is between a position or velocity and its log: the model was given what is logged, and
    /// gives other torques for what is true.
    pub(super) fn read(
        &self,
        motion: &Motion<'_>,
        values: &[f64],
        is_read_at_drive: bool,
    ) -> Response {
        let inertia = self.inertia_behind(motion, is_read_at_drive);
        let of = |values: &[f64]| self.of_truth(motion, values, inertia.as_ref());
        let step = |place: usize| {
            let sizes = self.law.parameters[place].start.iter().map(|start| start.abs());
            let size = sizes.fold(values[place].abs(), f64::max);
            DIFFERENCE * if size > 0.0 { size } else { 1.0 }
        };
        let torque = of(values);
        let gradient = differences(of, &torque, values, step);
        Response { equations: (0..torque.len()).collect(), torque, gradient }
    }

    /// The same of a joint behind a gap, without derivatives.
    pub(super) fn read_torque(&self, motion: &Motion<'_>, values: &[f64]) -> Response {
        let inertia = self.inertia_behind(motion, true);
        let torque = self.of_truth(motion, values, inertia.as_ref());
        Response { equations: (0..torque.len()).collect(), torque, gradient: Vec::new() }
    }

    /// The inertia of bodies behind a transmission, which a motor that is measured is not. A joint
    /// on a spring without a gap is taken to follow its load, slower than it swings: one that
    /// swings would take the noise of an encoder out of its position.
    fn inertia_behind(&self, motion: &Motion<'_>, is_read_at_drive: bool) -> Option<Vec<f64>> {
        let is_behind = is_read_at_drive && motion.signals.motor[self.joint.0].is_none();
        is_behind.then(|| match self.law.has_play() {
            true => self.inertia(motion),
            false => vec![0.0; motion.signals.samples()],
        })
    }

    /// What the torques of the true motion have more than those of the logged one.
    /// Of a joint behind a gap with its inertia.
    fn of_truth(
        &self,
        motion: &Motion<'_>,
        values: &[f64],
        inertia: Option<&Vec<f64>>,
    ) -> PerJoint {
        let (joint, logged) = (self.joint, motion.signals);
        let mut signals: Signals = logged.clone();
        let is_drive = self.law.is_read_at_drive() && logged.motor[joint.0].is_none();
        let truth: Vec<f64> = match inertia {
            Some(inertia) => {
                let deflection = self.deflection(motion, inertia, values);
                logged.q[joint.0].iter().zip(deflection).map(|(read, by)| read - by).collect()
            }
            None => self.law.corrected(&samples(motion, joint, None), values),
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
    fn deflection(&self, motion: &Motion<'_>, inertia: &[f64], values: &[f64]) -> Vec<f64> {
        let (joint, signals) = (self.joint, motion.signals);
        let gap = self.law.gives_way(values).zip(self.inertia_at_zero(motion));
        let gap = gap.and_then(|(way, at_zero)| Some((way, Gap::new(&way, at_zero)?)));
        let Some((way, gap)) = gap else {
            return vec![0.0; signals.samples()];
        };
        let (_, braked) = way.split(motion.drives[joint.0]);
        let both = motion.load[joint.0].iter().zip(&signals.qd[joint.0]);
        let load: Vec<f64> = both.map(|(load, qd)| load + braked.friction(*qd)).collect();
        gap.along(&signals.t, &load, inertia)
    }

    /// The inertia of the bodies about the joint where all joints are at 0; none where there is
    /// none [kg m^2, kg].
    fn inertia_at_zero(&self, motion: &Motion<'_>) -> Option<f64> {
        let (nominal, phi) = motion.model;
        let joints = nominal.model.joints.len();
        let mut both = vec![vec![0.0; 2]; 3 * joints];
        both[2 * joints + self.joint.0][1] = 1.0;
        let torques = nominal.model.torques(&both, &phi.axes).swap_remove(self.joint.0);
        let inertia = torques[1] - torques[0] - motion.drives[self.joint.0].inertia;
        (inertia > 0.0).then_some(inertia)
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

/// What is between a drive and its joint.
struct Gap {
    /// Half the play [rad, m].
    half: f64,
    /// Of the sides [N m/rad, N/m].
    stiffness: f64,
    /// Between the sides [N m s/rad, N s/m].
    drag: f64,
}

/// The swing of sides that hardly give way \[s\]: faster than any filter of logs passes.
const SHORTEST_S: f64 = 1e-3;

impl Gap {
    /// None where nothing gives way.
    fn new(way: &GivesWay, inertia: f64) -> Option<Self> {
        let swing_s = way.swing_s.max(SHORTEST_S);
        let stiffness = inertia / (swing_s * swing_s);
        let gap = Self { half: 0.5 * way.play, stiffness, drag: way.drag * inertia };
        (way.play > 0.0 || way.swing_s > SHORTEST_S).then_some(gap)
    }

    /// How far the joint is behind its drive along loads, by implicit steps of first order [rad,
    /// m].
    fn along(&self, t: &[f64], load: &[f64], inertia: &[f64]) -> Vec<f64> {
        let mut before = load.first().map_or(0.0, |load| self.behind(*load, 0.0));
        let (mut velocity, mut time) = (0.0, t.first().copied().unwrap_or(0.0));
        let of = |((t, load), inertia): ((&f64, &f64), &f64)| {
            let step_s = t - time;
            if step_s <= 0.0 {
                return before;
            }
            // all forces that grow with s alone, and their sum where s is 0
            let slope = inertia / (step_s * step_s) + self.drag / step_s;
            let sum = load + slope * before + inertia / step_s * velocity;
            let now = self.behind(sum, slope);
            velocity = (now - before) / step_s;
            (before, time) = (now, *t);
            now
        };
        t.iter().zip(load).zip(inertia).map(of).collect()
    }

    /// The deflection s of slope s + k (s beyond the play) = sum.
    fn behind(&self, sum: f64, slope: f64) -> f64 {
        let reached = slope * self.half;
        let beyond = (sum.abs() - reached).max(0.0) / (slope + self.stiffness);
        let within = if sum.abs() < reached { sum.abs() / slope } else { self.half };
        (within + beyond).copysign(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INERTIA: f64 = 0.08;

    fn gap(play: f64, swing_s: f64, drag: f64) -> Gap {
        let way = GivesWay { swing_s, play, damping: 0.0, drag, joint_friction: 0.0 };
        Gap::new(&way, INERTIA).expect("it gives way")
    }

    fn along(gap: &Gap, load: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let t: Vec<f64> = (0..600).map(|k| f64::from(k) * 1e-3 - 0.3).collect();
        let load: Vec<f64> = t.iter().map(|t| load(*t)).collect();
        let found = gap.along(&t, &load, &vec![INERTIA; t.len()]);
        t.into_iter().zip(found).collect()
    }

    #[test]
    fn a_joint_falls_through_its_gap() {
        let (half, slope) = (0.02, 5.0);
        let found = along(&gap(2.0 * half, 0.0, 0.0), |t| slope * t);
        // nothing is passed on in the gap: M s'' = slope t, from one side to the other
        let crosses_s = f64::cbrt(12.0 * INERTIA * half / slope);
        for (t, found) in found.iter().filter(|(t, _)| *t < crosses_s - 0.01) {
            let exact = -half + slope * t.max(0.0).powi(3) / (6.0 * INERTIA);
            // of first order: a step of time is 0.035 of half the play there
            assert!((found - exact).abs() < 0.04 * half, "{t}: {found}, not {exact}");
        }
        let (_, caught) = found.last().expect("samples");
        assert!((caught - half).abs() < 0.01 * half, "{caught}");
    }

    #[test]
    fn grease_lets_a_joint_sink_through_its_gap() {
        // M s'' + c s' = load from rest: after the start s' = load / c
        let (half, drag, load) = (0.5, 40.0, 2.0_f64);
        let found = along(&gap(2.0 * half, 0.0, drag), |t| f64::copysign(load, t));
        let speed = load / (drag * INERTIA);
        for (t, found) in found.iter().filter(|(t, s)| *t > 0.0 && *s < half - 0.01) {
            let start = (1.0 - (-drag * t).exp()) / drag;
            let exact = -half + speed * (t - start);
            assert!((found - exact).abs() < 0.01 * half, "{t}: {found}, not {exact}");
        }
    }

    #[test]
    fn a_side_gives_way_in_proportion_to_a_slow_load() {
        let (half, swing_s) = (0.01, 0.02);
        let drag = 100.0;
        let gap = gap(2.0 * half, swing_s, drag);
        let compliance = swing_s * swing_s / INERTIA;
        let (_, found) = *along(&gap, |t| 3.0 + t).last().expect("samples");
        // late by c / k
        let load = 3.299 - drag * swing_s * swing_s;
        assert!((found - half - compliance * load).abs() < 0.01 * compliance, "{found}");
    }
}
