//! One round of a search: which effect is added to a state, if any.

use super::data::RowResponse;
use super::driven::{evidence, stands_for};
use super::evidence::{by_ranks, paired};
use super::gap::Gap;
use super::problem::Problem;
use super::search::{
    DISTINCT, ROWS_PER_SAMPLE, Scored, Screen, SearchOptions, Step, best, fitted, refine, score,
};
use super::state::{MOST_Z, Setting, State, Taken, Trial};

/// A share of what can be explained that is found at two standard errors.
const LARGE: f64 = 0.2;

/// A joint with less than so many times the squares of noise has nothing to explain.
pub(super) const QUIET: f64 = 1.3;

/// Standard errors by which a model may move worse along held-out logs with an effect.
const WORSE_IN_MOTION: f64 = 1.0;

/// The share of what is left above noise there that an effect must close.
const OF_QUIET: f64 = 0.5;

/// A trial that leaves less than this share of the weighted squares of logs that are fitted has
/// other weights.
const OTHER_WEIGHTS: f64 = 0.6;

/// The share of what stays at a joint by which it changes by chance with whatever is fitted.
const BY_CHANCE: f64 = 1e-3;

/// The noise of a joint, which is hardly more than what is left of it `then`: laps in which a drive
/// sticks by chance differ by more than noise.
fn noise([left, noise]: [f64; 2]) -> f64 {
    noise.min(QUIET * left)
}

/// By how much squares have become less at a joint, in units of noise. Logs that have hardly any
/// show a drive that sticks as many times that: what changes by chance is the unit there.
fn falls([before, noise]: [f64; 2], after: f64, [then, _]: [f64; 2]) -> f64 {
    (before - after) / noise.max(BY_CHANCE * then).max(f64::MIN_POSITIVE)
}

/// The shares that are closed of what could be explained in the beginning, and now, at the joints
/// that this is about: those with a tenth of what one of them has.
pub(super) fn closed(from: &[[f64; 2]], now: &[[f64; 2]], then: &[[f64; 2]]) -> [f64; 2] {
    let closed: Vec<f64> =
        now.iter().zip(then).map(|(now, then)| falls(*now, then[0], *then)).collect();
    let most = closed.iter().copied().fold(0.0, f64::max);
    let own = || (0..closed.len()).filter(|&joint| closed[joint] > 0.1 * most);
    let sum: f64 = own().map(|joint| closed[joint]).sum();
    [from, now].map(|all| {
        let excess = |joint: usize| falls(all[joint], noise(then[joint]), then[joint]).max(0.0);
        let excess: f64 = own().map(excess).sum();
        if excess > 0.0 { sum / excess } else { 0.0 }
    })
}

