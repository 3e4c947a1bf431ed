//! Weights of rows by the noise of each joint in each log, which is that of its residuals.
//!
//! Logs of one robot may be of unlike sensors and filters; the noise of each weighs its own rows
//! (components of variance: Helmert 1924, Patterson and Thompson 1971). What an estimate takes from
//! the residuals of a log is its share of the parameters, by which a short log that decides most of
//! them seems better than it is.

use super::condensed::Condensed;
use super::least_squares::Fit;
use crate::policy::weights::LEAST_FREE;
pub(super) use crate::policy::weights::SETTLED;
use denavit_measure::JointIndex;
use denavit_numerics::least_squares::{Solution, Triangle};

/// Times that weights are found anew.
pub(super) const MAX_REWEIGHTING: usize = 30;

/// Logs whose own estimates weights begin with, beside that of all alike: the longest. Where a log
/// of little but noise pulls the first estimate, weights may settle with it.
const STARTS: usize = 8;

/// One number for each joint of each log.
pub(super) type ByLog = Vec<Vec<f64>>;

/// Weights that have settled, with what they lead to.
pub(super) struct Settled {
    pub(super) solution: Solution,
    pub(super) weights: ByLog,
    pub(super) noise: ByLog,
}

impl Fit<'_> {
    /// Least squares, rows weighted by the noise of their joint in their log if that is wanted: a
    /// few rounds, since the noise is that of the residuals.
    pub(super) fn settled(&self, condensed: &Condensed, is_weighted: bool) -> Settled {
        let triangles = condensed.whole();
        let of_one_size = condensed.first_weights(&triangles, is_weighted);
        let first = self.weighed(condensed, &triangles, of_one_size.clone());
        if !is_weighted {
            return first;
        }
        let mut best = self.settle(condensed, &triangles, first);
        let mut logs: Vec<usize> = (0..triangles.len()).collect();
        let rows = |log: usize| triangles[log].iter().map(Triangle::rows).sum::<usize>();
        logs.sort_by_key(|&log| std::cmp::Reverse(rows(log)));
        logs.truncate(if triangles.len() > 1 { STARTS } else { 0 });
        for log in logs {
            let mut alone = of_one_size.clone();
            let others = alone.iter_mut().enumerate().filter(|(at, _)| *at != log);
            others.for_each(|(_, weights)| weights.fill(0.0));
            let begun = self.weighed(condensed, &triangles, alone);
            let next = self.settle(condensed, &triangles, begun);
            if next.unlikeliness(condensed, &triangles) < best.unlikeliness(condensed, &triangles) {
                best = next;
            }
        }
        best
    }

    /// The same, from weights that are not far.
    pub(super) fn settled_from(&self, condensed: &Condensed, weights: ByLog) -> Settled {
        let triangles = condensed.whole();
        let first = self.weighed(condensed, &triangles, weights);
        self.settle(condensed, &triangles, first)
    }

    fn weighed(
        &self,
        condensed: &Condensed,
        triangles: &[Vec<Triangle>],
        weights: ByLog,
    ) -> Settled {
        let solution = self.solved(condensed, triangles, &weights);
        let noise = condensed.deviations(triangles, &solution, &weights);
        Settled { solution, weights, noise }
    }

    fn settle(
        &self,
        condensed: &Condensed,
        triangles: &[Vec<Triangle>],
        mut found: Settled,
    ) -> Settled {
        for _ in 1..MAX_REWEIGHTING {
            let weights = condensed.reciprocal(&found.noise, triangles);
            let next = self.weighed(condensed, triangles, weights);
            let change = moved(&found.solution, &next.solution);
            found = next;
            if change < SETTLED {
                break;
            }
        }
        found
    }
}

impl Settled {
    /// -2 log likelihood of the residuals, but for a constant and a factor. A log that contradicts
    /// others is left with what is like its motion, not like noise: it says no more for having the
    /// higher filter. Logs therefore count by their time.
    fn unlikeliness(&self, condensed: &Condensed, triangles: &[Vec<Triangle>]) -> f64 {
        let squares = condensed.squares(triangles, self.solution.phi.as_slice());
        let mut sum = 0.0;
        for (log, triangles) in triangles.iter().enumerate() {
            let share = condensed.row_s[log];
            for (joint, triangle) in triangles.iter().enumerate().filter(|(_, one)| one.rows() > 0)
            {
                let size = triangle.target_squares() / triangle.rows() as f64;
                let variance = self.noise[log][joint].powi(2).max(1e-24 * size);
                if variance > 0.0 {
                    sum += share * triangle.rows() as f64 * variance.ln();
                    sum += share * squares[log][joint] / variance;
                }
            }
        }
        sum
    }
}

impl Condensed {
    /// What rows of each log count beside those of the log whose rows are independent most.
    fn of_rows_alike(&self) -> Vec<f64> {
        let most = self.independent.iter().copied().fold(0.0, f64::max);
        self.independent.iter().map(|share| if most > 0.0 { share / most } else { 1.0 }).collect()
    }

    /// Rows, as many as count like those of the log whose rows are independent most.
    pub(super) fn counted_rows(&self) -> f64 {
        self.rows_by(&self.of_rows_alike())
    }

    /// Rows that are independent of each other.
    pub(super) fn independent_rows(&self) -> f64 {
        self.rows_by(&self.independent)
    }

