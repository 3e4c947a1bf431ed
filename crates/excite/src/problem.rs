//! The optimisation problem: objective and limits as functions of the coordinates of all joints
//! that move, with their derivatives.
//!
//! A limit holds at every time. For the solver it is one smooth function of the coordinates, the
//! maximum over the grid replaced by (Kreisselmeier, Steinhauser)
//!
//! > max_k u_k <= ln(sum_k exp(rho u_k)) / rho <= max_k u_k + ln(samples) / rho.
//!
//! Regressor, torques and points are differentiated by central differences of all samples at once:
//! what they return at a sample depends on the motion at that sample alone, so that 6 n
//! evaluations of the grid give the derivatives by every coordinate.

use super::model::{Evaluators, ExcitedModel};
use super::objective::{Excitation, Objective, Stacked};
use super::space::{Slopes, Space};
use super::stack::{Signs, Stack, share};
use crate::policy::problem::HEIGHT_M;
use nalgebra::DVector;

/// What is optimised.
#[derive(Clone, Debug)]
pub(super) struct Problem<'a> {
    pub(super) model: &'a ExcitedModel,
    pub(super) space: &'a Space,
    pub(super) stack: &'a Stack,
    pub(super) objective: Objective,
    /// Points stay this far above the ground \[m\].
    pub(super) clearance_m: f64,
    /// Share of each limit that is left unused, for what happens between the samples.
    pub(super) reserve: f64,
    /// rho.
    pub(super) sharpness: f64,
}

/// A limit that holds at every time.
#[derive(Clone, Copy, Debug)]
enum Bound {
    /// Of position, rate or acceleration of a joint, by its place among those that move.
    Motion { order: usize, moving: usize, side: f64 },
    /// Of the torque of a joint.
    Torque { joint: usize, side: f64 },
    /// Of the height of a point.
    Clear { point: usize },
}

/// Objective and limits at one place.
#[derive(Clone, Debug)]
pub(super) struct Values {
    pub(super) objective: f64,
    pub(super) excitation: Excitation,
    /// At most 0 where the limits hold.
    pub(super) limits: Vec<f64>,
}

/// Their derivatives by the coordinates.
#[derive(Clone, Debug)]
pub(super) struct Derivatives {
    pub(super) objective: Vec<f64>,
    pub(super) limits: Vec<Vec<f64>>,
}

/// For position, rate and acceleration of each joint that moves, one number a sample.
type Pulls = Vec<Vec<f64>>;

