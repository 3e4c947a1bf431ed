//! Which effects: forward, with swaps and removals, judged by logs that were not fitted.

use super::candidate::{Candidate, starts};
use super::data::{Data, RowResponse};
use super::driven::stands_for;
use super::evidence::paired;
use super::problem::{Fitted, Problem};
use super::round::{closed, forward};
use super::state::{MOST_Z, Setting, State, Taken, Trial};

/// What a search is allowed, and asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchOptions {
    /// Most effects that are added.
    pub most_effects: usize,
    /// Standard errors by which an effect must lower the squares that are left of held-out logs.
    pub significance: f64,
    /// The share of what can still be explained that an effect must close, in squares.
    pub least_share: f64,
    /// Candidates that are fitted in each round, of all that are scored.
    pub refined: usize,
    /// What the turns of decoys begin with.
    pub seed: u64,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self { most_effects: 6, significance: 3.0, least_share: 0.1, refined: 10, seed: 1 }
    }
}

/// A candidate with what it would explain.
#[derive(Clone, Debug, PartialEq)]
pub struct Scored {
    /// Its number.
    pub candidate: usize,
    /// By how much the weighted squares that are left would fall, to first order.
    pub gain: f64,
    /// The values where that is most.
    pub values: Vec<f64>,
}

/// One step of a search, for a report.
#[derive(Clone, Debug)]
pub struct Step {
    /// The candidate that explained most.
    pub added: usize,
    /// The one that explains it together with this, where neither does alone.
    pub with: Option<usize>,
    /// Whether it was added: the last one of a search may not have been.
    pub is_taken: bool,
    /// By how much the weighted squares that are left of the training logs fall.
    pub gain: f64,
    /// The same of the best decoy, to first order.
    pub decoy: f64,
    /// Standard errors by which held-out logs are better.
    pub significance: f64,
    /// The share of what can be explained that it closes.
    pub share: f64,
    /// The gap of held-out logs with it.
    pub held_out_gap: f64,
    /// Standard errors by which held-out logs are better when the model is moved along them; none
    /// if it was not, or if that says nothing.
    pub in_motion: Option<f64>,
    /// The candidates that came next, with the held-out gap that each would have left.
    pub runners_up: Vec<(usize, f64)>,
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// What is left is noise.
    Floor,
    /// No candidate explains more than chance, or enough.
    NothingLeft,
    /// As many effects as are allowed were found.
    MostEffects,
}

/// What a search found.
pub struct Outcome {
    /// The nominal model, re-estimated.
    pub before: State,
    /// The model with what was found.
    pub after: State,
    /// What the candidates do to the training logs.
    pub screen: Screen,
    /// How it came about.
    pub steps: Vec<Step>,
    /// Why it ended.
    pub stop: Stop,
}

/// Rows that count as one: what is left is correlated over the time of the filter.
pub(super) const ROWS_PER_SAMPLE: f64 = 4.0;

/// Searches which candidates are missing. `watch` hears of every step.
pub fn search(
    setting: &Setting<'_>,
    options: &SearchOptions,
    watch: &mut dyn FnMut(&State),
) -> Outcome {
    let before = setting.state(&setting.given);
    let screen = Screen::new(setting, &before);
    let mut state = before.clone();
    let (mut steps, mut idle) = (Vec::new(), Vec::new());
    // Exchanges and removals must not lead round in circles.
    let mut seen = vec![state.candidates()];
    let stop = loop {
        watch(&state);
        if state.taken.len() >= setting.given.len() + options.most_effects {
            break Stop::MostEffects;
        }
        if idle.len() > options.refined || steps.len() >= 2 * options.most_effects {
            break Stop::NothingLeft;
        }
        let left = setting.held_out_squares(&state, &state.held_out_residual);
        let is_driven = state.held.iter().any(Option::is_some);
        if !is_driven && left.iter().all(|[left, noise]| left <= noise) {
            break Stop::Floor;
        }
        let Some((next, step)) =
            forward((setting, &screen), options, (&state, &idle), &before.held_out_residual)
        else {
            break Stop::NothingLeft;
        };
        if !step.is_taken {
            steps.push(step);
            break Stop::NothingLeft;
        }
        let swapped = swap((setting, &screen), options, setting.state(&next.taken));
        let next = without_idle(setting, &before.held_out_residual, swapped);
        // An effect that the model's own uncertainty makes idle is not tried again, nor is one that
        // leads back.
        if seen.contains(&next.candidates()) {
            idle.push(step.added);
            continue;
        }
        idle.clear();
        seen.push(next.candidates());
        state = next;
        steps.push(step);
    };
    let after = if state.taken.is_empty() { state } else { setting.settled(state) };
    Outcome { before, after, screen, steps, stop }
}