    /// Rows, those of each log counted so.
    fn rows_by(&self, counts: &[f64]) -> f64 {
        let rows = |part: &Vec<Triangle>| part.iter().map(Triangle::rows).sum::<usize>() as f64;
        let both = self.parts.iter().zip(&self.log_of_part);
        both.map(|(part, log)| counts[log.0] * rows(part)).sum()
    }

    /// Weights to begin with: all alike, or torques of one size, whatever their units.
    fn first_weights(&self, triangles: &[Vec<Triangle>], is_weighted: bool) -> ByLog {
        let sizes: Vec<f64> = (0..self.pattern.len())
            .map(|joint| {
                let of_joint = triangles.iter().map(|of_log| &of_log[joint]);
                let (rows, squares) = of_joint.fold((0, 0.0), |(rows, squares), one| {
                    (rows + one.rows(), squares + one.target_squares())
                });
                if squares > 0.0 { (rows as f64 / squares).sqrt() } else { 0.0 }
            })
            .collect();
        let of_log = |(triangles, counts): (&Vec<Triangle>, f64)| {
            let of = |(one, size): (&Triangle, &f64)| match (one.rows() > 0, is_weighted) {
                (false, _) => 0.0,
                (true, false) => 1.0,
                (true, true) => size * counts.sqrt(),
            };
            triangles.iter().zip(&sizes).map(of).collect()
        };
        triangles.iter().zip(self.of_rows_alike()).map(of_log).collect()
    }

    /// |W phi - y|^2 of each joint in each log.
    pub(super) fn squares(&self, triangles: &[Vec<Triangle>], phi: &[f64]) -> ByLog {
        let of_log = |triangles: &Vec<Triangle>| {
            let all = triangles.iter().enumerate();
            all.map(|(joint, one)| one.squares(&self.of_joint(JointIndex(joint), phi))).collect()
        };
        triangles.iter().map(of_log).collect()
    }

    /// The deviation of each joint's residuals in each log, of as many independent ones as there
    /// are, without what the estimate takes of them: trace of w^2 W F F^T W^T.
    fn deviations(
        &self,
        triangles: &[Vec<Triangle>],
        solution: &Solution,
        weights: &ByLog,
    ) -> ByLog {
        let of = |log: usize, joint: usize| {
            let (pattern, triangle) = (&self.pattern[joint], &triangles[log][joint]);
            let all = self.independent[log] * triangle.rows() as f64;
            if all == 0.0 {
                return 0.0;
            }
            let own = solution.factor.select_rows(pattern);
            let r = triangle.matrix().view((0, 0), (pattern.len(), pattern.len()));
            let taken = weights[log][joint].powi(2) * (r * own).norm_squared();
            let free = (all - taken).max(LEAST_FREE * all);
            let phi = self.of_joint(JointIndex(joint), solution.phi.as_slice());
            (self.independent[log] * triangle.squares(&phi) / free).sqrt()
        };
        let joints = 0..self.pattern.len();
        let of_log = |log: usize| joints.clone().map(|joint| of(log, joint)).collect();
        (0..triangles.len()).map(of_log).collect()
    }

    /// The deviation of each joint's residuals in all logs, of those in each; 0 where no torque was
    /// measured.
    pub(super) fn noise_of_joints(&self, noise: &ByLog) -> Vec<f64> {
        let mut sums = vec![[0.0; 2]; self.pattern.len()];
        for (part, &log) in self.parts.iter().zip(&self.log_of_part) {
            for (joint, sum) in sums.iter_mut().enumerate() {
                let rows = part[joint].rows() as f64;
                *sum = [sum[0] + rows, sum[1] + rows * noise[log.0][joint].powi(2)];
            }
        }
        sums.iter().map(|[rows, squares]| (squares / rows.max(1.0)).sqrt()).collect()
    }

    /// 1 / noise; a joint without noise counts like one with a millionth of its torque.
    pub(super) fn reciprocal(&self, noise: &ByLog, triangles: &[Vec<Triangle>]) -> ByLog {
        let weight = |(noise, triangle): (&f64, &Triangle)| {
            if triangle.rows() == 0 {
                return 0.0;
            }
            let size = (triangle.target_squares() / triangle.rows() as f64).sqrt();
            let least = if size > 0.0 { 1e-12 * size } else { 1.0 };
            1.0 / noise.max(least)
        };
        let of_log = |(counts, (noise, triangles)): (f64, (&Vec<f64>, &Vec<Triangle>))| {
            noise.iter().zip(triangles).map(|both| counts.sqrt() * weight(both)).collect()
        };
        self.of_rows_alike().into_iter().zip(noise.iter().zip(triangles)).map(of_log).collect()
    }
}

/// The largest change of an entry of phi, in its standard errors.
pub(super) fn moved(before: &Solution, after: &Solution) -> f64 {
    let covariance = after.covariance();
    let change = |place: usize| {
        let deviation = covariance[(place, place)].sqrt();
        let step = (after.phi[place] - before.phi[place]).abs();
        // Without noise, deviations are rounding.
        let rounding = 1e-9 * after.phi.amax();
        if step <= rounding { 0.0 } else { step / deviation.max(f64::MIN_POSITIVE) }
    };
    (0..after.phi.len()).map(change).fold(0.0, f64::max)
}
