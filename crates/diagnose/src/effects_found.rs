//! What is said of effects: those that were found, with what would do as well, and those that the
//! model has.

use super::candidate::Candidate;
use super::error::Error;
use super::experiment::{Ambiguity, Experiment};
use super::gap::Gap;
use super::given::is_driven;
use super::hypothesis::Hypothesis;
use super::law_curve::LawCurve;
use super::rounds::{Found, Rival};
use super::search::Search;
use super::signals::Filters;
use super::state::{MOST_Z, Setting, State};
use super::weighing::{Placed, Weighing};
use denavit_codegen::alias::{ExactAliases, Named};
use denavit_codegen::model::Robot;
use denavit_evidence::policy;
use denavit_plants::effect::LawParameter;

/// A parameter of an effect, with its error.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectValue {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its standard deviation.
    pub std: f64,
    /// Its unit.
    pub unit: String,
}

/// An effect that would do as well in the place of one that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// The candidate.
    pub candidate: usize,
    /// The log of the odds of the one that was found against it.
    pub log_odds: f64,
    /// Whether no motion could tell the two apart: by the symbolic regressor.
    pub is_exact: bool,
}

/// An effect that was found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FoundEffect {
    /// Its number among the candidates.
    pub candidate: usize,
    /// Its parameters.
    pub parameters: Vec<EffectValue>,
    /// The log of the odds that it is there and not nothing in its place.
    pub log_odds: f64,
    /// What it does at the joint where that is most, as a share of its torque.
    pub size: f64,
    /// The same with the values of the logs for training.
    pub(super) trained: f64,
    /// Whether no motion of these has it act, so that all logs gave its values.
    pub is_untrained: bool,
    /// The same in held-out logs.
    pub(super) judged: f64,
    /// The share of what can be explained that is open again without it, on held-out logs; 0 where
    /// nothing can.
    pub share: f64,
    /// By how much more likely held-out logs are with it, as those that were fitted have it: a log
    /// of odds.
    pub log_predicted: f64,
    /// The joint or spring at which something without a name does what it is there for, if so.
    pub stands_for: Option<String>,
    /// Whether it fits: else it is only the nearest of the catalogue to something without a name.
    pub is_named: bool,
    /// Effects that would do as well in its place.
    pub alternatives: Vec<Alternative>,
    /// Finer forms of it that would: the logs do not ask for what they have more.
    pub finer: Vec<Alternative>,
    /// Parameters of the model that do exactly what it does, together, whatever the motion; none
    /// where there are no such.
    pub exact: Vec<String>,
    /// A motion that would tell it from these, or why there is none; none if it was not asked for,
    /// or if nothing is to be told apart.
    pub experiment: Option<Result<Experiment, Error>>,
    /// What it adds over what it depends on; none where it adds nothing to held-out logs.
    pub curve: Option<LawCurve>,
}

impl FoundEffect {
    /// Whether logs that its values were not fitted to speak against it, or do not ask for it
    /// though it acts there and is none that every drive has; or those that they were fitted to
    /// ask for nothing of it, so that the others alone show it.
    fn is_idle(&self, candidates: &[Candidate]) -> bool {
        let acts = self.judged > policy::WORTH;
        let is_asked = acts && !candidates[self.candidate].is_standard();
        let least = if is_asked { policy::NAMED } else { -policy::NAMED };
        self.log_predicted < least || self.trained < policy::WORTH
    }
}

/// The effect that held-out logs ask for least of those that are idle.
pub(super) fn idle(effects: &[FoundEffect], candidates: &[Candidate]) -> Option<usize> {
    let idle = (0..effects.len()).filter(|&place| effects[place].is_idle(candidates));
    idle.min_by(|&a, &b| effects[a].log_predicted.total_cmp(&effects[b].log_predicted))
}

/// An effect that the model has.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenEffect {
    /// Its number among the candidates.
    pub candidate: usize,
    /// Its parameters, estimated again.
    pub parameters: Vec<EffectValue>,
}

/// The effects of the state after, each with its share, errors and rivals, from that before, what
/// all logs say of them, and held-out logs alone.
pub(super) fn found_effects(
    setting: &Setting<'_>,
    search: &Search<'_>,
    judging: &Weighing<'_>,
    (found, by_all): (&Found, &Hypothesis),
    [before, after]: [&State; 2],
) -> Vec<FoundEffect> {
    let held_out = setting.data.held_out;
    let known = |row: usize| held_out.weights[row];
    let gap = |state: &State| Gap::new(held_out, &state.residual.held_out, &known).all;
    let floor = Gap::of_floor(held_out, setting.floors.held_out, &known).all;
    // Where all was below the floor already, of what the effects closed, if they did.
    let whole = (gap(before) - floor).max(gap(before) - gap(after));
    let share = |part: f64| if whole > 0.0 { part / whole } else { 0.0 };
    let given = setting.given.len();
    let all = &found.after;
    let predicted =
        |state: &State, by_all: &Hypothesis| setting.predicted(judging, state, by_all).1.posterior;
    let with_all = predicted(after, by_all);
    let of = |place: usize| {
        let without = search.settled(all.without(place), Some(all));
        let taken = &after.taken[given + place];
        let reopened = setting.state(&without, &before.z);
        let errors = setting.errors(after, by_all, place);
        let own = &setting.candidates[taken.candidate];
        // what the logs ask for is a rival, however fine
        let is_finer = |one: &Alternative| {
            setting.candidates[one.candidate].is_finer_than(own) && one.log_odds > -policy::NAMED
        };
        // what else would do, the most likely first
        let rivals = found.rivals.get(place).into_iter().flatten();
        let near = rivals.filter(|one| one.log_odds < policy::RIVAL).map(|one| {
            let (candidate, log_odds) = (one.placed.candidate, one.log_odds);
            Alternative { candidate, log_odds, is_exact: false }
        });
        let (finer, alternatives) = near.partition(is_finer);
        FoundEffect {
            candidate: taken.candidate,
            log_odds: all.posterior - without.posterior,
            size: search.size(all, place),
            trained: search.weighing.size(taken),
            is_untrained: after.untrained.contains(&place),
            judged: judging.size(taken),
            share: share(gap(&reopened) - gap(after)),
            log_predicted: with_all - predicted(&reopened, &without),
            parameters: values(setting, after, given + place, |k| errors[k]),
            alternatives,
            finer,
            curve: LawCurve::of(setting, after, taken),
            ..FoundEffect::default()
        }
    };
    (0..all.parts.len()).map(of).collect()
}

