//! Forces for the right side of the equations of motion, where their distribution matters little
//! and their price much.

use super::{ModeSolver, Unknown};
use crate::simulate::contact::cholesky::dot;
use crate::simulate::contact::{ContactFailure, ContactProblem, Mode};
use nalgebra::{DMatrix, DVector};

/// Compliance that makes redundant contacts regular, relative to the mean of the diagonal.
const COMPLIANCE: f64 = 1e-9;
/// Refinements at most: each reduces what is missed by the compliance over an eigenvalue.
const REFINEMENTS: usize = 5;
impl ModeSolver {
    /// As `forces`, for the motion alone: the forces of redundant contacts that all stick may be
    /// any, since they move nothing.
    ///
    /// A small compliance makes the system regular, refinement takes out what it gives way.
    pub fn moving_forces(
        &mut self,
        problem: &ContactProblem<'_>,
        modes: &[Mode],
        force: &mut [f64],
    ) -> Result<(), ContactFailure> {
        self.list_unknowns(problem, modes);
        self.write_system(problem);
        let size = self.unknowns.len();
        let trace: f64 = (0..size).map(|i| self.matrix[i * size + i].abs()).sum();
        let mut compliant = DMatrix::from_row_slice(size, size, &self.matrix);
        for i in 0..size {
            compliant[(i, i)] += COMPLIANCE * trace / size as f64;
        }
        let factors = compliant.lu();
        self.values.clear();
        self.values.resize(size, 0.0);
        let mut missing = DVector::from_column_slice(&self.right);
        let mut missed = f64::INFINITY;
        for _ in 0..REFINEMENTS {
            if !factors.solve_mut(&mut missing) {
                break;
            }
            for (value, correction) in self.values.iter_mut().zip(missing.iter()) {
                *value += correction;
            }
            for (i, line) in self.matrix.chunks_exact(size).enumerate() {
                missing[i] = self.right[i] - dot(line, &self.values);
            }
            missed = missing.amax();
            if missed <= 1e-2 * problem.response_zero() {
                break;
            }
        }
        let rows = problem.space.rows();
        let pulls =
            |(unknown, value): (&Unknown, &f64)| unknown.row % rows == rows - 1 && *value < 0.0;
        let slips = self.unknowns.iter().any(|unknown| unknown.tangents > 0);
        let shared = slips && self.unknowns.iter().zip(&self.values).any(pulls);
        if shared || missed.is_nan() || missed > problem.response_zero() {
            self.solve(problem, modes)?;
            if slips && self.system.nullity() > 0 {
                self.push_only(problem, modes);
            }
        }
        self.expand(force);
        Ok(())
    }

    /// Shares the forces so that none pulls. Cones of what sticks are not looked at: they say when
    /// the motion ends, not what it is.
    fn push_only(&mut self, problem: &ContactProblem<'_>, modes: &[Mode]) {
        self.least.clear();
        self.least.extend_from_slice(&self.values);
        self.list_planes(problem, modes);
        self.planes.retain(|plane| plane.tangents == 0);
        self.measure_planes();
        self.least_admissible();
    }
}
