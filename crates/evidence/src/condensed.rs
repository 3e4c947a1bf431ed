//! The evidence of rows that are condensed to their products: what all linear models of few columns
//! and many rows need.

use crate::orthant::bounded;
use crate::weigh::{Cell, Posterior, settled};
use nalgebra::{DMatrix, DVector};

/// Rows of one variance.
#[derive(Clone, Debug)]
pub struct Condensed {
    /// How many of the rows are independent of each other.
    pub rows: f64,
    /// The mean square that their noise is expected to have.
    pub expected: f64,
    /// The mean square that it has at least.
    pub least: f64,
    /// The mean products of a row, of the data and all columns with each other, the data first.
    /// Columns have priors of their factors with the deviation 1.
    pub products: DMatrix<f64>,
}

/// What condensed rows say of a linear model.
#[derive(Clone, Debug)]
pub struct Told {
    /// Its log evidence, up to a constant that all models on the same rows share.
    pub log_evidence: f64,
    /// The most likely factors.
    pub factors: DVector<f64>,
    /// Their standard deviations.
    pub deviations: DVector<f64>,
}

impl Told {
    /// Weighs the model whose columns all cells have. Of each factor the value that is believed and
    /// the lowest one are given.
    pub fn of(cells: &[Condensed], believed: &[f64], lowest: &[f64], rounds: usize) -> Self {
        let expected: Vec<f64> = cells.iter().map(|cell| cell.expected).collect();
        let of = |cell: &Condensed| Cell {
            rows: cell.rows,
            products: &cell.products * cell.rows,
            least: cell.least,
        };
        let weighted: Vec<Cell> = cells.iter().map(of).collect();
        let (evidence, variances) = settled(&weighted, &expected, None, rounds, believed);
        let Posterior { mean, covariance, .. } = Posterior::new(&weighted, &variances, believed);
        let (factors, gained) = bounded(&mean, &covariance, lowest, believed);
        Self {
            log_evidence: evidence + gained,
            deviations: covariance.diagonal().map(f64::sqrt),
            factors,
        }
    }
}
