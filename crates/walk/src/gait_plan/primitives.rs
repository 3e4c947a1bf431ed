//! Walking primitives (thesis 4.4.2): statically stable postures, joined joint by joint; after the
//! last one the legs swap and the first follows again.

use super::curve::{Curve, JointPath, Piece};
use super::plan::{GaitPlan, JointGains, Knot, ROUNDING_M};
use super::posture::{Posture, Sought};
use super::walker::{Height, Pose, Walker};
use crate::error::{Error, PlanError};
use denavit_plants::Plant;

/// How joint positions go from a posture to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Join {
    /// With the velocity 1 - cos, at rest in every posture.
    #[default]
    Cosine,
    /// A cubic spline through the postures of the swing; at rest where a foot leaves or lands.
    Cubic,
    /// A Bezier polynomial of degree 5 from posture to posture, at rest and without acceleration
    /// in every one.
    Bezier,
}

impl Join {
    /// What files call them, in the order of the enum.
    pub const WORDS: [&'static str; 3] = ["cosine", "cubic", "bezier"];
    /// All of them, in the order of the enum.
    pub const ALL: [Self; 3] = [Self::Cosine, Self::Cubic, Self::Bezier];
}

/// A posture of a step, seen from the ankle of the foot that stands; both feet are level.
#[derive(Clone, Debug, PartialEq)]
pub struct Primitive {
    /// Its name, for messages.
    pub name: String,
    /// Centre of mass, forward from the stance ankle \[m\].
    pub center_of_mass_m: f64,
    /// The swing foot: its ankle forward from the stance ankle, its sole above the ground \[m\].
    pub swing_foot_m: [f64; 2],
    /// Height of the hips, the base frame, above the ground \[m\].
    pub hip_height_m: f64,
    /// Pitch of the torso, positive forward \[rad\].
    pub torso_pitch_rad: f64,
    /// The time to the next posture \[s\].
    pub duration_s: f64,
}

/// Postures of a step, and how they are joined.
#[derive(Clone, Debug, PartialEq)]
pub struct PrimitivesProblem {
    /// In their order, at least two.
    pub postures: Vec<Primitive>,
    /// How they are joined.
    pub join: Join,
    /// The least static margin \[m\].
    pub margin_m: f64,
    /// Steps of the scenario.
    pub steps: usize,
    /// Laws of the joints.
    pub gains: JointGains,
}

/// Times between two postures at which the joined curves are checked.
const CHECKS: usize = 16;
/// A foot this low stands \[m\].
const ON_GROUND_M: f64 = 1e-9;
/// Places that are nearer are one \[m\].
const ONE_PLACE_M: f64 = 1e-9;

/// A step that is being planned: the right foot stands with its ankle at x = 0.
struct Step<'a> {
    walker: Walker,
    problem: &'a PrimitivesProblem,
    /// Of all postures, and of the first with the legs swapped.
    postures: Vec<Posture>,
    /// When each of them is \[s\].
    times_s: Vec<f64>,
}

/// Plans the gait of a robot.
///
/// # Errors
/// Postures that are out of reach, or not statically stable; steps that do not close.
pub fn plan_primitives(
    plant: &mut dyn Plant,
    problem: &PrimitivesProblem,
) -> Result<GaitPlan, Error> {
    let walker = Walker::of(plant)?;
    let step_length_m = length(problem)?;
    check_feet(problem)?;
    let mut times_s = vec![0.0];
    for primitive in &problem.postures {
        times_s.push(times_s[times_s.len() - 1] + primitive.duration_s);
    }
    let mut postures: Vec<Posture> = Vec::new();
    for (primitive, t_s) in problem.postures.iter().zip(&times_s) {
        let (pose, at) = (pose(primitive), Sought { name: &primitive.name, t_s: *t_s });
        let posture = match postures.last() {
            None => walker.first(plant, &pose, at)?,
            // a leap from one posture to another may lead nowhere where a search does not
            Some(before) => walker
                .reach(plant, &pose, &before.q, at)
                .or_else(|_| walker.first(plant, &pose, at))?,
        };
        postures.push(posture);
    }
    let mut last = postures[0].clone();
    last.q = walker.exchange.positions(&postures[0].q);
    postures.push(last);
    let step = Step { walker, problem, postures, times_s };
    let knots = step.knots(plant)?;
    let (step_s, steps) = (step.times_s[problem.postures.len()], problem.steps);
    GaitPlan {
        step_s,
        step_length_m,
        steps,
        duration_s: steps as f64 * step_s,
        distance_m: steps as f64 * step_length_m,
        paths: step.paths(),
        repeats: true,
        start: step.postures[0].q.clone(),
        gains: problem.gains,
        knots,
    }
    .joined()
}