/// All candidates that are not `taken`, by what they would explain; as decoys, if they are turned.
pub fn score(
    setting: &Setting<'_>,
    screen: &Screen,
    (state, taken): (&State, &[Taken]),
    turn: Option<f64>,
) -> Vec<Scored> {
    let given = {
        let plain = Problem::new(setting.train, &state.deviation[0], &[]);
        plain.responses(&setting.fitted(taken), &state.torques[0])
    };
    let problem = Problem::new(setting.train, &state.deviation[0], &given);
    let own_cost = problem.least_cost(&[], MOST_Z);
    let best_of = |(candidate, starts): (usize, &Vec<(Vec<f64>, RowResponse)>)| {
        if taken.iter().any(|taken| taken.candidate == candidate) {
            return None;
        }
        let of_start = |(values, response): &(Vec<f64>, RowResponse)| {
            let turned = turn.map(|turn| response.turned(turn));
            let response = std::slice::from_ref(turned.as_ref().unwrap_or(response));
            let gain = own_cost - problem.least_cost(response, MOST_Z);
            Scored { candidate, gain, values: values.clone() }
        };
        let all = starts.iter().map(of_start).filter(|one| one.gain.is_finite());
        all.max_by(|a, b| a.gain.total_cmp(&b.gain))
    };
    let mut scored: Vec<Scored> = screen.responses.iter().enumerate().filter_map(best_of).collect();
    scored.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    scored
}

/// What every candidate does to the training logs from where its search begins.
pub struct Screen {
    /// For each candidate its starts with their responses in the rows.
    responses: Vec<Vec<(Vec<f64>, RowResponse)>>,
}

impl Screen {
    /// The starts of a candidate with their responses.
    pub(super) fn of(&self, candidate: usize) -> &[(Vec<f64>, RowResponse)] {
        &self.responses[candidate]
    }

    /// Evaluates all candidates on the motion, or coarse views of it.
    pub fn new(setting: &Setting<'_>, state: &State) -> Self {
        let problem = Problem::new(setting.train, &state.deviation[0], &[]);
        let (problem, torques) = match &setting.coarse {
            Some(coarse) => (problem.coarse(coarse), &state.coarse),
            None => (problem.coarse(&setting.train.signals), &state.torques[0]),
        };
        let of = |candidate: &Candidate| -> Vec<(Vec<f64>, RowResponse)> {
            let law = candidate.law.as_ref();
            let of_start = |values: Vec<f64>| {
                let fitted = [Fitted { law, values: values.clone() }];
                (values, problem.responses(&fitted, torques).remove(0))
            };
            let range = candidate.joint.map(|joint| range(setting.train, joint));
            let largest = candidate.joint.and_then(|joint| largest(setting.train, joint));
            starts(law.parameters(), range, largest).into_iter().map(of_start).collect()
        };
        Self { responses: setting.candidates.iter().map(of).collect() }
    }
}

/// The largest measured torque of a joint.
fn largest(data: &Data<'_>, joint: usize) -> Option<f64> {
    let own = data.stretches.iter().filter(|stretch| stretch.equation == joint);
    let all = own.flat_map(|stretch| &data.torque[stretch.first..stretch.first + stretch.rows]);
    all.map(|torque| torque.abs()).max_by(f64::total_cmp)
}

/// The least and the largest position of a joint.
pub(super) fn range(data: &Data<'_>, joint: usize) -> [f64; 2] {
    let all = data.signals.iter().flat_map(|signals| &signals.q[joint]);
    all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &q| [low.min(q), high.max(q)])
}

/// How many are fitted to the whole motion, of all that are fitted roughly; and how much more the
/// rough fits of others may leave that are fitted as well.
const FINE: usize = 3;
const ROUGHLY: f64 = 1.1;

