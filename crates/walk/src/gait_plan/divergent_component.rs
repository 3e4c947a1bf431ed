//! A walk in space on planned footsteps, from standing to standing: the centre of pressure goes
//! from sole to sole, the centre of mass follows by the linear inverted pendulum along x and y, and
//! inverse kinematics makes joint positions of both.
//!
//! The pendulum is one point. The zero moment point of all bodies in the planned motion is
//! elsewhere; by how much is taken off the centre of pressure that the pendulum is planned with,
//! and the motion planned again (the second stage of preview control, Kajita 2003).

use super::biped::{Biped, BipedPose, RollCondition};
use super::curve::{Curve, JointPath, Piece};
use super::footsteps::{AnkleRolls, DivergentComponentProblem, Phase, phases};
use super::pendulum::{PendulumPath, PressureSegment};
use super::plan::{GaitPlan, Knot, ROUNDING_M};
use super::posture::{Posture, Sought};
use super::torque::{Bearing, Moment, torques};
use crate::error::{Error, PlanError};
use denavit_plants::Plant;
use denavit_plants::trajectory::{CubicSpline, EndCondition, Reference, Setpoint};

/// A plan with more knots is one for longer than anybody waits.
const MAX_KNOTS: usize = 20_000;

/// Plans the walk of a robot.
///
/// # Errors
/// Postures that are out of reach or beyond limits, feet on each other, phases that overlap, a
/// zero moment point outside the feet.
pub fn plan_divergent_component(
    plant: &mut dyn Plant,
    problem: &DivergentComponentProblem,
) -> Result<GaitPlan, Error> {
    Ok(plan_space_walk(plant, problem)?.0)
}

/// A planned walk in space, for what goes on planning during a run.
#[derive(Clone, Debug)]
pub(crate) struct SpaceWalk {
    pub(crate) problem: DivergentComponentProblem,
    pub(crate) biped: Biped,
    pub(crate) phases: Vec<Phase>,
    /// The centre of mass along x and y, with the centre of pressure under it.
    pub(crate) center: [PendulumPath; 2],
}

impl SpaceWalk {
    /// w of the pendulum \[1/s\].
    pub(crate) fn omega(&self) -> f64 {
        (self.biped.gravity / self.problem.center_of_mass_height_m).sqrt()
    }
}

/// The plan, and the walk behind it.
pub(crate) fn plan_space_walk(
    plant: &mut dyn Plant,
    problem: &DivergentComponentProblem,
) -> Result<(GaitPlan, SpaceWalk), Error> {
    let (double_support_s, step_s) = (problem.double_support_s, problem.step_s);
    // written so that NaN fails as well
    if !(double_support_s > 0.0 && double_support_s < step_s) {
        return Err(PlanError::Overlap { double_support_s, step_s }.into());
    }
    let biped = Biped::of(plant)?;
    let is_passive = problem.ankle_rolls == AnkleRolls::Passive;
    if is_passive && biped.rolls().is_none() {
        return Err(PlanError::NoBiped("joint that rolls each foot".to_owned()).into());
    }
    let phases = phases(problem, biped.width_m(plant), biped.rolls());
    let times = times(&phases, problem.interval_s)?;
    let planner = Planner { problem, biped, phases, times };
    let motion = planner.motion(plant)?;
    let knots = planner.checked(plant, &motion)?;
    let plan = GaitPlan {
        step_s,
        step_length_m: planner.mean_step_m(),
        steps: problem.swings(),
        duration_s: planner.end_s(),
        distance_m: planner.mean_step_m() * problem.footsteps.len() as f64,
        paths: planner.joint_paths(plant, &motion),
        repeats: false,
        start: motion.postures.first().map(|posture| posture.q.clone()).unwrap_or_default(),
        gains: problem.gains,
        knots,
    };
    let plan = plan.joined()?;
    let Planner { biped, phases, .. } = planner;
    let walk = SpaceWalk { problem: problem.clone(), biped, phases, center: motion.center };
    Ok((plan, walk))
}

