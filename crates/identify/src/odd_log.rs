//! The log of several that is unlike the others.

use super::estimate::Estimate;
use denavit_measure::{LogIndex, PartIndex};
use denavit_numerics::least_squares::{Solution, Triangle, solve};
use denavit_plants::regression::RegressionModel;

/// Of several logs the one, of those that are asked, without which the others agree best, and what
/// the others say.
pub(super) fn odd_log(
    model: &RegressionModel,
    asked: &[LogIndex],
    logs: &[LogIndex],
    found: &Estimate,
) -> Option<(LogIndex, Solution)> {
    let condensed = &found.condensed;
    if logs.len() < 2 || condensed.rank != model.rank() {
        return None;
    }
    // weighted by log, a log that is odd would count for little
    let weights = vec![found.weights_of_joints(); condensed.independent.len()];
    let without = |log: LogIndex| {
        let parts = (0..condensed.parts.len()).map(PartIndex);
        let others = parts.filter(|part| condensed.log_of_part[part.0] != log);
        let triangles = condensed.merged(others);
        let r = condensed.system(&triangles, &weights, &[]);
        let solution = solve(&r, found.solution.phi.as_slice());
        // of rows that are weighted, the last of R is what is left
        let rows: usize = triangles.iter().flatten().map(Triangle::rows).sum();
        let left = r[(condensed.rank, condensed.rank)].powi(2);
        (left / rows.max(1) as f64, log, solution)
    };
    let least = asked.iter().copied().map(without).min_by(|a, b| a.0.total_cmp(&b.0));
    least.map(|(_, log, solution)| (log, solution))
}
