//! Noise on both sides: what noise of the positions does to the residual of each row.
//!
//! Filter and differences turn the noise of a position into noise of position, rate and
//! acceleration of known covariance; how much each moves the torque follows from the model, row by
//! row. Rows weighted by the deviation of all that together give the maximum of the likelihood
//! where the torque is near enough to linear over the noise (Swevers et al. 1997).

use super::rows::Block;
use super::weights::ByLog;
use crate::policy::likelihood::LEAST_TORQUE_SHARE;
use denavit_measure::condition::Conditioned;
use denavit_measure::{JointIndex, LogIndex, SampleIndex};
use denavit_numerics::mean;
use denavit_plants::regression::{RegressionModel, RegressionRows};

/// Samples in a block.
const BLOCK: usize = 512;

/// Variances of rows from noise of the positions.
pub(super) struct Variance {
    /// Log, joint, sample [(N m)^2, N^2].
    of_positions: Vec<Vec<Vec<f64>>>,
}

impl Variance {
    /// Of logs, with phi and the deviation of each measured position, if a log shows no more.
    pub(super) fn new(
        model: &RegressionModel,
        logs: &[Conditioned],
        phi: &[f64],
        deviations: &[f64],
    ) -> Self {
        let of_log = |log: &Conditioned| {
            let known = deviations.iter().copied().chain(std::iter::repeat(0.0));
            let both = log.position_noise.iter().copied().chain(std::iter::repeat(0.0)).zip(known);
            let deviations: Vec<f64> =
                both.take(log.joints()).map(|(own, known)| own.max(known)).collect();
            of_log(model, log, phi, &deviations)
        };
        Self { of_positions: logs.iter().map(of_log).collect() }
    }

    /// The noise of the torques themselves, of residuals with given deviations, by log and joint.
    pub(super) fn torque_noise(&self, residual: &ByLog) -> ByLog {
        let of_joint = |(rows, deviation): (&Vec<f64>, &f64)| {
            let all = deviation * deviation;
            (all - mean(rows)).max(LEAST_TORQUE_SHARE * all).sqrt()
        };
        let of_log = |(rows, residual): (&Vec<Vec<f64>>, &Vec<f64>)| {
            rows.iter().zip(residual).map(of_joint).collect()
        };
        self.of_positions.iter().zip(residual).map(of_log).collect()
    }

    /// 1 over the deviation of each row.
    pub(super) fn factors(
        &self,
        log: LogIndex,
        joint: JointIndex,
        block: &Block,
        torque_noise: &ByLog,
    ) -> Vec<f64> {
        let first = block.first.0;
        let rows = &self.of_positions[log.0][joint.0][first..first + block.samples];
        let own = torque_noise[log.0][joint.0].powi(2);
        rows.iter().map(|variance| 1.0 / (own + variance).sqrt().max(f64::MIN_POSITIVE)).collect()
    }
}

/// For each joint what noise of the positions makes of each row.
fn of_log(
    model: &RegressionModel,
    log: &Conditioned,
    phi: &[f64],
    deviations: &[f64],
) -> Vec<Vec<f64>> {
    let (n, gains) = (log.joints(), log.noise_gains());
    let samples = log.samples();
    let mut variance = vec![vec![0.0; samples]; n];
    let mut evaluator = model.evaluator();
    let (mut rows, mut motion) = (RegressionRows::default(), Vec::new());
    let own: Vec<Vec<f64>> = (0..n).map(|joint| model.of_joint(joint, phi)).collect();
    for first in (0..samples).step_by(BLOCK) {
        let count = BLOCK.min(samples - first);
        log.motion_at(SampleIndex(first), count, &mut motion);
        for joint in 0..n {
            let deviation = deviations.get(joint).copied().unwrap_or(0.0);
            if deviation == 0.0 {
                continue;
            }
            // Half the difference over +- one deviation: a derivative that steps do not upset.
            let mut slopes = vec![vec![vec![0.0; count]; n]; 3];
            for (order, slopes) in slopes.iter_mut().enumerate() {
                let step = deviation * gains[order][order].sqrt();
                let place = order * n + joint;
                for sign in [1.0, -1.0] {
                    motion[place].iter_mut().for_each(|value| *value += sign * step);
                    let columns: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
                    evaluator.evaluate(&columns, &mut rows).expect("every joint has its columns");
                    motion[place].iter_mut().for_each(|value| *value -= sign * step);
                    let mut torque = vec![0.0; count];
                    for (row, slope) in slopes.iter_mut().enumerate() {
                        rows.torque(row, &own[row], &mut torque);
                        for (slope, torque) in slope.iter_mut().zip(&torque) {
                            *slope += 0.5 * sign * torque / step;
                        }
                    }
                }
            }
            for (row, variance) in variance.iter_mut().enumerate() {
                for k in 0..count {
                    let mut sum = 0.0;
                    for a in 0..3 {
                        for b in 0..3 {
                            sum += slopes[a][row][k] * gains[a][b] * slopes[b][row][k];
                        }
                    }
                    variance[first + k] += deviation * deviation * sum;
                }
            }
        }
    }
    variance
}