/// The best scored candidates, each fitted together with what a state has; best first.
pub(super) fn refine(
    setting: &Setting<'_>,
    count: usize,
    state: &State,
    (problem, scored): (&Problem<'_>, &[Scored]),
) -> Vec<Trial> {
    let candidates = scored.iter().take(count).filter(|one| one.gain > 0.0);
    let of = |one: &Scored| Taken { candidate: one.candidate, values: one.values.clone() };
    let added: Vec<Vec<Taken>> = candidates.map(|one| vec![of(one)]).collect();
    fitted(setting, state, problem, &added)
}

/// Effects that are added to those of a state, fitted together with these; best first.
pub(super) fn fitted(
    setting: &Setting<'_>,
    state: &State,
    problem: &Problem<'_>,
    added: &[Vec<Taken>],
) -> Vec<Trial> {
    let samples = setting.train.rows() as f64 / ROWS_PER_SAMPLE;
    let rough = |added: &Vec<Taken>| {
        let taken = [state.taken.as_slice(), added].concat();
        let taken = setting.roughly(problem, state, &taken);
        // Judged on the whole motion, with the values as they are.
        setting.judged(problem, state, &taken)
    };
    let mut trials: Vec<Trial> = added.iter().map(rough).collect();
    let sort = |trials: &mut [Trial]| {
        trials.sort_by(|a, b| a.score(samples).total_cmp(&b.score(samples)));
    };
    sort(&mut trials);
    let mut least: Option<(f64, usize)> = None;
    for (place, trial) in trials.iter_mut().enumerate() {
        let is_near = least.is_none_or(|(cost, parameters)| {
            trial.cost() < ROUGHLY * cost && trial.parameters() <= parameters
        });
        if place < FINE || is_near {
            *trial = setting.trial(problem, state, &trial.taken);
            let own = (trial.cost(), trial.parameters());
            least = least.filter(|(cost, _)| *cost <= own.0).or(Some(own));
        }
    }
    sort(&mut trials);
    trials
}

/// By which share a held-out gap may be larger for a law with fewer parameters.
pub(super) const ALIKE: f64 = 0.03;

/// Standard errors from which on one name is worse than another.
pub(super) const DISTINCT: f64 = 2.5;

/// The share of what the best trial explains that one with fewer parameters may leave.
const LEAVES: f64 = 0.1;

/// The trial that explains most of held-out logs, or nearly that with fewer parameters; `idle` is
/// without it.
pub(super) fn best<'t>(
    setting: &Setting<'_>,
    state: &State,
    trials: &'t [Trial],
    idle: &Trial,
) -> Option<&'t Trial> {
    let by_cost = |a: &&Trial, b: &&Trial| a.held_out_cost().total_cmp(&b.held_out_cost());
    let least = trials.iter().min_by(by_cost)?;
    let most = alike([idle, least]);
    let alike = trials
        .iter()
        .filter(|trial| trial.held_out_cost() <= most && !is_worse(setting, state, trial, least));
    // A tilt of the base that is an offset of one joint is one direction in two numbers.
    let size = |trial: &Trial| (trial.parameters(), trial.numbers());
    alike.min_by(|a, b| size(a).cmp(&size(b)).then(by_cost(a, b)))
}

/// What a law may leave of held-out logs to be like another one, that is `least`.
pub(super) fn alike([idle, least]: [&Trial; 2]) -> f64 {
    let [none, least] = [idle, least].map(Trial::held_out_cost);
    // Joints that this is not about weigh in the whole, but not in what is explained.
    ((1.0 + ALIKE).powi(2) * least).min(least + LEAVES * (none - least).max(0.0))
}