/// The step's length, if the first posture may follow the last.
fn length(problem: &PrimitivesProblem) -> Result<f64, Error> {
    let [Some(first), Some(last)] = [problem.postures.first(), problem.postures.last()] else {
        return Err(PlanError::NoWalker("posture".to_owned()).into());
    };
    let expected_m = [-first.swing_foot_m[0], 0.0];
    let off = [0, 1].map(|axis| (last.swing_foot_m[axis] - expected_m[axis]).abs());
    if off.iter().any(|off| *off > ONE_PLACE_M) || first.swing_foot_m[1].abs() > ON_GROUND_M {
        let (posture, foot_m) = (last.name.clone(), last.swing_foot_m);
        return Err(PlanError::NotClosed { posture, foot_m, expected_m }.into());
    }
    Ok(last.swing_foot_m[0])
}

/// Feet that stand in two postures, one after the other, do not slide in between.
fn check_feet(problem: &PrimitivesProblem) -> Result<(), Error> {
    let mut t_s = 0.0;
    for pair in problem.postures.windows(2) {
        t_s += pair[0].duration_s;
        let [from, to] = [pair[0].swing_foot_m, pair[1].swing_foot_m];
        let distance_m = (to[0] - from[0]).abs();
        if from[1] <= ON_GROUND_M && to[1] <= ON_GROUND_M && distance_m > ONE_PLACE_M {
            return Err(PlanError::Slides { posture: pair[1].name.clone(), t_s, distance_m }.into());
        }
    }
    Ok(())
}

fn pose(primitive: &Primitive) -> Pose {
    Pose {
        feet_m: [[0.0; 2], primitive.swing_foot_m],
        center_m: primitive.center_of_mass_m,
        height: Height::Hip(primitive.hip_height_m),
        pitch_rad: primitive.torso_pitch_rad,
    }
}

