//! What is known of the standard parameters theta0, from any source, as linear equations with
//! errors: A theta0 = b + e, each row divided by the standard deviation of its error.
//!
//! Weighings, gravity torques of held postures, a dynamic estimate of base parameters with its
//! covariance, values that a drawing gives with an uncertainty: all are rows, and joining them is
//! putting them below each other. Least squares in all rows at once is then the same as carrying
//! one result into the other as a prior (ridge towards given values with their uncertainty), and
//! does not ask which came first.
//!
//! Rows rarely determine every parameter. Which combinations of parameters follow is read off the
//! row space; a parameter follows by itself if its unit vector is in it.

use crate::policy::knowledge::{RANK_TOLERANCE, ROUNDING};
use denavit_plants::regression::RegressionModel;
use nalgebra::{DMatrix, DVector};

/// Equations of standard parameters, each of unit error.
#[derive(Clone, Debug, PartialEq)]
pub struct Knowledge {
    rows: DMatrix<f64>,
    values: DVector<f64>,
}

/// A parameter, or a combination of parameters, that follows.
#[derive(Clone, Debug, PartialEq)]
pub struct Determined {
    /// Parameters by their place, with factors; the first factor is 1.
    pub members: Vec<(usize, f64)>,
    /// Its value.
    pub value: f64,
    /// Standard deviation of the value.
    pub std: f64,
}

/// What follows from knowledge.
#[derive(Clone, Debug, PartialEq)]
pub struct Consequences {
    /// For each standard parameter its value and standard deviation, if it follows by itself.
    pub parameters: Vec<Option<(f64, f64)>>,
    /// As many combinations as are independent, each with a parameter that no other has.
    pub combinations: Vec<Determined>,
    /// Sum of squares of what the equations miss, in standard deviations.
    pub chi_squared: f64,
    /// Equations beyond those that determine something.
    pub degrees_of_freedom: usize,
}

impl Consequences {
    /// Whether the equations miss each other by more than chance does in one of three million
    /// cases: five deviations of the cube root of chi squared, which is nearly normal (Wilson and
    /// Hilferty 1931).
    pub fn contradicts(&self) -> bool {
        if self.degrees_of_freedom == 0 {
            return false;
        }
        let degrees = self.degrees_of_freedom as f64;
        let spread = 2.0 / (9.0 * degrees);
        self.chi_squared > degrees * (1.0 - spread + 5.0 * spread.sqrt()).powi(3)
    }
}

impl Knowledge {
    /// Nothing, of so many parameters.
    pub fn none(parameters: usize) -> Self {
        Self { rows: DMatrix::zeros(0, parameters), values: DVector::zeros(0) }
    }

    /// Number of parameters.
    pub fn parameters(&self) -> usize {
        self.rows.ncols()
    }

    /// Number of equations.
    pub fn equations(&self) -> usize {
        self.rows.nrows()
    }

    /// Adds the equation that a combination of parameters has a value, with a positive standard
    /// deviation.
    ///
    /// # Panics
    /// If a parameter is none of those that this is about, or the deviation not positive.
    pub fn add(&mut self, members: &[(usize, f64)], value: f64, std: f64) {
        assert!(std > 0.0, "an equation without error cannot be weighed against others");
        let at = self.rows.nrows();
        self.rows.resize_vertically_mut(at + 1, 0.0);
        for &(parameter, factor) in members {
            self.rows[(at, parameter)] += factor / std;
        }
        self.values.resize_vertically_mut(at + 1, value / std);
    }

    /// Adds base parameters on the joint axes that were estimated, with their covariance.
    /// Directions without information (an infinite variance) may be left out by giving the
    /// square root R of the information instead: see [`Knowledge::add_information`].
    pub fn add_estimate(
        &mut self,
        model: &RegressionModel,
        phi: &[f64],
        covariance: &DMatrix<f64>,
    ) -> bool {
        // C = L L^T: L^-1 (phi - estimate) has unit covariance
        let Some(factor) = covariance.clone().cholesky() else { return false };
        let identity = DMatrix::identity(phi.len(), phi.len());
        let Some(root) = factor.l().solve_lower_triangular(&identity) else { return false };
        self.add_information(model, phi, &root);
        true
    }

    /// Adds what a regression knows: R of W = Q R with rows of unit noise, at its estimate.
    ///
    /// # Panics
    /// If `phi` or `root` are not of the model.
    pub fn add_information(&mut self, model: &RegressionModel, phi: &[f64], root: &DMatrix<f64>) {
        let members = model.of_standard();
        assert_eq!(root.ncols(), members.nrows(), "one column for each base parameter");
        let rows = root * members;
        let values = root * DVector::from_column_slice(phi);
        let at = self.rows.nrows();
        self.rows.resize_vertically_mut(at + rows.nrows(), 0.0);
        self.rows.rows_mut(at, rows.nrows()).copy_from(&rows);
        self.values.resize_vertically_mut(at + values.len(), 0.0);
        self.values.rows_mut(at, values.len()).copy_from(&values);
    }

    /// Adds all equations of another source.
    ///
    /// # Panics
    /// If it is about another number of parameters.
    pub fn join(&mut self, other: &Self) {
        assert_eq!(self.parameters(), other.parameters(), "knowledge of the same parameters");
        let at = self.rows.nrows();
        self.rows.resize_vertically_mut(at + other.equations(), 0.0);
        self.rows.rows_mut(at, other.equations()).copy_from(&other.rows);
        self.values.resize_vertically_mut(at + other.equations(), 0.0);
        self.values.rows_mut(at, other.equations()).copy_from(&other.values);
    }

