//! What is said of effects: those that were found, with what would do as well, and those that the
//! model has.

use super::alias::{ExactAliases, Named};
use super::candidate::Candidate;
use super::errors::Errors;
use super::evidence::{block_costs, by_ranks, paired};
use super::experiment::{Ambiguity, Experiment, ExperimentOptions, NoExperiment};
use super::family::Alternative;
use super::floor::rms;
use super::gap::Gap;
use super::given::is_driven;
use super::profile::best_profile;
use super::search::DISTINCT;
use super::signals::Filters;
use super::state::{Setting, State, Taken};
use denavit_codegen::model::Robot;
use denavit_plants::effect::LawParameter;
use denavit_plants::regression::RegressionJoint;

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

/// An effect that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundEffect {
    /// Its number among the candidates.
    pub candidate: usize,
    /// Its parameters.
    pub parameters: Vec<EffectValue>,
    /// The share of what can be explained that is open again without it, on held-out logs.
    pub share: f64,
    /// Whether it fits: else it is only the nearest of the catalogue to something without a name.
    pub is_named: bool,
    /// Whether it closes little where it acts, and is not plain for all that.
    pub is_faint: bool,
    /// A law of its joint's own motion, as a formula, that leaves less than half as much; so it is
    /// not named.
    pub outdone_by: Option<String>,
    /// Effects that would do as well in its place.
    pub alternatives: Vec<Alternative>,
    /// Parameters of the model that do exactly what it does, together, whatever the motion; none
    /// where there are no such.
    pub exact: Vec<String>,
    /// A motion that would tell it from these, or why there is none; none if it was not asked for,
    /// or if nothing is to be told apart.
    pub experiment: Option<Result<Experiment, NoExperiment>>,
}

/// An effect that the model has.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenEffect {
    /// Its number among the candidates.
    pub candidate: usize,
    /// Its parameters, estimated again.
    pub parameters: Vec<EffectValue>,
}

/// A law that closes less than this share of what a joint leaves does not fit it, if more than so
/// many times the deviation of noise stays; nor does one that closes less than half, whatever its
/// values, or one whose values are others in another motion, by more than so many times the
/// squares of their errors.
const FITS: f64 = 0.8;
const MISFIT: f64 = 2.5;
const HALF: f64 = 0.5;
const MOVES: f64 = 2.0;

/// A law that is not of the catalogue leaves less than this share of what names leave that stand
/// for it, noise apart.
const OUTDONE: f64 = 0.5;

/// An effect that closes less than these shares of what a joint leaves, noise with it, of held-out
/// logs and of those that are fitted, is faint if its values are within so many errors of nothing,
/// or held-out logs are better with it by less than so many standard errors.
const CLOSES: f64 = 0.3;
const CLOSES_FITTED: f64 = 0.75;
const NOTHING: f64 = 3.0;
const PLAIN: f64 = 5.0;

