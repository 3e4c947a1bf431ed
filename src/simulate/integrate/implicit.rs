//! The implicit method: five stages with one matrix 1 - h g J, g = 1/4.

use super::{Accuracy, Rates, Stepper};
use crate::simulate::breakdown::Breakdown;
use nalgebra::{DMatrix, DVector, Dyn, LU};

const DIAGONAL: f64 = 0.25;
const NODES: [f64; 5] = [0.25, 0.75, 0.55, 0.5, 1.0];
/// Rows below the diagonal; the last is the solution.
const TABLEAU: [[f64; 4]; 5] = [
    [0.0; 4],
    [0.5, 0.0, 0.0, 0.0],
    [17.0 / 50.0, -1.0 / 25.0, 0.0, 0.0],
    [371.0 / 1360.0, -137.0 / 2720.0, 15.0 / 544.0, 0.0],
    [25.0 / 24.0, -49.0 / 48.0, 125.0 / 16.0, -85.0 / 12.0],
];
/// Order 4 minus order 3.
const ERROR: [f64; 5] = [-3.0 / 16.0, -27.0 / 32.0, 25.0 / 32.0, 0.0, 0.25];
/// Newton's iteration ends below this part of the allowed error.
const NEWTON: f64 = 0.01;
const MAX_ITERATIONS: usize = 10;

/// The Jacobian and the factored matrix of the last step.
#[derive(Clone, Debug, Default)]
pub(super) struct Implicit {
    jacobian: Option<DMatrix<f64>>,
    /// Whether the Jacobian is that of the start of the step.
    fresh: bool,
    factored: Option<(f64, LU<f64, Dyn, Dyn>)>,
    correction: Option<DVector<f64>>,
}

impl Implicit {
    /// The rates have jumped: nothing holds any more.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }
}

impl Stepper {
    /// A step from `y0` to `y1`; returns the error over what is allowed, none without convergence.
    pub(super) fn implicit_step(
        &mut self,
        system: &mut dyn Rates,
        step: f64,
        accuracy: Accuracy,
    ) -> Result<Option<f64>, Breakdown> {
        self.implicit.fresh = false;
        loop {
            self.factor(system, step)?;
            if self.solve_stages(system, step, accuracy)? {
                break;
            }
            if self.implicit.fresh {
                return Ok(None);
            }
            self.implicit.jacobian = None;
            self.implicit.factored = None;
        }
        for i in 0..self.error.len() {
            self.error[i] = step * (0..5).map(|j| ERROR[j] * self.stages[j][i]).sum::<f64>();
        }
        // through the matrix, which takes out what a stiff error estimate exaggerates
        let mut filtered = DVector::from_column_slice(&self.error);
        self.solve_linear(&mut filtered);
        self.error.copy_from_slice(filtered.as_slice());
        self.f1.copy_from_slice(&self.stages[4]);
        Ok(Some(self.weighted(accuracy)))
    }

    fn factor(&mut self, system: &mut dyn Rates, step: f64) -> Result<(), Breakdown> {
        if self.implicit.jacobian.is_none() {
            self.implicit.jacobian = Some(self.difference_jacobian(system)?);
            self.implicit.fresh = true;
            self.implicit.factored = None;
        }
        let stale = self.implicit.factored.as_ref().is_none_or(|(of, _)| *of != step);
        if let (true, Some(jacobian)) = (stale, &self.implicit.jacobian) {
            let n = self.y0.len();
            let matrix = DMatrix::identity(n, n) - jacobian * (step * DIAGONAL);
            self.implicit.factored = Some((step, matrix.lu()));
        }
        Ok(())
    }

    fn solve_linear(&self, right: &mut DVector<f64>) -> bool {
        self.implicit.factored.as_ref().is_some_and(|(_, lu)| lu.solve_mut(right))
    }

    /// All stages by Newton's method; false without convergence.
    fn solve_stages(
        &mut self,
        system: &mut dyn Rates,
        step: f64,
        accuracy: Accuracy,
    ) -> Result<bool, Breakdown> {
        let n = self.y0.len();
        let mut known = vec![0.0; n];
        let mut rates = vec![0.0; n];
        let mut correction = self.implicit.correction.take().unwrap_or_else(|| DVector::zeros(n));
        for stage in 0..5 {
            for i in 0..n {
                let sum: f64 = (0..stage).map(|j| TABLEAU[stage][j] * self.stages[j][i]).sum();
                known[i] = self.y0[i] + step * sum;
                let guess = if stage == 0 { self.f0[i] } else { self.stages[stage - 1][i] };
                self.trial[i] = known[i] + step * DIAGONAL * guess;
            }
            let mut last = f64::INFINITY;
            let mut converged = false;
            for _ in 0..MAX_ITERATIONS {
                system.rates(self.t0 + NODES[stage] * step, &self.trial, &mut rates)?;
                self.statistics.evaluations += 1;
                for i in 0..n {
                    correction[i] = known[i] + step * DIAGONAL * rates[i] - self.trial[i];
                }
                if !self.solve_linear(&mut correction) {
                    return Ok(false);
                }
                for (entry, change) in self.trial.iter_mut().zip(&correction) {
                    *entry += change;
                }
                self.error.copy_from_slice(correction.as_slice());
                self.y1.copy_from_slice(&self.trial);
                let size = self.weighted(accuracy);
                converged = size <= NEWTON;
                if converged || !size.is_finite() || size > 2.0 * last {
                    break;
                }
                last = size;
            }
            if !converged {
                self.implicit.correction = Some(correction);
                return Ok(false);
            }
            for i in 0..n {
                self.stages[stage][i] = (self.trial[i] - known[i]) / (step * DIAGONAL);
            }
        }
        self.implicit.correction = Some(correction);
        Ok(true)
    }

    /// df/dy at the start of the step, by differences; integrals have no column.
    fn difference_jacobian(&mut self, system: &mut dyn Rates) -> Result<DMatrix<f64>, Breakdown> {
        let n = self.y0.len();
        let mut jacobian = DMatrix::zeros(n, n);
        let mut moved = self.y0.clone();
        for column in 0..n - system.integrals() {
            let change = 1e-7 * self.y0[column].abs().max(1e-2);
            moved[column] += change;
            system.rates(self.t0, &moved, &mut self.trial)?;
            moved[column] = self.y0[column];
            for row in 0..n {
                jacobian[(row, column)] = (self.trial[row] - self.f0[row]) / change;
            }
        }
        self.statistics.evaluations += n - system.integrals();
        self.statistics.jacobians += 1;
        Ok(jacobian)
    }
}
