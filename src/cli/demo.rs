//! `denavit demo`: the whole way on two robots, with checks of what came out, and simulated runs.

mod diagnosed;

use super::Answer;
use super::failure::Failure;
use super::files::read_model_with_effects;
use super::identify;
use super::json::write_json;
use super::outputs::{NewDirectory, write_whole};
use super::progress::Progress;
use clap::Args;
use denavit::demo::{
    DecomposedOutcome, DemoRun, DiagnosedOutcome, Document, Experiment, IdentifiedOutcome, ROBOTS,
    RobotOutcome, Simulated, SimulatedRuns, Written,
};
use denavit::report::answer::drawn_run;
use diagnosed::diagnosed;
use serde::Serialize;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Derive, emit, draw, check, simulate, identify and diagnose TUlip, PUMA 560 and a biped
///
/// Needs no file: the models are part of the command. Its functions were generated when it was
/// built; they are run at random states against equations of motion that are derived in another
/// way. The exit code is 1 if they disagree. In the end an effect that the seed draws is hidden in
/// a simulated leg, diagnosed from logs alone, and revealed beside the answer, right or wrong.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit demo
  denavit demo --seed 7 --out demo_7
  denavit demo --json")]
pub(crate) struct Arguments {
    /// Draws the random states and what is hidden in the blind diagnosis
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Directory for the files that are written
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct DemoJson<'a> {
    version: &'a str,
    seed: u64,
    robots: &'a [RobotOutcome],
    decomposed: &'a DecomposedOutcome,
    simulated: &'a [Simulated],
    identified: &'a IdentifiedOutcome,
    diagnosed: &'a DiagnosedOutcome,
    seconds: f64,
    passed: bool,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let started = Instant::now();
    let progress = Progress::new();
    let version = env!("CARGO_PKG_VERSION");
    let &Arguments { seed, out: ref directory, json } = arguments;
    let _made = NewDirectory::make(directory)?;
    if !json {
        writeln!(out, "denavit {version}, seed {seed}")?;
    }
    let mut robots = Vec::new();
    for compiled in &ROBOTS {
        let robot = read_model_with_effects(Path::new(compiled.name), None)?;
        let show = |doing: &str| progress.show(doing);
        let mut write = |document| write(directory, document);
        let outcome = RobotOutcome::new(&robot, compiled, seed, &show, &mut write)?;
        if !json {
            progress.clear();
            write!(out, "{outcome}")?;
            out.flush()?;
        }
        robots.push(outcome);
    }
    progress.show("simulating");
    let simulated = DemoRun::all(|run, name| finished(run, name, directory))?;
    let identified = identified(seed, directory, &progress)?;
    let diagnosed = diagnosed(seed, directory, &progress)?;
    drop(progress);
    let decomposed = DecomposedOutcome::new(|document| write(directory, document))?;
    if !json {
        write!(out, "{decomposed}{}{identified}{diagnosed}", SimulatedRuns(&simulated))?;
    }
    let passed = robots.iter().all(RobotOutcome::passed)
        && simulated.iter().all(Simulated::passed)
        && identified.passed();
    let seconds = started.elapsed().as_secs_f64();
    if json {
        let json = DemoJson {
            version,
            seed,
            robots: &robots,
            decomposed: &decomposed,
            simulated: &simulated,
            identified: &identified,
            diagnosed: &diagnosed,
            seconds,
            passed,
        };
        write_json(out, &json)?;
    } else {
        let verdict = if passed { "all checks passed" } else { "A CHECK FAILED" };
        writeln!(out, "\n{verdict}; {seconds:.1} s")?;
    }
    Ok(if passed { Answer::Done } else { Answer::Negative })
}

/// Writes the log and the picture of a run.
fn finished(run: &mut DemoRun, name: &str, directory: &Path) -> Result<Vec<Written>, Failure> {
    let log = ("csv", run.run.log.to_csv(), "log of the run");
    let picture = ("svg", drawn_run(&mut run.scenario, &run.run, None), "picture of the run");
    let files = [log, picture].map(|(ending, text, what)| {
        write(directory, Document { name: format!("{name}.{ending}"), text, what: what.to_owned() })
    });
    files.into_iter().collect()
}

/// Simulates the experiment, identifies from its log alone, and compares.
fn identified(
    seed: u64,
    directory: &Path,
    progress: &Progress,
) -> Result<IdentifiedOutcome, Failure> {
    progress.show("simulating an experiment");
    let log = Experiment::log(seed)?;
    let path = directory.join(&log.name);
    let log = write(directory, log)?;
    let (model, cutoff_hz) = (Experiment::MODEL, Experiment::CUTOFF_HZ);
    let (found, page) = identify::of_log(model, path, cutoff_hz, progress)?;
    let page = write(directory, Experiment::page(page))?;
    Ok(IdentifiedOutcome::new(&found, vec![log, page]))
}

fn write(directory: &Path, document: Document) -> Result<Written, Failure> {
    let Document { name, text, what } = document;
    let path = directory.join(name);
    write_whole(&path, text.as_bytes())?;
    Ok(Written::new(&path, text.len(), &what))
}
