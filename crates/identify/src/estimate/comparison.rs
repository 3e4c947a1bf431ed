//! Logs for an estimate that are compared with each other.

use super::condensed::Condensed;
use super::contradiction::{Claim, ContradictingLog};
use super::errors::{Errors, Problem};
use super::least_squares::Fit;
use super::left_out::LeftOut;
use super::own_estimate::Tested;
use crate::policy::comparison::APART;
use denavit_measure::condition::Conditioned;
use denavit_measure::{JointIndex, LogIndex};
use denavit_numerics::least_squares::Solution;
use denavit_plants::regression::RegressionModel;
use nalgebra::{DMatrix, DVector};

/// Logs, and how their rows are weighted.
pub(super) struct Comparison<'a> {
    pub(super) model: &'a RegressionModel,
    pub(super) logs: &'a [Conditioned],
    pub(super) condensed: &'a Condensed,
    /// Those of the estimate of all of them: those of some begin with them.
    pub(super) weights: &'a [Vec<f64>],
    pub(super) fit: Fit<'a>,
    pub(super) left_out: &'a LeftOut,
}

/// What some of the logs say.
struct Said {
    solution: Solution,
    covariance: DMatrix<f64>,
    /// What rows of each joint count by their noise in these logs.
    weights: Vec<f64>,
}

impl Comparison<'_> {
    fn said(&self, logs: &[LogIndex]) -> Said {
        let condensed = self.condensed.of_logs(logs);
        let weights: Vec<Vec<f64>> = logs.iter().map(|&log| self.weights[log.0].clone()).collect();
        let settled = self.fit.settled_from(&condensed, weights);
        let (solution, noise) = (settled.solution, settled.noise);
        let (prior, weights) = (&self.fit.options.prior[..], &settled.weights[..]);
        let problem = Problem { condensed: &condensed, weights, prior, solution: &solution };
        let covariance = problem.covariance(Errors::Correlated);
        let weight = |noise: f64| if noise > 0.0 { 1.0 / noise } else { 0.0 };
        let weights = condensed.noise_of_joints(&noise).into_iter().map(weight).collect();
        Said { solution, covariance, weights }
    }

    /// The logs that contradict what the others say without them.
    pub(super) fn odd(&self, logs: &[LogIndex]) -> Vec<(LogIndex, ContradictingLog)> {
        let without = |odd: LogIndex| logs.iter().copied().filter(|log| *log != odd).collect();
        let of = |&log: &LogIndex| {
            let others: Vec<LogIndex> = without(log);
            Some((log, self.against(log, &others)?))
        };
        logs.iter().filter_map(of).collect()
    }

    /// Whether a log contradicts what others say.
    pub(super) fn against(&self, log: LogIndex, others: &[LogIndex]) -> Option<ContradictingLog> {
        let Self { model, left_out, .. } = *self;
        let said = self.said(others);
        let one = Tested::new(self.condensed, log, &said.weights);
        let phi = &one.with_own(&said.solution);
        let means = &self.condensed.means(others, phi.as_slice());
        let claim = Claim { model, phi, covariance: &said.covariance, left_out, means };
        claim.against(log, self.logs, &one)
    }

    /// Of logs that contradict the others the one without which fewest of these contradict each
    /// other, and of several such that without which least is left beside their own estimates, in
    /// units of what chance explains (Chow 1960).
    pub(super) fn oddest(
        &self,
        logs: &[LogIndex],
        odd: &[(LogIndex, ContradictingLog)],
    ) -> LogIndex {
        let alone = |log: LogIndex| {
            let said = self.said(&[log]);
            let one = Tested::new(self.condensed, log, &said.weights);
            (one.own(said.solution.phi.as_slice()), one.triangles)
        };
        let own: Vec<_> = logs.iter().map(|&log| alone(log)).collect();
        let among = |odd: LogIndex| -> f64 {
            let others: Vec<LogIndex> = logs.iter().copied().filter(|log| *log != odd).collect();
            let phi = self.said(&others).solution.phi;
            let all = logs.iter().zip(&own).filter(|(log, _)| **log != odd);
            let explained = all.flat_map(|(_, (own, triangles))| {
                let phi = &phi;
                own.iter().zip(triangles).enumerate().map(move |(joint, (own, triangle))| {
                    let phi = self.condensed.of_joint(JointIndex(joint), phi.as_slice());
                    let explained = (triangle.squares(&phi) - own.squares).max(0.0);
                    if own.chance > 0.0 { explained / own.chance } else { 0.0 }
                })
            });
            explained.sum()
        };
        let without = |log: LogIndex| {
            let others: Vec<LogIndex> =
                logs.iter().copied().filter(|other| *other != log).collect();
            self.odd(&others).len()
        };
        let all = odd.iter().map(|(log, _)| (*log, without(*log), among(*log)));
        let least = all.min_by(|a, b| a.1.cmp(&b.1).then(a.2.total_cmp(&b.2)));
        least.map_or(logs[0], |(log, ..)| log)
    }

    /// Whether parameters are what some logs say.
    pub(super) fn is_of(&self, logs: &[LogIndex], phi: &DVector<f64>) -> bool {
        let Said { solution, covariance, .. } = self.said(logs);
        let to = self.model.to_listed();
        let apart = to * (phi - &solution.phi);
        let variances = (to * covariance * to.transpose()).diagonal();
        apart.iter().zip(&variances).all(|(by, variance)| by * by <= APART.powi(2) * variance)
    }
}
