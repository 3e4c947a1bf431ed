//! A walk by the linear inverted pendulum (thesis 4.4.2), from standing to standing: feet are
//! placed at equal distances, the centre of pressure goes from one to the next in double support,
//! and the centre of mass follows from it; inverse kinematics makes joint positions of that.

use super::curve::{Curve, JointPath, Piece};
use super::footsteps::smooth;
use super::pendulum::{PendulumPath, PressureSegment};
use super::plan::{GaitPlan, JointGains, Knot, ROUNDING_M};
use super::posture::{Posture, Sought};
use super::walker::{Height, Pose, Walker};
use crate::error::{Error, PlanError};
use denavit_plants::Plant;
use denavit_runtime::Scalar;
use std::f64::consts::PI;

/// What the walk is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InvertedPendulumProblem {
    /// From a foot to the next \[m\].
    pub step_length_m: f64,
    /// From a foot's landing to the next one's, single and double support \[s\].
    pub step_s: f64,
    /// Double support in it \[s\].
    pub double_support_s: f64,
    /// Steps, the last of which puts the feet side by side.
    pub steps: usize,
    /// Height of the centre of mass above the ground \[m\].
    pub center_of_mass_height_m: f64,
    /// Height of the swing foot in the middle of its way \[m\].
    pub lift_m: f64,
    /// Pitch of the torso, positive forward \[rad\].
    pub torso_pitch_rad: f64,
    /// Where the centre of pressure is at the beginning and at the end of single support, forward
    /// from the stance ankle; none: in the middle of the sole \[m\].
    pub center_of_pressure_m: Option<[f64; 2]>,
    /// Standing before the first foot leaves, and after the last one has landed \[s\].
    pub standing_s: [f64; 2],
    /// The largest distance of knots \[s\].
    pub interval_s: f64,
    /// The least margin of the planned centre of pressure \[m\].
    pub margin_m: f64,
    /// Laws of the joints.
    pub gains: JointGains,
}

/// A plan with more knots is one for longer than anybody waits.
const MAX_KNOTS: usize = 20_000;
/// The swing foot rises before it goes forward, and sinks after: shares of the swing.
const FORWARD: [f64; 2] = [0.15, 0.85];

/// A time in which the same feet stand.
#[derive(Clone, Debug, PartialEq)]
struct Phase {
    name: String,
    start_s: f64,
    duration_s: f64,
    /// Places of the ankles at the beginning; of the swing foot where it lands, too \[m\].
    ankles_m: [f64; 2],
    swing: Option<(usize, f64)>,
}

/// Phases, and how the centre of pressure goes in them.
#[derive(Clone, Debug, Default, PartialEq)]
struct Course {
    phases: Vec<Phase>,
    segments: Vec<PressureSegment>,
}

impl Course {
    /// Adds a phase in which the centre of pressure goes to these places, one after the other.
    fn push(&mut self, phase: Phase, places_m: &[f64]) {
        let count = places_m.len().saturating_sub(1).max(1) as f64;
        for pair in places_m.windows(2) {
            let duration_s = phase.duration_s / count;
            self.segments.push(PressureSegment { duration_s, places_m: [pair[0], pair[1]] });
        }
        self.phases.push(phase);
    }

    fn end_s(&self) -> f64 {
        self.phases.last().map_or(0.0, |last| last.start_s + last.duration_s)
    }
}

/// Phases from standing to standing.
fn course(problem: &InvertedPendulumProblem, walker: &Walker) -> Course {
    let middle = walker.middle_m();
    let [from, to] = problem.center_of_pressure_m.unwrap_or([middle; 2]);
    let (length, steps) = (problem.step_length_m, problem.steps);
    let mut course = Course::default();
    let mut ankles_m = [0.0; 2];
    let [begin_s, end_s] = problem.standing_s;
    let phase = |name: String, start_s, duration_s, ankles_m, swing| Phase {
        name,
        start_s,
        duration_s,
        ankles_m,
        swing,
    };
    let begin = phase("start".to_owned(), 0.0, begin_s, ankles_m, None);
    course.push(begin, &[middle, 0.5 * (middle + from), from]);
    for step in 0..steps {
        let foot = step as f64 * length;
        let (side, is_last) = (1 - step % 2, step + 1 == steps);
        let landing = if is_last { foot } else { foot + length };
        let swing_s = problem.step_s - problem.double_support_s;
        let name = format!("step {}, swing", step + 1);
        let swing = phase(name, course.end_s(), swing_s, ankles_m, Some((side, landing)));
        course.push(swing, &[foot + from, foot + to]);
        ankles_m[side] = landing;
        if is_last {
            let stop = phase("stop".to_owned(), course.end_s(), end_s, ankles_m, None);
            let rest = foot + middle;
            course.push(stop, &[foot + to, 0.5 * (foot + to + rest), rest]);
        } else {
            let name = format!("step {}, double support", step + 1);
            let both = phase(name, course.end_s(), problem.double_support_s, ankles_m, None);
            course.push(both, &[foot + to, foot + length + from]);
        }
    }
    course
}

