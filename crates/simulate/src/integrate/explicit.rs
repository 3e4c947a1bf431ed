//! The explicit methods.

use super::{Accuracy, Rates, Stepper};
use crate::breakdown::Breakdown;

/// Nodes of Dormand and Prince.
const NODES: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
/// Rows of their tableau; the last is the solution of order 5.
const TABLEAU: [[f64; 6]; 7] = [
    [0.0; 6],
    [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// Order 5 minus order 4.
const ERROR: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];
/// The fourth-order continuous extension (Hairer, Norsett, Wanner, II.6).
const DENSE: [f64; 7] = [
    -12715105075.0 / 11282082432.0,
    0.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];

impl Stepper {
    /// A step from `y0` to `y1`; returns the error over what is allowed.
    pub(super) fn dormand_prince(
        &mut self,
        system: &mut dyn Rates,
        step: f64,
        accuracy: Accuracy,
    ) -> Result<f64, Breakdown> {
        self.stages[0].copy_from_slice(&self.f0);
        for stage in 1..7 {
            for i in 0..self.trial.len() {
                let sum: f64 = (0..stage).map(|j| TABLEAU[stage][j] * self.stages[j][i]).sum();
                self.trial[i] = self.y0[i] + step * sum;
            }
            system.rates(self.t0 + NODES[stage] * step, &self.trial, &mut self.stages[stage])?;
        }
        self.statistics.evaluations += 6;
        self.y1.copy_from_slice(&self.trial);
        for i in 0..self.error.len() {
            self.error[i] = step * (0..7).map(|j| ERROR[j] * self.stages[j][i]).sum::<f64>();
        }
        Ok(self.weighted(accuracy))
    }

    pub(super) fn prepare_dense(&mut self, step: f64) {
        for i in 0..self.y0.len() {
            let rise = self.y1[i] - self.y0[i];
            let bend = step * self.stages[0][i] - rise;
            let sum: f64 = (0..7).map(|j| DENSE[j] * self.stages[j][i]).sum();
            self.dense[0][i] = self.y0[i];
            self.dense[1][i] = rise;
            self.dense[2][i] = bend;
            self.dense[3][i] = rise - step * self.stages[6][i] - bend;
            self.dense[4][i] = step * sum;
        }
    }

    pub(super) fn interpolate_dense(&self, s: f64, y: &mut [f64]) {
        let r = 1.0 - s;
        let [a, b, c, d, e] = &self.dense;
        for (i, entry) in y.iter_mut().enumerate() {
            *entry = a[i] + s * (b[i] + r * (c[i] + s * (d[i] + r * e[i])));
        }
    }

    /// The classical step of order 4 from `y0` to `y1`.
    pub(super) fn runge_kutta(
        &mut self,
        system: &mut dyn Rates,
        step: f64,
    ) -> Result<(), Breakdown> {
        self.stages[0].copy_from_slice(&self.f0);
        for (stage, part) in [(1, 0.5), (2, 0.5), (3, 1.0)] {
            for i in 0..self.trial.len() {
                self.trial[i] = self.y0[i] + part * step * self.stages[stage - 1][i];
            }
            system.rates(self.t0 + part * step, &self.trial, &mut self.stages[stage])?;
        }
        self.statistics.evaluations += 3;
        let [a, b, c, d] = [0, 1, 2, 3].map(|stage| &self.stages[stage]);
        for i in 0..self.y1.len() {
            let sum = a[i] + 2.0 * (b[i] + c[i]) + d[i];
            self.y1[i] = self.y0[i] + step / 6.0 * sum;
        }
        Ok(())
    }
}