impl Problem<'_> {
    /// Number of coordinates.
    pub(super) fn coordinates(&self) -> usize {
        self.space.coordinates() * self.model.moving().len()
    }

    /// The coordinates of one of the joints that move.
    pub(super) fn of_joint<'x>(&self, x: &'x [f64], moving: usize) -> &'x [f64] {
        let count = self.space.coordinates();
        &x[moving * count..(moving + 1) * count]
    }

    fn bounds(&self) -> Vec<Bound> {
        let mut bounds = Vec::new();
        for moving in 0..self.model.moving().len() {
            for order in 0..3 {
                bounds.extend([1.0, -1.0].map(|side| Bound::Motion { order, moving, side }));
            }
        }
        for joint in self.model.limited() {
            bounds.extend([1.0, -1.0].map(|side| Bound::Torque { joint, side }));
        }
        bounds.extend((0..self.model.points.len()).map(|point| Bound::Clear { point }));
        bounds
    }

    /// Number of limits.
    pub(super) fn limits(&self) -> usize {
        self.bounds().len()
    }

    /// Columns of q, qd, qdd of all joints on the grid.
    pub(super) fn motion(&self, x: &[f64]) -> Vec<Vec<f64>> {
        let samples = self.space.times().len();
        let (joints, n) = (&self.model.joints, self.model.joints.len());
        let mut motion = vec![vec![0.0; samples]; 3 * n];
        for (joint, limits) in joints.iter().enumerate() {
            motion[joint].fill(limits.middle());
        }
        for (moving, joint) in self.model.moving().into_iter().enumerate() {
            let curve = self.space.curve(self.of_joint(x, moving));
            for (order, values) in curve.iter().enumerate() {
                for (entry, value) in motion[order * n + joint].iter_mut().zip(values) {
                    *entry += joints[joint].half() * value;
                }
            }
        }
        motion
    }

    /// How far a limit is exceeded at each sample, of its range; not positive where it holds.
    fn excess(&self, bound: Bound, motion: &[Vec<f64>], others: &Others) -> Vec<f64> {
        let n = self.model.joints.len();
        let ranged = |values: &[f64], [low, high]: [f64; 2], side: f64| -> Vec<f64> {
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            values.iter().map(|v| side * (v - middle) / half - 1.0 + self.reserve).collect()
        };
        match bound {
            Bound::Motion { order, moving, side } => {
                let joint = self.model.moving()[moving];
                let limits = &self.model.joints[joint];
                let range = match order {
                    0 => limits.position,
                    1 => [-limits.velocity, limits.velocity],
                    _ => [-limits.acceleration, limits.acceleration],
                };
                ranged(&motion[order * n + joint], range, side)
            }
            Bound::Torque { joint, side } => {
                let range = self.model.joints[joint].torque.unwrap_or([-1.0, 1.0]);
                ranged(&others.torques[joint], range, side)
            }
            Bound::Clear { point } => {
                let least = self.clearance_m + self.reserve * HEIGHT_M;
                others.gaps[point].iter().map(|gap| (least - gap) / HEIGHT_M).collect()
            }
        }
    }

    /// The smooth maximum, and what each sample weighs in its derivative.
    fn maximum(&self, excess: &[f64]) -> (f64, Vec<f64>) {
        let most = excess.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<f64> =
            excess.iter().map(|u| (self.sharpness * (u - most)).exp()).collect();
        let sum: f64 = weights.iter().sum();
        let weights = weights.into_iter().map(|weight| weight / sum).collect();
        (most + sum.ln() / self.sharpness, weights)
    }

    fn others(&self, evaluators: &mut Evaluators, motion: &[Vec<f64>]) -> Others {
        let columns: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
        self.others_of(evaluators, &columns)
    }

    fn others_of(&self, evaluators: &mut Evaluators, motion: &[&[f64]]) -> Others {
        let n = self.model.joints.len();
        let mut torques = Vec::new();
        if !self.model.limited().is_empty() {
            torques = self.model.torque_columns(evaluators, motion);
            for (joint, torque) in torques.iter_mut().enumerate() {
                let coulomb = self.model.coulomb(joint);
                for (entry, rate) in torque.iter_mut().zip(motion[n + joint]) {
                    if coulomb > 0.0 && *rate != 0.0 {
                        *entry += coulomb * rate.signum() * share(self.model, joint, *rate);
                    }
                }
            }
        }
        let gaps = self.model.gap_columns(evaluators, &motion[..n]);
        Others { torques, gaps }
    }

    /// Objective and limits.
    pub(super) fn values(&self, evaluators: &mut Evaluators, x: &[f64]) -> Values {
        let motion = self.motion(x);
        let stacked = self.stacked(evaluators, &motion);
        let others = self.others(evaluators, &motion);
        let limit = |bound: Bound| self.maximum(&self.excess(bound, &motion, &others)).0;
        Values {
            objective: stacked.value(&self.objective),
            excitation: stacked.excitation(),
            limits: self.bounds().into_iter().map(limit).collect(),
        }
    }

    fn stacked(&self, evaluators: &mut Evaluators, motion: &[Vec<f64>]) -> Stacked {
        let columns: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
        Stacked::new(self.stack.w(self.model, evaluators, &columns, Signs::Smooth))
    }

    /// The derivatives of objective and limits.
    pub(super) fn derivatives(&self, evaluators: &mut Evaluators, x: &[f64]) -> Derivatives {
        let motion = self.motion(x);
        let moving = self.model.moving();
        let gradient = self.stacked(evaluators, &motion).gradient(&self.objective);
        let a = self.stack.in_computed(&gradient);
        let others = self.others(evaluators, &motion);
        let bounds = self.bounds();
        let weights: Vec<Vec<f64>> = bounds
            .iter()
            .map(|bound| self.maximum(&self.excess(*bound, &motion, &others)).1)
            .collect();
        let samples = self.space.times().len();
        let none = || vec![vec![0.0; samples]; 3 * moving.len()];
        let mut objective_pulls = none();
        let mut limit_pulls: Vec<Pulls> = bounds.iter().map(|_| none()).collect();
        for order in 0..3 {
            for (place, &joint) in moving.iter().enumerate() {
                let at = order * moving.len() + place;
                let step = self.step(order, joint);
                let apart = self.apart(evaluators, &motion, &a, order, joint, step);
                objective_pulls[at] = apart.objective;
                for (pulls, (bound, weights)) in
                    limit_pulls.iter_mut().zip(bounds.iter().zip(&weights))
                {
                    let slope = self.bound_slope(*bound, (order, place), &apart.others);
                    if let Some(slope) = slope {
                        pulls[at] = slope.iter().zip(weights).map(|(s, w)| s * w).collect();
                    }
                }
            }
        }
        let slopes: Vec<Slopes> =
            (0..moving.len()).map(|place| self.space.slopes(self.of_joint(x, place))).collect();
        Derivatives {
            objective: self.pulled(&slopes, &objective_pulls),
            limits: limit_pulls.iter().map(|pulls| self.pulled(&slopes, pulls)).collect(),
        }
    }

    /// A step of a difference, small against the range of what is moved.
    fn step(&self, order: usize, joint: usize) -> f64 {
        let limits = &self.model.joints[joint];
        1e-5 * [1.0_f64.min(limits.half()), limits.velocity, limits.acceleration][order]
    }

    /// Differences over one of the inputs of every sample.
    fn apart(
        &self,
        evaluators: &mut Evaluators,
        motion: &[Vec<f64>],
        a: &nalgebra::DMatrix<f64>,
        order: usize,
        joint: usize,
        step: f64,
    ) -> Apart {
        let at = order * self.model.joints.len() + joint;
        let moved = |step: f64| -> Vec<f64> { motion[at].iter().map(|v| v + step).collect() };
        let [forth, back] = [moved(step), moved(-step)];
        let (forth, back) = (replaced(motion, at, &forth), replaced(motion, at, &back));
        let scale = 1.0 / (2.0 * step);
        let mut objective = self.stack.along(self.model, evaluators, a, [&forth, &back]);
        objective.iter_mut().for_each(|entry| *entry *= scale);
        let mut others = self.others_of(evaluators, &forth);
        let before = self.others_of(evaluators, &back);
        let lists = others.torques.iter_mut().chain(&mut others.gaps);
        for (after, before) in lists.zip(before.torques.iter().chain(&before.gaps)) {
            for (entry, back) in after.iter_mut().zip(before) {
                *entry = scale * (*entry - back);
            }
        }
        Apart { objective, others }
    }

    /// The derivative of what a bound limits, at each sample, by one of the inputs.
    fn bound_slope(
        &self,
        bound: Bound,
        input: (usize, usize),
        others: &Others,
    ) -> Option<Vec<f64>> {
        match bound {
            Bound::Motion { order, moving, side } if (order, moving) == input => {
                let limits = &self.model.joints[self.model.moving()[moving]];
                let half = [limits.half(), limits.velocity, limits.acceleration][order];
                Some(vec![side / half; self.space.times().len()])
            }
            Bound::Motion { .. } => None,
            Bound::Torque { joint, side } => {
                let [low, high] = self.model.joints[joint].torque?;
                let factor = side / (0.5 * (high - low));
                Some(others.torques[joint].iter().map(|slope| factor * slope).collect())
            }
            // heights are functions of positions alone
            Bound::Clear { .. } if input.0 > 0 => None,
            Bound::Clear { point } => {
                Some(others.gaps[point].iter().map(|slope| -slope / HEIGHT_M).collect())
            }
        }
    }

    /// Derivatives by the coordinates, of derivatives by the motion.
    fn pulled(&self, slopes: &[Slopes], pulls: &Pulls) -> Vec<f64> {
        let moving = self.model.moving();
        let mut gradient = Vec::with_capacity(self.coordinates());
        for (place, &joint) in moving.iter().enumerate() {
            let mut own = DVector::zeros(self.space.coordinates());
            for (order, slope) in slopes[place].iter().enumerate() {
                let pull = &pulls[order * moving.len() + place];
                if pull.iter().any(|entry| *entry != 0.0) {
                    own += slope.tr_mul(&DVector::from_column_slice(pull));
                }
            }
            own *= self.model.joints[joint].half();
            gradient.extend(own.iter());
        }
        gradient
    }
}