/// The effect that explains most of what is left, if it is more than chance; else the best one of
/// another joint that is, or two of one joint. If none is, the first of them.
pub(super) fn forward(
    (setting, screen): (&Setting<'_>, &Screen),
    options: &SearchOptions,
    (state, idle): (&State, &[usize]),
    before: &[f64],
) -> Option<(Trial, Step)> {
    let mut scored = score(setting, screen, (state, &state.taken), None);
    scored.retain(|one| !idle.contains(&one.candidate));
    let problem = Problem::new(setting.train, &state.deviation[0], &[]);
    let mut trials = refine(setting, options.refined, state, (&problem, &scored));
    let idle = setting.trial(&problem, state, &state.taken);
    let round = Round { setting, screen, options, state, before, idle: &idle };
    let (all, mut first) = (trials.clone(), None);
    while let Some(best) = best(setting, state, &trials, &idle).cloned() {
        let step = round.judged(&best, &trials);
        let joint = setting.candidates[step.added].joint;
        if step.is_taken {
            return Some((best, step));
        }
        first = first.or(Some((best, step)));
        trials.retain(|trial| round.joint(trial) != joint);
    }
    if let Some(found) = round.driven(&all) {
        return Some(found);
    }
    let pairs = fitted(setting, state, &problem, &round.pairs(&problem, &scored));
    let pair = best(setting, state, &pairs, &idle).cloned();
    let weighed = pair.map(|pair| (round.judged(&pair, &pairs), pair));
    let taken = weighed.filter(|(step, _)| step.is_taken);
    taken.map(|(step, pair)| (pair, step)).or(first)
}

/// Effects of a joint that are paired: those that would explain most alone.
const PAIRED: usize = 7;

/// Pairs that are fitted.
const MOST_PAIRS: usize = 3;

/// One round of a search: a state to which an effect may be added.
struct Round<'r, 's> {
    setting: &'r Setting<'s>,
    screen: &'r Screen,
    options: &'r SearchOptions,
    state: &'r State,
    /// What was left of held-out logs before the search.
    before: &'r [f64],
    /// The state as a trial.
    idle: &'r Trial,
}

impl Round<'_, '_> {
    fn added(trial: &Trial) -> usize {
        trial.taken.last().expect("an effect was added").candidate
    }

    fn joint(&self, trial: &Trial) -> Option<usize> {
        self.setting.candidates[Self::added(trial)].joint
    }

    /// What chance explains where `best` acts: of what would be left with it, since turned by some
    /// share of the log it may still be like itself.
    fn decoy(&self, best: &Trial) -> f64 {
        let Self { setting, screen, options, state, .. } = self;
        let turn = 0.2 + 0.6 * unit(options.seed, state.taken.len());
        let decoys = score(setting, screen, (state, &best.taken), Some(turn));
        let joint = self.joint(best);
        let is_there =
            |one: &&Scored| joint.is_none() || setting.candidates[one.candidate].joint == joint;
        decoys.iter().find(is_there).map_or(0.0, |best| best.gain)
    }

    /// The pairs of effects in one joint that would explain most together, to first order.
    fn pairs(&self, problem: &Problem<'_>, scored: &[Scored]) -> Vec<Vec<Taken>> {
        let Self { setting, screen, state, .. } = self;
        let given = problem.responses(&setting.fitted(&state.taken), &state.torques[0]);
        let problem = Problem::new(setting.train, &state.deviation[0], &given);
        let now = setting.held_out_squares(state, &self.idle.held_out_residual);
        let response = |one: &Scored| {
            let mut starts = screen.of(one.candidate).iter();
            starts.find(|(values, _)| *values == one.values).map(|(_, response)| response.clone())
        };
        let mut pairs: Vec<(f64, [&Scored; 2])> = Vec::new();
        let joints = setting.train.nominal.model.joints.len();
        let has_more = |equation: usize| now[equation][0] >= QUIET * now[equation][1];
        let of_spring = |joint| setting.train.nominal.spring_equation(joint).is_some_and(has_more);
        for joint in (0..joints).filter(|&joint| has_more(joint) || of_spring(joint)) {
            let own = scored.iter().filter(|one| {
                setting.candidates[one.candidate].joint == Some(joint) && one.gain > 0.0
            });
            let own: Vec<(&Scored, RowResponse)> =
                own.filter_map(|one| Some((one, response(one)?))).take(PAIRED).collect();
            for (place, (a, of_a)) in own.iter().enumerate() {
                for (b, of_b) in &own[place + 1..] {
                    let cost = problem.least_cost(&[of_a.clone(), of_b.clone()], MOST_Z);
                    pairs.push((cost, [a, b]));
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let taken = |one: &Scored| Taken { candidate: one.candidate, values: one.values.clone() };
        pairs.iter().take(MOST_PAIRS).map(|(_, pair)| pair.map(taken).to_vec()).collect()
    }

    /// Torques that are right for the wrong reason move the robot otherwise. What was computed with
    /// the model's numbers needs those that go with the effect, which are estimated again.
    fn in_motion(&self, best: &Trial) -> Option<f64> {
        let Self { setting, state, .. } = self;
        let next = setting.state(&best.taken);
        setting.in_motion((&state.taken, &state.z), (&next.taken, &next.z))
    }

    /// The effect that numbers of the model stand for that are driven, of all `trials`.
    fn driven(&self, trials: &[Trial]) -> Option<(Trial, Step)> {
        let Self { setting, idle, .. } = self;
        let stands = trials.iter().filter(|trial| stands_for(setting, [idle, trial]));
        let evidence = |trial: &&Trial| evidence(setting, [idle, trial]);
        let best = stands.max_by(|a, b| evidence(a).total_cmp(&evidence(b)))?;
        let in_motion = self.in_motion(best);
        // The numbers that are driven move it as well as the effect does, but for chance.
        let is_taken = in_motion.is_none_or(|better| better > -DISTINCT);
        is_taken.then(|| (best.clone(), Step { in_motion, is_taken, ..self.weigh(best, trials) }))
    }

    /// Whether a trial is more than chance, against all `trials`.
    fn judged(&self, best: &Trial, trials: &[Trial]) -> Step {
        let Self { setting, state, idle, .. } = self;
        let step = self.weigh(best, trials);
        if step.is_taken || best.found.cost > OTHER_WEIGHTS * idle.found.cost {
            return step;
        }
        // Weights of what is left without it let the model's own numbers be.
        let next = setting.state(&best.taken);
        let problem = Problem::new(setting.train, &next.deviation[0], &[]);
        let [idle, best] = [&state.taken, &best.taken].map(|of| setting.trial(&problem, &next, of));
        Round { state: &State { taken: state.taken.clone(), ..next }, idle: &idle, ..*self }
            .weigh(&best, trials)
    }

    /// The same with the weights of the state.
    fn weigh(&self, best: &Trial, trials: &[Trial]) -> Step {
        let Self { setting, options, state, idle, .. } = self;
        let [worse, better] = [&idle.blocks[1], &best.blocks[1]];
        let significance = paired(worse, better).max(by_ranks(worse, better));
        let added = Self::added(best);
        let [gain, decoy] = [idle.found.cost - best.found.cost, self.decoy(best)];
        let [_, trust] = state.trust();
        let held_out_gap = |left: &[f64]| Gap::new(setting.held_out, left, &trust).all;
        let of = |left: &[f64]| setting.held_out_squares(state, left);
        let [from, now, then] =
            [self.before, &idle.held_out_residual, &best.held_out_residual].map(of);
        let [share, of_rest] = closed(&from, &now, &then);
        let is_noise = |joint: usize| now[joint][0] < QUIET * noise(then[joint]);
        let closed_at = |joint: usize| falls(now[joint], then[joint][0], then[joint]);
        let most = (0..now.len()).max_by(|&a, &b| closed_at(a).total_cmp(&closed_at(b)));
        let mut runners_up: Vec<(usize, f64)> = trials
            .iter()
            .filter(|trial| Self::added(trial) != added)
            .map(|trial| (Self::added(trial), held_out_gap(&trial.held_out_residual)))
            .collect();
        runners_up.sort_by(|a, b| a.1.total_cmp(&b.1));
        let is_quiet = most.is_some_and(is_noise);
        // Blocks in which another missing effect weighs scatter much: a large share needs less.
        let asked = if share > LARGE && !is_quiet { 2.0 } else { options.significance };
        let samples = setting.train.rows() as f64 / ROWS_PER_SAMPLE;
        let parameters = best.parameters().saturating_sub(idle.parameters()) as f64;
        let is_more =
            gain > decoy.max(ROWS_PER_SAMPLE * parameters * samples.ln()) && significance > asked;
        let least_share = if is_quiet { OF_QUIET } else { options.least_share };
        let is_enough = is_more && of_rest >= least_share;
        let in_motion = is_enough.then(|| self.in_motion(best)).flatten();
        let before = &best.taken[state.taken.len()..best.taken.len() - 1];
        Step {
            added,
            with: before.first().map(|one| one.candidate),
            is_taken: is_enough && in_motion.is_none_or(|better| better > -WORSE_IN_MOTION),
            gain,
            decoy,
            significance,
            share,
            held_out_gap: held_out_gap(&best.held_out_residual),
            in_motion,
            runners_up,
        }
    }
}

/// A number from 0 to 1 of a seed and a round.
fn unit(seed: u64, round: usize) -> f64 {
    let mut random = denavit_numerics::Random::new(seed);
    (0..=round).map(|_| random.uniform()).last().unwrap_or(0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A joint that misses much is weighed little: its squares are few, and those that another
    /// joint loses by chance are as many.
    #[test]
    fn what_is_closed_counts_in_units_of_noise() {
        let now = [[1000.0, 850.0], [32.0, 2.0]];
        let then = [[970.0, 850.0], [5.0, 2.0]];
        let from = [[1000.0, 850.0], [62.0, 2.0]];
        let [share, of_rest] = closed(&from, &now, &then);
        assert!((share - 27.0 / 60.0).abs() < 1e-12 && (of_rest - 0.9).abs() < 1e-12);
    }

    /// Without noise in the logs a joint that sticks leaves 10^8 times its floor: a ten thousandth
    /// of that is chance, though it is many times what another joint misses.
    #[test]
    fn what_sticks_without_noise_is_no_unit() {
        let now = [[1e8, 1.0], [32.0, 2.0]];
        let then = [[1e8 - 1e4, 1.0], [5.0, 2.0]];
        let [share, of_rest] = closed(&now, &now, &then);
        assert!((share - 0.9).abs() < 1e-12 && (of_rest - 0.9).abs() < 1e-12);
        let then = [[1e7, 1.0], [32.0, 2.0]];
        let [share, _] = closed(&now, &now, &then);
        assert!((share - 0.9).abs() < 1e-6, "{share}");
    }
}
