//! What a model lacks, from logs: read, the model's effects apart, compared with the catalogue.

mod completed;

use crate::error::{Cause, Error};
use crate::logs::Logs;
use crate::observer::{Observer, Progress, Reading, Stage, Watched};
use crate::robot_file::{EffectUse, RobotFile, Treatment};
pub use completed::{Completed, NamedEffect};
use denavit_codegen::alias::ExactAliases;
use denavit_codegen::effect::{self, Channel, Effect};
use denavit_codegen::model::Robot;
use denavit_codegen::regressor::functions::modelled;
use denavit_diagnose::{
    BeforeSprings, Candidate, Diagnosis, Experiment, Filters, Moved, Request, Spring, Verdict,
    before_springs, candidates, given_candidates, spring_candidates,
};
use denavit_measure::Split;
use denavit_measure::condition::{Conditioned, Conditioning};
use denavit_measure::log::{LogRemark, MeasuredLog};
use denavit_plants::effect::ApartEffects;
use denavit_plants::regression::RegressionModel;
use denavit_replay::Ground;

/// How a model is diagnosed.
#[derive(Clone, Debug)]
pub struct DiagnoseOptions {
    /// Most effects to find.
    pub most_effects: usize,
    /// Cutoff of the filter of torques \[Hz\]; without it the filter follows from the motion.
    pub filter_hz: Option<f64>,
    /// What motions that separate names are drawn with; without it none are looked for.
    pub experiment_seed: Option<u64>,
}

impl Default for DiagnoseOptions {
    fn default() -> Self {
        Self { most_effects: 6, filter_hz: None, experiment_seed: None }
    }
}

/// A diagnosis with what it is about.
pub struct Diagnosed {
    /// The robot, without laws beside its equations.
    pub robot: Robot,
    /// Base parameters and their columns.
    pub model: RegressionModel,
    /// Effects in their places that were compared.
    pub candidates: Vec<Candidate>,
    /// The catalogue, with a user's own effects.
    pub effects: Vec<Effect>,
    /// What was found.
    pub found: Diagnosis,
    /// What was noticed of logs, each with its file.
    pub remarks: Vec<(String, LogRemark)>,
    /// What becomes of the effects that the model has.
    pub model_effects: Vec<EffectUse>,
    /// The numbers in the model's file of those that were estimated again.
    numbers: Vec<usize>,
    /// The text of the model's file.
    source: String,
}

/// What becomes of laws beside the equations that the model has.
const ESTIMATED: Treatment =
    Treatment { name: "estimated", words: "estimated again within its stated errors" };

/// Says which effects a model lacks, where, and how sure that is: the model's own parameters are
/// estimated again within their standard deviations, effects of the catalogue are compared by the
/// evidence of the logs for training, and those held out judge.
///
/// Work that the observer stops returns the best so far, whose verdict says that the rest was not
/// compared; before logs are read there is none.
///
/// # Errors
/// All that is wrong with the logs, or why they do not suit the robot.
pub fn diagnose(
    file: &RobotFile,
    logs: &Logs,
    options: &DiagnoseOptions,
    observer: &mut dyn Observer,
) -> Result<Diagnosed, Error> {
    let mut watched = Watched::new(observer);
    let mut remarks = Vec::new();
    if !watched.begins(Stage::ReadingLogs) {
        return Err(Cause::Stopped.into());
    }
    let count = logs.train.len() + logs.held_out.len();
    // one whose time is over while logs are read gets the answer that nothing was compared
    let mut reading = Reading::needed(&mut watched, Stage::ReadingLogs, count);
    let Subject { robot, model, springs, logs } = subject(file, logs, &mut reading, &mut remarks)?;
    let laws = &file.apart.laws;
    let effects = with_own(&file.own);
    let kept = laws.iter().filter(|law| law.law.channel() != Some(Channel::Rate));
    let numbers: Vec<usize> = kept.map(|law| law.number).collect();
    let (given_laws, given) = given_candidates(laws.clone());
    let mut searched = candidates(&effects, &robot, &model);
    searched.append(&mut spring_candidates(&effects, &springs, &model));
    let candidates = with_given(given_laws, searched);
    let moved =
        Moved { source: &file.source, effects: &effects, numbers: &numbers, logs: logs.clone() };
    let aliases = ExactAliases::new(&robot, &effects);
    let request = Request {
        model: &model,
        springs: &springs,
        train: logs.train,
        held_out: logs.held_out,
        candidates: &candidates,
        given,
        aliases: aliases.as_ref(),
        experiment: options.experiment_seed.map(|seed| (&robot, seed)),
        moved: Some(&moved),
        most_effects: options.most_effects,
        filters: options.filter_hz.map(Filters::of_torques),
    };
    let mut best = Vec::new();
    let found = denavit_diagnose::diagnose(request, &mut |at| {
        let (stage, share) = match at {
            denavit_diagnose::Progress::Evaluated(share) => {
                (Stage::EvaluatingEffects, Some(*share))
            }
            denavit_diagnose::Progress::Found(taken) => {
                best = places(&candidates, taken);
                (Stage::EffectsFound(taken.len()), None)
            }
        };
        watched.progress(&Progress { stage, share, best: &best, ..Progress::default() })
    });
    let found = found.map_err(Cause::Diagnosis)?;
    let (model_effects, source) = (file.uses(ESTIMATED), file.source.clone());
    Ok(Diagnosed {
        robot,
        model,
        candidates,
        effects,
        found,
        remarks,
        model_effects,
        numbers,
        source,
    })
}

/// What is diagnosed, by what.
struct Subject {
    robot: Robot,
    model: RegressionModel,
    springs: Vec<Spring>,
    logs: Split<Vec<MeasuredLog>>,
}

