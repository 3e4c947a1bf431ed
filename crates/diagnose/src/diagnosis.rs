//! The whole of it: logs and a model in, what is missing out, as data.

use super::candidate::Candidate;
use super::columns::misread;
use super::curve::{Curve, LoggedMotion, curves, logged};
use super::data::Data;
use super::effects_found::{
    FoundEffect, GivenEffect, driven_names, found_effects, given_effects, idle, separate,
    tell_aliases,
};
use super::elastic::Spring;
use super::error::Error;
use super::excitation::{Visible, visible};
use super::floor::{NoiseFloor, floors};
use super::gap::{Gap, Weight, share_closed};
use super::leftover::{Leftover, leftovers};
use super::nominal::Nominal;
use super::regime::{Where, where_left};
use super::rounds::Found;
use super::search::{Search, Step};
use super::signals::{Filters, Signals};
use super::simulated::{MotionGap, MotionGaps, Moved};
use super::state::{Effects, MOST_Z, Setting, State, Taken};
use super::structure::{Structure, describe};
use super::verdict::{Verdict, judge};
use super::weighing::{Placed, Weighing};
use denavit_codegen::alias::ExactAliases;
use denavit_codegen::model::Robot;
use denavit_evidence::policy;
use denavit_measure::Split;
use denavit_measure::log::MeasuredLog;
use denavit_plants::regression::RegressionModel;

/// What is to be diagnosed, from what.
pub struct Request<'a> {
    /// Base parameters of the nominal model and their columns.
    pub model: &'a RegressionModel,
    /// Springs between motors and joints that the logs have both angles of.
    pub springs: &'a [Spring],
    /// Logs to fit.
    pub train: Vec<MeasuredLog>,
    /// Logs to judge with.
    pub held_out: Vec<MeasuredLog>,
    /// What may be missing, after what the model has.
    pub candidates: &'a [Candidate],
    /// What the model has of them, at its values.
    pub given: Vec<Taken>,
    /// The symbolic regressor of the model, to tell exact aliases; none leaves them untold.
    pub aliases: Option<&'a ExactAliases<'a>>,
    /// The robot with its limits, for experiments that separate names, and the seed of what is
    /// drawn for them; none looks for none.
    pub experiment: Option<(&'a Robot, u64)>,
    /// The model as a file, to be moved along the logs; none leaves that gap out.
    pub moved: Option<&'a Moved<'a>>,
    /// Most effects that are added.
    pub most_effects: usize,
    /// The filters; found from the motion if none are given.
    pub filters: Option<Filters>,
}

/// Gaps of one set of logs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gaps {
    /// Of the model as it is given.
    pub before: Gap,
    /// Of the model with its own numbers estimated again, and with the effects.
    pub after: Gap,
    /// Of noise alone.
    pub floor: Gap,
    /// The share of what could be explained that was explained, of rows that count for what is
    /// known of them; none where nothing could.
    pub closed: Option<f64>,
}

impl Gaps {
    fn new(data: &Data<'_>, floors: &[NoiseFloor], before: &[f64], after: &[f64]) -> Self {
        let gaps = |weight: Weight<'_>| {
            let floor = Gap::of_floor(data, floors, weight);
            [Gap::new(data, before, weight), Gap::new(data, after, weight), floor]
        };
        let known = gaps(&|row| data.weights[row]).map(|gap| gap.all);
        let [before, after, floor] = gaps(&|_| 1.0);
        Self { before, after, floor, closed: share_closed(known[0], known[1], known[2]) }
    }
}

/// What a model lacks.
#[derive(Clone, Debug, Default)]
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
    /// What joints and springs have left in the bands in which the robot moves, beyond the level of
    /// the others.
    pub leftovers: Vec<Leftover>,
    /// What is left at joints that no effect explains.
    pub structures: Vec<Structure>,
    /// Whether joints leave most of held-out logs where their drives turn around or rest.
    pub is_left_at_reversals: bool,
    /// How they were found.
    pub steps: Vec<Step>,
    /// Gaps of the logs that were fitted.
    pub train: Gaps,
    /// Gaps of the logs that were held out.
    pub held_out: Gaps,
    /// Gaps of the models in motion, or why they are not moved; none if that was not asked for.
    pub motion: Option<Result<MotionGaps, Error>>,
    /// Torques of held-out logs over time.
    pub curves: Vec<Curve>,
    /// How the robot moved in these logs.
    pub logged: Vec<LoggedMotion>,
    /// The filters.
    pub filters: Filters,
    /// Numbers of the model that the logs would move beyond their uncertainty, before and after.
    pub driven: [Vec<String>; 2],
}

/// How far a search is.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// The share of candidates that were evaluated.
    Evaluated(f64),
    /// The candidates that were found so far.
    Found(Vec<usize>),
}

