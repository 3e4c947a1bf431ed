//! The command: one file for each subcommand; what they share stands here, in `files`,
//! `outputs` and `printed`.
//!
//! Answers go to standard output, progress to standard error where that is a terminal, failures to
//! standard error. Exit codes: 0 done; 1 done, and the answer is negative; 2 bad input or usage.
//! [`embedded`] is the command inside another program.

mod base;
mod count;
mod decompose;
mod demo;
mod derive;
mod diagnose;
pub mod embedded;
mod emit;
mod evaluate;
mod excite;
mod export;
mod failure;
mod files;
mod identify;
mod import;
mod inspect;
mod json;
mod list;
mod logs;
mod options;
mod output_failure;
mod outputs;
mod printed;
mod progress;
mod remarks;
mod schema;
mod simulate;
mod unfinished;
mod verify;
mod walk;

use clap::{Parser, Subcommand};
use failure::Failure;
use printed::{Printed, shown, standard_error};
use std::env;
use std::ffi::OsString;
use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

/// Symbolic robot dynamics: from a Denavit-Hartenberg table to exact equations and optimised Rust.
#[derive(Debug, Parser)]
#[command(name = "denavit", version, after_help = EXAMPLE, subcommand_required = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLE: &str = "\
MODEL is the path of a model file, of a URDF or of an MJCF, the name of a shipped model, or - for
standard input.
Exit codes: 0 done; 1 done, and the answer is negative; 2 bad input or usage.

Example:
  denavit inspect tulip";

#[derive(Debug, Subcommand)]
enum Command {
    Demo(demo::Arguments),
    Import(import::Arguments),
    Export(export::Arguments),
    List(list::Arguments),
    Inspect(inspect::Arguments),
    Derive(derive::Arguments),
    Decompose(decompose::Arguments),
    Count(count::Arguments),
    Evaluate(evaluate::Arguments),
    Emit(emit::Arguments),
    Base(base::Arguments),
    Verify(verify::Arguments),
    Schema(schema::Arguments),
    Simulate(simulate::Arguments),
    Walk(walk::Arguments),
    Excite(excite::Arguments),
    Identify(identify::Arguments),
    Diagnose(diagnose::Arguments),
}

/// What a command that ran to its end says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Answer {
    /// Done, and the answer is good.
    Done,
    /// Done, and the answer is negative.
    Negative,
}

/// Runs the command line of the process.
pub fn run() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            say_usage(&error);
            return ExitCode::from(if error.use_stderr() { 2 } else { 0 });
        }
    };
    let mut out = Printed::new(io::BufWriter::new(io::stdout().lock()));
    let answer = cli.command.run(&mut out);
    match answer.and_then(|answer| Ok(out.flush().map(|()| answer)?)) {
        Ok(Answer::Done) => ExitCode::SUCCESS,
        Ok(Answer::Negative) => ExitCode::from(1),
        Err(failure) if failure.is_closed_pipe() => ExitCode::SUCCESS,
        Err(failure) => {
            say_error(&failure);
            ExitCode::from(2)
        }
    }
}

/// Says on standard error what nobody may see.
fn say_error(said: &impl Display) {
    if let Some(observed) = embedded::observed() {
        return observed.note(&said.to_string());
    }
    let mut errors = standard_error();
    let _ = writeln!(errors, "{said}").and_then(|()| errors.flush());
}

/// Prints help, or what is wrong with the usage: in colours, unless an argument brings control
/// characters along.
fn say_usage(error: &clap::Error) {
    let is_plain = |argument: OsString| {
        let argument = argument.to_string_lossy();
        shown(&argument) == argument
    };
    if env::args_os().all(is_plain) {
        // help that nobody reads, or an error that nobody sees: nothing is left to say
        let _ = error.print();
    } else {
        say_error(&error.render().to_string().trim_end());
    }
}

impl Command {
    /// Whether the command evaluates models again and again.
    fn computes(&self) -> bool {
        matches!(
            self,
            Self::Demo(_)
                | Self::Simulate(_)
                | Self::Walk(_)
                | Self::Excite(_)
                | Self::Identify(_)
                | Self::Diagnose(_)
        )
    }

    /// The name of the subcommand.
    fn name(&self) -> &'static str {
        match self {
            Self::Demo(_) => "demo",
            Self::Import(_) => "import",
            Self::Export(_) => "export",
            Self::List(_) => "list",
            Self::Inspect(_) => "inspect",
            Self::Derive(_) => "derive",
            Self::Decompose(_) => "decompose",
            Self::Count(_) => "count",
            Self::Evaluate(_) => "evaluate",
            Self::Emit(_) => "emit",
            Self::Base(_) => "base",
            Self::Verify(_) => "verify",
            Self::Schema(_) => "schema",
            Self::Simulate(_) => "simulate",
            Self::Walk(_) => "walk",
            Self::Excite(_) => "excite",
            Self::Identify(_) => "identify",
            Self::Diagnose(_) => "diagnose",
        }
    }

    fn run(&self, out: &mut dyn Write) -> Result<Answer, Failure> {
        if let (true, Err(unsupported)) = (self.computes(), denavit::plants::native_code()) {
            let note = "note: models are interpreted, which takes three to five times as long";
            say_error(&format!("{note}: {unsupported}"));
        }
        match self {
            Self::Demo(arguments) => demo::run(arguments, out),
            Self::Import(arguments) => import::run(arguments, out),
            Self::Export(arguments) => export::run(arguments, out),
            Self::List(arguments) => list::run(arguments, out),
            Self::Inspect(arguments) => inspect::run(arguments, out),
            Self::Derive(arguments) => derive::run(arguments, out),
            Self::Decompose(arguments) => decompose::run(arguments, out),
            Self::Count(arguments) => count::run(arguments, out),
            Self::Evaluate(arguments) => evaluate::run(arguments, out),
            Self::Emit(arguments) => emit::run(arguments, out),
            Self::Base(arguments) => base::run(arguments, out),
            Self::Verify(arguments) => verify::run(arguments, out),
            Self::Schema(arguments) => schema::run(arguments, out),
            Self::Simulate(arguments) => simulate::run(arguments, out),
            Self::Walk(arguments) => walk::run(arguments, out),
            Self::Excite(arguments) => excite::run(arguments, out),
            Self::Identify(arguments) => identify::run(arguments, out),
            Self::Diagnose(arguments) => diagnose::run(arguments, out),
        }
    }
}
