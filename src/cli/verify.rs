//! `denavit verify`: checks a certificate against a model.

use super::Answer;
use super::failure::Failure;
use super::files::{FILES, read_robot};
use super::json::write_json;
use super::options::EffectsOption;
use clap::Args;
use denavit::regressor::Certificate;
use denavit::report::symbolic::{verdict_json, verdict_text};
use denavit::workflow::FileKind;
use std::io::Write;
use std::path::PathBuf;

/// Check a certificate of base parameters against its model
///
/// The rank by a determinant modulo a prime, each relation exactly, without any elimination.
/// Answers with exit code 1 if something does not hold.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit verify leg.certificate.json tulip_leg
  denavit verify leg.certificate.json tulip_leg --json")]
pub(crate) struct Arguments {
    /// Path of a certificate that `denavit base --certificate` wrote, or - for standard input
    #[arg(value_name = "CERTIFICATE")]
    certificate: PathBuf,
    /// Path of a model file, name of a shipped model, or - for standard input
    #[arg(value_name = "MODEL")]
    model: PathBuf,
    #[command(flatten)]
    effects: EffectsOption,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let bytes = FILES.wanted(&arguments.certificate, FileKind::Certificate)?;
    let certificate: Certificate = serde_json::from_slice(&bytes).map_err(|error| {
        Failure::Certificate { file: arguments.certificate.display().to_string(), error }
    })?;
    let model = read_robot(&arguments.model, arguments.effects.effects.as_deref())?;
    let robot = model.apart.robot;
    let verdict = certificate.verify(&robot);
    if arguments.json {
        write_json(out, &verdict_json(&robot.name, &certificate, &verdict))?;
    } else {
        write!(out, "{}", verdict_text(&robot.name, &certificate, &verdict))?;
    }
    Ok(if verdict.is_verified() { Answer::Done } else { Answer::Negative })
}
