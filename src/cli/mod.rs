//! The command: one file for each subcommand; what they share stands here, in `files`,
//! `outputs` and `printed`.
//!
//! Answers go to standard output; failures, notes and the progress of long work to standard error
//! (`said`, `progress`). Exit codes: 0 done; 1 done, and the answer is negative; 2 bad input or
//! usage.
//! [`embedded`] is the command inside another program.

mod base;
mod completions;
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
mod flags;
mod identify;
mod import;
mod inspect;
mod json;
mod list;
mod logs;
mod long;
mod man;
mod mistaken;
mod options;
mod output_failure;
mod outputs;
mod printed;
mod progress;
mod remarks;
mod said;
mod schema;
mod simulate;
mod unfinished;
mod verify;
mod view;
mod walk;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser, Subcommand};
use denavit::workflow::LogSource;
use failure::Failure;
use printed::{Printed, shown};
use said::{Loudness, say_error, say_note, say_time, set_loudness};
use std::env;
use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;
use std::time::Instant;

/// Symbolic robot dynamics: from a Denavit-Hartenberg table to exact equations and optimised Rust.
#[derive(Debug, Parser)]
#[command(name = "denavit", version, after_help = EXAMPLE, subcommand_required = true)]
struct Cli {
    #[command(flatten)]
    loudness: Loudness,
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
    Long(long::Arguments),
    Diagnose(diagnose::Arguments),
    Completions(completions::Arguments),
    Man(man::Arguments),
    View(view::Arguments),
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
    let started = Instant::now();
    let cli = match Cli::of(env::args_os()) {
        Ok(cli) => cli,
        Err(error) => {
            say_usage(&error);
            return ExitCode::from(if error.use_stderr() { 2 } else { 0 });
        }
    };
    let Cli { command, loudness } = cli;
    set_loudness(loudness);
    let mut out = Printed::new(io::BufWriter::new(io::stdout().lock()));
    let answer = command.run(&mut out);
    let answer = answer.and_then(|answer| Ok(out.flush().map(|()| answer)?));
    if loudness.is_verbose() {
        say_time("altogether", started.elapsed());
    }
    match answer {
        Ok(Answer::Done) => ExitCode::SUCCESS,
        Ok(Answer::Negative) => ExitCode::from(1),
        Err(failure) if failure.is_closed_pipe() => ExitCode::SUCCESS,
        Err(failure) => {
            say_error(&failure);
            ExitCode::from(2)
        }
    }
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

impl Cli {
    /// Of a whole command line.
    fn of(line: impl IntoIterator<Item = OsString>) -> Result<Self, clap::Error> {
        let cli = Self::try_parse_from(line)?;
        // said here: one may stand before the subcommand, the other after it, which clap lets pass
        if cli.loudness.contradicts_itself() {
            let fault = "the argument '--quiet' cannot be used with '--verbose'";
            return Err(Self::command().error(ErrorKind::ArgumentConflict, fault));
        }
        Ok(cli)
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
                | Self::Long(_)
                | Self::Diagnose(_)
        )
    }

    /// The logs of an option, if the subcommand has logs.
    fn logs_of(&mut self, option: &str) -> Option<&mut Vec<LogSource>> {
        match self {
            Self::Identify(arguments) => arguments.logs_of(option),
            Self::Long(arguments) => arguments.logs_of(option),
            Self::Diagnose(arguments) => arguments.logs_of(option),
            _ => None,
        }
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
            Self::Long(_) => "long",
            Self::Diagnose(_) => "diagnose",
            Self::Completions(_) => "completions",
            Self::Man(_) => "man",
            Self::View(_) => "view",
        }
    }

    fn run(&self, out: &mut dyn Write) -> Result<Answer, Failure> {
        if let (true, Err(unsupported)) = (self.computes(), denavit::plants::native_code()) {
            let note = "note: models are interpreted, which takes three to five times as long";
            say_note(&format!("{note}: {unsupported}"));
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
            Self::Long(arguments) => long::run(arguments, out),
            Self::Diagnose(arguments) => diagnose::run(arguments, out),
            Self::Completions(arguments) => completions::run(arguments, out),
            Self::Man(arguments) => man::run(arguments, out),
            Self::View(arguments) => view::run(arguments, out),
        }
    }
}
