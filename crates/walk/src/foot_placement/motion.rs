//! From a course and a measured state to what joints follow.

use super::course::Course;
use super::law::FootPlacementLaw;
use super::measured::Measured;
use super::pendulum::Pendulum;
use crate::fading::{FADES_PER_S, Moving};
use crate::gait_plan::{Bearing, Moment, Sought, pose, torques};
use denavit_plants::Plant;
use denavit_plants::trajectory::{CubicSpline, EndCondition, Reference, Setpoint};
use denavit_simulate::JointPlan;

/// A motion from a time of the course on, up to its end or as far as the legs reach.
pub(super) struct Motion<'a> {
    pub(super) law: &'a FootPlacementLaw,
    pub(super) course: &'a Course,
    pub(super) measured: &'a Measured,
    /// Times of the course, from now on \[s\].
    pub(super) times_s: &'a [f64],
    pub(super) pendulums: &'a [Pendulum],
}

/// Velocities of the first posture are differences over this time \[s\].
const DIFFERENCE_S: f64 = 1e-4;

/// Knots from a time up to the end of the course, of which ends of phases are some.
pub(super) fn knots(course: &Course, from_s: f64, interval_s: f64) -> Vec<f64> {
    let mut times_s = Vec::new();
    let mut start_s = from_s;
    for phase in &course.phases[course.phase_at(from_s)..] {
        let duration_s = phase.end_s() - start_s;
        let count = (duration_s / interval_s).ceil().max(1.0);
        if duration_s > DIFFERENCE_S {
            times_s.extend((0..count as usize).map(|k| start_s + duration_s * k as f64 / count));
            start_s = phase.end_s();
        }
    }
    times_s.push(course.end_s());
    times_s
}

impl Motion<'_> {
    fn posture(
        &self,
        plant: &mut dyn Plant,
        t_s: f64,
        pendulum: &Pendulum,
        near: &[f64],
    ) -> Option<Vec<f64>> {
        let walk = &self.law.walk;
        let phase = &self.course.phases[self.course.phase_at(t_s)];
        let share = (t_s - phase.start_s) / phase.duration_s;
        let pose = pose(&walk.problem, phase, share, pendulum.center_m);
        let at = Sought { name: &phase.name, t_s };
        Some(walk.biped.reach(plant, &pose, near, at).ok()?.q)
    }

    /// Postures at all times, up to the first that is out of reach; what is measured beside the
    /// first one fades.
    fn postures(&self, plant: &mut dyn Plant) -> Option<Vec<Vec<f64>>> {
        let (now_s, measured) = (self.times_s[0], self.measured);
        let first = self.posture(plant, now_s, &self.pendulums[0], &measured.q)?;
        let Pendulum { center_m, divergent_m } = self.pendulums[0];
        let way = DIFFERENCE_S * self.course.omega();
        let on = |axis: usize| center_m[axis] + way * (divergent_m[axis] - center_m[axis]);
        let soon = Pendulum { center_m: [on(0), on(1)], divergent_m };
        let next = self.posture(plant, now_s + DIFFERENCE_S, &soon, &first)?;
        let apart: Vec<Moving> = (0..first.len())
            .map(|joint| Moving {
                value: measured.q[joint] - first[joint],
                rate: measured.qd[joint] - (next[joint] - first[joint]) / DIFFERENCE_S,
            })
            .collect();
        let mut postures = Vec::with_capacity(self.times_s.len());
        let mut near = first;
        for (t_s, pendulum) in self.times_s.iter().zip(self.pendulums) {
            let Some(posture) = self.posture(plant, *t_s, pendulum, &near) else { break };
            let since_s = t_s - now_s;
            let faded =
                posture.iter().zip(&apart).map(|(q, apart)| q + apart.left(FADES_PER_S, since_s));
            postures.push(faded.collect());
            near = posture;
        }
        (postures.len() > 1).then_some(postures)
    }

    /// What the driven joints follow, and up to which time; none if the robot cannot move so.
    pub(super) fn plans(&self, plant: &mut dyn Plant) -> Option<(Vec<JointPlan>, f64)> {
        let postures = self.postures(plant)?;
        let reached = &self.times_s[..postures.len()];
        let biped = &self.law.walk.biped;
        // the clock of the run may be behind that of the course
        let ahead_s = self.times_s[0] - self.measured.t_s;
        let times: Vec<f64> = reached.iter().map(|t_s| t_s - ahead_s).collect();
        let spline = |values: Vec<f64>, ends: [EndCondition; 2]| {
            CubicSpline::new(times.clone(), values, ends).ok().map(Reference::Cubic)
        };
        let path = |joint: usize| {
            let values = postures.iter().map(|q| q[joint]).collect();
            let start = EndCondition::Rate(self.measured.qd[joint]);
            spline(values, [start, EndCondition::Natural])
        };
        let paths = (0..self.measured.q.len()).map(path).collect::<Option<Vec<Reference>>>()?;
        let mut fed = Vec::with_capacity(times.len());
        for (t_s, course_s) in times.iter().zip(reached) {
            let at: Vec<Setpoint> = paths.iter().map(|path| path.at(*t_s)).collect();
            let moment = Moment {
                q: at.iter().map(|point| point.position).collect(),
                qd: at.iter().map(|point| point.rate).collect(),
                qdd: at.iter().map(|point| point.acceleration).collect(),
            };
            let phase = &self.course.phases[self.course.phase_at(*course_s)];
            let share = (course_s - phase.start_s) / phase.duration_s;
            let weights = biped.weights(plant.model(), phase.load_at(share));
            fed.push(torques(plant, &moment, Bearing { weights: &weights, free: &[] }));
        }
        let plan = |joint: &usize| {
            let values = fed.iter().map(|torques| torques[*joint]).collect();
            let feed_forward = Some(spline(values, [EndCondition::Natural; 2])?);
            Some(JointPlan { joint: *joint, reference: paths[*joint].clone(), feed_forward })
        };
        let plans = biped.drivable.iter().map(plan).collect::<Option<Vec<JointPlan>>>()?;
        Some((plans, *reached.last()?))
    }
}