/// The effects of a state, each with its share, its errors and what would do as well.
pub(super) fn found_effects(
    setting: &Setting<'_>,
    [before, after]: [&State; 2],
    (errors, families): (&Errors, Vec<Vec<Alternative>>),
) -> Vec<FoundEffect> {
    let [_, trust] = after.trust();
    let gap = |state: &State| Gap::new(setting.held_out, &state.held_out_residual, &trust).all;
    let floor = Gap::of_floor(setting.held_out, setting.held_out_floor, &trust).all;
    let squares = |left: &[f64]| setting.held_out_squares(after, left);
    let (from, to) = (squares(&before.held_out_residual), squares(&after.held_out_residual));
    let outdone = outdone(setting, after);
    let fits = |equations: &[usize], joint: Option<usize>| {
        let share = closed_at(equations, [&from, &to]);
        share > FITS || share > HALF && stays(setting, (after, errors), joint)
    };
    let mut found = Vec::new();
    let places = after.taken.iter().enumerate().skip(setting.given.len());
    for ((place, taken), alternatives) in places.zip(families) {
        let mut others = after.taken.clone();
        others.remove(place);
        // Where all was below the floor already, of what the effects closed.
        let whole = (gap(before) - floor).max(gap(before) - gap(after));
        let without = setting.state(&others);
        let parameters = values(setting, (after, errors), place);
        let own = own_equations(setting, after, taken);
        let is_little = |own: &Vec<usize>| {
            let leaves = |set: usize, most: f64| {
                let [with, less] = [after, &without].map(|state| {
                    let left = [&state.residual, &state.held_out_residual][set];
                    let squares = setting.squares(set, after, left);
                    own.iter().map(|&at| squares[at][0]).sum::<f64>()
                });
                with > most * less
            };
            // What one log has may not happen in the other.
            leaves(1, 1.0 - CLOSES) && leaves(0, 1.0 - CLOSES_FITTED)
        };
        let is_plain = || {
            let [worse, better] = [&without, after].map(|state| {
                block_costs(setting.held_out, &state.held_out_residual, &after.deviation[1])
            });
            paired(&worse, &better).max(by_ranks(&worse, &better)) >= PLAIN
        };
        let candidate = &setting.candidates[taken.candidate];
        let laws = candidate.law.parameters();
        let at = |own: &Vec<usize>| own.iter().find_map(|&at| outdone.get(at)?.clone());
        let outdone_by = own.as_ref().and_then(at);
        let is_fitting = own.as_ref().is_none_or(|own| fits(own, candidate.joint));
        found.push(FoundEffect {
            candidate: taken.candidate,
            share: (gap(&without) - gap(after)) / whole.max(f64::MIN_POSITIVE),
            is_named: is_fitting && outdone_by.is_none(),
            // Of what numbers of the model stand for that are driven, logs show little.
            is_faint: own.as_ref().is_some_and(is_little)
                && (errors_from_nothing(laws, &parameters) < NOTHING || !is_plain()),
            outdone_by,
            parameters,
            alternatives,
            exact: Vec::new(),
            experiment: None,
        });
    }
    found
}

/// The share that is closed of what equations had, in units of the noise of each: an effect may
/// have motor and link to be seen at. All of it where little more than noise stays.
fn closed_at(equations: &[usize], [from, to]: [&[[f64; 2]]; 2]) -> f64 {
    let over = |of: &[[f64; 2]]| -> f64 {
        equations.iter().map(|&at| of[at][0] / to[at][1].max(f64::MIN_POSITIVE)).sum()
    };
    let (from, to, noise) = (over(from), over(to), equations.len() as f64);
    let open = (from - noise).max(f64::MIN_POSITIVE);
    if to < MISFIT * MISFIT * noise { 1.0 } else { (from - to) / open }
}

/// For each joint the profile that leaves much less of it than its effects, as a formula.
fn outdone(setting: &Setting<'_>, state: &State) -> Vec<Option<String>> {
    let costs = |left: &[f64]| block_costs(setting.held_out, left, &state.deviation[1]);
    let squares = |left: &[f64]| setting.held_out_squares(state, left);
    let now = squares(&state.held_out_residual);
    let acts = |joint: usize| {
        let mut taken = state.taken[setting.given.len()..].iter();
        let of = |one: &Taken| &setting.candidates[one.candidate];
        taken.any(|one| of(one).joint == Some(joint) && !of(one).is_body)
    };
    let of = |(joint, described): (usize, &RegressionJoint)| {
        let [left, noise] = now[joint];
        if !acts(joint) || left < noise {
            return None;
        }
        let profile = best_profile(setting, state, joint)?;
        let [less, _] = squares(&profile.held_out_residual)[joint];
        let better = paired(&costs(&state.held_out_residual), &costs(&profile.held_out_residual));
        let is_less = less - noise < OUTDONE * (left - noise);
        (is_less && better > DISTINCT).then(|| profile.formula(&described.name))
    };
    setting.train.nominal.model.joints.iter().enumerate().map(of).collect()
}

/// Whether the effects of a joint have the same values in another motion.
fn stays(setting: &Setting<'_>, (state, errors): (&State, &Errors), joint: Option<usize>) -> bool {
    let of_joint = |taken: &Taken| {
        let is_there = setting.candidates[taken.candidate].joint == joint;
        std::iter::repeat_n(is_there, taken.values.len())
    };
    let is_there = state.taken.iter().flat_map(of_joint);
    let moves = errors.moves.iter().zip(is_there);
    let own: Vec<f64> = moves.filter(|(_, is_there)| *is_there).map(|(by, _)| *by).collect();
    rms(&own) < MOVES.sqrt()
}

