//! Whether one model is better than another: paired by blocks of time, since what is left of
//! torques is correlated from sample to sample.

use super::data::Data;
use crate::policy::blocks::BLOCK_S;

const LEAST_BLOCKS: usize = 16;

/// The block of time of each row, and the number of blocks: all joints of a block together.
pub(super) fn blocks(data: &Data<'_>) -> (Vec<usize>, usize) {
    let (mut of_row, mut first) = (vec![0; data.rows()], 0);
    for (log, signals) in data.signals.iter().enumerate() {
        let rows = signals.rows();
        let by_time = (rows as f64 * signals.row_step_s() / BLOCK_S) as usize;
        let count = by_time.max(LEAST_BLOCKS).min(rows.max(1));
        for stretch in data.stretches.iter().filter(|stretch| stretch.log.0 == log) {
            for row in 0..stretch.rows {
                of_row[stretch.first + row] = first + row * count / stretch.rows;
            }
        }
        first += count;
    }
    (of_row, first)
}

/// Sums of squares of what is left, weighted, over blocks of time.
pub(super) fn block_costs(data: &Data<'_>, residual: &[f64], deviation: &[f64]) -> Vec<f64> {
    let (of_row, count) = blocks(data);
    let mut costs = vec![0.0; count];
    for ((block, residual), deviation) in of_row.iter().zip(residual).zip(deviation) {
        costs[*block] += (residual / deviation).powi(2);
    }
    costs
}

/// How many standard errors the costs `worse` are above `better`, from the differences of blocks.
pub(super) fn paired(worse: &[f64], better: &[f64]) -> f64 {
    let differences: Vec<f64> = worse.iter().zip(better).map(|(a, b)| a - b).collect();
    let count = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / count;
    let variance =
        differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    match variance > 0.0 {
        true => mean / (variance / count).sqrt(),
        false => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Student's sleep data: of ten differences the mean is 1.58 with t = 4.06 at 9 degrees of
    /// freedom.
    #[test]
    fn differences_of_students_sleepers() {
        let less = [0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0];
        let more = [1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4];
        assert!((paired(&more, &less) - 4.0621).abs() < 1e-3);
    }
}
