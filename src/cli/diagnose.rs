//! `denavit diagnose`: what a model lacks, from logs.

mod json;
mod model;
mod page;
mod text;

use super::Answer;
use super::failure::Failure;
use super::files::{effects_folder, read_file};
use super::identify::IdentifyFailure;
use super::logs::measured_log;
use super::model_effects::{EffectUse, ModelApart};
use super::outputs::{NewDirectory, check_outputs, write_together};
use super::progress::Progress;
use clap::Args;
use denavit::diagnose::{
    BeforeSprings, Candidate, Diagnosis, ExactAliases, Experiment, ExperimentOptions, Filters,
    FoundEffect, Moved, Progress as Stage, Request, SearchOptions, Uncertainty, Verdict,
    before_springs, candidates, diagnose, given_candidates, spring_candidates,
};
use denavit::effect::{Channel, Effect};
use denavit::identify::Ground;
use denavit::measure::condition::{Conditioned, Conditioning};
use denavit::measure::log::{ColumnMapping, LogOf, LogRemark, MeasuredLog};
use denavit::model::Robot;
use denavit::plants::effect::ApartEffects;
use denavit::plants::regression::RegressionModel;
use denavit::regressor::functions::modelled;
use denavit::report::verdict_paragraph;
use model::Completed;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Diagnose: which physics does a model lack, where, and how sure is that
///
/// The model's own parameters are estimated again within their standard deviations. Effects of the
/// catalogue are compared by the evidence of all logs, their values are fitted to --train, and
/// --validate says what is then left. Exits with 1 if what is left is not explained, or if logs of
/// --validate are among those of --train.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit demo --out demo   makes logs of a leg with something hidden, among others
  denavit diagnose tulip_leg_table34 --train demo/blind_train.csv --validate demo/blind_validate.csv
  denavit diagnose tulip_leg_table34 --train demo/blind_train.csv \
    --validate demo/blind_validate.csv --out found   also writes report.html, and the model")]
pub(crate) struct Arguments {
    /// Path of a model, name of a shipped one, or - for standard input
    #[arg(value_name = "MODEL")]
    model: PathBuf,
    /// Logs to search
    #[arg(long, value_name = "LOG", num_args = 1.., required = true)]
    train: Vec<PathBuf>,
    /// Logs to judge with: another motion
    #[arg(long, value_name = "LOG", num_args = 1.., required = true)]
    validate: Vec<PathBuf>,
    /// Which columns of the logs are ours: {"q_knee": {"column": "a", "scale": 1, "offset": 0},
    /// "q_{joint}": "/joint_states/{joint}/position"}
    #[arg(long, value_name = "MAP.json")]
    columns: Option<PathBuf>,
    /// A folder of effects beside those of the catalogue; without it the folder `effects` beside
    /// the model
    #[arg(long, value_name = "DIR")]
    effects: Option<PathBuf>,
    /// Most effects to find
    #[arg(
        long,
        value_name = "N",
        default_value_t = 6,
        value_parser = clap::value_parser!(u8).range(1..=20)
    )]
    most: u8,
    /// What separating experiments are drawn with
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Cutoff of the filter of torques in Hz; without it the filter follows from the motion
    #[arg(long, value_name = "HZ", value_parser = positive)]
    filter: Option<f64>,
    /// Stop after so many seconds, with the best until then
    #[arg(long, value_name = "S", value_parser = positive)]
    time_limit: Option<f64>,
    /// Take logs as they are, however wrong they look
    #[arg(long)]
    accept_suspicious: bool,
    /// Of a log that is cut or corrupt, take what is before the damage
    #[arg(long)]
    accept_cut: bool,
    /// Write all of it into a folder: diagnosis.json, the model with its effects as model.json,
    /// and a page, report.html
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// A diagnosis with what it is about.
pub(super) struct Shown {
    robot: Robot,
    model: RegressionModel,
    candidates: Vec<Candidate>,
    effects: Vec<Effect>,
    /// What was found.
    pub(super) found: Diagnosis,
    remarks: Vec<(String, LogRemark)>,
    /// What becomes of the effects that the model has.
    model_effects: Vec<EffectUse>,
    /// The numbers in the model's file of those that were estimated again.
    numbers: Vec<usize>,
    /// The text of the model's file.
    source: String,
    written: Option<Written>,
}

/// An effect in its place, as it was named.
#[derive(Serialize)]
pub(super) struct Named {
    /// The effect.
    pub(super) effect: String,
    /// Its place.
    pub(super) at: String,
    /// Values of its parameters.
    pub(super) parameters: BTreeMap<String, f64>,
    /// Effects with their places that would do as well.
    pub(super) or: Vec<[String; 2]>,
}

