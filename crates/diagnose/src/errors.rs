//! Errors of the parameters of effects: of noise, of what is left of the logs, of the filter.

use super::data::Data;
use super::evidence::blocks;
use super::floor::NoiseFloor;
use super::problem::Problem;
use super::state::{Setting, State};
use nalgebra::DMatrix;

/// Errors of all parameters of a state's effects, in order.
pub(super) struct Errors {
    /// Standard deviations; infinite where the logs say nothing.
    pub(super) deviations: Vec<f64>,
    /// How far values are from what held-out logs alone give them, in the errors of both.
    pub(super) moves: Vec<f64>,
}

/// The errors of a state's effects; `smoother` are the logs for training through lower filters.
///
/// Values that differ in another motion by more than both errors have these too small, by that
/// factor if it is one (Birge 1932).
pub(super) fn errors(setting: &Setting<'_>, state: &State, smoother: Option<&Data<'_>>) -> Errors {
    let own = deviations(setting, state, smoother);
    let moves = if own.is_empty() { Vec::new() } else { moves(setting, state, &own) };
    let both = own.iter().zip(&moves);
    let deviations = both.map(|(std, moved)| std * moved.abs().max(1.0)).collect();
    Errors { deviations, moves }
}

/// Standard deviations by logs for training.
///
/// What noise alone makes of values differs between two filters by the difference of their
/// variances (Hausman 1978). What they differ by beyond that is an error of both: of friction that
/// sticks, of corners that a filter moves, of noise in the columns.
fn deviations(setting: &Setting<'_>, state: &State, smoother: Option<&Data<'_>>) -> Vec<f64> {
    let own = of_rows(setting, state);
    let Some(train) = smoother.filter(|_| !own.is_empty()) else { return own };
    let floor = NoiseFloor::of_logs(train.nominal, &train.signals);
    let there = elsewhere(setting, state, (train, &floor));
    let apart = state.values().into_iter().zip(there).map(|(a, [b, std])| ((a - b).powi(2), std));
    let both = own.iter().zip(apart).map(|(own, (apart, theirs))| ((own, theirs), apart));
    let of = |((own, theirs), apart): ((&f64, f64), f64)| {
        let of_noise = (theirs.powi(2) - own.powi(2)).max(0.0);
        let more = (apart - of_noise).max(0.0);
        // Where a lower filter leaves nothing of an effect it says nothing of its error.
        if theirs.is_finite() { (own.powi(2) + more).sqrt() } else { *own }
    };
    both.map(of).collect()
}

/// The values of a state's effects by other logs, with their standard deviations.
fn elsewhere(
    setting: &Setting<'_>,
    state: &State,
    (logs, floor): (&Data<'_>, &[NoiseFloor]),
) -> Vec<[f64; 2]> {
    let there = Setting {
        train: logs,
        held_out: logs,
        candidates: setting.candidates,
        given: setting.given.clone(),
        moved: None,
        coarse: None,
        train_floor: floor,
        held_out_floor: floor,
    };
    let found = there.settled(there.state(&state.taken));
    let deviations = of_rows(&there, &found);
    found.values().into_iter().zip(deviations).map(|(value, std)| [value, std]).collect()
}

/// How far the values of a state's effects are from what held-out logs alone give them, in their
/// errors: another law than what is there has other values in another motion (Chow 1960).
fn moves(setting: &Setting<'_>, state: &State, deviations: &[f64]) -> Vec<f64> {
    let there = elsewhere(setting, state, (setting.held_out, setting.held_out_floor));
    let both = state.values().into_iter().zip(deviations).zip(there);
    both.map(|((own, std), [other, of_other])| (own - other) / std.hypot(of_other)).collect()
}

/// Standard deviations by what is left of the rows.
///
/// With N the normal equations beyond what the model is not sure of, the covariance is N^-1 if
/// what is left is noise. What is left of a wrong model is correlated over rows and joints: the
/// sums of (column x what is left) over blocks of time then have the covariance S, and the
/// parameters N^-1 (N - T + S) N^-1, T being what rows have of N; the rest of it are the model's
/// own deviations (Huber 1967; Liang, Zeger 1986, blocks in place of persons). The larger one of
/// both is stated.
fn of_rows(setting: &Setting<'_>, state: &State) -> Vec<f64> {
    let laws = setting.fitted(&state.taken);
    let problem = Problem::new(setting.train, &state.deviation[0], &[]).holding(&state.held);
    let responses = problem.responses(&laws, &state.torques[0]);
    let normal = problem.look(&responses).believing(&laws).normal;
    let columns = problem.beyond_z(&responses);
    let width = columns.ncols();
    let (of_row, count) = blocks(setting.train);
    let mut sums = DMatrix::zeros(count, width);
    for (row, block) in of_row.iter().enumerate() {
        let left = state.residual[row] / state.deviation[0][row];
        for place in 0..width {
            sums[(*block, place)] += columns[(row, place)] * left;
        }
    }
    // As many sums are 0 as there are parameters.
    let free = count as f64 / count.saturating_sub(width).max(1) as f64;
    let seen = sums.tr_mul(&sums) * free + &normal - columns.tr_mul(&columns);
    let scale: Vec<f64> =
        (0..width).map(|k| normal[(k, k)].max(f64::MIN_POSITIVE).sqrt().recip()).collect();
    let scaled = |matrix: &DMatrix<f64>| {
        DMatrix::from_fn(width, width, |a, b| matrix[(a, b)] * scale[a] * scale[b])
    };
    let regular = scaled(&normal) + DMatrix::identity(width, width) * 1e-12;
    let Some(inverse) = regular.try_inverse() else { return vec![f64::INFINITY; width] };
    let both = &inverse * scaled(&seen) * &inverse;
    let of = |k: usize| scale[k] * both[(k, k)].max(inverse[(k, k)]).max(0.0).sqrt();
    (0..width).map(of).collect()
}
