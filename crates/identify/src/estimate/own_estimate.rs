//! A log by itself: what parameters of its own, or a constant, leave of its torques, and what of
//! that chance explains.

use super::condensed::Condensed;
use super::solve::{DEAD, Solution, stacked};
use super::triangle::Triangle;
use nalgebra::{DMatrix, DVector};

/// The rows of a log that is compared with what others say.
pub(super) struct Tested<'a> {
    pub(super) condensed: Condensed,
    /// By joint.
    pub(super) triangles: Vec<Triangle>,
    /// What rows of each joint count, to begin with.
    pub(super) weights: &'a [f64],
}

impl<'a> Tested<'a> {
    pub(super) fn new(condensed: &Condensed, log: usize, weights: &'a [f64]) -> Self {
        let condensed = condensed.of_logs(&[log]);
        let triangles = condensed.whole().remove(0);
        Self { condensed, triangles, weights }
    }

    fn system(&self, weights: &[f64]) -> DMatrix<f64> {
        let Condensed { pattern, rank, .. } = &self.condensed;
        stacked(&[(&self.triangles, weights)], pattern, &[], *rank)
    }

    /// phi of a solution, in the directions that it says nothing about of the log's own.
    pub(super) fn with_own(&self, solution: &Solution) -> DVector<f64> {
        let (phi, dead) = (&solution.phi, &solution.dead);
        if dead.ncols() == 0 {
            return phi.clone();
        }
        let rank = phi.len();
        let r = self.system(self.weights);
        let w = r.view((0, 0), (rank, rank));
        let left = r.view((0, rank), (rank, 1)).column(0) - w * phi;
        let along = w * dead;
        if along.iter().any(|entry| !entry.is_finite()) {
            return phi.clone();
        }
        let along = along.svd(true, true);
        let least = DEAD * along.singular_values.max();
        along.solve(&left, least).map_or_else(|_| phi.clone(), |along| phi + dead * along)
    }
}

/// The entries of phi that a joint's columns belong to.
pub(super) fn of_joint(places: &[usize], phi: &[f64]) -> Vec<f64> {
    places.iter().map(|&place| phi[place]).collect()
}

/// The squares that errors of phi make of a joint's rows in the mean.
pub(super) fn spread(triangle: &Triangle, places: &[usize], covariance: &DMatrix<f64>) -> f64 {
    let r = triangle.matrix().view((0, 0), (places.len(), places.len()));
    let own = covariance.select_rows(places).select_columns(places);
    (r * own * r.transpose()).trace()
}
