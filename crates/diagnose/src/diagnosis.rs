//! The whole of it: logs and a model in, what is missing out, as data.

use super::alias::ExactAliases;
use super::candidate::Candidate;
use super::curve::{Curve, curves};
use super::data::Data;
use super::effects_found::{
    FoundEffect, GivenEffect, driven_names, found_effects, given_effects, separate, tell_aliases,
};
use super::elastic::SeriesSpring;
use super::errors::{Errors, errors};
use super::excitation::{Visible, unseen, visible};
use super::experiment::ExperimentOptions;
use super::family::{Families, named};
use super::fault::DiagnosisError;
use super::floor::{NoiseFloor, UNREPEATABLE};
use super::gap::{Gap, share_closed};
use super::nominal::{Nominal, Uncertainty};
use super::regime::{Where, where_left};
use super::repeat::{raise_floors, unrepeatable};
use super::search::{SearchOptions, Step, Stop, search};
use super::signals::{Filters, Signals};
use super::simulated::{MotionGap, MotionGaps, Moved, NotMoved};
use super::state::{Setting, State, Taken};
use super::structure::{Structure, describe};
use denavit_codegen::model::Robot;
use denavit_measure::log::MeasuredLog;
use denavit_plants::regression::RegressionModel;
use std::collections::BTreeSet;

/// What is to be diagnosed, from what.
pub struct Request<'a> {
    /// Base parameters of the nominal model and their columns.
    pub model: &'a RegressionModel,
    /// Springs between motors and joints that the logs have both angles of.
    pub springs: &'a [SeriesSpring],
    /// Logs to fit.
    pub train: Vec<MeasuredLog>,
    /// Logs to judge with.
    pub held_out: Vec<MeasuredLog>,
    /// What may be missing, after what the model has.
    pub candidates: &'a [Candidate],
    /// What the model has of them, at its values.
    pub given: Vec<Taken>,
    /// How far numbers of the model may be off that state nothing.
    pub uncertainty: Uncertainty,
    /// The symbolic regressor of the model, to tell exact aliases; none leaves them untold.
    pub aliases: Option<&'a ExactAliases<'a>>,
    /// The robot with its limits, for experiments that separate names; none looks for none.
    pub experiment: Option<(&'a Robot, ExperimentOptions)>,
    /// The model as a file, to be moved along the logs; none leaves that gap out.
    pub moved: Option<&'a Moved<'a>>,
    /// What the search asks for.
    pub options: SearchOptions,
    /// The filters; found from the steps of the encoders if none are given.
    pub filters: Option<Filters>,
}

/// The answer in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// What is left is noise.
    NothingMissing,
    /// Effects were found that leave noise.
    Explained,
    /// Effects were found, and more than noise is left.
    PartlyExplained,
    /// More than noise is left, and no effect of the catalogue explains it.
    Unexplained,
    /// The logs do not say.
    CannotTell,
}

impl Verdict {
    /// The word in files.
    pub const fn word(self) -> &'static str {
        match self {
            Self::NothingMissing => "nothing_missing",
            Self::Explained => "explained",
            Self::PartlyExplained => "partly_explained",
            Self::Unexplained => "unexplained",
            Self::CannotTell => "cannot_tell",
        }
    }
}

/// Gaps of one set of logs.
#[derive(Clone, Debug, PartialEq)]
pub struct Gaps {
    /// Of the nominal model, re-estimated.
    pub before: Gap,
    /// With the effects.
    pub after: Gap,
    /// Of noise alone.
    pub floor: Gap,
}

impl Gaps {
    fn new(
        (data, floors): (&Data<'_>, &[NoiseFloor]),
        [before, after]: [&[f64]; 2],
        trust: &[f64],
    ) -> Self {
        Self {
            before: Gap::new(data, before, trust),
            after: Gap::new(data, after, trust),
            floor: Gap::of_floor(data, floors, trust),
        }
    }
}

/// What a model lacks.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// The answer in one word.
    pub verdict: Verdict,
    /// Why.
    pub reasons: Vec<String>,
    /// The joints, then the springs whose balance is measured, by name.
    pub places: Vec<String>,
    /// Where torques disagreed before.
    pub before: Vec<Where>,
    /// Where they still do.
    pub after: Vec<Where>,
    /// The effects that the model has, with what their parameters are by these logs.
    pub given: Vec<GivenEffect>,
    /// The effects, in the order in which they were found.
    pub effects: Vec<FoundEffect>,
    /// How small other effects of one parameter would have been seen in the logs for training.
    pub visible: Vec<Visible>,
    /// What is left at joints that no effect explains.
    pub structures: Vec<Structure>,
    /// How they were found.
    pub steps: Vec<Step>,
    /// Gaps of the logs that were fitted.
    pub train: Gaps,
    /// Gaps of the logs that were held out.
    pub held_out: Gaps,
    /// Gaps of the models in motion, or why they are not moved; none if that was not asked for.
    pub motion: Option<Result<MotionGaps, NotMoved>>,
    /// Torques of held-out logs over time.
    pub curves: Vec<Curve>,
    /// The filters.
    pub filters: Filters,
    /// Numbers of the model that the logs would move beyond their uncertainty, before and after.
    pub driven: [Vec<String>; 2],
}