/// What was written into a folder.
struct Written {
    folder: PathBuf,
    /// Whether the model with its effects is there; the reason if it could not be.
    model: Result<bool, String>,
}

/// What becomes of laws beside the equations that the model has.
const ESTIMATED: (&str, &str) = ("estimated", "estimated again within its stated errors");

/// The files of a folder.
const DIAGNOSIS: &str = "diagnosis.json";
const MODEL: &str = "model.json";
const REPORT: &str = "report.html";

/// The file of the experiment that separates an effect from what would do as well.
fn experiment_file(number: usize) -> String {
    format!("separating_{}.json", number + 1)
}

impl Shown {
    /// What was found, in order.
    pub(super) fn named(&self) -> Vec<Named> {
        let name = |candidate: usize| {
            let own = &self.candidates[candidate];
            [own.effect.clone(), own.at.clone()]
        };
        let of = |one: &FoundEffect| {
            let [mut effect, at] = name(one.candidate);
            if !one.is_named {
                effect = "unnamed".to_owned();
            }
            let values = one.parameters.iter().map(|value| (value.name.clone(), value.value));
            let or = one.alternatives.iter().map(|other| name(other.candidate)).collect();
            Named { effect, at, parameters: values.collect(), or }
        };
        self.found.effects.iter().map(of).collect()
    }

    /// The answer in a paragraph.
    pub(super) fn paragraph(&self) -> String {
        verdict_paragraph(&self.found, &self.candidates)
    }

    /// The files that were written, each with what it is.
    pub(super) fn files(&self) -> Vec<(PathBuf, &'static str)> {
        let Some(written) = &self.written else { return Vec::new() };
        let has_model = written.model == Ok(true);
        let all = [
            (DIAGNOSIS, "the diagnosis as JSON"),
            (MODEL, "the model with the effects that were found"),
            (REPORT, "the diagnosis as a page"),
        ];
        let there = all.into_iter().filter(|(name, _)| has_model || *name != MODEL);
        let there = there.map(|(name, what)| (written.folder.join(name), what));
        let what = "a motion that separates names";
        let motions = self.experiments();
        let motions = motions.map(|(at, _)| (written.folder.join(experiment_file(at)), what));
        there.chain(motions).collect()
    }

    /// Logs for judging that say the same as one that was searched: they judge nothing.
    fn searched_again(&self) -> impl Iterator<Item = [&str; 2]> {
        self.remarks.iter().filter_map(|(file, remark)| match remark {
            LogRemark::SameAs { other } => Some([file.as_str(), other.as_str()]),
            _ => None,
        })
    }

    /// Experiments that were found, each with the number of its effect.
    fn experiments(&self) -> impl Iterator<Item = (usize, &Experiment)> {
        let all = self.found.effects.iter().enumerate();
        all.filter_map(|(number, one)| Some((number, one.experiment.as_ref()?.as_ref().ok()?)))
    }

    /// Why the folder has no model, if it has none.
    fn about_model(&self) -> Option<String> {
        match &self.written.as_ref()?.model {
            Ok(true) => None,
            Ok(false) => Some(format!("no {MODEL}: no effect was named that could be added")),
            Err(reason) => Some(format!("no {MODEL}: {reason}")),
        }
    }
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let _made = arguments.out.as_deref().map(NewDirectory::make).transpose()?;
    if let Some(folder) = &arguments.out {
        let files = [DIAGNOSIS, MODEL, REPORT].map(|name| folder.join(name));
        check_outputs(&files.each_ref().map(Some))?;
    }
    let progress = Progress::new();
    let mut shown = of_logs(arguments, &progress)?;
    progress.clear();
    if let Some(folder) = &arguments.out {
        write_folder(arguments, folder, &mut shown)?;
    }
    match arguments.json {
        true => json::write(out, &shown)?,
        false => text::write(out, &shown)?,
    }
    let is_judged = shown.searched_again().next().is_none();
    Ok(match shown.found.verdict {
        Verdict::NothingMissing | Verdict::Explained if is_judged => Answer::Done,
        _ => Answer::Negative,
    })
}

/// Diagnoses a model from the logs of two motions, of which it searches the first, and writes all
/// of it into a folder.
pub(super) fn of_motions(
    model: &str,
    logs: &[PathBuf],
    folder: &Path,
    progress: &Progress,
) -> Result<Shown, Failure> {
    let (train, validate) = logs.split_at(1.min(logs.len()));
    let arguments = Arguments {
        model: PathBuf::from(model),
        train: train.to_vec(),
        validate: validate.to_vec(),
        columns: None,
        effects: None,
        most: 3,
        seed: 1,
        filter: None,
        time_limit: None,
        accept_suspicious: false,
        accept_cut: false,
        out: Some(folder.to_owned()),
        json: false,
    };
    let mut shown = of_logs(&arguments, progress)?;
    write_folder(&arguments, folder, &mut shown)?;
    Ok(shown)
}