/// The robot and its logs; before the springs of its drives, where the logs have their motors.
fn subject(
    file: &RobotFile,
    logs: &Logs,
    reading: &mut Reading<'_, '_>,
    remarks: &mut Vec<(String, LogRemark)>,
) -> Result<Subject, Error> {
    let ApartEffects { robot, .. } = &file.apart;
    let model = regression(robot)?;
    let sources = logs.train.iter().chain(&logs.held_out);
    let measured = sources.map(|source| {
        reading.next()?;
        logs.measured(source, robot, &model)
    });
    let all = Error::of_any_log(measured)?;
    let mut logs = checked(all, logs.train.len(), robot, &model, remarks)?;
    let before = before_springs(robot, &model.joints, &mut [&mut logs.train, &mut logs.held_out]);
    let (robot, model, springs) = match before {
        Some(BeforeSprings { robot, springs }) => {
            let model = regression(&robot)?;
            (robot, model, springs)
        }
        None => (robot.clone(), model, Vec::new()),
    };
    Ok(Subject { robot, model, springs, logs })
}

impl Diagnosed {
    /// Whether the model, with what was found, explains logs that judge it.
    pub fn is_good(&self) -> bool {
        let explains = matches!(self.found.verdict, Verdict::NothingMissing | Verdict::Explained);
        explains && self.searched_again().next().is_none()
    }

    /// Logs for judging that say the same as one that was searched: they judge nothing.
    pub fn searched_again(&self) -> impl Iterator<Item = [&str; 2]> {
        self.remarks.iter().filter_map(|(file, remark)| match remark {
            LogRemark::SameAs { other } => Some([file.as_str(), other.as_str()]),
            _ => None,
        })
    }

    /// Motions that separate names, each with the number of its effect.
    pub fn experiments(&self) -> impl Iterator<Item = (usize, &Experiment)> {
        let all = self.found.effects.iter().enumerate();
        all.filter_map(|(number, one)| Some((number, one.experiment.as_ref()?.as_ref().ok()?)))
    }
}

/// Effects in their places.
fn places(candidates: &[Candidate], taken: &[usize]) -> Vec<[String; 2]> {
    let place = |&one: &usize| {
        let own = &candidates[one];
        [own.effect.clone(), own.at.clone()]
    };
    taken.iter().map(place).collect()
}

fn regression(robot: &Robot) -> Result<RegressionModel, Error> {
    let model = RegressionModel::new(robot, modelled(robot), &[]);
    Ok(model.map_err(Cause::Regression)?)
}

/// The logs that are searched, the first ones, and those that judge; none says the same as another
/// for the search, and loads of the ground are known.
fn checked(
    mut all: Vec<MeasuredLog>,
    searched: usize,
    robot: &Robot,
    model: &RegressionModel,
    remarks: &mut Vec<(String, LogRemark)>,
) -> Result<Split<Vec<MeasuredLog>>, Error> {
    let failed = |error| Cause::Plant(model.model.clone(), error);
    let mut ground = Ground::under(robot, model).map_err(failed)?;
    for log in &mut all {
        for remark in std::mem::take(&mut log.remarks) {
            let remark = (log.file.clone(), remark);
            // A log may be given twice.
            if !remarks.contains(&remark) {
                remarks.push(remark);
            }
        }
    }
    let held_out = all.split_off(searched);
    let mut sets = Split { train: all, held_out };
    let train = &sets.train;
    let same = train.iter().enumerate().find_map(|(at, log)| {
        let before = train[..at].iter().find(|other| other.joints == log.joints)?;
        Some([&before.file, &log.file].map(String::clone))
    });
    if let Some(same) = same {
        return Err(Cause::SameLogs(same).into());
    }
    remarks.extend(searched_again(model, &sets));
    if ground.is_none()
        && sets.train.iter().chain(&sets.held_out).any(|log| !log.wrenches.is_empty())
    {
        ground = Some(Ground::around(robot, model).map_err(failed)?);
    }
    if let Some(ground) = &mut ground {
        for log in sets.train.iter_mut().chain(&mut sets.held_out) {
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
    sets: &Split<Vec<MeasuredLog>>,
) -> Vec<(String, LogRemark)> {
    let names: Vec<String> = model.joints.iter().map(|joint| joint.name.clone()).collect();
    let as_it_is = |log: &MeasuredLog| {
        // one that is too short is refused later
        Conditioned::new(log.clone(), &names, &Conditioning::default()).ok()
    };
    let searched: Vec<Conditioned> = sets.train.iter().filter_map(as_it_is).collect();
    let judging = sets.held_out.iter().filter_map(as_it_is);
    let same = judging.filter_map(|log| {
        let other = searched.iter().find(|other| other.shares_a_part(&log))?.file.clone();
        Some((log.file, LogRemark::SameAs { other }))
    });
    same.collect()
}

/// What the model has, then everything else that may be missing.
fn with_given(mut given: Vec<Candidate>, mut searched: Vec<Candidate>) -> Vec<Candidate> {
    let place = |one: &Candidate| (one.effect.clone(), one.at.clone(), one.is_behind_spring);
    let is = |one: &Candidate, other: &Candidate| place(one) == place(other);
    searched.retain(|one| given.iter().all(|given| !is(given, one)));
    given.append(&mut searched);
    given
}

/// The catalogue, with a user's own effects.
fn with_own(own: &[Effect]) -> Vec<Effect> {
    let mut all = effect::catalogue().to_vec();
    for own in own {
        all.retain(|known| known.name != own.name);
        all.push(own.clone());
    }
    all
}