/// Diagnoses. `watch` hears how far it is, and says whether to go on; if not, the answer is what
/// was found until then.
pub fn diagnose(
    request: Request<'_>,
    watch: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Diagnosis, Error> {
    Error::check(&request)?;
    let nominal = Nominal::new(request.model).with_springs(request.springs);
    let filters = request
        .filters
        .map_or_else(|| filters_of(&[request.train.as_slice(), &request.held_out].concat()), Ok)?;
    let read = |logs: Vec<MeasuredLog>| conditioned(logs, filters);
    let logs = Split { train: read(request.train)?, held_out: read(request.held_out)? };
    let nominal = nominal.moving_as(&logs.train);
    let data = with_rests(&nominal, &logs, request.candidates, &request.given);
    let floors = data.each_ref().map(|data| floors(&nominal, &data.signals));
    let setting = Setting {
        data: data.each_ref(),
        candidates: request.candidates,
        given: request.given,
        floors: floors.each_ref().map(Vec::as_slice),
    };
    let misread = misread(&data.train, &setting.as_given(&data.train));
    let most = if misread.is_empty() { request.most_effects } else { 0 };
    let (z, mut search, mut found) = searched(&setting, most, watch);
    let before = setting.state(&found.before, &z);
    let judging = setting.judging(&before.z);
    // What does not help logs that its values were not fitted to is not told.
    let (after, by_all, mut effects) = loop {
        let by_all = search.without_twins(&found.after);
        let after = setting.state(&by_all, &z);
        let of = (&found, &by_all);
        let effects = found_effects(&setting, &search, &judging, of, [&before, &after]);
        let Some(place) = idle(&effects, setting.candidates) else {
            break (after, by_all, effects);
        };
        search.drop(&mut found, place);
    };
    if let Some(aliases) = request.aliases {
        tell_aliases(request.candidates, aliases, &mut effects);
    }
    if let Some(asked) = request.experiment {
        separate(&setting, asked, (&found, &after), filters, &mut effects);
    }
    let states = [&before, &after];
    let all_left = leftovers(&search.weighing.spectra, &found.after.weighed.variances);
    search.tell_stand_ins(&found.after, &all_left, &mut effects);
    let (judging, judged) = setting.predicted(&judging, &after, &by_all);
    let open = [(&search.weighing, &found.after), (&judging, &judged)]
        .map(|(weighing, of)| weighing.open(of, &search.floor));
    let unnamed = all_left.iter().filter(|one| one.share > policy::LEFT);
    let mut diagnosis = Diagnosis {
        visible: visible(&search, &found.after),
        structures: unnamed.filter_map(|one| describe(&setting, &after, one.equation)).collect(),
        leftovers: all_left,
        effects,
        motion: request.moved.map(|moved| motion_gaps(moved, &setting, filters, states)),
        ..told(&setting, filters, &found, states)
    };
    judge(&mut diagnosis, &setting, (&found, &after), &open, &misread);
    Ok(diagnosis)
}

/// A search that begins again where what it found moves the model's own numbers, with these, in
/// their deviations.
fn searched<'s>(
    setting: &'s Setting<'s>,
    most: usize,
    watch: &mut dyn FnMut(&Progress) -> bool,
) -> (Vec<f64>, Search<'s>, Found) {
    let Setting { data, floors, .. } = setting;
    let both = [(data.train, floors.train), (data.held_out, floors.held_out)];
    let [a, b] = both.map(|(data, floors)| Gap::of_floor(data, floors, &|_| 1.0).per_joint);
    let floor = a.iter().zip(&b).map(|(a, b)| a.unwrap_or(0.0).max(b.unwrap_or(0.0)));
    let floor: Vec<f64> = floor.collect();
    let sets = Vec::from(data.into_array());
    let own = setting.effects(&setting.given);
    // Numbers that are driven further have in them what is missing.
    let mut z: Vec<f64> = null(&sets, own).iter().map(|z| z.clamp(-MOST_Z, MOST_Z)).collect();
    let (mut begun, mut moves, mut steps) = (Vec::<Placed>::new(), 0, Vec::new());
    let (mut screen, mut beside) = (Vec::new(), Vec::new());
    loop {
        let weighing = Weighing::new(sets.clone(), own, [&z, &z], &beside);
        let watched = &mut |share| watch(&Progress::Evaluated(share));
        let mut search = Search::new(weighing, [setting.given.len(), most], screen, watched);
        search.floor.clone_from(&floor);
        search.may_move = moves < MOST_MOVES;
        let watched = &mut |taken: &[usize]| watch(&Progress::Found(taken.to_vec()));
        let found = search.run(&begun, watched);
        steps.extend_from_slice(&found.steps);
        let Some(moved) = found.moved else { return (z, search, Found { steps, ..found }) };
        beside = found.after.all_taken(setting.candidates);
        begun = found.after.parts.into_iter().map(|part| part.placed).collect();
        (z, moves, screen) = (moved, moves + 1, search.kept());
    }
}