    /// What follows.
    pub fn consequences(&self) -> Consequences {
        let count = self.parameters();
        // kilograms and kilogram square metres differ by orders: columns of one size decide ranks
        let scales: Vec<f64> = self
            .rows
            .column_iter()
            .map(|column| column.norm())
            .map(|length| if length > 0.0 { 1.0 / length } else { 1.0 })
            .collect();
        let scaled = DMatrix::from_fn(self.equations(), count, |row, column| {
            self.rows[(row, column)] * scales[column]
        });
        let nothing = Consequences {
            parameters: vec![None; count],
            combinations: Vec::new(),
            chi_squared: 0.0,
            degrees_of_freedom: 0,
        };
        if scaled.is_empty() {
            return nothing;
        }
        let svd = scaled.svd(true, true);
        let (Some(u), Some(v_t)) = (&svd.u, &svd.v_t) else { return nothing };
        let largest = svd.singular_values.amax();
        let kept: Vec<usize> = (0..svd.singular_values.len())
            .filter(|&at| svd.singular_values[at] > RANK_TOLERANCE * largest)
            .collect();
        // in the row space: theta0 = scales * sum of v_i (u_i . b) / s_i
        let space = Space { kept, u, v_t, sizes: &svd.singular_values, scales: &scales };
        let residual = space.residual(&self.values);
        let parameters = (0..count).map(|at| space.determined(&[(at, 1.0)], &self.values));
        let reduced = space.reduced();
        let combinations = reduced.into_iter().filter_map(|members| {
            let (value, std) = space.determined(&members, &self.values)?;
            Some(Determined { members, value, std })
        });
        Consequences {
            parameters: parameters.collect(),
            combinations: combinations.collect(),
            chi_squared: residual,
            degrees_of_freedom: self.equations() - space.kept.len(),
        }
    }
}

/// The row space of scaled equations.
struct Space<'a> {
    kept: Vec<usize>,
    u: &'a DMatrix<f64>,
    v_t: &'a DMatrix<f64>,
    sizes: &'a DVector<f64>,
    scales: &'a [f64],
}

impl Space<'_> {
    fn residual(&self, values: &DVector<f64>) -> f64 {
        let explained: f64 =
            self.kept.iter().map(|&at| self.u.column(at).dot(values).powi(2)).sum();
        (values.norm_squared() - explained).max(0.0)
    }

    /// Value and deviation of a combination, if it is in the row space.
    fn determined(&self, members: &[(usize, f64)], values: &DVector<f64>) -> Option<(f64, f64)> {
        let along = |at: usize| -> f64 {
            members.iter().map(|&(p, factor)| factor * self.scales[p] * self.v_t[(at, p)]).sum()
        };
        let shares: Vec<(usize, f64)> = self.kept.iter().map(|&at| (at, along(at))).collect();
        let length: f64 = members.iter().map(|&(p, f)| (f * self.scales[p]).powi(2)).sum();
        let inside: f64 = shares.iter().map(|(_, share)| share * share).sum();
        if length <= 0.0 || length - inside > ROUNDING * length {
            return None;
        }
        let value =
            shares.iter().map(|&(at, s)| s * self.u.column(at).dot(values) / self.sizes[at]).sum();
        let variance: f64 = shares.iter().map(|&(at, s)| (s / self.sizes[at]).powi(2)).sum();
        Some((value, variance.sqrt()))
    }

    /// The row space in reduced echelon form: each combination has a parameter, with factor 1,
    /// that no other has. Rows are in the order of these parameters.
    fn reduced(&self) -> Vec<Vec<(usize, f64)>> {
        let count = self.scales.len();
        let mut rows: Vec<Vec<f64>> = self
            .kept
            .iter()
            .map(|&at| (0..count).map(|p| self.v_t[(at, p)] / self.scales[p]).collect())
            .collect();
        // of each parameter in turn the largest entry left, in the measure of its column
        let mut done = 0;
        for parameter in 0..count {
            if done == rows.len() {
                break;
            }
            let size = |row: &Vec<f64>| row[parameter].abs() * self.scales[parameter];
            let (pivot, largest) = (done..rows.len())
                .map(|row| (row, size(&rows[row])))
                .fold((done, 0.0), |best, next| if next.1 > best.1 { next } else { best });
            if largest < ROUNDING {
                continue;
            }
            rows.swap(done, pivot);
            let factor = rows[done][parameter];
            rows[done].iter_mut().for_each(|entry| *entry /= factor);
            let own = rows[done].clone();
            for (at, row) in rows.iter_mut().enumerate().filter(|(at, _)| *at != done) {
                debug_assert_ne!(at, done);
                let factor = row[parameter];
                row.iter_mut().zip(&own).for_each(|(entry, own)| *entry -= factor * own);
            }
            done += 1;
        }
        let members = |row: &Vec<f64>| -> Vec<(usize, f64)> {
            let sizes = row.iter().zip(self.scales).map(|(entry, scale)| (entry * scale).abs());
            let largest = sizes.fold(0.0, f64::max);
            let is_there =
                |(p, entry): &(usize, &f64)| (**entry * self.scales[*p]).abs() > ROUNDING * largest;
            row.iter().enumerate().filter(is_there).map(|(p, entry)| (p, *entry)).collect()
        };
        rows.iter().map(members).collect()
    }
}