/// A time of the plan: the phase that it is in, which may have just begun.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Time {
    t_s: f64,
    phase: usize,
}

/// Knots from a phase's beginning up to before its end; then the end.
fn times(phases: &[Phase], interval_s: f64) -> Result<Vec<Time>, Error> {
    let mut times = Vec::new();
    for (phase, own) in phases.iter().enumerate() {
        // an even number: in the middle of standing the centre of pressure turns around
        let count = 2.0 * (0.5 * own.duration_s / interval_s).ceil().max(1.0);
        if times.len() as f64 + count > MAX_KNOTS as f64 {
            return Err(PlanError::TooManyKnots(MAX_KNOTS).into());
        }
        let t_s = |index: usize| own.start_s + own.duration_s * (index as f64 / count);
        times.extend((0..count as usize).map(|index| Time { t_s: t_s(index), phase }));
    }
    let last = phases.last().map(|last| Time { t_s: last.end_s(), phase: phases.len() - 1 });
    times.extend(last);
    Ok(times)
}

/// A walk that is being planned.
struct Planner<'a> {
    problem: &'a DivergentComponentProblem,
    biped: Biped,
    phases: Vec<Phase>,
    times: Vec<Time>,
}

/// Postures at all knots, and what passes through them.
struct Motion {
    /// The centre of mass along x and y.
    center: [PendulumPath; 2],
    postures: Vec<Posture>,
    /// Of each coordinate.
    splines: Vec<Reference>,
}

impl Motion {
    fn moment(&self, t_s: f64) -> Moment {
        let points: Vec<Setpoint> = self.splines.iter().map(|spline| spline.at(t_s)).collect();
        Moment {
            q: points.iter().map(|point| point.position).collect(),
            qd: points.iter().map(|point| point.rate).collect(),
            qdd: points.iter().map(|point| point.acceleration).collect(),
        }
    }

    /// The zero moment point of all bodies \[m\].
    fn zero_moment_point(&self, plant: &mut dyn Plant, t_s: f64) -> Result<[f64; 2], Error> {
        let Moment { q, qd, qdd } = self.moment(t_s);
        let lacks = || PlanError::NoBiped("zero moment point of its bodies".to_owned());
        let mut walking = plant.walking().ok_or_else(lacks)?;
        let [x, y, _] = walking.zero_moment_point(&q, &qd, &qdd).ok_or_else(lacks)?;
        Ok([x, y])
    }
}

