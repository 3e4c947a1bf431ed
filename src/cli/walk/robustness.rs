//! `denavit walk basin` and `denavit walk push`: what a gait endures.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::files::FILES;
use super::super::outputs::{check_outputs, on_stdout, print_answer, write_given, write_whole};
use super::super::progress::Progress;
use super::number::within;
use clap::Args;
use denavit::report::answer::{
    BasinAnswer, PushAnswer, basin_json, basin_log, basin_picture, basin_text, push_json,
    push_picture, push_text,
};
use denavit::workflow::{PushQuestion, PushedGait, Starts, gait_basin, push_gait};
use std::io::Write;
use std::path::PathBuf;

/// Walk from starts around the cycle of a gait: its basin of attraction as a map
///
/// Two coordinates are varied on a grid, or all velocities at random (--noise). Where the no-slip
/// law has no answer to an impact, friction of 0.8 stands in, unless the scenario says otherwise.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit walk basin planar_biped_limit_cycle_gait --grid 3 --steps 5 --svg basin.svg
  denavit walk basin planar_biped_limit_cycle_gait --noise 0.2 --starts 10 --seed 7")]
pub(crate) struct BasinArguments {
    /// The path of a scenario file, or the name of a shipped scenario
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// The two coordinates that are varied
    #[arg(
        long,
        value_name = "A,B",
        value_delimiter = ',',
        num_args = 1,
        default_value = "qd_base_pitch,q_base_pitch"
    )]
    vary: Vec<String>,
    /// How far each is varied, either way [rad, rad/s, m, m/s]
    #[arg(
        long,
        value_name = "A,B",
        value_delimiter = ',',
        num_args = 1,
        default_value = "1,0.1",
        value_parser = within(0.0..=100.0, "rad, rad/s, m or m/s")
    )]
    reach: Vec<f64>,
    /// Starts along each coordinate
    #[arg(
        long,
        value_name = "COUNT",
        default_value_t = 11,
        value_parser = clap::value_parser!(u32).range(2..=101)
    )]
    grid: u32,
    /// Vary all joint velocities instead: normal, with this standard deviation [rad/s]
    #[arg(
        long,
        value_name = "DEVIATION",
        conflicts_with_all = ["vary", "reach", "grid"],
        value_parser = within(1e-9..=100.0, "rad/s")
    )]
    noise: Option<f64>,
    /// How many random starts
    #[arg(
        long,
        value_name = "COUNT",
        default_value_t = 100,
        requires = "noise",
        value_parser = clap::value_parser!(u32).range(1..=100_000)
    )]
    starts: u32,
    /// Seed of the random starts
    #[arg(long, value_name = "SEED", default_value_t = 1, requires = "noise")]
    seed: u64,
    /// Cycles that each start is to walk
    #[arg(
        long,
        value_name = "COUNT",
        default_value_t = 10,
        value_parser = clap::value_parser!(u32).range(1..=10_000)
    )]
    steps: u32,
    /// Where the starts go, row by row, as CSV; - is standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draw the map; - is standard output
    #[arg(long, value_name = "FILE", conflicts_with = "noise")]
    svg: Option<PathBuf>,
    /// The answer as JSON
    #[arg(long)]
    json: bool,
}

/// Push a robot: the least impulse that fells it, over the time in its step and the direction
///
/// Where the gait has a cycle, the robot is pushed in it, else after the start of the scenario.
/// Pushes of the scenario itself are left out. Where the no-slip law has no answer to an impact,
/// friction of 0.8 stands in, unless the scenario says otherwise.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  denavit walk push planar_biped_limit_cycle_gait --times 2 --svg push.svg")]
pub(crate) struct PushArguments {
    /// The path of a scenario file, or the name of a shipped scenario
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// The link that is pushed, at the origin of its frame [default: the last of the base]
    #[arg(long, value_name = "LINK")]
    link: Option<String>,
    /// How many times in the cycle
    #[arg(
        long,
        value_name = "COUNT",
        default_value_t = 12,
        value_parser = clap::value_parser!(u32).range(1..=1000)
    )]
    times: u32,
    /// The one of these times that is tried, from 0, as a study of them does
    #[arg(long, value_name = "K")]
    only: Option<u32>,
    /// The strongest impulse that is tried [N s]
    #[arg(long, value_name = "NS", default_value = "20", value_parser = within(1e-6..=1e6, "N s"))]
    most: f64,
    /// The least impulse is found to this [N s] [default: the strongest over 256]
    #[arg(long, value_name = "NS", value_parser = within(1e-6..=1e6, "N s"))]
    resolution: Option<f64>,
    /// How long the robot must walk on after the push
    #[arg(
        long,
        value_name = "SECONDS",
        default_value = "4",
        value_parser = within(1e-3..=1e3, "s")
    )]
    after: f64,
    /// Draw the map; - is standard output
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// The answer as JSON
    #[arg(long)]
    json: bool,
}

/// Two of a list, or what is wrong.
fn pair<T: Clone>(values: &[T], flag: &str) -> Result<[T; 2], Failure> {
    match values {
        [a, b] => Ok([a.clone(), b.clone()]),
        _ => Err(Failure::Walk(flag.to_owned(), "two values, with a comma".to_owned())),
    }
}

pub(crate) fn run_basin(
    arguments: &BasinArguments,
    out: &mut dyn Write,
) -> Result<Answer, Failure> {
    let outputs = [arguments.output.as_ref(), arguments.svg.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let (vary, reach) = (pair(&arguments.vary, "--vary")?, pair(&arguments.reach, "--reach")?);
    let count = arguments.grid as usize;
    let starts = match arguments.noise {
        Some(deviation) => {
            Starts::Noise { deviation, count: arguments.starts as usize, seed: arguments.seed }
        }
        None => Starts::Grid { vary: vary.clone(), reach, count },
    };
    check_outputs(&outputs)?;
    let (progress, cycles) = (Progress::new(), arguments.steps);
    let path = &arguments.scenario;
    let found = gait_basin(&FILES, path, &starts, cycles as usize, &mut progress.observer())?;
    progress.clear();
    let (name, model, starts) = (&found.name, &found.model, &found.starts[..]);
    let answer = BasinAnswer { name, model, cycles, starts };
    write_given(&arguments.output, || basin_log(&answer).to_csv())?;
    if let Some(path) = &arguments.svg {
        let map = basin_picture(&answer, [&vary[0], &vary[1]], reach, count);
        write_whole(path, map.as_bytes())?;
    }
    let shown = (is_answered, arguments.json);
    print_answer(out, shown, || basin_json(&answer), || basin_text(&answer), &outputs)?;
    Ok(Answer::Done)
}

pub(crate) fn run_push(arguments: &PushArguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [arguments.svg.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let question = PushQuestion {
        link: arguments.link.clone(),
        times: arguments.times as usize,
        only: arguments.only.map(|only| only as usize),
        most_ns: arguments.most,
        resolution_ns: arguments.resolution,
        after_s: arguments.after,
    };
    check_outputs(&outputs)?;
    let progress = Progress::new();
    let pushed = push_gait(&FILES, &arguments.scenario, &question, &mut progress.observer())?;
    progress.clear();
    let PushedGait { name, model, options, found, .. } = &pushed;
    let answer = PushAnswer { name, model, options, found };
    write_given(&arguments.svg, || push_picture(&answer))?;
    let shown = (is_answered, arguments.json);
    print_answer(out, shown, || push_json(&answer), || push_text(&answer), &outputs)?;
    Ok(Answer::Done)
}
