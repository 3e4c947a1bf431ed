//! `denavit demo`: the whole way on two robots, with checks of what came out, and simulated runs.

mod checks;
mod compiled;
mod counts;
mod decomposed;
mod diagnosed;
mod identified;
mod simulated;
mod states;

use super::Answer;
use super::base::{Found, latex};
use super::emit::Lowered;
use super::failure::Failure;
use super::files::read_model_with_effects;
use super::json::{Ordered, write_json};
use super::outputs::{NewDirectory, write_whole};
use super::progress::Progress;
use checks::Check;
use clap::Args;
use compiled::{Compiled, ROBOTS};
use counts::Comparison;
use decomposed::Decomposed;
use denavit::derive::{Derivation, Flavour, StageReport};
use denavit::emit::latex::document;
use denavit::function::FunctionName;
use denavit::model::Robot;
use denavit::regressor::{Certificate, RegressorOptions, base_parameters};
use denavit::report::{Align, Pose, Table, picture};
use diagnosed::Diagnosed;
use identified::Identified;
use serde::Serialize;
use simulated::Simulated;
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

/// What became of one robot.
#[derive(Serialize)]
struct Outcome {
    model: String,
    hash: String,
    degrees_of_freedom: usize,
    stages: Ordered<StageJson>,
    operations: Ordered<Comparison>,
    base: BaseJson,
    files: Vec<Written>,
    checks: Vec<Check>,
}

#[derive(Serialize)]
struct StageJson {
    milliseconds: f64,
    nodes: usize,
}

/// What was found of the base parameters.
#[derive(Serialize)]
struct BaseJson {
    columns: usize,
    rank: usize,
    alone: usize,
    verified: bool,
    milliseconds: f64,
}

/// A file that was written.
#[derive(Serialize)]
struct Written {
    file: String,
    bytes: usize,
    what: String,
}

