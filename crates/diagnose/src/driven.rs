//! Numbers of the model that logs would move beyond what the model says of them.
//!
//! They take up what a body lacks whose errors are larger than stated: what is left of the logs
//! then hardly shows it, while the model's own deviations do. These are measurements as well.

use super::evidence::paired;
use super::search::{DISTINCT, ROWS_PER_SAMPLE};
use super::state::{MOST_Z, Setting, Taken, Trial};

/// Whether numbers of the model are driven without an effect on a body, are not with it, and say,
/// with what is left of the logs, that it is there, while held-out logs do not say otherwise. Any
/// other effect would stand for a law that does not quite fit, as the numbers do.
pub(super) fn stands_for(setting: &Setting<'_>, [without, with]: [&Trial; 2]) -> bool {
    let is_driven = |trial: &Trial| trial.found.z.iter().any(|z| z.abs() >= MOST_Z);
    let is_added =
        |one: &&Taken| without.taken.iter().all(|other| other.candidate != one.candidate);
    let mut added = with.taken.iter().filter(is_added);
    added.any(|one| setting.candidates[one.candidate].is_body)
        && is_driven(without)
        && !is_driven(with)
        && evidence(setting, [without, with]) > 0.0
        && paired(&without.blocks[1], &with.blocks[1]) > -DISTINCT
}

/// What speaks for an effect, in squares of deviations: what the numbers of the model and the logs
/// that are fitted are off by less, for its parameters (Schwarz 1978).
pub(super) fn evidence(setting: &Setting<'_>, [without, with]: [&Trial; 2]) -> f64 {
    let samples = setting.train.rows() as f64 / ROWS_PER_SAMPLE;
    let squares = |trial: &Trial| {
        let of_model: f64 = trial.found.z.iter().map(|z| z * z).sum();
        of_model + trial.blocks[0].iter().sum::<f64>() / ROWS_PER_SAMPLE
    };
    let parameters = with.parameters().saturating_sub(without.parameters()) as f64;
    squares(without) - squares(with) - parameters * samples.ln()
}
