//! Sequential quadratic programming with elastic constraints in a trust region (Fletcher's
//! S l1 QP): every subproblem has a solution, from however bad a start, and a step is taken if it
//! lowers the cost plus the penalised violations.
//!
//! Chosen over a line search because linearisations of a gait at a bad guess mean something only
//! nearby, and over an interior-point method of its own because the subproblems are those that
//! `clarabel` solves well: sparse, convex, with many bounds.

use super::program::{Linearisation, Program, violation};
use super::quadratic::{Step, Subproblem};

/// How far to go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Most subproblems.
    pub iterations: usize,
    /// First radius of the trust region, in scales of the variables.
    pub radius: f64,
    /// First weight of violations.
    pub penalty: f64,
    /// Violations below this are none.
    pub feasible: f64,
    /// A predicted decrease below this share of the cost ends the search.
    pub decrease: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { iterations: 200, radius: 0.3, penalty: 10.0, feasible: 1e-6, decrease: 1e-4 }
    }
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// No step that the linearisation sees lowers the cost by more than what counts.
    Converged,
    /// There were as many subproblems as allowed.
    Iterations,
    /// A local least violation that is not none.
    Infeasible,
    /// Steps became too short, or the solver of subproblems failed.
    Stalled,
}

/// Where a search ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimum {
    /// The point.
    pub x: Vec<f64>,
    /// Its cost.
    pub cost: f64,
    /// Its constraints.
    pub constraints: Vec<f64>,
    /// Multipliers of the constraints.
    pub multipliers: Vec<f64>,
    /// The largest violation of a constraint.
    pub violation: f64,
    /// Why the search ended there.
    pub ending: Ending,
    /// Subproblems solved.
    pub iterations: usize,
}

const LARGEST_PENALTY: f64 = 1e6;
const SMALLEST_RADIUS: f64 = 1e-7;

struct Search<'a, P: Program + ?Sized> {
    program: &'a mut P,
    settings: Settings,
    x: Vec<f64>,
    cost: f64,
    constraints: Vec<f64>,
    multipliers: Vec<f64>,
    linear: Linearisation,
    radius: f64,
    penalty: f64,
    iterations: usize,
}

/// Searches a minimum from a start.
pub fn minimise<P: Program + ?Sized>(
    program: &mut P,
    start: &[f64],
    settings: Settings,
) -> Optimum {
    let bounded = start.iter().zip(program.bounds()).map(|(x, [low, high])| x.clamp(*low, *high));
    let x: Vec<f64> = bounded.collect();
    let mut constraints = Vec::new();
    let cost = program.evaluate(&x, &mut constraints);
    let multipliers = vec![0.0; constraints.len()];
    let mut search = Search {
        program,
        settings,
        x,
        cost,
        constraints,
        multipliers,
        linear: Linearisation::default(),
        radius: settings.radius,
        penalty: settings.penalty,
        iterations: 0,
    };
    let ending = search.run();
    let violation = search.largest_violation(&search.constraints);
    Optimum {
        x: search.x,
        cost: search.cost,
        constraints: search.constraints,
        multipliers: search.multipliers,
        violation,
        ending,
        iterations: search.iterations,
    }
}

/// What became of a step.
enum Outcome {
    Taken,
    Refused,
    /// Nothing left to gain with this penalty.
    Stationary,
    Failed,
}

