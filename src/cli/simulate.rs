//! `denavit simulate`: run a scenario.

use super::Answer;
use super::failure::Failure;
use super::files::{FILES, mapping, say_notes};
use super::logs::{log_source, note_logs, run_file};
use super::options::ShapesOption;
use super::outputs::{check_outputs, on_stdout, print_answer, write_given, write_whole};
use super::progress::Progress;
use clap::{Args, ValueEnum, ValueHint};
use denavit::report::answer::{
    ShownWithRun, drawn_at, drawn_run, run_json, run_page, run_text, window_of,
};
use denavit::report::{can_draw_png, png};
use denavit::simulate::scenario::{RunScheme, Scenario};
use denavit::simulate::{Log, Stop};
use denavit::workflow::{LogBeside, LogSource, Logs, simulate, step_of};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Simulate a scenario: a robot, its start, its control, the ground
///
/// Every run is audited: energy, momentum across impacts, penetration, complementarity, adhesion,
/// friction cones, and the zero moment point from forces against that from momentum. A run that
/// breaks a tolerance, or that ends otherwise than at its end, exits with 1.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit simulate bouncing_ball -o ball.csv
  denavit simulate tulip_leg_tracking -o tracking.mcap
  denavit simulate tulip_step --html step.html
  denavit simulate tulip_leg_tracking --scheme time-stepping --beside tracking.mcap \
    --html both.html
  denavit simulate planar_biped_zmp_gait --scheme time-stepping --step 0.0005 -o gait.csv")]
pub(crate) struct Arguments {
    /// The path of a scenario file, or the name of a shipped scenario
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// Where the log goes, as CSV, or as MCAP if it ends in .mcap; - is standard output (and no
    /// summary)
    #[arg(short, long, value_name = "LOG")]
    output: Option<PathBuf>,
    /// How the run is made, in place of what the scenario says
    #[arg(long, value_enum)]
    scheme: Option<SchemeName>,
    /// The step of time stepping, in place of the scenario's
    #[arg(long, value_name = "SECONDS", value_parser = step_of)]
    step: Option<f64>,
    /// Draw the run: figures, joints with references and torques, contact forces; - is standard
    /// output
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// The same drawing as PNG, in builds with the feature `png`; - is standard output
    #[arg(long, value_name = "FILE",
        value_parser = |file: &str| can_draw_png().map(|()| PathBuf::from(file)))]
    png: Option<PathBuf>,
    /// Draw the robot alone in it, at this time
    #[arg(long, value_name = "SECONDS", requires = "png")]
    at: Option<f64>,
    /// Write the run as one page of HTML: played back in three dimensions, with its curves and its
    /// audit; - is standard output
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Show a log of the same robot on the page: as a second robot, and in the curves. Its times
    /// are those of the run
    #[arg(long, value_name = "LOG", value_parser = log_source(), requires = "html",
        value_hint = ValueHint::AnyPath)]
    beside: Option<LogSource>,
    /// Which columns of that log are ours, as for `denavit identify`
    #[arg(long, value_name = "MAP.json", requires = "beside")]
    columns: Option<PathBuf>,
    #[command(flatten)]
    shapes: ShapesOption,
    /// The part of the run that is drawn
    #[arg(long, value_name = "FROM,TO", value_parser = window_of, requires = "svg")]
    window: Option<[f64; 2]>,
    /// The summary as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum SchemeName {
    /// Smooth motion from event to event
    Event,
    /// Steps that take contacts, impacts and friction into account
    TimeStepping,
}

/// The log that is shown beside the run.
fn log_beside(arguments: &Arguments, scenario: &Scenario) -> Result<Option<LogBeside>, Failure> {
    let Some(source) = &arguments.beside else { return Ok(None) };
    let columns = mapping(arguments.columns.as_deref())?;
    let logs = Logs { columns, ..Logs::default() };
    Ok(Some(LogBeside::read(scenario.plant.model(), &logs, source)?))
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    Ok(run_kept(arguments, out)?.0)
}

/// The same; keeps the log of the run.
pub(super) fn run_kept(
    arguments: &Arguments,
    out: &mut dyn Write,
) -> Result<(Answer, Log), Failure> {
    let outputs = [&arguments.output, &arguments.svg, &arguments.png, &arguments.html];
    let outputs = outputs.map(Option::as_ref);
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let mut scenario = FILES.scenario(&arguments.scenario)?;
    match arguments.scheme {
        Some(SchemeName::Event) => scenario.scheme = RunScheme::Event,
        Some(SchemeName::TimeStepping) => scenario.scheme = RunScheme::TimeStepping,
        None => {}
    }
    if let Some(step_s) = arguments.step {
        if scenario.scheme == RunScheme::Event {
            return Err(Failure::StepOfEventScheme);
        }
        scenario.set_step_s(step_s);
    }
    say_notes(&scenario.notes());
    let whole = [scenario.initial.t_s, scenario.simulation.end_s];
    if arguments.window.is_some_and(|[from, to]| from < whole[0] || to > whole[1]) {
        return Err(Failure::Window(whole));
    }
    note_logs(&arguments.beside);
    check_outputs(&outputs)?;
    let beside = log_beside(arguments, &scenario)?;
    let shapes = arguments.shapes.read(Path::new(""))?;
    let started = Instant::now();
    let progress = Progress::new();
    let run = simulate(&mut scenario, &mut progress.observer())?;
    drop(progress);
    let took = started.elapsed();
    let broken = scenario.broken(&run);
    if let Some(path) = &arguments.output {
        write_whole(path, &run_file(path, &run.log)?)?;
    }
    // a run that ends before the window is drawn as it is
    let window = arguments.window.filter(|[from, _]| *from < run.end.t_s);
    write_given(&arguments.svg, || drawn_run(&mut scenario, &run, window))?;
    if let Some(path) = &arguments.png {
        let picture = png(&drawn_at(&mut scenario, &run, arguments.at));
        write_whole(path, &picture.map_err(|why| Failure::Library(why.into()))?)?;
    }
    let with = ShownWithRun { log: beside.as_ref(), shapes: shapes.as_ref() };
    let page = || run_page(&mut scenario, &run, &broken, with, env!("CARGO_PKG_VERSION")).render();
    write_given(&arguments.html, page)?;
    let shown = (is_answered, arguments.json);
    print_answer(
        out,
        shown,
        || run_json(&scenario, &run, &broken),
        || run_text(&scenario, &run, &broken, took),
        &outputs,
    )?;
    let good = run.stop == Stop::End && broken.is_empty();
    Ok((if good { Answer::Done } else { Answer::Negative }, run.log))
}
