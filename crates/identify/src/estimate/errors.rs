//! Standard errors that hold where residuals are alike from one sample to the next.

use super::condensed::Condensed;
use crate::policy::errors::{MOST_LEVERAGE, NEIGHBOURS};
use denavit_measure::{JointIndex, PartIndex};
use denavit_numerics::least_squares::{PriorRow, Solution, Triangle, solve};
use denavit_numerics::{Random, long_run};
use nalgebra::{DMatrix, DVector};

/// How standard errors are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Errors {
    /// As if residuals were independent of each other.
    Classical,
    /// From the sums of scores over parts of the log, neighbours counted half (Newey, West 1987,
    /// with one lag of parts): residuals may be correlated over less than a part.
    #[default]
    Correlated,
    /// From estimates of logs put together of parts drawn at random (Kuensch 1989).
    Bootstrap {
        /// Number of drawings.
        draws: usize,
        /// What the drawings begin with.
        seed: u64,
    },
}

/// An estimate's problem, as its errors need it.
pub(super) struct Problem<'a> {
    pub(super) condensed: &'a Condensed,
    pub(super) weights: &'a [Vec<f64>],
    pub(super) prior: &'a [PriorRow],
    pub(super) solution: &'a Solution,
}

/// Fewer parts say nothing of how residuals are correlated.
pub(super) const FEWEST_PARTS: usize = 8;

