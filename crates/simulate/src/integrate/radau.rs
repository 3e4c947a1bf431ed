//! The implicit method: three stages at once on the nodes of Radau, of order 5, L-stable (Hairer
//! and Wanner, Solving Ordinary Differential Equations II, IV.5 and IV.8).
//!
//! With z_i the way of stage i from the start, A^-1 z = h f(y0 + z). The eigenvectors of A^-1 take
//! Newton's method for all stages apart into one real and one complex system of the size of y.

use super::newton::{Factored, Jacobian};
use super::{Accuracy, Rates, Stepper};
use crate::breakdown::Breakdown;
use nalgebra::Complex;

/// (4 -+ sqrt 6)/10 and 1.
const NODES: [f64; 3] = [0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0];
/// The eigenvalues of A^-1: a real one, and one of a conjugate pair.
const REAL: f64 = 3.637_834_252_744_496;
const COMPLEX: Complex<f64> = Complex::new(2.681_082_873_627_752_3, -3.050_430_199_247_411);
/// From eigenvectors to stages, and back.
const TO_STAGES: [[f64; 3]; 3] = [
    [0.094_438_762_488_975_24, -0.141_255_295_020_954_2, 0.030_029_194_105_147_42],
    [0.250_213_122_965_333_3, 0.204_129_352_293_799_94, -0.382_942_112_757_261_9],
    [1.0, 1.0, 0.0],
];
const FROM_STAGES: [[f64; 3]; 3] = [
    [4.178_718_591_551_904, 0.327_682_820_761_062_37, 0.523_376_445_499_449_5],
    [-4.178_718_591_551_904, -0.327_682_820_761_062_37, 0.476_623_554_500_550_44],
    [0.502_872_634_945_786_8, -2.571_926_949_855_605, 0.596_039_204_828_224_9],
];
/// The error of an embedded formula of order 3, in z; with h f(y0).
const ERROR: [f64; 3] = [-10.048_809_399_827_414, 1.382_142_733_160_748, -1.0 / 3.0];
/// Newton's iteration ends below this part of the allowed error.
const NEWTON: f64 = 0.01;
const MAX_ITERATIONS: usize = 8;
/// Iterations that reduce the error by less than this call for a new Jacobian.
const SLOW: f64 = 0.15;

/// What is kept from step to step.
#[derive(Clone, Debug, Default)]
pub(super) struct Implicit {
    jacobian: Option<Jacobian>,
    /// Whether the Jacobian is that of the start of the step: a shorter one has no better.
    fresh: bool,
    factored: Option<(f64, Factored<f64>, Factored<Complex<f64>>)>,
    /// Ways of the stages, and the same in eigenvectors.
    z: [Vec<f64>; 3],
    w: [Vec<f64>; 3],
    /// Length and ways of the last accepted step, which foretell those of the next.
    last: Option<(f64, [Vec<f64>; 3])>,
    real: Vec<f64>,
    complex: Vec<Complex<f64>>,
}

impl Implicit {
    /// The rates have jumped: nothing holds any more.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    /// The step that was just made has been accepted.
    pub(super) fn accept(&mut self, step: f64) {
        self.fresh = false;
        let (_, ways) = self.last.get_or_insert_with(Default::default);
        for (kept, way) in ways.iter_mut().zip(&self.z) {
            kept.clone_from(way);
        }
        if let Some((length, _)) = &mut self.last {
            *length = step;
        }
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
        loop {
            self.factor(system, step)?;
            if let Some(slowest) = self.solve_stages(system, step, accuracy)? {
                let error = self.implicit_error(system, step, accuracy)?;
                if slowest > SLOW && !self.implicit.fresh {
                    self.implicit.jacobian = None;
                    self.implicit.factored = None;
                }
                return Ok(error);
            }
            if self.implicit.fresh {
                return Ok(None);
            }
            self.implicit.jacobian = None;
            self.implicit.factored = None;
        }
    }

    fn factor(&mut self, system: &mut dyn Rates, step: f64) -> Result<(), Breakdown> {
        let implicit = &mut self.implicit;
        if implicit.jacobian.is_none() {
            let jacobian = Jacobian::by_differences(system, self.t0, &self.y0, &self.f0)?;
            self.statistics.evaluations += jacobian.evaluations();
            self.statistics.jacobians += 1;
            implicit.jacobian = Some(jacobian);
            implicit.fresh = true;
            implicit.factored = None;
        }
        let stale = implicit.factored.as_ref().is_none_or(|(of, ..)| *of != step);
        if let (true, Some(jacobian)) = (stale, &implicit.jacobian) {
            let real = Factored::new(jacobian, REAL / step);
            let complex = Factored::new(jacobian, COMPLEX / step);
            implicit.factored = Some((step, real, complex));
        }
        Ok(())
    }

