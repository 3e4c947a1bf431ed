//! `denavit diagnose`: what a model lacks, from logs.

mod page;

use super::Answer;
use super::failure::Failure;
use super::files::{FILES, effects_folder, is_input, mapping, read_robot};
use super::flags::by_flag;
use super::json::write_json;
use super::logs::{log_source, note_logs};
use super::outputs::{NewDirectory, check_outputs, write_together};
use super::progress::Progress;
use clap::{Args, ValueHint};
use denavit::report::answer::{DIAGNOSIS_FILES, DiagnosisFolder, diagnosed_json, diagnosed_text};
use denavit::workflow::{self, DiagnoseOptions, Diagnosed, LogSource, Logs, diagnose};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Diagnose: which physics does a model lack, where, and how sure is that
///
/// The model's own parameters are estimated again within their standard deviations. Effects of the
/// catalogue are compared by the evidence of all logs, their values are fitted to --train, and
/// --validate says what mismatch remains. Exits with 1 if that is not explained, or if logs of
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
    #[arg(long, value_name = "LOG", num_args = 1.., required = true, value_parser = log_source(),
        value_hint = ValueHint::AnyPath)]
    train: Vec<LogSource>,
    /// Logs to judge with: another motion
    #[arg(long, value_name = "LOG", num_args = 1.., required = true, value_parser = log_source(),
        value_hint = ValueHint::AnyPath)]
    validate: Vec<LogSource>,
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
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true)]
    seed: u64,
    /// Cutoff of the filter of torques in Hz; without it the filter follows from the motion
    #[arg(long, value_name = "HZ", value_parser = positive, allow_negative_numbers = true)]
    filter: Option<f64>,
    /// Stop after so many seconds, with the best until then
    #[arg(long, value_name = "S", value_parser = positive, allow_negative_numbers = true)]
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

impl Arguments {
    /// The logs of an option.
    pub(crate) fn logs_of(&mut self, option: &str) -> Option<&mut Vec<LogSource>> {
        match option {
            "train" => Some(&mut self.train),
            "validate" => Some(&mut self.validate),
            _ => None,
        }
    }
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let _made = arguments.out.as_deref().map(NewDirectory::make).transpose()?;
    note_logs(arguments.train.iter().chain(&arguments.validate));
    if let Some(folder) = &arguments.out {
        let files = DIAGNOSIS_FILES.map(|name| folder.join(name));
        check_outputs(&files.each_ref().map(Some))?;
    }
    let progress = Progress::new();
    let shown = of_logs(arguments, &progress)?;
    progress.clear();
    let folder = arguments.out.as_deref();
    let folder = folder.map(|folder| write_folder(arguments, folder, &shown)).transpose()?;
    match arguments.json {
        true => write_json(out, &diagnosed_json(&shown, folder.as_ref()))?,
        false => write!(out, "{}", by_flag(&diagnosed_text(&shown, folder.as_ref())))?,
    }
    Ok(if shown.is_good() { Answer::Done } else { Answer::Negative })
}

/// Diagnoses a model from the logs of two motions, of which it searches the first, and writes all
/// of it into a folder.
pub(super) fn of_motions(
    model: &str,
    logs: &[PathBuf],
    folder: &Path,
    progress: &Progress,
) -> Result<(Diagnosed, DiagnosisFolder), Failure> {
    let logs: Vec<LogSource> = logs.iter().cloned().map(LogSource::from).collect();
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
    let shown = of_logs(&arguments, progress)?;
    let folder = write_folder(&arguments, folder, &shown)?;
    Ok((shown, folder))
}

/// Reads model and logs, and diagnoses.
fn of_logs(arguments: &Arguments, progress: &Progress) -> Result<Diagnosed, Failure> {
    let robot = read_robot(&arguments.model, arguments.effects.as_deref())?;
    let logs = Logs {
        train: arguments.train.clone(),
        held_out: arguments.validate.clone(),
        columns: mapping(arguments.columns.as_deref())?,
        accepts_suspicious: arguments.accept_suspicious,
        accepts_cut: arguments.accept_cut,
    };
    let options = DiagnoseOptions {
        most_effects: usize::from(arguments.most),
        filter_hz: arguments.filter,
        experiment_seed: arguments.out.as_ref().map(|_| arguments.seed),
    };
    let started = Instant::now();
    let mut observer = |at: &workflow::Progress<'_>| {
        progress.report(at);
        arguments.time_limit.is_none_or(|most_s| started.elapsed().as_secs_f64() < most_s)
    };
    Ok(diagnose(&robot, &logs, &options, &mut observer)?)
}

/// Writes answer, model and page, which belong together: all of them, or none.
fn write_folder(
    arguments: &Arguments,
    folder: &Path,
    shown: &Diagnosed,
) -> Result<DiagnosisFolder, Failure> {
    let _made = NewDirectory::make(folder)?;
    let written = DiagnosisFolder::new(folder, shown);
    let (mut files, mut _effects_made) = (Vec::new(), None);
    if written.has_model() {
        let own = effects_folder(&arguments.model, arguments.effects.as_deref());
        if let Some(own) = own.filter(|own| own.is_dir()) {
            files = shown.definitions(&FILES, &own, &folder.join("effects"))?;
        }
        if let Some((path, _)) = files.first() {
            _effects_made = path.parent().map(NewDirectory::make).transpose()?;
        }
    }
    files.extend(written.contents(shown, page::of(arguments, shown, &written).render())?);
    let outdated = written.outdated(&files, &is_input);
    write_together(&files)?;
    outdated.iter().try_for_each(std::fs::remove_file)?;
    Ok(written)
}

/// A number above 0.
fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("`{text}` is no number"))?;
    match value.is_finite() && value > 0.0 {
        true => Ok(value),
        false => Err("must be a finite number above 0".to_owned()),
    }
}