/// The most errors by which what switches an effect off is from where it does; infinite where the
/// logs do not say so much of any.
fn errors_from_nothing(parameters: &[LawParameter], values: &[EffectValue]) -> f64 {
    let of = |(parameter, one): (&LawParameter, &EffectValue)| {
        let nothing = parameter.nominal.filter(|_| one.std.is_finite())?;
        Some((one.value - nothing).abs() / one.std.max(f64::MIN_POSITIVE))
    };
    let all = parameters.iter().zip(values).filter_map(of);
    all.max_by(f64::total_cmp).unwrap_or(f64::INFINITY)
}

/// Where an effect of a joint acts of the joint and its spring; none for one of the whole model, or
/// of a body, which all joints before it carry.
fn own_equations(setting: &Setting<'_>, state: &State, taken: &Taken) -> Option<Vec<usize>> {
    let candidate = &setting.candidates[taken.candidate];
    let joint = candidate.joint.filter(|_| !candidate.is_body)?;
    let data = setting.train;
    let fitted = setting.fitted(std::slice::from_ref(taken));
    let motion = state.torques[0].first()?.motion(data.nominal, data.signals.first()?);
    let acts_on = fitted[0].law.response(motion, &fitted[0].values).equations;
    let own = [Some(joint), data.nominal.spring_equation(joint)];
    Some(own.into_iter().flatten().filter(|equation| acts_on.contains(equation)).collect())
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
        for other in &mut one.alternatives {
            other.is_exact = aliases.are_alike(own, named(other.candidate));
        }
    }
}

/// The parameters of the effect in one place of a state, with their errors.
fn values(
    setting: &Setting<'_>,
    (state, errors): (&State, &Errors),
    place: usize,
) -> Vec<EffectValue> {
    let before: usize = state.taken[..place].iter().map(|taken| taken.values.len()).sum();
    let taken = &state.taken[place];
    let parameters = setting.candidates[taken.candidate].law.parameters();
    let value = |(k, (value, parameter)): (usize, (&f64, &LawParameter))| EffectValue {
        name: parameter.name.clone(),
        value: *value,
        std: errors.deviations[before + k],
        unit: parameter.unit.clone(),
    };
    taken.values.iter().zip(parameters).enumerate().map(value).collect()
}

/// What these logs say of the effects that the model has.
pub(super) fn given_effects(
    setting: &Setting<'_>,
    state: &State,
    errors: &Errors,
) -> Vec<GivenEffect> {
    let of = |(place, taken): (usize, &Taken)| GivenEffect {
        candidate: taken.candidate,
        parameters: values(setting, (state, errors), place),
    };
    setting.given.iter().enumerate().map(of).collect()
}

/// The names of what the logs would move beyond what the model says of it: its own numbers, and
/// those of its effects.
pub(super) fn driven_names(setting: &Setting<'_>, state: &State) -> Vec<String> {
    let nominal = setting.train.nominal;
    let numbers = state.held.iter().zip(&nominal.uncertain);
    let mut names: Vec<String> =
        numbers.filter_map(|(held, one)| held.map(|_| one.name.clone())).collect();
    for (place, spring) in nominal.springs.iter().enumerate() {
        let first = nominal.place_of_spring(place);
        let zero = format!("zero of {}", spring.name);
        let both = [spring.name.clone(), zero].into_iter().zip(&state.held[first..]);
        names.extend(both.filter_map(|(name, held)| held.map(|_| name)));
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
    (robot, options): (&Robot, &ExperimentOptions),
    (state, filters): (&State, Filters),
    found: &mut [FoundEffect],
) {
    let given = setting.given.len();
    for (place, one) in found.iter_mut().enumerate() {
        let rivals = one.alternatives.iter().filter(|other| !other.is_exact).take(MOST_RIVALS);
        let rivals: Vec<Taken> = rivals
            .map(|other| Taken { candidate: other.candidate, values: other.values.clone() })
            .collect();
        if rivals.is_empty() {
            continue;
        }
        let mut others = state.taken.clone();
        let own = others.remove(given + place);
        let ambiguity = Ambiguity {
            nominal: setting.train.nominal,
            candidates: setting.candidates,
            log: &setting.train.signals[0],
            filters,
            floor: &setting.train_floor[0],
            z: &state.z,
            names: [vec![own], rivals].concat(),
            others,
        };
        one.experiment = Some(ambiguity.separate(robot, options));
    }
}
