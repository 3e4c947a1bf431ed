//! The quadratic subproblem of a step: a linearisation within a trust region, with elastic
//! constraints, so that it always has a solution.
//!
//! minimise g^T d + d^T H d / 2 + nu sum(s) subject to l - s <= c + J d <= u + s, s >= 0, and to a
//! box for d; solved by the interior-point method of `clarabel`, single-threaded, so that the same
//! input gives the same bytes.

use super::program::Linearisation;
use super::sparse::Triplets;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, SupportedConeT,
    ZeroConeT,
};

/// A subproblem; variables are those of the program over their scales.
pub(super) struct Subproblem<'a> {
    pub(super) linear: &'a Linearisation,
    /// Constraint values that are linearised about.
    pub(super) values: &'a [f64],
    pub(super) ranges: &'a [[f64; 2]],
    pub(super) scales: &'a [f64],
    /// Lowest and highest step, of the variables as they are.
    pub(super) steps: &'a [[f64; 2]],
    /// Weight of a constraint's violation.
    pub(super) penalty: f64,
}

/// A step.
#[derive(Clone, Debug)]
pub(super) struct Step {
    /// Change of the variables.
    pub(super) change: Vec<f64>,
    /// One multiplier a constraint: derivative of the optimal value by the constraint's value.
    pub(super) multipliers: Vec<f64>,
}

/// Rows of `clarabel`'s constraint matrix: A x + s = b with s in a cone.
#[derive(Default)]
struct Rows {
    matrix: Triplets,
    right: Vec<f64>,
}

impl Rows {
    fn push(&mut self, right: f64) -> usize {
        self.right.push(right);
        self.right.len() - 1
    }
}

impl Subproblem<'_> {
    /// The step that minimises the subproblem; none if the solver fails.
    pub(super) fn solve(&self) -> Option<Step> {
        let n = self.scales.len();
        let (mut rows, mut slacks) = (Rows::default(), n);
        // row of the matrix and sign, for each constraint: at most one of equality, lower, upper
        let mut places: Vec<[Option<(usize, f64)>; 2]> = vec![[None; 2]; self.ranges.len()];
        for (index, [low, high]) in self.ranges.iter().enumerate() {
            if low == high {
                let row = rows.push(low - self.values[index]);
                rows.matrix.add(row, slacks, -1.0);
                rows.matrix.add(row, slacks + 1, 1.0);
                slacks += 2;
                places[index][0] = Some((row, 1.0));
            }
        }
        let equalities = rows.right.len();
        for (index, [low, high]) in self.ranges.iter().enumerate() {
            if low == high {
                continue;
            }
            let sides = [(*high - self.values[index], 1.0), (self.values[index] - *low, -1.0)];
            for (place, (right, sign)) in places[index].iter_mut().zip(sides) {
                if right.is_finite() {
                    let row = rows.push(right);
                    rows.matrix.add(row, slacks, -1.0);
                    slacks += 1;
                    *place = Some((row, sign));
                }
            }
        }
        for &(index, column, value) in &self.linear.jacobian.entries {
            for (row, sign) in places[index].iter().flatten() {
                rows.matrix.add(*row, column, sign * value * self.scales[column]);
            }
        }
        self.bound(&mut rows, n, slacks);
        self.run(rows, equalities, slacks, &places)
    }

    /// Bounds of the step, and slacks that are not negative.
    fn bound(&self, rows: &mut Rows, n: usize, slacks: usize) {
        for (column, [low, high]) in self.steps.iter().enumerate() {
            for (right, sign) in [(*high, 1.0), (-*low, -1.0)] {
                if right.is_finite() {
                    let row = rows.push(right / self.scales[column]);
                    rows.matrix.add(row, column, sign);
                }
            }
        }
        for column in n..slacks {
            let row = rows.push(0.0);
            rows.matrix.add(row, column, -1.0);
        }
    }

    fn run(
        &self,
        rows: Rows,
        equalities: usize,
        slacks: usize,
        places: &[[Option<(usize, f64)>; 2]],
    ) -> Option<Step> {
        let n = self.scales.len();
        let mut curvature = Triplets::default();
        for &(row, column, value) in &self.linear.hessian.entries {
            curvature.add(row, column, value * self.scales[row] * self.scales[column]);
        }
        let gradient = self.linear.gradient.iter().zip(self.scales).map(|(g, scale)| g * scale);
        let mut linear: Vec<f64> = gradient.collect();
        linear.resize(slacks, self.penalty);
        let count = rows.right.len();
        let cones: [SupportedConeT<f64>; 2] =
            [ZeroConeT(equalities), NonnegativeConeT(count - equalities)];
        let settings = DefaultSettings {
            verbose: false,
            max_threads: 1,
            direct_solve_method: "qdldl".to_owned(),
            ..DefaultSettings::default()
        };
        let mut solver = DefaultSolver::new(
            &curvature.compressed(slacks, slacks),
            &linear,
            &rows.matrix.compressed(count, slacks),
            &rows.right,
            &cones,
            settings,
        )
        .ok()?;
        solver.solve();
        let solution = &solver.solution;
        let solved =
            [SolverStatus::Solved, SolverStatus::AlmostSolved, SolverStatus::InsufficientProgress];
        if !solved.contains(&solution.status) || solution.x.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let change = solution.x[..n].iter().zip(self.scales).map(|(x, scale)| x * scale);
        let clamped = change.zip(self.steps).map(|(x, [low, high])| x.clamp(*low, *high));
        // clarabel's duals z belong to A x + s = b: those of c are z on upper sides, -z on lower
        let multiplier = |place: &[Option<(usize, f64)>; 2]| {
            place.iter().flatten().map(|(row, sign)| sign * solution.z[*row]).sum()
        };
        Some(Step {
            change: clamped.collect(),
            multipliers: places.iter().map(multiplier).collect(),
        })
    }
}