    /// All stages by Newton's method, into `stages` their rates; returns the slowest reduction of
    /// its error, none without convergence.
    fn solve_stages(
        &mut self,
        system: &mut dyn Rates,
        step: f64,
        accuracy: Accuracy,
    ) -> Result<Option<f64>, Breakdown> {
        self.foretell(step);
        let n = self.y0.len();
        let (mut last, mut slowest) = (f64::INFINITY, 0.0_f64);
        for iteration in 0..MAX_ITERATIONS {
            for stage in 0..3 {
                for i in 0..n {
                    self.trial[i] = self.y0[i] + self.implicit.z[stage][i];
                }
                let time = self.t0 + NODES[stage] * step;
                system.rates(time, &self.trial, &mut self.stages[stage])?;
            }
            self.statistics.evaluations += 3;
            let Some(size) = self.correct_stages(step, accuracy) else { return Ok(None) };
            if iteration > 0 {
                let reduction = size / last;
                slowest = slowest.max(reduction);
                if reduction >= 1.0 && size > NEWTON {
                    return Ok(None);
                }
                // what the iterations still to come would leave
                if size * reduction <= NEWTON * (1.0 - reduction) {
                    return Ok(Some(slowest));
                }
            }
            if size <= 0.1 * NEWTON {
                return Ok(Some(slowest));
            }
            if !size.is_finite() {
                return Ok(None);
            }
            last = size;
        }
        Ok(None)
    }

    /// One correction of all stages; returns its size over what is allowed.
    fn correct_stages(&mut self, step: f64, accuracy: Accuracy) -> Option<f64> {
        let n = self.y0.len();
        let Implicit { jacobian, factored, z, w, real, complex, .. } = &mut self.implicit;
        let (_, of_real, of_complex) = factored.as_mut()?;
        let jacobian = jacobian.as_ref()?;
        real.clear();
        complex.clear();
        let shifts = (REAL / step, COMPLEX / step);
        for i in 0..n {
            let f = [0, 1, 2].map(|stage| self.stages[stage][i]);
            let [a, b, c] = FROM_STAGES.map(|row| row[0] * f[0] + row[1] * f[1] + row[2] * f[2]);
            real.push(a - shifts.0 * w[0][i]);
            complex.push(Complex::new(b, c) - shifts.1 * Complex::new(w[1][i], w[2][i]));
        }
        if !of_real.solve(jacobian, real) || !of_complex.solve(jacobian, complex) {
            return None;
        }
        let mut sum = 0.0;
        for i in 0..n {
            let change = [real[i], complex[i].re, complex[i].im];
            let allowed = accuracy.absolute + accuracy.relative * self.y0[i].abs();
            for (entry, change) in w.iter_mut().zip(change) {
                entry[i] += change;
            }
            for (stage, row) in TO_STAGES.iter().enumerate() {
                let change: f64 = row.iter().zip(change).map(|(t, change)| t * change).sum();
                z[stage][i] += change;
                sum += (change / allowed).powi(2);
            }
        }
        Some((sum / (3 * n) as f64).sqrt())
    }

    /// Where the polynomial of the last step leads, or, if that step is made again, where it was.
    fn foretell(&mut self, step: f64) {
        let n = self.y0.len();
        let again = self.t1 > self.t0;
        let Implicit { z, w, last, .. } = &mut self.implicit;
        for ways in [&mut *z, &mut *w] {
            ways.iter_mut().for_each(|way| way.resize(n, 0.0));
        }
        match last {
            None => z.iter_mut().for_each(|way| way.fill(0.0)),
            Some((length, ways)) => {
                for (stage, way) in z.iter_mut().enumerate() {
                    let start = if again { 0.0 } else { 1.0 };
                    let shares = through_stages(start + NODES[stage] * step / *length);
                    for i in 0..n {
                        let reached: f64 = (0..3).map(|j| shares[j] * ways[j][i]).sum();
                        way[i] = reached - start * ways[2][i];
                    }
                }
            }
        }
        for (row, way) in FROM_STAGES.iter().zip(w.iter_mut()) {
            for i in 0..n {
                way[i] = row[0] * z[0][i] + row[1] * z[1][i] + row[2] * z[2][i];
            }
        }
    }

