//! How well a motion excites: condition number and determinant of the stacked regressor, and their
//! derivatives by its entries.
//!
//! Of W = Q R with singular values s_1 >= .. >= s_p of R and right singular vectors v_i,
//!
//! > d ln(s_i) = <W v_i v_i^T / s_i^2, dW>,   d ln det(W^T W) = 2 <W (R^T R)^-1, dW>.
//!
//! W^T W is never formed: it would square the condition number of what begins at 1e8.

use crate::policy::objective::LARGEST_LOG;
use nalgebra::{DMatrix, DVector};

/// What is made small: a weighted sum of ln(condition number) and -ln det(W^T W / rows) / p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Objective {
    /// Weight of the condition number.
    pub condition: f64,
    /// Weight of the determinant: D-optimality.
    pub determinant: f64,
    /// The condition number is that of W with columns of length 1.
    pub is_scaled: bool,
}

impl Objective {
    /// The condition number alone.
    pub const CONDITION: Self = Self { condition: 1.0, determinant: 0.0, is_scaled: false };

    /// The determinant alone.
    pub const D_OPTIMAL: Self = Self { condition: 0.0, determinant: 1.0, is_scaled: false };

    /// Both, one e-fold of each worth the same.
    pub const BOTH: Self = Self { condition: 1.0, determinant: 1.0, is_scaled: false };
}

/// What is said of a stacked regressor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Excitation {
    /// Condition number of W, infinite where a column depends on others.
    pub condition: f64,
    /// Condition number of W with columns of length 1.
    pub condition_scaled: f64,
    /// ln det(W^T W / rows).
    pub log_determinant: f64,
}

/// W with what its derivatives need.
pub(super) struct Stacked {
    w: DMatrix<f64>,
    lengths: Vec<f64>,
    plain: Option<Spectrum>,
    scaled: Option<Spectrum>,
    r: DMatrix<f64>,
}

/// Singular values from the largest to the smallest, and right singular vectors as columns.
struct Spectrum {
    values: Vec<f64>,
    right: DMatrix<f64>,
}

impl Spectrum {
    fn new(r: DMatrix<f64>) -> Option<Self> {
        if r.iter().any(|entry| !entry.is_finite()) {
            return None;
        }
        let svd = r.try_svd(false, true, f64::EPSILON, 10_000)?;
        let right = svd.v_t?.transpose();
        let mut order: Vec<usize> = (0..svd.singular_values.len()).collect();
        order.sort_by(|&a, &b| svd.singular_values[b].total_cmp(&svd.singular_values[a]));
        let values = order.iter().map(|&at| svd.singular_values[at]).collect();
        let columns: Vec<DVector<f64>> =
            order.iter().map(|&at| right.column(at).into_owned()).collect();
        Some(Self { values, right: DMatrix::from_columns(&columns) })
    }

    fn condition(&self) -> f64 {
        match (self.values.first(), self.values.last()) {
            (Some(first), Some(last)) if *last > 0.0 => first / last,
            _ => f64::INFINITY,
        }
    }
}

impl Stacked {
    pub(super) fn new(w: DMatrix<f64>) -> Self {
        let lengths: Vec<f64> = w.column_iter().map(|column| column.norm()).collect();
        let r = if w.nrows() >= w.ncols() { w.clone().qr().r() } else { w.clone() };
        let mut of_scaled = r.clone();
        for (mut column, length) in of_scaled.column_iter_mut().zip(&lengths) {
            column /= length.max(f64::MIN_POSITIVE);
        }
        let (plain, scaled) = (Spectrum::new(r.clone()), Spectrum::new(of_scaled));
        Self { w, lengths, plain, scaled, r }
    }

    pub(super) fn excitation(&self) -> Excitation {
        let condition = |spectrum: &Option<Spectrum>| {
            spectrum.as_ref().map_or(f64::INFINITY, Spectrum::condition)
        };
        let rows = self.w.nrows().max(1) as f64;
        let logs = |s: &Spectrum| s.values.iter().map(|value| (value * value / rows).ln()).sum();
        Excitation {
            condition: condition(&self.plain),
            condition_scaled: condition(&self.scaled),
            log_determinant: self.plain.as_ref().map_or(f64::NEG_INFINITY, logs),
        }
    }

    /// The objective; finite also where a column depends on others, so that a solver can leave.
    pub(super) fn value(&self, objective: &Objective) -> f64 {
        let found = self.excitation();
        let condition = if objective.is_scaled { found.condition_scaled } else { found.condition };
        let columns = self.w.ncols().max(1) as f64;
        let mut value = 0.0;
        if objective.condition > 0.0 {
            value += objective.condition * condition.ln().min(LARGEST_LOG);
        }
        if objective.determinant > 0.0 {
            let mean = found.log_determinant / columns;
            value -= objective.determinant * mean.clamp(-LARGEST_LOG, LARGEST_LOG);
        }
        value
    }