/// The rows of logs. Whether a drive at rest needs more than it slides with depends on the weight
/// of its bodies: that by the numbers of all logs, and not by those of the model file.
fn with_rests<'a>(
    nominal: &'a Nominal<'a>,
    logs: &Split<Vec<Signals>>,
    candidates: &[Candidate],
    taken: &[Taken],
) -> Split<Data<'a>> {
    let of = |z: &[f64]| logs.each_ref().map(|logs| Data::new(nominal, logs.clone(), z));
    let as_given = of(&vec![0.0; nominal.len()]);
    if logs.train.iter().chain(&logs.held_out).flat_map(|log| &log.rests).all(Vec::is_empty) {
        return as_given;
    }
    let sets = Vec::from(as_given.each_ref().into_array());
    of(&null(&sets, Effects { candidates, taken })[..nominal.len()])
}

/// The model's own numbers, in their deviations, as all logs have them where nothing is missing.
fn null(sets: &[&Data<'_>], given: Effects<'_>) -> Vec<f64> {
    let none = vec![0.0; sets[0].columns.len()];
    let weighing = Weighing::new(sets.to_vec(), given, [&none, &none], &[]);
    let weighed = weighing.base.weigh(&[], None, policy::ROUNDS[1]);
    weighed.own[..none.len()].to_vec()
}

/// What two states say of the logs, before and after effects were found.
fn told(
    setting: &Setting<'_>,
    filters: Filters,
    found: &Found,
    [before, after]: [&State; 2],
) -> Diagnosis {
    let Setting { data, floors, .. } = setting;
    let nominal = data.train.nominal;
    let filter_s = 0.35 / filters.torque_hz;
    let left = |State { residual, torques, .. }: &State| {
        where_left(data.train, &residual.train, &torques.train, floors.train, filter_s)
    };
    let given = data.map(|data| setting.as_given(data));
    let [of_before, of_after] = [before, after].map(|state| &state.residual);
    Diagnosis {
        places: (0..nominal.equations()).map(|at| nominal.equation_name(at)).collect(),
        before: left(before),
        after: left(after),
        given: given_effects(setting, after),
        steps: found.steps.clone(),
        train: Gaps::new(data.train, floors.train, &given.train, &of_after.train),
        held_out: Gaps::new(data.held_out, floors.held_out, &given.held_out, &of_after.held_out),
        curves: curves(data.held_out, [&given.held_out, &of_before.held_out, &of_after.held_out]),
        logged: logged(data.held_out),
        filters,
        driven: [before, after].map(|state| driven_names(setting, state)),
        ..Diagnosis::default()
    }
}

/// The gaps of the models before and after in motion.
fn motion_gaps(
    moved: &Moved<'_>,
    setting: &Setting<'_>,
    filters: Filters,
    states: [&State; 2],
) -> Result<MotionGaps, Error> {
    let of = |logs: &[MeasuredLog]| -> Result<[MotionGap; 2], Error> {
        let [before, after] = states.map(|one| moved.gap(logs, filters.motion_hz, setting, one));
        Ok([before?, after?])
    };
    Ok(MotionGaps { train: of(&moved.logs.train)?, held_out: of(&moved.logs.held_out)? })
}

/// How often a search begins again with other numbers of the model, at most.
const MOST_MOVES: usize = 2;

/// Logs through filters.
fn conditioned(logs: Vec<MeasuredLog>, filters: Filters) -> Result<Vec<Signals>, Error> {
    let of = |log: MeasuredLog| {
        let file = log.file.clone();
        Signals::new(log, filters).map_err(|error| Error::condition(error).in_log(&file))
    };
    logs.into_iter().map(of).collect()
}

/// Filters that leave bands above the motion, which tell noise.
fn filters_of(logs: &[MeasuredLog]) -> Result<Filters, Error> {
    let [least_hz, most_hz] = policy::CUTOFF_HZ;
    let step_s = logs.iter().map(|log| log.step_s).fold(f64::MIN_POSITIVE, f64::max);
    let widest_hz = most_hz.min(policy::CUTOFF_OF_RATE / step_s);
    let widest = Filters::of_torques(widest_hz);
    let signals = conditioned(logs.to_vec(), widest)?;
    let driven_hz = signals.iter().map(Signals::driven_hz).fold(0.0, f64::max);
    let wanted_hz = (policy::CUTOFF_OVER_DRIVEN * driven_hz).max(least_hz).min(widest_hz);
    let wanted = Filters { torque_hz: wanted_hz, ..widest };
    // A lower cutoff needs longer logs.
    let has_rows = |logs: Vec<Signals>| logs.iter().all(Signals::has_rows_to_spare);
    Ok(if conditioned(logs.to_vec(), wanted).is_ok_and(has_rows) { wanted } else { widest })
}