/// The columns of a motion with another in place of one.
fn replaced<'m>(motion: &'m [Vec<f64>], at: usize, own: &'m [f64]) -> Vec<&'m [f64]> {
    let mut columns: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
    columns[at] = own;
    columns
}

/// What is limited besides the motion itself.
struct Others {
    torques: Vec<Vec<f64>>,
    gaps: Vec<Vec<f64>>,
}

/// Derivatives at each sample by one of its inputs.
struct Apart {
    objective: Vec<f64>,
    others: Others,
}

#[cfg(test)]
mod tests {
    use super::super::{Ends, ExciteOptions, Family};
    use super::*;
    use denavit_codegen::model;

    const ARM: &str = r#"{"format": "denavit-model/1", "name": "arm", "convention": "standard",
      "gravity": [0, -9.81, 0], "links": [
        {"name": "a", "joint": {"type": "revolute", "a": 0.5},
         "limits": {"position": [-1, 2], "velocity": 3, "acceleration": 20, "torque": [-30, 40]},
         "body": {"mass": 2, "com": [-0.2, 0.01, 0], "inertia": {"zz": 0.04}, "about": "com"}},
        {"name": "b", "joint": {"type": "revolute", "a": 0.4},
         "limits": {"position": [-1, 1], "velocity": 4, "acceleration": 30, "torque": [-9, 9]},
         "body": {"mass": 1, "com": [-0.2, 0, 0], "inertia": {"zz": 0.02}, "about": "com"}}],
      "drives": {"a": {"viscous": 0.2, "coulomb": 0.3, "rotor_inertia": 0.01}},
      "contacts": [{"name": "tip", "link": "b", "position": [0, 0.01, 0]}],
      "ground": {"point": [0, -0.7, 0], "normal": [0, 2, 0]}}"#;

    /// Derivatives of objective and limits are those of differences, and what smooth maxima are
    /// bounds of holds.
    #[test]
    fn derivatives_are_those_of_differences() {
        let robot = model::read("arm.json", ARM.as_bytes()).expect("a sound model");
        for family in [Family::Fourier { harmonics: 3 }, Family::FreeFourier { terms: 4 }] {
            let ends = Ends { at_rest: true, unaccelerated: true, closed: true };
            let mut options = ExciteOptions { family, ends, ..ExciteOptions::default() };
            options.duration_s = 2.5;
            options.with.friction = true;
            options.with.only_modelled = true;
            let space = options.space(&mut Vec::new()).expect("a space");
            let model = options.model(&robot, &mut Vec::new()).expect("a model");
            let mut evaluators = model.evaluators();
            let stack = Stack::new(&model, &mut evaluators);
            for objective in [Objective::CONDITION, Objective::D_OPTIMAL] {
                let problem = Problem {
                    model: &model,
                    space: &space,
                    stack: &stack,
                    objective,
                    clearance_m: 0.01,
                    reserve: 0.0,
                    sharpness: 50.0,
                };
                compare(&problem, &mut evaluators);
            }
        }
    }

    fn compare(problem: &Problem<'_>, evaluators: &mut Evaluators) {
        let mut random = denavit_numerics::Random::new(11);
        let mut x = problem.space.random(|| random.uniform());
        x.extend(problem.space.random(|| random.uniform()));
        let exact = problem.derivatives(evaluators, &x);
        // each joint: two sides of three; two torques of two sides; the tip
        assert_eq!(exact.limits.len(), 2 * 6 + 4 + 1);
        let step = 1e-6;
        for at in 0..x.len() {
            let [after, before] = [step, -step].map(|step| {
                let mut moved = x.clone();
                moved[at] += step;
                problem.values(evaluators, &moved)
            });
            let close = |found: f64, [after, before]: [f64; 2], size: f64, what: &str| {
                let difference = (after - before) / (2.0 * step);
                let apart = (found - difference).abs();
                assert!(apart < 2e-4 * (1.0 + size), "{what} {at}: {found} {difference}");
            };
            let size = |gradient: &[f64]| gradient.iter().map(|g| g.abs()).fold(0.0, f64::max);
            let both = [after.objective, before.objective];
            close(exact.objective[at], both, size(&exact.objective), "objective");
            for (limit, gradient) in exact.limits.iter().enumerate() {
                let both = [after.limits[limit], before.limits[limit]];
                close(gradient[at], both, size(gradient), &format!("limit {limit}"));
            }
        }
    }

    #[test]
    fn the_smooth_maximum_is_between_the_maximum_and_its_bound() {
        let robot = model::read("arm.json", ARM.as_bytes()).expect("a sound model");
        let options = ExciteOptions::default();
        let space = options.space(&mut Vec::new()).expect("a space");
        let model = options.model(&robot, &mut Vec::new()).expect("a model");
        let stack = Stack::new(&model, &mut model.evaluators());
        let problem = Problem {
            model: &model,
            space: &space,
            stack: &stack,
            objective: Objective::CONDITION,
            clearance_m: 0.0,
            reserve: 0.0,
            sharpness: 30.0,
        };
        for values in [vec![0.1, 0.1, 0.1], vec![-3.0, 5.0, 1.0], vec![1e5, -1e5]] {
            let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let (found, weights) = problem.maximum(&values);
            let bound = most + (values.len() as f64).ln() / 30.0;
            assert!(most <= found && found <= bound + 1e-12, "{values:?}: {found}");
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }
}