impl<P: Program + ?Sized> Search<'_, P> {
    fn run(&mut self) -> Ending {
        let mut fresh = true;
        while self.iterations < self.settings.iterations {
            if fresh {
                self.program.linearise(&self.x, &self.multipliers, &mut self.linear);
            }
            match self.advance() {
                Outcome::Taken => fresh = true,
                Outcome::Refused => fresh = false,
                Outcome::Stationary => {
                    if self.largest_violation(&self.constraints) <= self.settings.feasible {
                        return Ending::Converged;
                    }
                    if self.penalty >= LARGEST_PENALTY {
                        return Ending::Infeasible;
                    }
                    self.penalty *= 10.0;
                    self.radius = self.radius.max(self.settings.radius * 0.1);
                    fresh = false;
                }
                Outcome::Failed => {
                    self.radius *= 0.3;
                    fresh = false;
                }
            }
            if self.radius < SMALLEST_RADIUS {
                return Ending::Stalled;
            }
        }
        Ending::Iterations
    }

    /// Solves a subproblem and takes its step if it is good.
    fn advance(&mut self) -> Outcome {
        self.iterations += 1;
        let Some(step) = self.subproblem(&self.constraints, &self.x) else {
            return Outcome::Failed;
        };
        let merit = self.cost + self.penalty * self.total_violation(&self.constraints);
        let predicted = merit - self.model(&step.change);
        if predicted <= self.settings.decrease * (self.cost.abs() + 1e-3) * self.radius.min(1.0) {
            self.multipliers = step.multipliers;
            return Outcome::Stationary;
        }
        let (trial, cost, constraints) = self.try_step(&step.change);
        let actual = merit - cost - self.penalty * self.total_violation(&constraints);
        let mut ratio = actual / predicted;
        let (mut best, mut taken) = ((trial, cost, constraints), step);
        if ratio < 0.25
            && ratio.is_finite()
            && let Some((corrected, step, gain)) = self.correct(&best.2, &taken, merit)
            && gain / predicted > ratio
        {
            ratio = gain / predicted;
            (best, taken) = (corrected, step);
        }
        let length = self.length(&taken.change);
        // a ratio that is no number is no step either
        if ratio.is_nan() || ratio <= 1e-3 {
            self.radius = 0.4 * self.radius.min(length);
            return Outcome::Refused;
        }
        if ratio < 0.25 {
            self.radius *= 0.5;
        } else if ratio > 0.7 && length > 0.9 * self.radius {
            self.radius = (2.0 * self.radius).min(10.0 * self.settings.radius.max(0.1));
        }
        (self.x, self.cost, self.constraints) = best;
        self.multipliers = taken.multipliers;
        self.relax();
        Outcome::Taken
    }

    /// Lowers the weight of violations to what the multipliers ask for: a larger one keeps steps
    /// along curved constraints short. Where a linearised constraint cannot be met, its multiplier
    /// is the weight itself, which stays.
    fn relax(&mut self) {
        let largest = self.multipliers.iter().fold(0.0_f64, |most, m| most.max(m.abs()));
        if largest < 0.4 * self.penalty {
            self.penalty = (2.0 * largest).max(0.3 * self.penalty);
        }
    }

    /// A second subproblem about what the constraints became after the first step: the correction
    /// of second order, without which curved constraints keep steps short.
    #[allow(clippy::type_complexity)] // one caller, and a name would say no more
    fn correct(
        &mut self,
        after: &[f64],
        step: &Step,
        merit: f64,
    ) -> Option<((Vec<f64>, f64, Vec<f64>), Step, f64)> {
        let mut shifted = after.to_vec();
        for &(row, column, value) in &self.linear.jacobian.entries {
            shifted[row] -= value * step.change[column];
        }
        let corrected = self.subproblem(&shifted, &self.x)?;
        let (trial, cost, constraints) = self.try_step(&corrected.change);
        let gain = merit - cost - self.penalty * self.total_violation(&constraints);
        Some(((trial, cost, constraints), corrected, gain))
    }

    fn subproblem(&self, values: &[f64], x: &[f64]) -> Option<Step> {
        let scales = self.program.scales();
        let within = |((x, scale), [low, high]): ((&f64, &f64), &[f64; 2])| {
            let reach = self.radius * scale;
            [(low - x).max(-reach).min(0.0), (high - x).min(reach).max(0.0)]
        };
        let steps: Vec<[f64; 2]> =
            x.iter().zip(scales).zip(self.program.bounds()).map(within).collect();
        let subproblem = Subproblem {
            linear: &self.linear,
            values,
            ranges: self.program.ranges(),
            scales,
            steps: &steps,
            penalty: self.penalty,
        };
        subproblem.solve()
    }

    /// Cost and penalised violations that the linearisation predicts.
    fn model(&self, change: &[f64]) -> f64 {
        let mut values = self.constraints.clone();
        self.linear.jacobian.multiply(change, &mut values);
        let slope: f64 = self.linear.gradient.iter().zip(change).map(|(g, d)| g * d).sum();
        let curvature = 0.5 * self.linear.hessian.quadratic(change);
        self.cost + slope + curvature + self.penalty * self.total_violation(&values)
    }

    fn try_step(&mut self, change: &[f64]) -> (Vec<f64>, f64, Vec<f64>) {
        let bounds = self.program.bounds().iter();
        let moved = self.x.iter().zip(change).zip(bounds);
        let trial: Vec<f64> =
            moved.map(|((x, d), [low, high])| (x + d).clamp(*low, *high)).collect();
        let mut constraints = Vec::new();
        let cost = self.program.evaluate(&trial, &mut constraints);
        (trial, cost, constraints)
    }

    fn length(&self, change: &[f64]) -> f64 {
        let scaled = change.iter().zip(self.program.scales()).map(|(d, scale)| (d / scale).abs());
        scaled.fold(0.0, f64::max)
    }

    fn total_violation(&self, values: &[f64]) -> f64 {
        values.iter().zip(self.program.ranges()).map(|(v, range)| violation(*v, *range)).sum()
    }

    fn largest_violation(&self, values: &[f64]) -> f64 {
        let each = values.iter().zip(self.program.ranges()).map(|(v, range)| violation(*v, *range));
        each.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimal::sparse::Triplets;

    /// A program of dense functions, with derivatives by hand.
    struct Textbook {
        scales: Vec<f64>,
        bounds: Vec<[f64; 2]>,
        ranges: Vec<[f64; 2]>,
        evaluate: fn(&[f64], &mut Vec<f64>) -> f64,
        linearise: fn(&[f64], &[f64], &mut Linearisation),
    }

    impl Program for Textbook {
        fn scales(&self) -> &[f64] {
            &self.scales
        }

        fn bounds(&self) -> &[[f64; 2]] {
            &self.bounds
        }

        fn ranges(&self) -> &[[f64; 2]] {
            &self.ranges
        }

        fn evaluate(&mut self, x: &[f64], constraints: &mut Vec<f64>) -> f64 {
            constraints.clear();
            (self.evaluate)(x, constraints)
        }

        fn linearise(&mut self, x: &[f64], multipliers: &[f64], linear: &mut Linearisation) {
            linear.clear(x.len());
            (self.linearise)(x, multipliers, linear);
            for index in 0..x.len() {
                linear.hessian.add(index, index, 0.1);
            }
        }
    }

    const TIGHT: Settings =
        Settings { iterations: 300, radius: 1.0, penalty: 10.0, feasible: 1e-8, decrease: 1e-9 };

    #[test]
    fn hock_and_schittkowskis_problem_71_is_solved() {
        let mut program = Textbook {
            scales: vec![1.0; 4],
            bounds: vec![[1.0, 5.0]; 4],
            ranges: vec![[25.0, f64::INFINITY], [40.0, 40.0]],
            evaluate: |x, constraints| {
                constraints.push(x.iter().product());
                constraints.push(x.iter().map(|x| x * x).sum());
                x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2]
            },
            linearise: |x, _, linear| {
                let sum = x[0] + x[1] + x[2];
                let ends = x[0] * x[3];
                linear.gradient = vec![x[3] * (sum + x[0]), ends, ends + 1.0, x[0] * sum];
                let all: f64 = x.iter().product();
                for (index, x) in x.iter().enumerate() {
                    linear.jacobian.add(0, index, all / x);
                    linear.jacobian.add(1, index, 2.0 * x);
                }
            },
        };
        let found = minimise(&mut program, &[1.0, 5.0, 5.0, 1.0], TIGHT);
        assert_eq!(found.ending, Ending::Converged);
        // the published optimum
        assert!((found.cost - 17.014_017_3).abs() < 1e-5, "{}", found.cost);
        for (x, known) in found.x.iter().zip([1.0, 4.742_999_4, 3.821_149_8, 1.379_408_2]) {
            assert!((x - known).abs() < 1e-3, "{:?}", found.x);
        }
        assert!(found.violation < 1e-8);
    }

    #[test]
    fn what_cannot_be_is_infeasible_and_the_violation_is_the_least() {
        // x^2 = -1
        let mut program = Textbook {
            scales: vec![1.0],
            bounds: vec![[-10.0, 10.0]],
            ranges: vec![[-1.0, -1.0]],
            evaluate: |x, constraints| {
                constraints.push(x[0] * x[0]);
                0.0
            },
            linearise: |x, _, linear| linear.jacobian.add(0, 0, 2.0 * x[0]),
        };
        let found = minimise(&mut program, &[3.0], TIGHT);
        assert!(matches!(found.ending, Ending::Infeasible | Ending::Stalled), "{found:?}");
        assert!((found.violation - 1.0).abs() < 1e-3, "{found:?}");
    }

    /// Pieces that the double integrator's unit of time is cut into.
    const PIECES: usize = 40;

    struct Integrator {
        h: f64,
        scales: Vec<f64>,
        bounds: Vec<[f64; 2]>,
        ranges: Vec<[f64; 2]>,
    }
    impl Integrator {
        fn rows(&self, x: &[f64], jacobian: &mut Triplets) -> Vec<f64> {
            let half = 0.5 * self.h;
            let mut values = Vec::new();
            for k in 0..PIECES {
                for (state, slope) in [(0, 1), (1, 2)] {
                    let [a, b] = [3 * k, 3 * k + 3];
                    let row = values.len();
                    let rise = half * (x[a + slope] + x[b + slope]);
                    values.push(x[b + state] - x[a + state] - rise);
                    jacobian.add(row, b + state, 1.0);
                    jacobian.add(row, a + state, -1.0);
                    jacobian.add(row, a + slope, -half);
                    jacobian.add(row, b + slope, -half);
                }
            }
            values
        }

        fn weight(&self, k: usize) -> f64 {
            if k == 0 || k == PIECES { 0.5 * self.h } else { self.h }
        }
    }
    impl Program for Integrator {
        fn scales(&self) -> &[f64] {
            &self.scales
        }

        fn bounds(&self) -> &[[f64; 2]] {
            &self.bounds
        }

        fn ranges(&self) -> &[[f64; 2]] {
            &self.ranges
        }

        fn evaluate(&mut self, x: &[f64], constraints: &mut Vec<f64>) -> f64 {
            *constraints = self.rows(x, &mut Triplets::default());
            (0..=PIECES).map(|k| self.weight(k) * x[3 * k + 2].powi(2)).sum()
        }

        fn linearise(&mut self, x: &[f64], _: &[f64], linear: &mut Linearisation) {
            linear.clear(x.len());
            self.rows(x, &mut linear.jacobian);
            for k in 0..=PIECES {
                linear.gradient[3 * k + 2] = 2.0 * self.weight(k) * x[3 * k + 2];
                linear.hessian.add(3 * k + 2, 3 * k + 2, 2.0 * self.weight(k));
            }
        }
    }

    /// The double integrator from rest to rest over unit time and distance, with least effort:
    /// u = 6 - 12 t, integral of u^2 = 12. Trapezoidal collocation, whose own optimum differs by
    /// the square of the step.
    #[test]
    fn least_effort_of_a_double_integrator_is_that_of_the_closed_form() {
        let h = 1.0 / PIECES as f64;
        let free = [-100.0, 100.0];
        let mut bounds = vec![free; 3 * (PIECES + 1)];
        for (index, value) in [(0, 0.0), (1, 0.0), (3 * PIECES, 1.0), (3 * PIECES + 1, 0.0)] {
            bounds[index] = [value, value];
        }
        let mut program = Integrator {
            h,
            scales: vec![10.0; bounds.len()],
            bounds,
            ranges: vec![[0.0; 2]; 2 * PIECES],
        };
        let found = minimise(&mut program, &vec![0.0; 3 * (PIECES + 1)], TIGHT);
        assert_eq!(found.ending, Ending::Converged);
        assert!((found.cost - 12.0).abs() < 12.0 * 5.0 * h * h, "{}", found.cost);
        for k in 1..PIECES {
            let exact = 6.0 - 12.0 * k as f64 * h;
            assert!((found.x[3 * k + 2] - exact).abs() < 0.05, "{k}: {}", found.x[3 * k + 2]);
        }
    }
}