/// The parameters of an effect of a state, each with an error.
fn values(
    setting: &Setting<'_>,
    state: &State,
    own: usize,
    std: impl Fn(usize) -> f64,
) -> Vec<EffectValue> {
    let taken = &state.taken[own];
    let parameters = setting.candidates[taken.candidate].law.parameters();
    let value = |(k, parameter): (usize, &LawParameter)| EffectValue {
        name: parameter.name.clone(),
        value: taken.values[k],
        std: std(k),
        unit: parameter.unit.clone(),
    };
    parameters.iter().enumerate().map(value).collect()
}

/// Says of what was found which of it no motion tells apart.
pub(super) fn tell_aliases(
    candidates: &[Candidate],
    aliases: &ExactAliases<'_>,
    found: &mut [FoundEffect],
) {
    let named = |candidate: usize| {
        let Candidate { effect, at, .. } = &candidates[candidate];
        Named { effect, at }
    };
    for one in found {
        let own = named(one.candidate);
        one.exact = aliases.of_parameters(own);
        for other in one.alternatives.iter_mut().chain(&mut one.finer) {
            let is_behind = |one: usize| candidates[one].is_behind_spring;
            other.is_exact = is_behind(one.candidate) == is_behind(other.candidate)
                && aliases.are_alike(own, named(other.candidate));
        }
    }
}

/// What these logs say of the effects that the model has.
pub(super) fn given_effects(setting: &Setting<'_>, state: &State) -> Vec<GivenEffect> {
    let of = |place: usize| GivenEffect {
        candidate: state.taken[place].candidate,
        parameters: values(setting, state, place, |k| state.deviations[place][k]),
    };
    (0..setting.given.len()).map(of).collect()
}

/// The names of what the logs would move beyond what the model says of it: its own numbers, and
/// those of its effects.
pub(super) fn driven_names(setting: &Setting<'_>, state: &State) -> Vec<String> {
    let nominal = setting.data.train.nominal;
    let is_far = |z: &f64| z.abs() > MOST_Z;
    let numbers = state.z.iter().zip(&nominal.uncertain);
    let mut names: Vec<String> =
        numbers.filter(|(z, _)| is_far(z)).map(|(_, one)| one.name.clone()).collect();
    for (place, spring) in nominal.springs.iter().enumerate() {
        let first = nominal.place_of_spring(place);
        let zero = format!("zero of {}", spring.name);
        let both = [spring.name.clone(), zero].into_iter().zip(&state.z[first..]);
        names.extend(both.filter(|(_, z)| is_far(z)).map(|(name, _)| name));
    }
    for taken in &state.taken {
        let candidate = &setting.candidates[taken.candidate];
        let parameters = candidate.law.parameters().iter().zip(candidate.law.beliefs());
        for ((parameter, belief), value) in parameters.zip(&taken.values) {
            if is_driven(belief, *value) {
                names.push(format!("{}_{}_{}", parameter.name, candidate.effect, candidate.at));
            }
        }
    }
    names
}

/// Alternatives that an experiment is to exclude, at most: the best ones.
const MOST_RIVALS: usize = 3;

/// Looks for motions that tell what was found from what would do as well.
pub(super) fn separate(
    setting: &Setting<'_>,
    (robot, seed): (&Robot, u64),
    (found, state): (&Found, &State),
    filters: Filters,
    effects: &mut [FoundEffect],
) {
    let given = setting.given.len();
    for (place, one) in effects.iter_mut().enumerate() {
        let is_asked = |rival: &&Rival| {
            let mut others = one.alternatives.iter().filter(|other| !other.is_exact);
            others.any(|other| other.candidate == rival.placed.candidate)
        };
        // a search that was stopped has looked for none
        let rivals = found.rivals.get(place).into_iter().flatten().filter(is_asked);
        let rivals = rivals.take(MOST_RIVALS).map(|rival| rival.placed.clone());
        let rivals: Vec<Placed> = rivals.collect();
        if rivals.is_empty() {
            continue;
        }
        let mut others = state.taken.clone();
        let values = others.remove(given + place).values;
        let own = Placed { values, ..found.after.parts[place].placed.clone() };
        let ambiguity = Ambiguity {
            nominal: setting.data.train.nominal,
            candidates: setting.candidates,
            log: &setting.data.train.signals[0],
            filters,
            floor: &setting.floors.train[0],
            z: &state.z,
            names: [vec![own], rivals].concat(),
            others,
        };
        one.experiment = Some(ambiguity.separate(robot, seed));
    }
}