/// Shares of the rate of sampling that the filter of positions may pass.
const SHARES: [f64; 6] = [0.1, 0.07, 0.05, 0.035, 0.025, 0.018];

/// What is left within so many times the deviation of noise is noise.
const NOISE: f64 = 1.6;

/// Diagnoses. `watch` hears of the effects that were found so far.
pub fn diagnose(
    request: Request<'_>,
    watch: &mut dyn FnMut(&[usize], f64),
) -> Result<Diagnosis, DiagnosisError> {
    DiagnosisError::check(&request)?;
    let nominal = Nominal::new(request.model, request.uncertainty)
        .with_springs(request.springs, request.uncertainty);
    let filters = request.filters.map_or_else(|| quiet_filters(&nominal, &request.train), Ok)?;
    let smoother = smoother(&nominal, &request.train, filters);
    let read = |logs: Vec<MeasuredLog>| conditioned(&nominal, logs, filters);
    let (train, held_out) = (read(request.train)?, read(request.held_out)?);
    let floors = [&train, &held_out].map(|data| NoiseFloor::of_logs(&nominal, &data.signals));
    let [train_floor, held_out_floor] = &floors;
    let setting = Setting {
        train: &train,
        held_out: &held_out,
        moved: request.moved.map(|moved| (moved, filters.motion_hz)),
        candidates: request.candidates,
        given: request.given,
        coarse: train.signals.iter().map(Signals::coarse).collect(),
        train_floor,
        held_out_floor,
    };
    let [train_floor, held_out_floor] = &with_scatter(&setting);
    let setting = Setting { train_floor, held_out_floor, ..setting };
    let outcome = search(&setting, &request.options, &mut |state| {
        let taken: Vec<usize> = state.taken.iter().map(|one| one.candidate).collect();
        watch(&taken, Gap::new(&held_out, &state.held_out_residual, &state.trust()[1]).all);
    });
    let before = &outcome.before;
    let name = |state| named((&setting, &outcome.screen), &request.options, state);
    let errors = |state: &State| errors(&setting, state, smoother.as_ref());
    let Told { state: after, errors, mut effects } =
        told(&setting, before, name(outcome.after), &name, &errors);
    let after = &after;
    if let Some(aliases) = request.aliases {
        tell_aliases(request.candidates, aliases, &mut effects);
    }
    if let Some((robot, options)) = request.experiment {
        separate(&setting, (robot, &options), (after, filters), &mut effects);
    }
    let filter_s = 0.35 / filters.torque_hz;
    let left = |of: &State| where_left(&train, &of.residual, &of.torques[0], train_floor, filter_s);
    let trust = after.trust();
    let mut diagnosis = Diagnosis {
        verdict: Verdict::CannotTell,
        reasons: Vec::new(),
        places: (0..nominal.equations()).map(|at| nominal.equation_name(at)).collect(),
        before: left(before),
        after: left(after),
        given: given_effects(&setting, after, &errors),
        effects,
        train: Gaps::new((&train, train_floor), [&before.residual, &after.residual], &trust[0]),
        held_out: Gaps::new(
            (&held_out, held_out_floor),
            [&before.held_out_residual, &after.held_out_residual],
            &trust[1],
        ),
        visible: visible(&setting, &outcome.screen, after),
        structures: structures(&setting, after),
        curves: curves(&held_out, [&before.held_out_residual, &after.held_out_residual]),
        motion: request.moved.map(|_| motion_gaps(&setting, [before, after])),
        filters,
        driven: [before, after].map(|state| driven_names(&setting, state)),
        steps: outcome.steps,
    };
    diagnosis.judge(&setting, outcome.stop, after);
    Ok(diagnosis)
}

/// What is told of the effects of a state.
struct Told {
    state: State,
    errors: Errors,
    effects: Vec<FoundEffect>,
}

/// The effects of a state, without those that are faint: others are named and estimated anew then.
fn told(
    setting: &Setting<'_>,
    before: &State,
    (mut state, mut families): Families,
    name: &dyn Fn(State) -> Families,
    errors: &dyn Fn(&State) -> Errors,
) -> Told {
    loop {
        let errors = errors(&state);
        let effects = found_effects(setting, [before, &state], (&errors, families));
        let Some(faint) = effects.iter().position(|one| one.is_faint) else {
            return Told { state, errors, effects };
        };
        state.taken.remove(setting.given.len() + faint);
        (state, families) = name(setting.settled(setting.state(&state.taken)));
    }
}