impl Phase {
    fn standing(&self) -> [bool; 2] {
        [0, 1].map(|side| self.swing.is_none_or(|(swing, _)| swing != side))
    }

    /// The foot that stands, or one of both.
    fn stance(&self) -> usize {
        self.swing.map_or(0, |(side, _)| 1 - side)
    }

    fn feet_m(&self, share: f64, lift_m: f64) -> [[f64; 2]; 2] {
        let mut feet_m = self.ankles_m.map(|ankle| [ankle, 0.0]);
        if let Some((side, landing)) = self.swing {
            let way = smooth((share - FORWARD[0]) / (FORWARD[1] - FORWARD[0]));
            let (sine, _) = (PI * share).sincos();
            // sin^2 would leave 1e-33 at the end
            let lift = if share >= 1.0 { 0.0 } else { lift_m * sine * sine };
            feet_m[side] = [feet_m[side][0] + (landing - feet_m[side][0]) * way, lift];
        }
        feet_m
    }
}

/// A walk that is being planned.
struct Planner<'a> {
    problem: &'a InvertedPendulumProblem,
    walker: Walker,
    course: Course,
    path: PendulumPath,
}

/// Plans the walk of a robot.
///
/// # Errors
/// Postures that are out of reach, phases that overlap, a centre of pressure outside the feet.
pub fn plan_inverted_pendulum(
    plant: &mut dyn Plant,
    problem: &InvertedPendulumProblem,
) -> Result<GaitPlan, Error> {
    let (double_support_s, step_s) = (problem.double_support_s, problem.step_s);
    // written so that NaN fails as well
    if !(double_support_s > 0.0 && double_support_s < step_s) {
        return Err(PlanError::Overlap { double_support_s, step_s }.into());
    }
    let walker = Walker::of(plant)?;
    let course = course(problem, &walker);
    if course.end_s() / problem.interval_s > MAX_KNOTS as f64 {
        return Err(PlanError::TooManyKnots(MAX_KNOTS).into());
    }
    let path = path(problem, &walker, &course)?;
    let duration_s = course.end_s();
    let planner = Planner { problem, walker, course, path };
    let knots = planner.knots(plant)?;
    let paths = planner.joint_paths(&knots);
    let knots = planner.checked(plant, knots, &paths)?;
    GaitPlan {
        step_s,
        step_length_m: problem.step_length_m,
        steps: problem.steps,
        duration_s,
        distance_m: problem.steps.saturating_sub(1) as f64 * problem.step_length_m,
        paths,
        repeats: false,
        start: knots.first().map(|knot| knot.q.clone()).unwrap_or_default(),
        gains: problem.gains,
        knots,
    }
    .joined()
}

/// The centre of mass from rest to rest.
fn path(
    problem: &InvertedPendulumProblem,
    walker: &Walker,
    course: &Course,
) -> Result<PendulumPath, Error> {
    let omega = (walker.gravity / problem.center_of_mass_height_m).sqrt();
    let segments = &course.segments;
    let ends = [0, segments.len().saturating_sub(2)];
    PendulumPath::resting(omega, segments, walker.middle_m(), ends)
        .ok_or_else(|| PlanError::NoWalker("walk from rest to rest".to_owned()).into())
}

