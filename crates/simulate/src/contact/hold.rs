//! The guess that every contact sticks: what standing robots do in nearly every step.
//!
//! Sticking means w = 0, one linear system; redundant contacts make it singular, so that a small
//! multiple of the unit matrix is added, which chooses nearly the least forces, and the error of
//! that is taken out again by refinement. The guess holds if all forces lie in their cones.

use super::cholesky::{backward, dot, factorise, forward};
use super::{ContactProblem, length};

/// What is added to the diagonal, relative to its mean.
const REGULARISATION: f64 = 1e-9;
/// Refinements at most: each reduces the error by the regularisation over the smallest eigenvalue.
const REFINEMENTS: usize = 4;

/// Memory of the guess; grows to the largest problem and stays.
#[derive(Clone, Debug, Default)]
pub struct Hold {
    factor: Vec<f64>,
    correction: Vec<f64>,
    guess: Vec<f64>,
}

impl Hold {
    /// No memory yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// If forces within the friction cones hold all contacts up to `response`, writes them into
    /// `force` and says so; leaves `force` as it is otherwise.
    pub fn solve(
        &mut self,
        problem: &ContactProblem<'_>,
        response: f64,
        force: &mut [f64],
    ) -> bool {
        if problem.contacts.iter().any(|contact| contact.released) || !self.factorise(problem) {
            return false;
        }
        let rows = problem.rows();
        self.guess.clear();
        self.guess.resize(rows, 0.0);
        for _ in 0..=REFINEMENTS {
            self.correction.clear();
            for (i, free) in problem.free.iter().enumerate() {
                let line = &problem.delassus[i * rows..(i + 1) * rows];
                self.correction.push(-free - dot(line, &self.guess));
            }
            if self.correction.iter().all(|missing| missing.abs() <= response) {
                return self.accept(problem, force);
            }
            forward(&self.factor, &mut self.correction);
            backward(&self.factor, &mut self.correction);
            for (entry, correction) in self.guess.iter_mut().zip(&self.correction) {
                *entry += correction;
            }
        }
        false
    }

    /// Factors G + eps.
    fn factorise(&mut self, problem: &ContactProblem<'_>) -> bool {
        let n = problem.rows();
        self.factor.clear();
        self.factor.extend_from_slice(problem.delassus);
        let trace: f64 = (0..n).map(|i| problem.delassus[i * n + i]).sum();
        let added = REGULARISATION * trace / n as f64;
        for i in 0..n {
            self.factor[i * n + i] += added;
        }
        factorise(&mut self.factor, n).is_ok()
    }

    fn accept(&self, problem: &ContactProblem<'_>, force: &mut [f64]) -> bool {
        let tangents = problem.space.tangents();
        let within = problem.contacts.iter().enumerate().all(|(index, contact)| {
            let f = &self.guess[problem.block(index)];
            let normal = f[tangents];
            let limit = contact.coefficient().map_or(f64::INFINITY, |mu| mu * normal);
            normal >= 0.0 && length(&f[..tangents]) <= limit
        });
        if within {
            force.copy_from_slice(&self.guess);
        }
        within
    }
}