/// Logs as rows.
fn conditioned<'n>(
    nominal: &'n Nominal<'n>,
    logs: Vec<MeasuredLog>,
    filters: Filters,
) -> Result<Data<'n>, DiagnosisError> {
    let signals = logs.into_iter().map(|log| {
        let file = log.file.clone();
        Signals::new(log, filters).map_err(|error| DiagnosisError::Condition { file, error })
    });
    Ok(Data::new(nominal, signals.collect::<Result<Vec<Signals>, _>>()?))
}

/// How much lower the filters are that values must not depend on.
const SMOOTHER: f64 = 0.5;

/// Logs through lower filters; none if they are too short for them.
fn smoother<'n>(
    nominal: &'n Nominal<'n>,
    logs: &[MeasuredLog],
    filters: Filters,
) -> Option<Data<'n>> {
    let Filters { motion_hz, torque_hz } = filters;
    let lower = Filters { motion_hz: SMOOTHER * motion_hz, torque_hz: SMOOTHER * torque_hz };
    conditioned(nominal, logs.to_vec(), lower).ok()
}

/// The widest filters with which the steps of the encoders make less of a torque than its noise.
fn quiet_filters(nominal: &Nominal<'_>, logs: &[MeasuredLog]) -> Result<Filters, DiagnosisError> {
    let log = logs.first().ok_or(DiagnosisError::NoLog)?;
    let mut last = Err(DiagnosisError::NoLog);
    for share in SHARES {
        let filters = Filters::new(log.step_s, share);
        let signals = match Signals::new(log.clone(), filters) {
            Ok(signals) => signals,
            Err(error) => {
                let file = log.file.clone();
                last = last.or(Err(DiagnosisError::Condition { file, error }));
                break;
            }
        };
        let floor = NoiseFloor::of_logs(nominal, &[signals]).remove(0);
        let joints = floor.positions.iter().zip(&floor.white).take(log.joints.len());
        let mut ratios: Vec<f64> = joints.map(|(p, w)| p / w.max(1e-300)).collect();
        ratios.sort_by(f64::total_cmp);
        last = Ok(filters);
        if ratios.get(ratios.len() / 2).is_none_or(|ratio| *ratio < 1.0) {
            break;
        }
    }
    last
}

/// The floors of both sets of logs, with what differs from lap to lap if that is little of what the
/// model leaves.
fn with_scatter(setting: &Setting<'_>) -> [Vec<NoiseFloor>; 2] {
    let mut floors = [setting.train_floor, setting.held_out_floor].map(<[NoiseFloor]>::to_vec);
    if floors.iter().flatten().any(NoiseFloor::is_exceeded_by_laps) {
        let state = setting.state(&setting.given);
        let [of_train, of_held_out] = &state.trust();
        let train = (setting.train, &state.residual[..], &of_train[..]);
        let held_out = (setting.held_out, &state.held_out_residual[..], &of_held_out[..]);
        raise_floors([train, held_out], &mut floors);
    }
    floors
}

/// The gaps of the models before and after in motion.
fn motion_gaps(setting: &Setting<'_>, states: [&State; 2]) -> Result<MotionGaps, NotMoved> {
    let of = |set: usize| -> Result<[MotionGap; 2], NotMoved> {
        let [before, after] = states.map(|state| setting.motion_gap(set, (&state.taken, &state.z)));
        Ok([before?, after?])
    };
    Ok(MotionGaps { train: of(0)?, held_out: of(1)? })
}

/// What joints and springs still lack that are left with more than noise.
fn structures(setting: &Setting<'_>, state: &State) -> Vec<Structure> {
    let squares = setting.held_out_squares(state, &state.held_out_residual);
    let is_left = |at: &usize| squares[*at][0] > NOISE * NOISE * squares[*at][1];
    let equations = (0..squares.len()).filter(is_left);
    equations.filter_map(|equation| describe(setting, state, equation)).collect()
}

/// The share of what can be explained that an effect closes which is likely, though not for sure.
const LIKELY: f64 = 0.8;

impl Diagnosis {
    /// The share of what could be explained of held-out logs that was explained.
    pub fn share_closed(&self) -> Option<f64> {
        let Gaps { before, after, floor } = &self.held_out;
        share_closed(before.all, after.all, floor.all)
    }

    /// The effect that was not taken last, if it would explain most of what is left of held-out
    /// logs, though by few blocks of them.
    fn likely(&self) -> Option<&Step> {
        let last = self.steps.last().filter(|step| !step.is_taken)?;
        (last.share > LIKELY && last.significance > 1.0 && last.gain > last.decoy).then_some(last)
    }

