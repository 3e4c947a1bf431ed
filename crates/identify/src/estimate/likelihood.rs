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
use denavit_plants::regression::{RegressionModel, RegressionRows};

/// Samples in a block.
const BLOCK: usize = 512;

/// Blocks of a log in which noise is looked at.
const LOOKED_AT: usize = 4;

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
            of_log(model, log, 1, phi, &deviations, &log.noise_gains())
        };
        Self { of_positions: logs.iter().map(of_log).collect() }
    }

    /// The noise of the torques themselves, of residuals with given deviations, by log and joint.
    pub(super) fn torque_noise(&self, residual: &ByLog) -> ByLog {
        let of_joint = |(rows, deviation): (&Vec<f64>, &f64)| {
            let mean = rows.iter().sum::<f64>() / rows.len().max(1) as f64;
            let all = deviation * deviation;
            (all - mean).max(LEAST_TORQUE_SHARE * all).sqrt()
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

/// How much of each joint's torque noise of the positions makes up by itself after the filter,
/// root of mean square over root of mean square, looked at in some blocks of each log.
pub(crate) fn noise_of_positions(
    model: &RegressionModel,
    logs: &[&Conditioned],
    phi: &[f64],
) -> Vec<f64> {
    let mut sums = vec![[0.0; 2]; model.joints.len()];
    for log in logs {
        let every = log.samples().div_ceil(BLOCK * LOOKED_AT).max(1);
        let rows = of_log(model, log, every, phi, &log.position_noise, &log.filter_gains());
        let looked_at = |sample: &usize| (sample / BLOCK).is_multiple_of(every);
        let count = (0..log.samples()).filter(looked_at).count().max(1) as f64;
        let weight = log.samples() as f64;
        for ((sums, row), torque) in sums.iter_mut().zip(rows).zip(&log.torque) {
            let torque = &torque.as_deref().unwrap_or_default();
            let torque = torque.get(log.range.clone()).unwrap_or_default();
            let squares = torque.iter().map(|torque| torque * torque).sum::<f64>();
            sums[0] += weight * row.iter().sum::<f64>() / count;
            sums[1] += weight * squares / torque.len().max(1) as f64;
        }
    }
    let share = |[noise, torque]: [f64; 2]| match torque > 0.0 {
        true => (noise / torque).sqrt(),
        false => 0.0,
    };
    sums.into_iter().map(share).collect()
}

/// Of every so many blocks of a log one is looked at; the variances of others are 0.
fn of_log(
    model: &RegressionModel,
    log: &Conditioned,
    every: usize,
    phi: &[f64],
    deviations: &[f64],
    gains: &[[f64; 3]; 3],
) -> Vec<Vec<f64>> {
    let n = log.joints();
    let samples = log.samples();
    let mut variance = vec![vec![0.0; samples]; n];
    let mut evaluator = model.evaluator();
    let (mut rows, mut motion) = (RegressionRows::default(), Vec::new());
    let own: Vec<Vec<f64>> = (0..n).map(|joint| model.of_joint(joint, phi)).collect();
    for first in (0..samples).step_by(BLOCK * every) {
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