impl Planner<'_> {
    fn end_s(&self) -> f64 {
        self.phases.last().map_or(0.0, Phase::end_s)
    }

    /// The mean of how far the middle between the feet goes, negative backwards \[m\].
    fn mean_step_m(&self) -> f64 {
        let steps = &self.problem.footsteps;
        let way = steps.iter().map(|step| {
            let length_m = step.forward_m.hypot(step.left_m);
            if step.forward_m < 0.0 { -length_m } else { length_m }
        });
        // not the sum, which begins at -0
        way.fold(0.0, |sum, step| sum + step) / steps.len().max(1) as f64
    }

    fn phase(&self, time: Time) -> (&Phase, f64) {
        let phase = &self.phases[time.phase];
        (phase, (time.t_s - phase.start_s) / phase.duration_s)
    }

    /// The motion, its centre of pressure corrected.
    fn motion(&self, plant: &mut dyn Plant) -> Result<Motion, Error> {
        let wanted: Vec<[f64; 2]> = self.times.iter().map(|time| self.wanted(*time)).collect();
        let mut planned = wanted.clone();
        let mut motion = self.planned(plant, &planned, None)?;
        for _ in 0..self.problem.corrections {
            for (index, time) in self.times.iter().enumerate() {
                let exact = motion.zero_moment_point(plant, time.t_s)?;
                (0..2).for_each(|axis| planned[index][axis] += wanted[index][axis] - exact[axis]);
            }
            motion = self.planned(plant, &planned, Some(&motion))?;
        }
        Ok(motion)
    }

    /// Where the centre of pressure is to be \[m\].
    fn wanted(&self, time: Time) -> [f64; 2] {
        let (phase, share) = self.phase(time);
        phase.pressure_at(share)
    }

    /// The motion with this centre of pressure at the knots \[m\], near another one.
    fn planned(
        &self,
        plant: &mut dyn Plant,
        pressures_m: &[[f64; 2]],
        near: Option<&Motion>,
    ) -> Result<Motion, Error> {
        let center = [self.center(pressures_m, 0)?, self.center(pressures_m, 1)?];
        let mut postures: Vec<Posture> = Vec::new();
        for (index, time) in self.times.iter().enumerate() {
            let (pose, at) = (self.pose(&center, *time), self.at(*time));
            let known = near.map(|motion| &motion.postures[index]);
            let posture = match known.or(postures.last()) {
                None => self.biped.first(plant, &pose, at)?,
                Some(near) => self.biped.reach(plant, &pose, &near.q, at)?,
            };
            postures.push(posture);
        }
        let times_s: Vec<f64> = self.times.iter().map(|time| time.t_s).collect();
        let spline = |coordinate: usize| {
            let values = postures.iter().map(|posture| posture.q[coordinate]).collect();
            let ends = [EndCondition::Rate(0.0); 2];
            Ok(Reference::Cubic(CubicSpline::new(times_s.clone(), values, ends)?))
        };
        let splines = (0..plant.model().joints.len()).map(spline);
        let splines = splines.collect::<Result<Vec<_>, Error>>()?;
        Ok(Motion { center, postures, splines })
    }

    /// The centre of mass along an axis, from rest to rest: while it stands the centre of pressure
    /// goes back and forth for that.
    fn center(&self, pressures_m: &[[f64; 2]], axis: usize) -> Result<PendulumPath, Error> {
        let omega = (self.biped.gravity / self.problem.center_of_mass_height_m).sqrt();
        let pairs = self.times.windows(2).zip(pressures_m.windows(2));
        let segment = |(times, places): (&[Time], &[[f64; 2]])| PressureSegment {
            duration_s: times[1].t_s - times[0].t_s,
            places_m: [places[0][axis], places[1][axis]],
        };
        let segments: Vec<PressureSegment> = pairs.map(segment).collect();
        let shape = |standing: usize| -> Vec<f64> {
            let height = |time: &Time| {
                let (_, share) = self.phase(*time);
                let rises = if time.phase == standing { 1.0 } else { 0.0 };
                rises * (1.0 - (2.0 * share - 1.0).abs())
            };
            self.times.iter().map(height).collect()
        };
        let shapes = [shape(0), shape(self.phases.len().saturating_sub(1))];
        let start_m = pressures_m.first().map_or(0.0, |place| place[axis]);
        PendulumPath::resting_by(omega, &segments, start_m, &shapes)
            .ok_or_else(|| PlanError::NoBiped("walk from rest to rest".to_owned()).into())
    }

    fn at(&self, time: Time) -> Sought<'_> {
        Sought { name: &self.phases[time.phase].name, t_s: time.t_s }
    }

    fn pose(&self, center: &[PendulumPath; 2], time: Time) -> BipedPose {
        let (phase, share) = self.phase(time);
        pose(self.problem, phase, share, [0, 1].map(|axis| center[axis].at(time.t_s).position_m))
    }

    fn joint_paths(&self, plant: &mut dyn Plant, motion: &Motion) -> Vec<JointPath> {
        let times_s: Vec<f64> = self.times.iter().map(|time| time.t_s).collect();
        let rolls = self.biped.rolls().filter(|_| self.problem.ankle_rolls == AnkleRolls::Passive);
        let free: Vec<usize> = rolls.iter().flatten().map(|roll| roll.joint).collect();
        let mut needed = |time: &Time| {
            let (phase, share) = self.phase(*time);
            let weights = self.biped.weights(plant.model(), phase.load_at(share));
            let bearing = Bearing { weights: &weights, free: &free };
            torques(plant, &motion.moment(time.t_s), bearing)
        };
        let planned: Vec<Vec<f64>> = self.times.iter().map(&mut needed).collect();
        let driven = self.biped.drivable.iter().filter(|joint| !free.contains(joint));
        let path = |joint: &usize| {
            let cubic = |values| Curve::Cubic { times_s: times_s.clone(), values };
            let curve = cubic(motion.postures.iter().map(|posture| posture.q[*joint]).collect());
            let torque = cubic(planned.iter().map(|torques| torques[*joint]).collect());
            let pieces = vec![Piece { duration_s: self.end_s(), curve }];
            JointPath { joint: *joint, pieces, feed_forward: Some(torque) }
        };
        driven.map(path).collect()
    }

    /// The knots with the times halfway between them, where curves pass, and all margins checked.
    fn checked(&self, plant: &mut dyn Plant, motion: &Motion) -> Result<Vec<Knot>, Error> {
        let mut all = Vec::with_capacity(2 * self.times.len());
        for (index, time) in self.times.iter().enumerate() {
            let posture = motion.postures[index].clone();
            all.push(self.knot(plant, motion, *time, posture, true)?);
            let Some(next) = self.times.get(index + 1) else { continue };
            let between = Time { t_s: 0.5 * (time.t_s + next.t_s), ..*time };
            let (pose, stance) =
                (self.pose(&motion.center, between), self.phase(between).0.stance());
            let along: Vec<f64> =
                motion.splines.iter().map(|spline| spline.at(between.t_s).position).collect();
            let (place, at) = (&pose.soles[stance], self.at(between));
            let q = self.biped.placed(plant, stance, place, &along, at)?;
            let residual = self.biped.error(plant, &pose, &q);
            all.push(self.knot(plant, motion, between, Posture { q, residual }, false)?);
        }
        Ok(all)
    }

    fn knot(
        &self,
        plant: &mut dyn Plant,
        motion: &Motion,
        time: Time,
        posture: Posture,
        is_solved: bool,
    ) -> Result<Knot, Error> {
        let (phase, pose) = (&self.phases[time.phase], self.pose(&motion.center, time));
        let (name, t_s) = (phase.name.clone(), time.t_s);
        if !self.biped.are_apart(&pose.soles) {
            return Err(PlanError::Collision { posture: name, t_s }.into());
        }
        let pressure = motion.zero_moment_point(plant, t_s)?;
        let standing = phase.standing();
        let [x, y, _] = pose.center_m;
        let margin_m = self.biped.margin_m(plant.model(), &pose.soles, standing, pressure);
        let least_m = self.problem.margin_m;
        if margin_m < least_m - ROUNDING_M || margin_m.is_nan() {
            let point = "planned zero moment point";
            return Err(PlanError::Margin { point, posture: name, t_s, margin_m, least_m }.into());
        }
        Ok(Knot {
            t_s,
            name,
            q: posture.q,
            is_solved,
            residual: posture.residual,
            static_margin_m: self.biped.margin_m(plant.model(), &pose.soles, standing, [x, y]),
            pressure_margin_m: Some(margin_m),
        })
    }
}

/// The pose at a share of a phase, with the centre of mass there \[m\].
pub(crate) fn pose(
    problem: &DivergentComponentProblem,
    phase: &Phase,
    share: f64,
    [x, y]: [f64; 2],
) -> BipedPose {
    BipedPose {
        soles: phase.soles_at(share, problem.lift_m),
        center_m: [x, y, problem.center_of_mass_height_m],
        yaw_rad: phase.yaw_at(share),
        pitch_rad: problem.torso_pitch_rad,
        roll: match problem.ankle_rolls {
            AnkleRolls::Driven => RollCondition::Torso(0.0),
            AnkleRolls::Passive => RollCondition::Ankles(phase.load_at(share)),
        },
    }
}