    /// The error over what is allowed; the end of the step.
    fn implicit_error(
        &mut self,
        system: &mut dyn Rates,
        step: f64,
        accuracy: Accuracy,
    ) -> Result<Option<f64>, Breakdown> {
        let n = self.y0.len();
        for i in 0..n {
            self.y1[i] = self.y0[i] + self.implicit.z[2][i];
        }
        let mut error = self.filtered_error(step, accuracy, None);
        if error.is_some_and(|error| error > 1.0) {
            // once more from where it leads: stiff entries are overestimated
            for i in 0..n {
                self.trial[i] = self.y0[i] + self.error[i];
            }
            let mut rates = std::mem::take(&mut self.stages[3]);
            let moved = system.rates(self.t0, &self.trial, &mut rates);
            self.statistics.evaluations += 1;
            if moved.is_ok() {
                error = self.filtered_error(step, accuracy, Some(&rates));
            }
            self.stages[3] = rates;
        }
        Ok(error)
    }

    fn filtered_error(
        &mut self,
        step: f64,
        accuracy: Accuracy,
        rates: Option<&[f64]>,
    ) -> Option<f64> {
        let Implicit { jacobian, factored, z, .. } = &mut self.implicit;
        let (_, of_real, _) = factored.as_mut()?;
        let rates = rates.unwrap_or(&self.f0);
        for (i, entry) in self.error.iter_mut().enumerate() {
            let way = ERROR[0] * z[0][i] + ERROR[1] * z[1][i] + ERROR[2] * z[2][i];
            *entry = rates[i] + way / step;
        }
        if !of_real.solve(jacobian.as_ref()?, &mut self.error) {
            return None;
        }
        Some(self.weighted(allowed(accuracy)))
    }
}

/// What the embedded formula may be off by for steps to be as accurate as asked for. It is of order
/// 3, the step itself of order 5: where the former is off by e, the latter is by about e^(3/2). The
/// factor is that of Hairer's and Wanner's own code.
fn allowed(accuracy: Accuracy) -> Accuracy {
    let factor = (0.1 * accuracy.relative.powf(-1.0 / 3.0)).max(1.0);
    let [relative, absolute] = [accuracy.relative, accuracy.absolute].map(|part| factor * part);
    Accuracy { relative, absolute, ..accuracy }
}

/// What the ways of the stages contribute at a part of the step: Lagrange's polynomials on 0 and
/// the nodes.
fn through_stages(part: f64) -> [f64; 3] {
    std::array::from_fn(|j| {
        let others = (0..3).filter(|k| *k != j);
        let product: f64 = others.map(|k| (part - NODES[k]) / (NODES[j] - NODES[k])).product();
        product * part / NODES[j]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Collocation on the nodes: a_ij = integral of the j-th Lagrange polynomial from 0 to c_i.
    #[test]
    fn the_eigenvectors_are_those_of_the_method() {
        let a: [[f64; 3]; 3] = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let [k, l] = [[1, 2], [0, 2], [0, 1]][j].map(|other: usize| NODES[other]);
                let (c, scale) = (NODES[i], (NODES[j] - k) * (NODES[j] - l));
                (c.powi(3) / 3.0 - (k + l) * c * c / 2.0 + k * l * c) / scale
            })
        });
        let times = |x: &[[f64; 3]; 3], y: &[[f64; 3]; 3]| -> [[f64; 3]; 3] {
            std::array::from_fn(|i| {
                std::array::from_fn(|j| (0..3).map(|k| x[i][k] * y[k][j]).sum())
            })
        };
        let (alpha, beta) = (COMPLEX.re, COMPLEX.im);
        let blocks = [[REAL, 0.0, 0.0], [0.0, alpha, -beta], [0.0, beta, alpha]];
        let inverse = times(&times(&TO_STAGES, &blocks), &FROM_STAGES);
        let one = times(&inverse, &a);
        for i in 0..3 {
            for j in 0..3 {
                let expected = f64::from(u8::from(i == j));
                assert!((one[i][j] - expected).abs() < 1e-14, "{one:?}");
            }
        }
    }
}