/// Whether a trial is worse than another for sure, and by more than a parameter costs (Schwarz
/// 1978), of the logs that were fitted or of the others: laws that become each other differ by
/// little, but for sure; and what one log has may not happen in the other.
pub(super) fn is_worse(setting: &Setting<'_>, state: &State, trial: &Trial, than: &Trial) -> bool {
    let costs_more = |set: usize| {
        let of = |one: &Trial| setting.squares(set, state, one.residuals()[set]);
        let (of_trial, of_other, rows) = (of(trial), of(than), setting.rows(set));
        let all: f64 = rows.iter().sum();
        let own = of_trial.iter().zip(&of_other).zip(rows);
        let more =
            own.map(|(([a, noise], [b, _]), rows)| rows * (a - b) / noise.max(f64::MIN_POSITIVE));
        more.sum::<f64>() > ROWS_PER_SAMPLE * (all / ROWS_PER_SAMPLE).ln()
    };
    (costs_more(0) || costs_more(1))
        && paired(&trial.blocks.concat(), &than.blocks.concat()) >= DISTINCT
}

/// Exchanges effects for candidates that explain more in their place, or as much with fewer
/// parameters.
fn swap(
    (setting, screen): (&Setting<'_>, &Screen),
    options: &SearchOptions,
    mut state: State,
) -> State {
    let samples = setting.train.rows() as f64 / ROWS_PER_SAMPLE;
    for place in setting.given.len()..state.taken.len().saturating_sub(1) {
        let mut others = state.taken.clone();
        let own = others.remove(place);
        let rest = setting.state(&others);
        let scored = score(setting, screen, (&rest, &rest.taken), None);
        let problem = Problem::new(setting.train, &state.deviation[0], &[]);
        // Weighed as the others are: by what is left without it.
        let now = setting.trial(&problem, &rest, &state.taken);
        let trials = refine(setting, options.refined, &rest, (&problem, &scored));
        let idle = setting.trial(&problem, &rest, &rest.taken);
        let is_other =
            |trial: &&Trial| trial.taken.last().is_some_and(|last| last.candidate != own.candidate);
        let is_driven = stands_for(setting, [&idle, &now]);
        let stands = |trial: &&Trial| !is_driven || stands_for(setting, [&idle, trial]);
        let is_better = |trial: &&Trial| {
            paired(&now.blocks.concat(), &trial.blocks.concat()) > options.significance
                && trial.score(samples) < now.score(samples)
        };
        let better =
            best(setting, &state, &trials, &idle).filter(is_other).filter(is_better).filter(stands);
        let is_simpler = |trial: &&Trial| {
            trial.parameters() < now.parameters() && !is_worse(setting, &state, trial, &now)
        };
        let simplest = trials.iter().filter(is_other).filter(is_simpler).filter(stands);
        let simplest = simplest.min_by_key(|trial| trial.parameters());
        if let Some(best) = better.or(simplest) {
            state = setting.state(&best.taken);
        }
    }
    state
}

/// The least share of what could be explained at its joints in the beginning that an effect must
/// close, or else of what would be left without it.
const IDLE: f64 = 0.05;
const IDLE_OF_REST: f64 = 0.3;

/// Takes effects out that the others have made idle, the idlest first.
fn without_idle(setting: &Setting<'_>, before: &[f64], mut state: State) -> State {
    let samples = setting.train.rows() as f64 / ROWS_PER_SAMPLE;
    while state.taken.len() > setting.given.len() + 1 {
        let problem = Problem::new(setting.train, &state.deviation[0], &[]);
        let now = setting.trial(&problem, &state, &state.taken);
        let squares = |left: &[f64]| setting.held_out_squares(&state, left);
        let (from, then) = (squares(before), squares(&now.held_out_residual));
        let mut idlest: Option<(f64, Vec<Taken>)> = None;
        for place in setting.given.len()..state.taken.len() {
            let mut others = state.taken.clone();
            others.remove(place);
            let less = setting.trial(&problem, &state, &others);
            // Rows are weighted by what is left of them: squares count as those of unit noise.
            let worth = (less.cost() - now.cost()) / ROWS_PER_SAMPLE;
            let parameters = now.parameters().saturating_sub(less.parameters()) as f64;
            let [share, of_rest] = closed(&from, &squares(&less.held_out_residual), &then);
            let is_small = share < IDLE && of_rest < IDLE_OF_REST;
            let is_idle = (worth <= parameters * samples.ln() || is_small)
                && !stands_for(setting, [&less, &now]);
            if is_idle && idlest.as_ref().is_none_or(|(least, _)| worth < *least) {
                idlest = Some((worth, others));
            }
        }
        let Some((_, others)) = idlest else { break };
        state = setting.state(&others);
    }
    state
}
