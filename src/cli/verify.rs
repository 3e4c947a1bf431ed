//! `denavit verify`: checks a certificate against a model.

use super::Answer;
use super::failure::Failure;
use super::files::read_wanted;
use super::json::write_json;
use super::mistaken::Wanted;
use super::model_effects::ModelApart;
use super::options::EffectsOption;
use clap::Args;
use denavit::regressor::{Certificate, ParameterGroup, Verdict};
use serde::Serialize;
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

/// What a check found.
#[derive(Serialize)]
struct VerdictJson<'a> {
    model: &'a str,
    verified: bool,
    /// The number of base parameters.
    rank: Option<usize>,
    /// Whether each relation was also written out in every torque.
    multiplied_out: bool,
    /// What it is about: bodies, friction, ..
    about: Vec<&'static str>,
    verdict: String,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let bytes = read_wanted(&arguments.certificate, Wanted::Certificate)?;
    let certificate: Certificate = serde_json::from_slice(&bytes).map_err(|error| {
        Failure::Certificate { file: arguments.certificate.display().to_string(), error }
    })?;
    let model = ModelApart::read(&arguments.model, arguments.effects.effects.as_deref())?;
    let robot = model.apart.robot;
    let verdict = certificate.verify(&robot);
    let about: Vec<&str> = certificate.about().into_iter().map(ParameterGroup::as_str).collect();
    if arguments.json {
        let (rank, multiplied_out) = match verdict {
            Verdict::Verified { rank, multiplied_out } => (Some(rank), multiplied_out),
            _ => (None, false),
        };
        let (verified, model) = (verdict.is_verified(), robot.name.as_str());
        let verdict = verdict.to_string();
        write_json(out, &VerdictJson { model, verified, rank, multiplied_out, about, verdict })?;
    } else {
        writeln!(out, "{}: {verdict}", robot.name)?;
        writeln!(out, "about: {}", about.join(", "))?;
    }
    Ok(if verdict.is_verified() { Answer::Done } else { Answer::Negative })
}
