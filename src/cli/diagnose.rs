//! `denavit diagnose`: what a model lacks, from logs.

mod json;
mod text;

use super::Answer;
use super::failure::Failure;
use super::files::{given_effects, open_log, read_file, read_model, write_whole};
use super::identify::IdentifyFailure;
use super::progress::Progress;
use clap::Args;
use denavit::diagnose::{
    Candidate, Diagnosis, DiagnosisError, Request, SearchOptions, Uncertainty, Verdict,
    before_springs, candidates, diagnose,
};
use denavit::effect::{self, Effect};
use denavit::identify::log::{ColumnMapping, LogOf, LogRemark, MeasuredLog, read_log};
use denavit::model::Robot;
use denavit::plants::regression::RegressionModel;
use denavit::regressor::functions::modelled;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Diagnose: which physics does a model lack, where, and how sure is that
///
/// The model's own parameters are estimated again within their standard deviations; what is left
/// of the torques of --train is searched for effects of the catalogue, and every effect must lower
/// what is left of --validate. Exits with 1 if what is left is not explained.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit simulate tulip_leg_identification -o leg.csv
  denavit diagnose tulip_leg_table34 --train leg.csv --validate leg.csv
  denavit diagnose tulip_leg_table34 --train leg.csv --validate leg.csv --json")]
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
    /// Which columns of the logs are ours: {"q_knee": {"column": "a", "scale": 1, "offset": 0}}
    #[arg(long, value_name = "MAP.json")]
    columns: Option<PathBuf>,
    /// A folder of effects beside those of the catalogue
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
    /// What the turns of decoys begin with
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Take logs as they are, however wrong they look
    #[arg(long)]
    accept_suspicious: bool,
    /// Write all of it into a folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// What is shown.
struct Shown<'a> {
    robot: &'a Robot,
    model: &'a RegressionModel,
    candidates: &'a [Candidate],
    found: &'a Diagnosis,
    remarks: &'a [(String, LogRemark)],
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let robot = read_model(&arguments.model)?;
    let model = regression(&robot)?;
    // Before its logs are asked for columns of a base.
    DiagnosisError::check_model(&model).map_err(Failure::Diagnose)?;
    let mut remarks = Vec::new();
    let mut read = |paths: &[PathBuf]| -> Result<Vec<MeasuredLog>, Failure> {
        paths.iter().map(|path| log(arguments, &robot, &model, path, &mut remarks)).collect()
    };
    let (mut train, mut held_out) = (read(&arguments.train)?, read(&arguments.validate)?);
    let before = before_springs(&robot, &model.joints, &mut [&mut train, &mut held_out]);
    let (robot, model) = match before {
        Some(robot) => {
            let model = regression(&robot)?;
            (robot, model)
        }
        None => (robot, model),
    };
    let effects = effects(arguments.effects.as_deref())?;
    let candidates = candidates(&effects, &robot, &model.joints);
    let progress = Progress::new();
    let request = Request {
        model: &model,
        train,
        held_out,
        candidates: &candidates,
        uncertainty: Uncertainty::default(),
        options: SearchOptions {
            most_effects: usize::from(arguments.most),
            seed: arguments.seed,
            ..SearchOptions::default()
        },
        filters: None,
    };
    let found = diagnose(request, &mut |taken, gap| {
        progress.show(&format!("{} effects, held-out gap {:.2} %", taken.len(), 100.0 * gap));
    });
    progress.clear();
    let found = found.map_err(Failure::Diagnose)?;
    let shown = Shown {
        robot: &robot,
        model: &model,
        candidates: &candidates,
        found: &found,
        remarks: &remarks,
    };
    if let Some(folder) = &arguments.out {
        let failure = |error| Failure::Write { file: folder.display().to_string(), error };
        std::fs::create_dir_all(folder).map_err(failure)?;
        let mut bytes = Vec::new();
        json::write(&mut bytes, &shown)?;
        write_whole(&folder.join("diagnosis.json"), &bytes)?;
    }
    match arguments.json {
        true => json::write(out, &shown)?,
        false => text::write(out, &shown)?,
    }
    Ok(match found.verdict {
        Verdict::NothingMissing | Verdict::Explained => Answer::Done,
        _ => Answer::Negative,
    })
}

fn regression(robot: &Robot) -> Result<RegressionModel, Failure> {
    let model = RegressionModel::new(robot, modelled(robot), &[]);
    Ok(model.map_err(|error| IdentifyFailure::Regression(Box::new(error)))?)
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
    let mut log = read_log(&file, open_log(path)?, of, &mapping).map_err(IdentifyFailure::Log)?;
    let found = std::mem::take(&mut log.remarks);
    remarks.extend(found.into_iter().map(|remark| (file.clone(), remark)));
    Ok(log)
}

/// The catalogue, with the files of a folder.
fn effects(folder: Option<&Path>) -> Result<Vec<Effect>, Failure> {
    let mut all = effect::catalogue().to_vec();
    for own in folder.map_or_else(|| Ok(Vec::new()), given_effects)? {
        all.retain(|known| known.name != own.name);
        all.push(own);
    }
    Ok(all)
}