    /// The derivative of the objective by each entry of W.
    pub(super) fn gradient(&self, objective: &Objective) -> DMatrix<f64> {
        let mut gradient = DMatrix::zeros(self.w.nrows(), self.w.ncols());
        if objective.condition > 0.0 {
            gradient += objective.condition
                * if objective.is_scaled { self.of_scaled() } else { self.of_plain() };
        }
        let inverse = self.r.clone().try_inverse().filter(|_| objective.determinant > 0.0);
        if let Some(inverse) = inverse {
            let columns = self.w.ncols().max(1) as f64;
            let factor = -2.0 * objective.determinant / columns;
            gradient += factor * (&self.w * (&inverse * inverse.transpose()));
        }
        match gradient.iter().all(|entry| entry.is_finite()) {
            true => gradient,
            false => DMatrix::zeros(self.w.nrows(), self.w.ncols()),
        }
    }

    fn of_plain(&self) -> DMatrix<f64> {
        self.plain.as_ref().map_or_else(
            || DMatrix::zeros(self.w.nrows(), self.w.ncols()),
            |spectrum| of_condition(&self.w, spectrum),
        )
    }

    /// Through W D^-1 with D the lengths of the columns, which depend on W.
    fn of_scaled(&self) -> DMatrix<f64> {
        let mut scaled = self.w.clone();
        for (mut column, length) in scaled.column_iter_mut().zip(&self.lengths) {
            column /= length.max(f64::MIN_POSITIVE);
        }
        let Some(spectrum) = &self.scaled else {
            return DMatrix::zeros(self.w.nrows(), self.w.ncols());
        };
        let mut gradient = of_condition(&scaled, spectrum);
        for (at, length) in self.lengths.iter().enumerate() {
            let along = scaled.column(at).dot(&gradient.column(at));
            let radial = scaled.column(at) * along;
            let turned = (gradient.column(at) - radial) / length.max(f64::MIN_POSITIVE);
            gradient.set_column(at, &turned);
        }
        gradient
    }
}

/// The derivative of ln(s_1 / s_p).
fn of_condition(w: &DMatrix<f64>, spectrum: &Spectrum) -> DMatrix<f64> {
    let last = spectrum.values.len().saturating_sub(1);
    let part = |at: usize| {
        let (value, v) = (spectrum.values[at], spectrum.right.column(at));
        (w * v / (value * value)) * v.transpose()
    };
    match spectrum.values.is_empty() {
        true => DMatrix::zeros(w.nrows(), w.ncols()),
        false => part(0) - part(last),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use denavit_numerics::Random;

    fn random(rows: usize, columns: usize, seed: u64) -> DMatrix<f64> {
        let mut random = Random::new(seed);
        DMatrix::from_fn(rows, columns, |_, column| random.normal() * 10f64.powi(column as i32))
    }

    #[test]
    fn numbers_are_those_of_a_matrix_with_known_singular_values() {
        let turn = |angle: f64| {
            DMatrix::from_row_slice(2, 2, &[angle.cos(), -angle.sin(), angle.sin(), angle.cos()])
        };
        let middle = DMatrix::from_row_slice(3, 2, &[5.0, 0.0, 0.0, 0.5, 0.0, 0.0]);
        let found = Stacked::new(middle * turn(0.4)).excitation();
        assert!((found.condition - 10.0).abs() < 1e-12);
        // det(W^T W / 3) = (25 / 3) (0.25 / 3)
        assert!((found.log_determinant - (25.0_f64 * 0.25 / 9.0).ln()).abs() < 1e-12);
        let orthogonal = DMatrix::from_row_slice(3, 2, &[3.0, 0.0, 0.0, 0.1, 0.0, 0.0]);
        let found = Stacked::new(orthogonal).excitation();
        assert!((found.condition - 30.0).abs() < 1e-12);
        assert!((found.condition_scaled - 1.0).abs() < 1e-12);
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let w = random(12, 4, 1);
        let scaled = Objective { is_scaled: true, ..Objective::CONDITION };
        for objective in [Objective::CONDITION, Objective::D_OPTIMAL, Objective::BOTH, scaled] {
            let gradient = Stacked::new(w.clone()).gradient(&objective);
            for (row, column) in [(0, 0), (3, 1), (7, 2), (11, 3)] {
                let step = 1e-6 * w.column(column).norm();
                let at = |step: f64| {
                    let mut moved = w.clone();
                    moved[(row, column)] += step;
                    Stacked::new(moved).value(&objective)
                };
                let difference = (at(step) - at(-step)) / (2.0 * step);
                let found = gradient[(row, column)];
                let scale = gradient.column(column).norm();
                assert!((found - difference).abs() < 1e-6 * scale, "{found} {difference}");
            }
        }
    }

    #[test]
    fn a_column_that_depends_on_others_is_infinitely_bad_and_still_a_number() {
        let mut w = random(8, 3, 2);
        let sum = w.column(0) + w.column(1);
        w.set_column(2, &sum);
        let stacked = Stacked::new(w);
        assert!(stacked.excitation().condition > 1e14);
        assert!(stacked.value(&Objective::BOTH).is_finite());
        assert!(stacked.gradient(&Objective::BOTH).iter().all(|entry| entry.is_finite()));
        let zero = Stacked::new(DMatrix::zeros(5, 2));
        assert!(zero.value(&Objective::CONDITION) >= 50.0);
    }
}