impl Problem<'_> {
    /// The covariance of phi.
    pub(super) fn covariance(&self, errors: Errors) -> DMatrix<f64> {
        match errors {
            _ if self.condensed.parts.len() < FEWEST_PARTS => self.solution.covariance(),
            Errors::Classical => self.solution.covariance(),
            Errors::Correlated => self.correlated(),
            Errors::Bootstrap { draws, seed } => self.bootstrap(draws.max(2), seed),
        }
    }

    /// Rows beyond those that the estimate takes.
    pub(super) fn free_rows(&self) -> f64 {
        let rows: usize = self.condensed.parts.iter().flatten().map(Triangle::rows).sum();
        (rows as f64 - self.solution.excited() as f64).max(1.0)
    }

    /// Degrees of freedom of the variances of sums of phi, the rows of a matrix. A variance that is
    /// found from parts of the logs has as many as parts that decide alike would leave
    /// (Satterthwaite 1946, with what residuals that are independent make of each part as Bell and
    /// McCaffrey 2002): of a parameter that few parts decide they say little.
    pub(super) fn degrees_of_freedom(&self, errors: Errors, sums: &DMatrix<f64>) -> DVector<f64> {
        let neighbours = match errors {
            Errors::Correlated => NEIGHBOURS,
            Errors::Bootstrap { .. } => 1.0,
            Errors::Classical => return DVector::from_element(sums.nrows(), self.free_rows()),
        };
        if self.condensed.parts.len() < FEWEST_PARTS {
            return DVector::from_element(sums.nrows(), self.free_rows());
        }
        let follows = &self.solution.factor * (sums * &self.solution.factor).transpose();
        let mut moments = vec![[0.0; 2]; sums.nrows()];
        for part in 0..self.condensed.parts.len() {
            let mut decides = vec![0.0; sums.nrows()];
            for rows in self.weighted(PartIndex(part), &follows) {
                for (decides, column) in decides.iter_mut().zip(rows.column_iter()) {
                    *decides += column.norm_squared();
                }
            }
            for ([sum, squares], decides) in moments.iter_mut().zip(decides) {
                *sum += decides;
                *squares += decides * decides;
            }
        }
        let parts_alike =
            |[sum, squares]: [f64; 2]| if squares > 0.0 { sum * sum / squares } else { 0.0 };
        let degrees = moments.into_iter().map(|both| (parts_alike(both) / neighbours).max(1.0));
        DVector::from_iterator(sums.nrows(), degrees)
    }

    /// W of a part, weighted, times a matrix: for each joint its rows.
    fn weighted<'b>(
        &'b self,
        part: PartIndex,
        by: &'b DMatrix<f64>,
    ) -> impl Iterator<Item = DMatrix<f64>> + 'b {
        let weights = &self.weights[self.condensed.log_of_part[part.0].0];
        let of = move |(joint, triangle): (usize, &Triangle)| {
            let pattern = &self.condensed.pattern[joint];
            let r = triangle.matrix().view((0, 0), (pattern.len(), pattern.len()));
            weights[joint] * (r * by.select_rows(pattern))
        };
        self.condensed.parts[part.0].iter().enumerate().map(of)
    }

    /// F F^T S F F^T with S the long-run covariance of the scores.
    fn correlated(&self) -> DMatrix<f64> {
        // Half of one lag may leave a variance below 0 where there are few parts.
        let floor = self.solution.covariance() * 1e-4;
        let mut covariance = long_run(&self.influences(), &self.condensed.log_of_part);
        for place in 0..covariance.nrows() {
            covariance[(place, place)] = covariance[(place, place)].max(floor[(place, place)]);
        }
        covariance
    }

    /// What each part does to phi: F F^T g, with the score g as it is without the part.
    pub(super) fn influences(&self) -> Vec<DVector<f64>> {
        let factor = &self.solution.factor;
        // F^T g has the squares of the excited directions alone.
        let of = |part| factor * self.left_out(part, factor.tr_mul(&self.score(part)));
        (0..self.condensed.parts.len()).map(PartIndex).map(of).collect()
    }

    /// A score in the excited directions as it is for the estimate without its part: the change of
    /// phi when the part is left out is (I - H)^-1 g with H = F^T W^T W F of the part (the
    /// jackknife of parts). The estimate adapts to a part that says much about the parameters,
    /// whose residuals are too small therefore; this puts it right, and errs to the safe side.
    fn left_out(&self, part: PartIndex, score: DVector<f64>) -> DVector<f64> {
        let factor = &self.solution.factor;
        let size = factor.ncols();
        if size == 0 {
            // a log without torques determines nothing
            return score;
        }
        let mut leverage = DMatrix::zeros(size, size);
        for rows in self.weighted(part, factor) {
            leverage += rows.tr_mul(&rows);
        }
        if leverage.iter().any(|entry| !entry.is_finite()) {
            return score;
        }
        let eigen = leverage.symmetric_eigen();
        let mut turned = eigen.eigenvectors.tr_mul(&score);
        for (entry, share) in turned.iter_mut().zip(eigen.eigenvalues.iter()) {
            // what one part alone determines cannot be compared with the others
            *entry /= 1.0 - share.clamp(0.0, MOST_LEVERAGE);
        }
        eigen.eigenvectors * turned
    }

    /// sum over joints of w^2 W^T (y - W phi) of a part.
    fn score(&self, part: PartIndex) -> DVector<f64> {
        let mut score = DVector::zeros(self.condensed.rank);
        let phi = self.solution.phi.as_slice();
        let weights = &self.weights[self.condensed.log_of_part[part.0].0];
        for (joint, triangle) in self.condensed.parts[part.0].iter().enumerate() {
            let weight = weights[joint] * weights[joint];
            if triangle.rows() == 0 || weight == 0.0 {
                continue;
            }
            let own = triangle.score(&self.condensed.of_joint(JointIndex(joint), phi));
            for (&place, entry) in self.condensed.pattern[joint].iter().zip(own) {
                score[place] += weight * entry;
            }
        }
        score
    }

    fn bootstrap(&self, draws: usize, seed: u64) -> DMatrix<f64> {
        let Self { condensed, weights, prior, solution } = self;
        let mut random = Random::new(seed);
        let count = condensed.parts.len();
        let estimates: Vec<DVector<f64>> = (0..draws)
            .map(|_| {
                let drawn = (0..count).map(|_| PartIndex((random.bits() % count as u64) as usize));
                let triangles = condensed.merged(drawn);
                let r = condensed.system(&triangles, weights, prior);
                solve(&r, solution.phi.as_slice()).phi
            })
            .collect();
        let mean = estimates.iter().fold(DVector::zeros(condensed.rank), |sum, one| sum + one)
            / draws as f64;
        let mut covariance = DMatrix::zeros(condensed.rank, condensed.rank);
        for one in &estimates {
            let apart = one - &mean;
            covariance += &apart * apart.transpose();
        }
        covariance / (draws - 1) as f64
    }
}

#[cfg(test)]
#[path = "../../tests/unit/errors.rs"]
mod tests;