/// Reads model and logs, and diagnoses.
fn of_logs(arguments: &Arguments, progress: &Progress) -> Result<Shown, Failure> {
    let given = ModelApart::read(&arguments.model, arguments.effects.as_deref())?;
    let model_effects = given.uses(ESTIMATED);
    let ModelApart { apart: ApartEffects { robot, laws, .. }, own, source, .. } = given;
    let model = regression(&robot)?;
    let mut remarks = Vec::new();
    let [mut train, mut held_out] = logs(arguments, &robot, &model, &mut remarks)?;
    let before = before_springs(&robot, &model.joints, &mut [&mut train, &mut held_out]);
    let (robot, model, springs) = match before {
        Some(BeforeSprings { robot, springs }) => {
            let model = regression(&robot)?;
            (robot, model, springs)
        }
        None => (robot, model, Vec::new()),
    };
    let effects = with_own(own);
    let kept = laws.iter().filter(|law| law.law.channel() != Some(Channel::Rate));
    let numbers: Vec<usize> = kept.map(|law| law.number).collect();
    let (given_laws, given) = given_candidates(laws, Uncertainty::default());
    let mut searched = candidates(&effects, &robot, &model);
    searched.append(&mut spring_candidates(&effects, &springs, &model));
    let candidates = with_given(given_laws, searched);
    let moved = Moved {
        source: &source,
        effects: &effects,
        numbers: &numbers,
        logs: [train.clone(), held_out.clone()],
    };
    let aliases = ExactAliases::new(&robot, &effects);
    let experiment = ExperimentOptions { seed: arguments.seed, ..ExperimentOptions::default() };
    let request = Request {
        model: &model,
        springs: &springs,
        train,
        held_out,
        candidates: &candidates,
        given,
        aliases: aliases.as_ref(),
        experiment: arguments.out.as_ref().map(|_| (&robot, experiment)),
        moved: Some(&moved),
        uncertainty: Uncertainty::default(),
        options: SearchOptions { most_effects: usize::from(arguments.most) },
        filters: arguments.filter.map(Filters::of_torques),
    };
    let started = Instant::now();
    let found = diagnose(request, &mut |at| {
        match at {
            Stage::Evaluated(share) => progress.show_share("effects evaluated", *share),
            Stage::Found(taken) => progress.show(&format!("{} effects found", taken.len())),
        }
        arguments.time_limit.is_none_or(|most_s| started.elapsed().as_secs_f64() < most_s)
    });
    let found = found.map_err(Failure::Diagnose)?;
    Ok(Shown {
        robot,
        model,
        candidates,
        effects,
        found,
        remarks,
        model_effects,
        numbers,
        source,
        written: None,
    })
}

/// Writes answer, model and page, which belong together: all of them, or none.
fn write_folder(arguments: &Arguments, folder: &Path, shown: &mut Shown) -> Result<(), Failure> {
    let _made = NewDirectory::make(folder)?;
    let mut files = Vec::new();
    let mut _effects_made = None;
    let completed = model::complete(&shown.source, shown, &shown.effects);
    let model = match &completed {
        Completed::Text(text) => {
            let own = effects_folder(&arguments.model, arguments.effects.as_deref());
            if let Some(own) = own.filter(|own| own.is_dir()) {
                files = model::definitions(&own, folder, shown)?;
            }
            if let Some((path, _)) = files.first() {
                _effects_made = path.parent().map(NewDirectory::make).transpose()?;
            }
            files.push((folder.join(MODEL), text.clone().into_bytes()));
            Ok(true)
        }
        Completed::NothingFound => Ok(false),
        Completed::Refused(reason) => Err(reason.clone()),
    };
    shown.written = Some(Written { folder: folder.to_owned(), model });
    for (number, experiment) in shown.experiments() {
        let mut bytes = serde_json::to_vec_pretty(&experiment.file)?;
        bytes.push(b'\n');
        files.push((folder.join(experiment_file(number)), bytes));
    }
    files.push((folder.join(REPORT), page::of(arguments, shown).render().into_bytes()));
    let mut bytes = Vec::new();
    json::write(&mut bytes, shown)?;
    files.push((folder.join(DIAGNOSIS), bytes));
    write_together(&files)
}