impl Planner<'_> {
    fn pose(&self, phase: &Phase, t_s: f64) -> Pose {
        let share = (t_s - phase.start_s) / phase.duration_s;
        Pose {
            feet_m: phase.feet_m(share, self.problem.lift_m),
            center_m: self.path.at(t_s).position_m,
            height: Height::CenterOfMass(self.problem.center_of_mass_height_m),
            pitch_rad: self.problem.torso_pitch_rad,
        }
    }

    /// The knots of all phases, from a phase's beginning up to before its end; then the end.
    fn knots(&self, plant: &mut dyn Plant) -> Result<Vec<Knot>, Error> {
        let mut knots: Vec<Knot> = Vec::new();
        for phase in &self.course.phases {
            // an even number: in the middle of standing the centre of pressure turns around
            let count = 2.0 * (0.5 * phase.duration_s / self.problem.interval_s).ceil().max(1.0);
            let is_last = phase.start_s + phase.duration_s >= self.course.end_s();
            for index in 0..count as usize + usize::from(is_last) {
                let t_s = phase.start_s + phase.duration_s * (index as f64 / count);
                let (pose, at) = (self.pose(phase, t_s), Sought { name: &phase.name, t_s });
                let posture = match knots.last() {
                    None => self.walker.first(plant, &pose, at)?,
                    Some(before) => self.walker.reach(plant, &pose, &before.q, at)?,
                };
                knots.push(self.knot(phase, t_s, posture, true));
            }
        }
        Ok(knots)
    }

    fn knot(&self, phase: &Phase, t_s: f64, posture: Posture, is_solved: bool) -> Knot {
        let pose = self.pose(phase, t_s);
        let [low, high] = self.walker.support_m(&pose.feet_m, phase.standing());
        let margin = |x: f64| (x - low).min(high - x);
        Knot {
            t_s,
            name: phase.name.clone(),
            q: posture.q,
            is_solved,
            residual: posture.residual,
            static_margin_m: margin(pose.center_m),
            pressure_margin_m: Some(margin(self.path.at(t_s).pressure_m)),
        }
    }

    fn joint_paths(&self, knots: &[Knot]) -> Vec<JointPath> {
        let times_s: Vec<f64> = knots.iter().map(|knot| knot.t_s).collect();
        let path = |joint: &usize| {
            let values = knots.iter().map(|knot| knot.q[*joint]).collect();
            let curve = Curve::Cubic { times_s: times_s.clone(), values };
            let pieces = vec![Piece { duration_s: self.course.end_s(), curve }];
            JointPath { joint: *joint, pieces, feed_forward: None }
        };
        self.walker.driven.iter().map(path).collect()
    }

    /// The knots with the times halfway between them, where curves pass, and all margins checked.
    fn checked(
        &self,
        plant: &mut dyn Plant,
        knots: Vec<Knot>,
        paths: &[JointPath],
    ) -> Result<Vec<Knot>, Error> {
        let references = paths.iter().map(|path| path.reference(false));
        let references = references.collect::<Result<Vec<_>, _>>()?;
        let times_s: Vec<f64> = knots.iter().map(|knot| knot.t_s).collect();
        let mut all = Vec::with_capacity(2 * knots.len());
        for (index, knot) in knots.into_iter().enumerate() {
            let mut q = knot.q.clone();
            all.push(knot);
            let Some(next_s) = times_s.get(index + 1) else { continue };
            let t_s = 0.5 * (times_s[index] + next_s);
            let phases = &self.course.phases;
            let after = phases.partition_point(|phase| phase.start_s <= t_s);
            let phase = &phases[after.saturating_sub(1)];
            for (path, reference) in paths.iter().zip(&references) {
                q[path.joint] = reference.at(t_s).position;
            }
            let (pose, stance) = (self.pose(phase, t_s), phase.stance());
            let (foot_m, at) = (pose.feet_m[stance], Sought { name: &phase.name, t_s });
            let q = self.walker.placed(plant, stance, foot_m, &q, at)?;
            let residual = self.walker.error(plant, &pose, &q);
            all.push(self.knot(phase, t_s, Posture { q, residual }, false));
        }
        for knot in &all {
            let margin_m = knot.pressure_margin_m.unwrap_or(f64::NAN);
            let least_m = self.problem.margin_m;
            if margin_m >= least_m - ROUNDING_M {
                continue;
            }
            let (posture, t_s) = (knot.name.clone(), knot.t_s);
            let point = "planned centre of pressure";
            return Err(PlanError::Margin { point, posture, t_s, margin_m, least_m }.into());
        }
        Ok(all)
    }
}