    /// What it means that no effect was found, and why.
    fn nothing_found(&self, setting: &Setting<'_>, is_noise: bool) -> (Verdict, Vec<String>) {
        let joints = &setting.train.nominal.model.joints;
        let names: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
        if is_noise {
            let unseen = unseen(setting, &self.visible);
            // Numbers that are driven beyond what the model says stand for something else.
            let is_model_right = unseen.is_empty() && self.driven[1].is_empty();
            let verdict =
                if is_model_right { Verdict::NothingMissing } else { Verdict::CannotTell };
            return (verdict, unseen.iter().map(|one| one.sentence(&names)).collect());
        }
        let Some(step) = self.likely() else {
            let why = "nothing in the catalogue explains what is left".to_owned();
            return (Verdict::Unexplained, vec![why]);
        };
        let why = format!(
            "too little was logged: {} would close {:.0} %, but by {:.1} standard errors only; \
             longer logs decide",
            setting.candidates[step.added].name(),
            100.0 * step.share,
            step.significance
        );
        (Verdict::CannotTell, vec![why])
    }

    fn judge(&mut self, setting: &Setting<'_>, stop: Stop, state: &State) {
        let squares = setting.held_out_squares(state, &state.held_out_residual);
        let is_noise = squares.iter().all(|[left, noise]| *left <= NOISE * NOISE * noise);
        let trust = state.trust();
        let unrepeatable = [
            unrepeatable(setting.train, setting.train_floor, &state.residual, &trust[0]),
            unrepeatable(
                setting.held_out,
                setting.held_out_floor,
                &state.held_out_residual,
                &trust[1],
            ),
        ];
        let unrepeatable = unrepeatable
            .into_iter()
            .flatten()
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .filter(|(_, ratio)| *ratio > UNREPEATABLE);
        let mut reasons = Vec::new();
        let ambiguous: Vec<String> = self
            .effects
            .iter()
            .filter(|one| one.is_named && one.alternatives.len() > 2)
            .map(|one| setting.candidates[one.candidate].name())
            .collect();
        self.verdict = if let Some((equation, ratio)) = unrepeatable {
            reasons.push(format!(
                "not repeatable: laps of {} differ by {ratio:.1} times their noise",
                setting.train.nominal.equation_name(equation)
            ));
            Verdict::CannotTell
        } else if self.effects.is_empty() {
            let (verdict, why) = self.nothing_found(setting, is_noise);
            reasons.extend(why);
            verdict
        } else if self.effects.iter().all(|one| !one.is_named) {
            let nearest: Vec<String> =
                self.effects.iter().map(|one| setting.candidates[one.candidate].name()).collect();
            reasons
                .push(format!("no effect of the catalogue fits; nearest: {}", nearest.join(", ")));
            Verdict::Unexplained
        } else if !ambiguous.is_empty() {
            reasons.push(format!("alias: others would do as well as {}", ambiguous.join(", ")));
            Verdict::CannotTell
        } else if is_noise || self.share_closed().is_some_and(|share| share > 0.95) {
            Verdict::Explained
        } else {
            reasons.push("more than noise is left".to_owned());
            Verdict::PartlyExplained
        };
        self.reasons = reasons;
        self.add_doubts(setting, stop);
    }

    /// What else must be known to trust the answer.
    fn add_doubts(&mut self, setting: &Setting<'_>, stop: Stop) {
        let reasons = &mut self.reasons;
        let is_searched =
            |log: &Signals| setting.train.signals.iter().any(|other| other.q == log.q);
        if setting.held_out.signals.iter().any(is_searched) {
            reasons.push("judged with a log that was searched: nothing is held out".to_owned());
        }
        for one in self.effects.iter().filter(|one| !one.exact.is_empty()) {
            let name = setting.candidates[one.candidate].name();
            reasons.push(format!(
                "exact alias: {name} does what parameters of the model do in every motion ({}); \
                 what is told is that they are off by more than the model states",
                one.exact.join(", ")
            ));
        }
        let laws: BTreeSet<&String> =
            self.effects.iter().filter_map(|one| one.outdone_by.as_ref()).collect();
        for law in laws {
            let own = self.effects.iter().filter(|one| one.outdone_by.as_ref() == Some(law));
            let names: Vec<String> =
                own.map(|one| setting.candidates[one.candidate].name()).collect();
            reasons.push(format!(
                "{} stands for another law: {law}, g being some smooth function, leaves less than \
                 half as much",
                names.join(" + ")
            ));
        }
        if stop == Stop::MostEffects {
            reasons.push("as many effects were found as are allowed".to_owned());
        }
        if !self.driven[1].is_empty() {
            reasons.push(format!(
                "the logs would move parameters beyond their uncertainty: {}",
                self.driven[1].join(", ")
            ));
        }
    }
}
