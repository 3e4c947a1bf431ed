//! Linear equations with errors, A x = b + e, and what follows from them, whatever their rank.
//!
//! Whatever is known of unknowns, from any source, is rows, and joining it is putting them below
//! each other. Least squares in all rows at once is then the same as carrying one result into the
//! other as a prior (ridge towards given values with their uncertainty), and does not ask which
//! came first.
//!
//! Rows rarely determine every unknown. Which combinations follow is read off the row space; an
//! unknown follows by itself if its unit vector is in it.

use nalgebra::{DMatrix, DVector};

/// Parts of a row space below this, of the largest, are rounding.
const RANK_TOLERANCE: f64 = 1e-10;

/// Below this share of its column an entry of a reduced system is rounding.
const ROUNDING: f64 = 1e-9;

/// Equations, each divided by the standard deviation of its error.
#[derive(Clone, Debug, PartialEq)]
pub struct Equations {
    rows: DMatrix<f64>,
    values: DVector<f64>,
}

/// An unknown, or a combination of unknowns, that follows.
#[derive(Clone, Debug, PartialEq)]
pub struct Determined {
    /// Unknowns by their place, with factors; the first factor is 1.
    pub members: Vec<(usize, f64)>,
    /// Its value.
    pub value: f64,
    /// Standard deviation of the value.
    pub std: f64,
}

/// What follows from equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Consequences {
    /// For each unknown its value and standard deviation, if it follows by itself.
    pub parameters: Vec<Option<(f64, f64)>>,
    /// As many combinations as are independent, each with an unknown that no other has.
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

impl Equations {
    /// None, of so many unknowns.
    pub fn none(unknowns: usize) -> Self {
        Self { rows: DMatrix::zeros(0, unknowns), values: DVector::zeros(0) }
    }

    /// Their number.
    pub fn count(&self) -> usize {
        self.rows.nrows()
    }

    /// Adds the equation that a combination of unknowns has a value, with a positive standard
    /// deviation.
    ///
    /// # Panics
    /// If an unknown is none of those that this is about, or the deviation not positive.
    pub fn add(&mut self, members: &[(usize, f64)], value: f64, std: f64) {
        assert!(std > 0.0, "an equation without error cannot be weighed against others");
        let at = self.rows.nrows();
        self.rows.resize_vertically_mut(at + 1, 0.0);
        for &(unknown, factor) in members {
            self.rows[(at, unknown)] += factor / std;
        }
        self.values.resize_vertically_mut(at + 1, value / std);
    }

    /// Adds rows of unit error.
    ///
    /// # Panics
    /// If they are of another number of unknowns, or not one for each value.
    pub fn add_rows(&mut self, rows: &DMatrix<f64>, values: &DVector<f64>) {
        let at = self.rows.nrows();
        self.rows.resize_vertically_mut(at + rows.nrows(), 0.0);
        self.rows.rows_mut(at, rows.nrows()).copy_from(rows);
        self.values.resize_vertically_mut(at + values.len(), 0.0);
        self.values.rows_mut(at, rows.nrows()).copy_from(values);
    }

    /// What follows.
    pub fn consequences(&self) -> Consequences {
        let count = self.rows.ncols();
        // units of unknowns differ by orders: columns of one size decide ranks
        let scales: Vec<f64> = self
            .rows
            .column_iter()
            .map(|column| column.norm())
            .map(|length| if length > 0.0 { 1.0 / length } else { 1.0 })
            .collect();
        let scaled = DMatrix::from_fn(self.count(), count, |row, column| {
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
        // in the row space: x = scales * sum of v_i (u_i . b) / s_i
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
            degrees_of_freedom: self.count() - space.kept.len(),
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

    /// The row space in reduced echelon form: each combination has an unknown, with factor 1,
    /// that no other has. Rows are in the order of these unknowns.
    fn reduced(&self) -> Vec<Vec<(usize, f64)>> {
        let count = self.scales.len();
        let mut rows: Vec<Vec<f64>> = self
            .kept
            .iter()
            .map(|&at| (0..count).map(|p| self.v_t[(at, p)] / self.scales[p]).collect())
            .collect();
        // of each unknown in turn the largest entry left, in the measure of its column
        let mut done = 0;
        for unknown in 0..count {
            if done == rows.len() {
                break;
            }
            let size = |row: &Vec<f64>| row[unknown].abs() * self.scales[unknown];
            let (pivot, largest) = (done..rows.len())
                .map(|row| (row, size(&rows[row])))
                .fold((done, 0.0), |best, next| if next.1 > best.1 { next } else { best });
            if largest < ROUNDING {
                continue;
            }
            rows.swap(done, pivot);
            let factor = rows[done][unknown];
            rows[done].iter_mut().for_each(|entry| *entry /= factor);
            let own = rows[done].clone();
            for (at, row) in rows.iter_mut().enumerate().filter(|(at, _)| *at != done) {
                debug_assert_ne!(at, done);
                let factor = row[unknown];
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
