//! `denavit completions`: what a shell needs to complete the command.

use super::failure::Failure;
use super::{Answer, Cli};
use clap::{Args, CommandFactory};
use clap_complete::Shell;
use std::io::Write;

/// Print a script that completes subcommands and options in a shell
///
/// The script goes to standard output. Where a shell looks for it differs: see the guide,
/// docs/guide/shell.md.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit completions bash
  denavit completions zsh
  denavit completions fish")]
pub(crate) struct Arguments {
    /// The shell
    #[arg(value_name = "SHELL", value_enum)]
    shell: Shell,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    // generated into memory: an output that has gone is no reason to panic
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Cli::command(), "denavit", &mut script);
    out.write_all(&script)?;
    Ok(Answer::Done)
}
