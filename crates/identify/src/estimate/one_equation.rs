//! Least squares of a single equation, with the errors that all estimates have.

use super::condensed::Condensed;
use super::errors::{Errors, Problem};
use denavit_measure::LogIndex;
use denavit_numerics::least_squares::{Triangle, solve};
use nalgebra::{DMatrix, DVector};

/// What the columns of an equation are multiplied with.
#[derive(Clone, Debug)]
pub struct OneEquation {
    /// The most likely ones.
    pub values: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
    /// Root of the mean square of what is left.
    pub residual: f64,
}

impl OneEquation {
    /// Of rows in parts of time that follow each other; none if a column depends on others.
    pub fn of_parts(parts: Vec<Triangle>) -> Option<Self> {
        let rank = parts.first()?.width();
        let columns = (vec![(0..rank).collect()], rank);
        let condensed = Condensed {
            log_of_part: vec![LogIndex(0); parts.len()],
            parts: parts.into_iter().map(|part| vec![part]).collect(),
            ..Condensed::without_parts(columns, vec![1.0], vec![1.0])
        };
        let whole = condensed.whole();
        let solved =
            |weight: f64| solve(&condensed.system(&whole, &[vec![weight]], &[]), &vec![0.0; rank]);
        let plain = solved(1.0);
        let rows = whole[0][0].rows().max(1) as f64;
        let residual = (whole[0][0].squares(plain.phi.as_slice()) / rows).sqrt();
        let weight = if residual > 0.0 { 1.0 / residual } else { 1.0 };
        let (solution, weights) = (&solved(weight), &[vec![weight]][..]);
        let problem = Problem { condensed: &condensed, weights, prior: &[], solution };
        let covariance = problem.covariance(Errors::Correlated);
        let is_told = solution.excited() == rank;
        is_told.then_some(Self { values: plain.phi, covariance, residual })
    }
}