impl Step<'_> {
    fn stands(&self, posture: usize) -> bool {
        let postures = &self.problem.postures;
        postures[posture % postures.len()].swing_foot_m[1] <= ON_GROUND_M
    }

    /// Whether both feet stand from a posture to the next.
    fn is_double(&self, part: usize) -> bool {
        self.stands(part) && self.stands(part + 1)
    }

    /// What a posture stands on: the stance foot alone where the other one leaves or lands.
    fn is_on_both(&self, posture: usize) -> bool {
        let parts = self.problem.postures.len();
        let before = (posture + parts - 1) % parts;
        self.is_double(before) && self.is_double(posture)
    }

    fn check_margin(&self, knot: &Knot) -> Result<(), Error> {
        let least_m = self.problem.margin_m;
        // written so that NaN fails as well
        if knot.static_margin_m >= least_m - ROUNDING_M {
            return Ok(());
        }
        let (posture, t_s, margin_m) = (knot.name.clone(), knot.t_s, knot.static_margin_m);
        Err(PlanError::Margin { point: "centre of mass", posture, t_s, margin_m, least_m }.into())
    }

    /// Postures, each with the times up to the next.
    fn knots(&self, plant: &mut dyn Plant) -> Result<Vec<Knot>, Error> {
        let mut knots = Vec::new();
        let paths = self.paths();
        let references = paths.iter().map(|path| path.reference(false));
        let references = references.collect::<Result<Vec<_>, _>>()?;
        for (part, primitive) in self.problem.postures.iter().enumerate() {
            let posture = &self.postures[part];
            let standing = [true, self.is_on_both(part)];
            let at_posture = Knot {
                t_s: self.times_s[part],
                name: primitive.name.clone(),
                q: posture.q.clone(),
                is_solved: true,
                residual: posture.residual,
                static_margin_m: self.margin_m(plant, part, standing, &posture.q),
                pressure_margin_m: None,
            };
            self.check_margin(&at_posture)?;
            knots.push(at_posture);
            let mut near = posture.q.clone();
            for check in 1..=CHECKS {
                let share = check as f64 / (CHECKS + 1) as f64;
                let t_s = self.times_s[part] + share * primitive.duration_s;
                for (path, reference) in paths.iter().zip(&references) {
                    near[path.joint] = reference.at(t_s).position;
                }
                let knot = self.between(plant, part, t_s, &near)?;
                near.clone_from(&knot.q);
                knots.push(knot);
            }
        }
        Ok(knots)
    }

    /// What the curves say at a time between two postures.
    fn between(
        &self,
        plant: &mut dyn Plant,
        part: usize,
        t_s: f64,
        q: &[f64],
    ) -> Result<Knot, Error> {
        let name = format!("after {}", self.problem.postures[part].name);
        let at = Sought { name: &name, t_s };
        let q = self.walker.placed(plant, 0, [0.0; 2], q, at)?;
        let is_double = self.is_double(part);
        let foot_m = self.problem.postures[part].swing_foot_m;
        let residual = match is_double {
            true => self.walker.off_place_m(plant, 1, foot_m, &q),
            false => self.walker.depth_m(plant, 1, &q),
        };
        let static_margin_m = self.margin_m(plant, part, [true, is_double], &q);
        let pressure_margin_m = None;
        Ok(Knot { t_s, name, q, is_solved: false, residual, static_margin_m, pressure_margin_m })
    }

    fn margin_m(&self, plant: &mut dyn Plant, part: usize, standing: [bool; 2], q: &[f64]) -> f64 {
        let feet_m = [[0.0; 2], self.problem.postures[part].swing_foot_m];
        let [low, high] = self.walker.support_m(&feet_m, standing);
        let [x, ..] = plant.center_of_mass(q);
        (x - low).min(high - x)
    }

    /// What joints follow in two steps: the second is the first with the legs swapped.
    fn paths(&self) -> Vec<JointPath> {
        let path = |joint: &usize| {
            let roles = [*joint, self.walker.exchange.coordinates[*joint]];
            let pieces = roles.iter().flat_map(|role| self.pieces(*role)).collect();
            JointPath { joint: *joint, pieces, feed_forward: None }
        };
        self.walker.driven.iter().map(path).collect()
    }

    /// What a coordinate does in a step.
    fn pieces(&self, coordinate: usize) -> Vec<Piece> {
        let value = |posture: usize| self.postures[posture].q[coordinate];
        let parts = self.problem.postures.len();
        let mut pieces = Vec::new();
        let mut part = 0;
        while part < parts {
            let mut end = part + 1;
            if self.problem.join == Join::Cubic {
                // on through postures in which the foot swings
                while end < parts && !self.stands(end) {
                    end += 1;
                }
            }
            let duration_s = self.times_s[end] - self.times_s[part];
            let (from, to) = (value(part), value(end));
            let curve = match self.problem.join {
                Join::Cosine => Curve::Cosine { duration_s, values: [from, to] },
                Join::Bezier => {
                    Curve::Bezier { duration_s, controls: vec![from, from, from, to, to, to] }
                }
                Join::Cubic => {
                    let times = self.times_s[part..=end].iter();
                    Curve::Cubic {
                        times_s: times.map(|t_s| t_s - self.times_s[part]).collect(),
                        values: (part..=end).map(value).collect(),
                    }
                }
            };
            pieces.push(Piece { duration_s, curve });
            part = end;
        }
        pieces
    }
}