fn regression(robot: &Robot) -> Result<RegressionModel, Failure> {
    let model = RegressionModel::new(robot, modelled(robot), &[]);
    Ok(model.map_err(|error| IdentifyFailure::Regression(Box::new(error)))?)
}

/// Reads the logs that are searched and those that judge.
fn logs(
    arguments: &Arguments,
    robot: &Robot,
    model: &RegressionModel,
    remarks: &mut Vec<(String, LogRemark)>,
) -> Result<[Vec<MeasuredLog>; 2], Failure> {
    let failed = |error| IdentifyFailure::Plant(model.model.clone(), error);
    let mut ground = Ground::under(robot, model).map_err(failed)?;
    let paths = arguments.train.iter().chain(&arguments.validate);
    let mut train =
        Failure::of_any_log(paths.map(|path| log(arguments, robot, model, path, remarks)))?;
    let validate = train.split_off(arguments.train.len());
    let mut sets = [train, validate];
    let [train, _] = &sets;
    let same = train.iter().enumerate().find_map(|(at, log)| {
        let before = train[..at].iter().find(|other| other.joints == log.joints)?;
        Some([&before.file, &log.file].map(String::clone))
    });
    if let Some(same) = same {
        return Err(IdentifyFailure::SameLogs(same).into());
    }
    remarks.extend(searched_again(model, &sets));
    if ground.is_none() && sets.iter().flatten().any(|log| !log.wrenches.is_empty()) {
        ground = Some(Ground::around(robot, model).map_err(failed)?);
    }
    if let Some(ground) = &mut ground {
        for log in sets.iter_mut().flatten() {
            ground.load(log);
            let found = std::mem::take(&mut log.remarks);
            remarks.extend(found.into_iter().map(|remark| (log.file.clone(), remark)));
        }
    }
    Ok(sets)
}

/// Logs for judging with a part that is one of a log that is searched, whatever their files are
/// called.
fn searched_again(
    model: &RegressionModel,
    sets: &[Vec<MeasuredLog>; 2],
) -> Vec<(String, LogRemark)> {
    let names: Vec<String> = model.joints.iter().map(|joint| joint.name.clone()).collect();
    let as_it_is = |log: &MeasuredLog| {
        // one that is too short is refused later
        Conditioned::new(log.clone(), &names, &Conditioning::default()).ok()
    };
    let [searched, judging] = sets.each_ref().map(|set| set.iter().filter_map(as_it_is));
    let searched: Vec<Conditioned> = searched.collect();
    let same = judging.filter_map(|log| {
        let other = searched.iter().find(|other| other.overlaps(&log))?.file.clone();
        Some((log.file, LogRemark::SameAs { other }))
    });
    same.collect()
}

fn log(
    arguments: &Arguments,
    robot: &Robot,
    model: &RegressionModel,
    path: &Path,
    remarks: &mut Vec<(String, LogRemark)>,
) -> Result<MeasuredLog, Failure> {
    let mapping = match &arguments.columns {
        None => ColumnMapping::default(),
        Some(path) => {
            let name = path.display().to_string();
            ColumnMapping::from_json(&name, &read_file(path)?).map_err(IdentifyFailure::Mapping)?
        }
    };
    let contacts: Vec<String> = robot.contacts.values().map(|one| one.name.clone()).collect();
    let file = path.display().to_string();
    let of = LogOf {
        model: &model.model,
        joints: &model.joints,
        contacts: &contacts,
        accepts_suspicious: arguments.accept_suspicious,
    };
    let mut log = measured_log(path, of, (&mapping, arguments.accept_cut))?;
    let found = std::mem::take(&mut log.remarks);
    for remark in found.into_iter().map(|remark| (file.clone(), remark)) {
        // A log may be given twice.
        if !remarks.contains(&remark) {
            remarks.push(remark);
        }
    }
    Ok(log)
}

/// What the model has, then everything else that may be missing.
fn with_given(mut given: Vec<Candidate>, mut searched: Vec<Candidate>) -> Vec<Candidate> {
    let is =
        |one: &Candidate, other: &Candidate| (&one.effect, &one.at) == (&other.effect, &other.at);
    searched.retain(|one| given.iter().all(|given| !is(given, one)));
    given.append(&mut searched);
    given
}

/// A number above 0.
fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("`{text}` is no number"))?;
    match value.is_finite() && value > 0.0 {
        true => Ok(value),
        false => Err("must be above 0".to_owned()),
    }
}

/// The catalogue, with a user's own effects.
fn with_own(own: Vec<Effect>) -> Vec<Effect> {
    let mut all = denavit::effect::catalogue().to_vec();
    for own in own {
        all.retain(|known| known.name != own.name);
        all.push(own);
    }
    all
}