#[derive(Serialize)]
struct DemoJson<'a> {
    version: &'a str,
    seed: u64,
    robots: &'a [Outcome],
    decomposed: &'a Decomposed,
    simulated: &'a [Simulated],
    identified: &'a Identified,
    diagnosed: &'a Diagnosed,
    seconds: f64,
    passed: bool,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let started = Instant::now();
    let progress = Progress::new();
    let version = env!("CARGO_PKG_VERSION");
    let directory = &arguments.out;
    let _made = NewDirectory::make(directory)?;
    if !arguments.json {
        writeln!(out, "denavit {version}, seed {}", arguments.seed)?;
    }
    let mut outcomes = Vec::new();
    for compiled in &ROBOTS {
        let outcome = one_robot(compiled, arguments.seed, directory, &progress)?;
        if !arguments.json {
            progress.clear();
            write_outcome(out, &outcome)?;
            out.flush()?;
        }
        outcomes.push(outcome);
    }
    progress.show("simulating");
    let simulated = Simulated::all(directory)?;
    let identified = Identified::new(arguments.seed, directory, &progress)?;
    let diagnosed = Diagnosed::new(arguments.seed, directory, &progress)?;
    drop(progress);
    let decomposed = Decomposed::new(directory)?;
    if !arguments.json {
        decomposed.write(out)?;
        simulated::write_all(&simulated, out)?;
        identified.write(out)?;
        diagnosed.write(out)?;
    }
    let checked = outcomes.iter().flat_map(|outcome| &outcome.checks).all(Check::passed);
    let walked = simulated.iter().all(Simulated::passed);
    let passed = checked
        && walked
        && identified.passed()
        && outcomes.iter().all(|outcome| outcome.base.verified);
    let seconds = started.elapsed().as_secs_f64();
    if arguments.json {
        let seed = arguments.seed;
        let (robots, decomposed, simulated) = (&outcomes[..], &decomposed, &simulated[..]);
        let json = DemoJson {
            version,
            seed,
            robots,
            decomposed,
            simulated,
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

fn one_robot(
    compiled: &Compiled,
    seed: u64,
    directory: &Path,
    progress: &Progress,
) -> Result<Outcome, Failure> {
    let name = compiled.name;
    let robot = read_model_with_effects(Path::new(name), None)?;
    progress.show(&format!("{name}: deriving and emitting"));
    let lowered = Lowered::new(&robot, Flavour::Tunable, false, &FunctionName::ALL)?;
    let mut files = Vec::new();
    let functions = lowered.program.routines.len();
    let what = format!("{functions} functions as Rust, tunable parameters");
    files.push(write(directory, &format!("{name}_dynamics.rs"), &lowered.rust()?, what)?);
    progress.show(&format!("{name}: setting the equations"));
    let document = equations(&robot, &lowered.derivation);
    let what = "D, C, G and W^T as LaTeX".to_owned();
    files.push(write(directory, &format!("{name}_equations.tex"), &document, what)?);
    progress.show(&format!("{name}: finding base parameters"));
    let base = base(&robot, directory, &mut files)?;
    progress.show(&format!("{name}: drawing"));
    let pose = Pose::zero(&robot).map_err(|e| Failure::Lower(name.to_owned(), e))?;
    let drawn = picture(&robot, &pose);
    let what = "the robot with the frames of its links".to_owned();
    files.push(write(directory, &format!("{name}.svg"), &drawn, what)?);
    progress.show(&format!("{name}: counting"));
    let operations = counts::compare(&robot, &lowered.program)?;
    progress.show(&format!("{name}: checking"));
    let checks = checks::run(&robot, compiled, seed)?;
    // a robot without contacts has no stage for their functions
    let made = |stage: &&StageReport| {
        let name = FunctionName::parse(&stage.stage);
        name.is_none_or(|name| lowered.derivation.functions.iter().any(|f| f.name == name))
    };
    let stages = lowered.derivation.report.iter().filter(made).map(stage_json).collect();
    Ok(Outcome {
        model: name.to_owned(),
        hash: format!("{:016x}", robot.hash),
        degrees_of_freedom: robot.degrees_of_freedom(),
        stages: Ordered(stages),
        operations: Ordered(operations),
        base,
        files,
        checks,
    })
}

/// Finds the base parameters, proves them, and writes both.
fn base(robot: &Robot, directory: &Path, files: &mut Vec<Written>) -> Result<BaseJson, Failure> {
    let name = &robot.name;
    let options = RegressorOptions::default();
    let started = Instant::now();
    let base = base_parameters(robot, options, &[])
        .map_err(|error| Failure::Base(robot.name.clone(), Box::new(error)))?;
    let milliseconds = 1e3 * started.elapsed().as_secs_f64();
    let certificate = Certificate::new(robot, options, &base, false);
    let verified = certificate.verify(robot).is_verified();
    let document = latex(&Found::new(robot, &base, None, verified));
    let what = "base parameters as LaTeX".to_owned();
    files.push(write(directory, &format!("{name}_base_parameters.tex"), &document, what)?);
    let mut text = serde_json::to_string_pretty(&certificate)?;
    text.push('\n');
    let what = "the certificate that they are exact".to_owned();
    files.push(write(directory, &format!("{name}_certificate.json"), &text, what)?);
    let (columns, rank) = (base.regressor.columns.len(), base.rank());
    Ok(BaseJson { columns, rank, alone: base.alone().len(), verified, milliseconds })
}

/// D, C, G and, of a robot with contacts, W^T as a LaTeX document.
fn equations(robot: &Robot, derivation: &Derivation) -> String {
    use FunctionName::{ContactJacobian, CoriolisMatrix, GravityVector, MassMatrix};
    let is_set =
        |name| matches!(name, MassMatrix | CoriolisMatrix | GravityVector | ContactJacobian);
    let functions = derivation.functions.iter().filter(|function| is_set(function.name));
    let functions: Vec<_> = functions.cloned().collect();
    document(robot, &derivation.dag, &functions).expect("our template has a place for each value")
}

fn stage_json(stage: &StageReport) -> (String, StageJson) {
    let milliseconds = 1e3 * stage.time.as_secs_f64();
    (stage.stage.clone(), StageJson { milliseconds, nodes: stage.nodes })
}

fn write(directory: &Path, name: &str, text: &str, what: String) -> Result<Written, Failure> {
    let path = directory.join(name);
    write_whole(&path, text.as_bytes())?;
    Ok(Written { file: path.display().to_string(), bytes: text.len(), what })
}

fn write_outcome(out: &mut dyn Write, outcome: &Outcome) -> Result<(), Failure> {
    let Outcome { model, hash, degrees_of_freedom, .. } = outcome;
    writeln!(out, "\n{model}: {degrees_of_freedom} degrees of freedom, hash {hash}")?;
    let mut stages =
        Table::new(&[("stage", Align::Left), ("nodes", Align::Right), ("ms", Align::Right)]);
    let mut total = 0.0;
    for (name, stage) in &outcome.stages.0 {
        total += stage.milliseconds;
        stages.push(vec![
            name.clone(),
            stage.nodes.to_string(),
            format!("{:.2}", stage.milliseconds),
        ]);
    }
    stages.push(vec!["total".to_owned(), String::new(), format!("{total:.2}")]);
    writeln!(out, "\nstages (nodes: of the graph after it)\n{stages}")?;
    writeln!(out, "operations of one call (mul + add)\n{}", counts::table(&outcome.operations.0))?;
    let BaseJson { columns, rank, alone, verified, milliseconds } = &outcome.base;
    let verdict = if *verified { "verified" } else { "NOT VERIFIED" };
    writeln!(
        out,
        "base parameters: {rank} of {columns} columns in {milliseconds:.1} ms, {alone} of them \
         parameters alone; certificate {verdict}\n"
    )?;
    writeln!(
        out,
        "checks, by running the generated functions\n{}",
        checks::table(&outcome.checks)
    )?;
    for file in &outcome.files {
        writeln!(out, "wrote {} ({} kB): {}", file.file, file.bytes.div_ceil(1000), file.what)?;
    }
    Ok(())
}
