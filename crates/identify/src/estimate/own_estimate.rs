//! A log by itself: what parameters of its own, or a constant, leave of its torques, and what of
//! that chance explains.

use super::condensed::Condensed;
use super::errors::{FEWEST_PARTS, Problem};
use denavit_measure::{JointIndex, LogIndex};
use denavit_numerics::least_squares::{DEAD, Solution, Triangle, solve, stacked};
use denavit_numerics::long_run;
use nalgebra::{DMatrix, DVector};

/// Times that the weights of a log's own estimate are found anew.
const REWEIGHTING: usize = 3;

/// The rows of a log that is compared with what others say.
pub(super) struct Tested<'a> {
    pub(super) condensed: Condensed,
    /// By joint.
    pub(super) triangles: Vec<Triangle>,
    /// What rows of each joint count, to begin with.
    pub(super) weights: &'a [f64],
}

/// What parameters of a log's own leave of a joint's torque.
pub(super) struct Own {
    /// |W phi - y|^2.
    pub(super) squares: f64,
    /// The variance of a row.
    pub(super) variance: f64,
    /// The squares that chance explains in the mean.
    pub(super) chance: f64,
}

impl<'a> Tested<'a> {
    pub(super) fn new(condensed: &Condensed, log: LogIndex, weights: &'a [f64]) -> Self {
        let condensed = condensed.of_logs(&[log]);
        let triangles = condensed.whole().remove(0);
        Self { condensed, triangles, weights }
    }

    /// The share of rows that are independent of each other.
    fn independent(&self) -> f64 {
        self.condensed.independent[0]
    }

    /// Whether its parts say for how long residuals are alike.
    pub(super) fn has_parts(&self) -> bool {
        self.condensed.parts.len() >= FEWEST_PARTS
    }

    /// What an estimate of its own leaves of each joint. What chance explains is that of samples
    /// that are independent after the filter, or that of parts of the log, if that is more:
    /// residuals may be alike for longer.
    pub(super) fn own(&self, phi: &[f64]) -> Vec<Own> {
        let pattern = &self.condensed.pattern;
        let independent = self.independent();
        let mut weights = self.weights.to_vec();
        let mut own: Vec<Own> = Vec::new();
        for round in 0..=REWEIGHTING {
            let solution = solve(&self.system(&weights), phi);
            let of_parts = (round == REWEIGHTING && self.has_parts()).then(|| {
                let (condensed, weights) = (&self.condensed, &[weights.clone()][..]);
                let problem = Problem { condensed, weights, prior: &[], solution: &solution };
                long_run(&problem.influences(), &condensed.log_of_part)
            });
            let of = |(joint, triangle): (usize, &Triangle)| {
                let places = &pattern[joint];
                let r = triangle.matrix().view((0, 0), (places.len(), places.len()));
                let factor = solution.factor.select_rows(places);
                let decided = weights[joint].powi(2) * (r * factor).norm_squared();
                let own = self.condensed.of_joint(JointIndex(joint), solution.phi.as_slice());
                let squares = triangle.squares(&own);
                let free = (independent * triangle.rows() as f64 - decided).max(f64::MIN_POSITIVE);
                let variance = squares * independent / free;
                let by_parts = of_parts.as_ref().map_or(0.0, |own| spread(triangle, places, own));
                let chance = decided.max(1.0) * variance / independent;
                Own { squares, variance, chance: chance.max(by_parts) }
            };
            own = self.triangles.iter().enumerate().map(of).collect();
            let weight = |one: &Own| if one.variance > 0.0 { one.variance.powf(-0.5) } else { 0.0 };
            weights = own.iter().map(weight).collect();
        }
        own
    }

    /// What a constant beside that of other logs, of mean `mean`, leaves of a joint's torque, of
    /// whose squares phi leaves `left`.
    pub(super) fn constant(&self, left: f64, joint: JointIndex, phi: &[f64], mean: f64) -> Own {
        let phi = &self.condensed.of_joint(joint, phi);
        let sums = |triangle: &Triangle| [triangle.rows() as f64, triangle.sum(phi)];
        let independent = self.independent();
        let [rows, sum] = sums(&self.triangles[joint.0]);
        let own = sum / rows.max(1.0);
        let by = own - mean;
        let squares = left - by * (2.0 * sum - by * rows);
        let variance = squares * independent / (independent * rows - 1.0).max(f64::MIN_POSITIVE);
        let parts = self.condensed.parts.iter().map(|part| sums(&part[joint.0]));
        let apart = parts.map(|[rows, sum]| DVector::from_element(1, sum - own * rows));
        let apart: Vec<DVector<f64>> = apart.collect();
        let by_parts = match self.has_parts() {
            true => long_run(&apart, &vec![LogIndex(0); apart.len()])[(0, 0)] / rows.max(1.0),
            false => 0.0,
        };
        Own { squares, variance, chance: by_parts.max(variance / independent) }
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

/// The squares that errors of phi make of a joint's rows in the mean.
pub(super) fn spread(triangle: &Triangle, places: &[usize], covariance: &DMatrix<f64>) -> f64 {
    let r = triangle.matrix().view((0, 0), (places.len(), places.len()));
    let own = covariance.select_rows(places).select_columns(places);
    (r * own * r.transpose()).trace()
}
