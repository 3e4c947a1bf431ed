//! Logs of which noise of the positions makes most, and those that bias parameters by it.

use super::estimate::{Estimate, IdentifiedParameter, NoiseOfLog};
pub(super) use crate::policy::noisy_logs::MOST;
use crate::policy::noisy_logs::SHARE;
use denavit_measure::LogIndex;
use denavit_measure::condition::Conditioned;
use denavit_plants::regression::RegressionModel;

/// Of several logs those of which noise makes most: the largest share of it in what each shows of a
/// direction of the parameters by itself.
pub(super) fn noisy_logs(logs: &[Conditioned], found: &Estimate) -> Vec<(String, f64)> {
    let both = logs.iter().zip(&found.noise_of_logs);
    let noisy = both.filter(|(_, one)| logs.len() > 1 && one.share > MOST);
    noisy.map(|(log, one)| (log.file.clone(), one.share)).collect()
}

/// The logs for an estimate of which noise does not make most; all if it does of all.
pub(super) fn shown_logs(logs: usize, found: &Estimate) -> Vec<LogIndex> {
    let share = |log: LogIndex| found.noise_of_logs.get(log.0).map_or(0.0, |one| one.share);
    let all = (0..logs).map(LogIndex);
    let shown: Vec<LogIndex> = all.clone().filter(|&log| share(log) <= MOST).collect();
    if shown.is_empty() { all.collect() } else { shown }
}

/// For each log whether it has its share of a bias, so that it needs a lower filter; all if noise
/// makes most of all.
pub(super) fn biasing_logs(
    model: &RegressionModel,
    listed: &[IdentifiedParameter],
    found: &Estimate,
) -> Vec<bool> {
    let biased = |at: &usize| listed[*at].is_biased_without_change();
    let biased: Vec<usize> = (0..listed.len()).filter(biased).collect();
    let all = model.to_listed() * &found.noise_bias;
    let noisy = found.noise_of_logs.iter().filter(|one| one.share > 0.0).count().max(1) as f64;
    let has_part = |one: &NoiseOfLog| {
        let own = model.to_listed() * &one.bias;
        let is_part = |&at: &usize| own[at] * all[at].signum() * noisy >= SHARE * all[at].abs();
        found.noise_share > MOST || (one.share > 0.0 && biased.iter().any(is_part))
    };
    found.noise_of_logs.iter().map(has_part).collect()
}
