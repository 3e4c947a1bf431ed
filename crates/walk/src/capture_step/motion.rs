//! From planned paths of centre of mass, trunk and feet to what joints follow.

use super::measured::Measured;
use super::pendulum::Pressure;
use super::reach::Reach;
use super::torques::torques;
use crate::fading::{FADES_PER_S, Moving};
use crate::gait_plan::{Height, Pose, Sought, Walker};
use denavit_plants::Plant;
use denavit_plants::trajectory::{CubicSpline, EndCondition, Reference};
use denavit_runtime::Scalar;
use denavit_simulate::JointPlan;
use std::f64::consts::PI;

/// The way of a foot that swings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Swing {
    pub(super) side: usize,
    /// Where its ankle lands \[m\].
    pub(super) landing_m: f64,
    pub(super) step_s: f64,
    pub(super) lift_m: f64,
}

/// A planned motion on a clock that starts at 0 where it was measured.
#[derive(Clone, Debug)]
pub(super) struct Motion<'a> {
    pub(super) walker: &'a Walker,
    pub(super) measured: &'a Measured,
    pub(super) pressure: Pressure,
    pub(super) reach: Reach,
    pub(super) height_m: f64,
    pub(super) swing: Option<Swing>,
    /// For so long \[s\].
    pub(super) duration_s: f64,
}

/// The torso comes upright so fast: it takes angular momentum, which moves the centre of pressure
/// \[1/s\].
const RIGHTS_PER_S: f64 = 8.0;
/// Distance of knots at most \[s\].
const INTERVAL_S: f64 = 0.03;
/// Velocities of the first posture are differences over this time \[s\].
const DIFFERENCE_S: f64 = 1e-4;
/// The swing foot rises before it goes on, and sinks after: shares of the swing.
const ALONG: [f64; 2] = [0.1, 0.9];
/// A foot that has not met the ground goes on down with this velocity [m/s].
const SINK_M_S: f64 = 0.2;

/// From 0 to 1 without velocity and acceleration at the ends.
fn smooth(share: f64) -> f64 {
    let u = share.clamp(0.0, 1.0);
    u * u * u * (10.0 - u * (15.0 - 6.0 * u))
}

/// The way from where something is, with its velocity, to a place.
fn to(from: Moving, place: f64, t_s: f64) -> f64 {
    place + Moving { value: from.value - place, rate: from.rate }.left(FADES_PER_S, t_s)
}

impl Motion<'_> {
    fn foot_m(&self, side: usize, t_s: f64) -> [f64; 2] {
        let [along, height] = self.measured.feet[side];
        match &self.swing {
            Some(swing) if swing.side == side => {
                let share = t_s / swing.step_s;
                let way = smooth((share - ALONG[0]) / (ALONG[1] - ALONG[0]));
                let x = along.value + (swing.landing_m - along.value) * way;
                let (sine, _) = (PI * share.clamp(0.0, 1.0)).sincos();
                let late_s = (t_s - swing.step_s).max(0.0);
                let lift = swing.lift_m * sine * sine - SINK_M_S * late_s;
                let moving = Moving { value: 0.0, rate: along.rate };
                [x + moving.left(FADES_PER_S, t_s), lift + height.left(FADES_PER_S, t_s)]
            }
            _ => [along.value, to(height, 0.0, t_s)],
        }
    }

    fn pose(&self, t_s: f64) -> Pose {
        let pendulum = self.measured.pendulum(self.pressure.omega).after(&self.pressure, t_s);
        let feet_m = [0, 1].map(|side| self.foot_m(side, t_s));
        let height_m = to(self.measured.center[1], self.height_m, t_s);
        let highest_m = self.reach.height_m(pendulum.center_m, feet_m);
        Pose {
            feet_m,
            center_m: pendulum.center_m,
            height: Height::CenterOfMass(height_m.min(highest_m)),
            pitch_rad: self.measured.pitch.left(RIGHTS_PER_S, t_s),
        }
    }

    fn posture(&self, plant: &mut dyn Plant, t_s: f64, near: &[f64]) -> Option<Vec<f64>> {
        let at = Sought { name: "capture step", t_s };
        let found = self.walker.reach(plant, &self.pose(t_s), near, at);
        Some(found.ok()?.q)
    }

    /// Postures at regular times, up to the first that is out of reach; what is measured beside
    /// the first one, a foot that is tilted, fades.
    fn postures(&self, plant: &mut dyn Plant) -> Option<Vec<(f64, Vec<f64>)>> {
        let measured = self.measured;
        let first = self.posture(plant, 0.0, &measured.q)?;
        let next = self.posture(plant, DIFFERENCE_S, &first)?;
        let apart: Vec<Moving> = (0..first.len())
            .map(|joint| Moving {
                value: measured.q[joint] - first[joint],
                rate: measured.qd[joint] - (next[joint] - first[joint]) / DIFFERENCE_S,
            })
            .collect();
        let count = (self.duration_s / INTERVAL_S).ceil().max(2.0);
        let mut knots: Vec<(f64, Vec<f64>)> = Vec::new();
        let mut near = first;
        for index in 0..=count as usize {
            let t_s = self.duration_s * index as f64 / count;
            let Some(posture) = self.posture(plant, t_s, &near) else { break };
            let faded =
                posture.iter().zip(&apart).map(|(q, apart)| q + apart.left(FADES_PER_S, t_s));
            knots.push((t_s, faded.collect()));
            near = posture;
        }
        (knots.len() > 1).then_some(knots)
    }

    /// What the driven joints follow; none if the robot cannot move so.
    pub(super) fn plans(&self, plant: &mut dyn Plant) -> Option<Vec<JointPlan>> {
        let knots = self.postures(plant)?;
        let start_s = self.measured.t_s;
        let times: Vec<f64> = knots.iter().map(|(t_s, _)| start_s + t_s).collect();
        let spline = |values: Vec<f64>, start: EndCondition| -> Result<_, denavit_plants::Error> {
            let ends = [start, EndCondition::Natural];
            Ok(Reference::Cubic(CubicSpline::new(times.clone(), values, ends)?))
        };
        let paths = (0..self.measured.q.len()).map(|joint| {
            let values = knots.iter().map(|(_, q)| q[joint]).collect();
            spline(values, EndCondition::Rate(self.measured.qd[joint]))
        });
        let paths = paths.collect::<Result<Vec<Reference>, _>>().ok()?;
        let standing = [0, 1].map(|side| self.swing.is_none_or(|swing| swing.side != side));
        let mut fed = Vec::with_capacity(times.len());
        for t_s in &times {
            let at: Vec<_> = paths.iter().map(|path| path.at(*t_s)).collect();
            let q: Vec<f64> = at.iter().map(|setpoint| setpoint.position).collect();
            let qd: Vec<f64> = at.iter().map(|setpoint| setpoint.rate).collect();
            let qdd: Vec<f64> = at.iter().map(|setpoint| setpoint.acceleration).collect();
            fed.push(torques(plant, self.walker, standing, [&q, &qd, &qdd])?);
        }
        let plan = |joint: &usize| {
            let values = fed.iter().map(|torques| torques[*joint]).collect();
            let feed_forward = Some(spline(values, EndCondition::Natural).ok()?);
            Some(JointPlan { joint: *joint, reference: paths[*joint].clone(), feed_forward })
        };
        self.walker.driven.iter().map(plan).collect()
    }
}
