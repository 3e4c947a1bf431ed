//! `denavit verify`: checks a certificate against a model.

use super::Answer;
use super::failure::Failure;
use super::files::{read_file, read_model};
use clap::Args;
use denavit::regressor::Certificate;
use std::io::Write;
use std::path::PathBuf;

/// Check a certificate of base parameters against its model
///
/// The rank by a determinant modulo a prime, each relation exactly, without any elimination.
/// Answers with exit code 1 if something does not hold.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  denavit verify leg.certificate.json tulip_leg")]
pub(crate) struct Arguments {
    /// Path of a certificate that `denavit base --certificate` wrote
    #[arg(value_name = "CERTIFICATE")]
    certificate: PathBuf,
    /// Path of a model file, name of a shipped model, or - for standard input
    #[arg(value_name = "MODEL")]
    model: PathBuf,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let bytes = read_file(&arguments.certificate)?;
    let certificate: Certificate = serde_json::from_slice(&bytes).map_err(|error| {
        Failure::Certificate { file: arguments.certificate.display().to_string(), error }
    })?;
    let robot = read_model(&arguments.model)?;
    let verdict = certificate.verify(&robot);
    writeln!(out, "{}: {verdict}", robot.name)?;
    Ok(if verdict.is_verified() { Answer::Done } else { Answer::Negative })
}
