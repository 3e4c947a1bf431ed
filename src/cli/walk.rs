//! `denavit walk`: gaits, their stability, and what each criterion misses.

mod poincare;

use super::Answer;
use super::failure::Failure;
use clap::{Args, Subcommand};
use std::io::Write;

/// Walk: design gaits, and say whether they are stable
///
/// The criteria are those of the thesis's chapter 4; docs/walking.md says what each means.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  denavit walk poincare planar_biped_limit_cycle_gait")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Poincare(poincare::Arguments),
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    match &arguments.command {
        Command::Poincare(arguments) => poincare::run(arguments, out),
    }
}
