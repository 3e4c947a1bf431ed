//! `denavit walk basin` and `denavit walk push`: what a gait endures.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::files::FILES;
use super::super::json::write_json;
use super::super::outputs::{check_outputs, on_stdout, say_written, write_whole};
use super::super::progress::Progress;
use super::number::within;
use clap::Args;
use denavit::plants::{PlantModel, PointModel};
use denavit::report::answer::{
    BasinAnswer, PushAnswer, basin_json, basin_log, basin_picture, basin_text, push_json,
    push_picture, push_text,
};
use denavit::simulate::Simulation;
use denavit::simulate::scenario::Scenario;
use denavit::walk::balance::check_walker;
use denavit::walk::poincare::{PoincareAnalysis, PoincareOptions, analyse};
use denavit::walk::robustness::{BasinOptions, PushOptions, basin, grid, least_pushes, noise};
use std::io::Write;
use std::path::{Path, PathBuf};

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

/// The scenario as it is pushed: its own pushes are others.
fn pushable(path: &Path) -> Result<Scenario, Failure> {
    let mut scenario = disturbed(path)?;
    scenario.simulation.pushes.clear();
    Ok(scenario)
}

/// The scenario as disturbed runs need it.
fn disturbed(path: &Path) -> Result<Scenario, Failure> {
    let mut scenario = FILES.scenario(path)?;
    scenario.simulation.touching.fallback_friction.get_or_insert(super::FALLBACK_FRICTION);
    Ok(scenario)
}

/// The cycle of a gait.
fn cycle(scenario: &mut Scenario) -> Result<PoincareAnalysis, String> {
    let options = PoincareOptions { checks: false, ..PoincareOptions::default() };
    analyse(scenario, &options).map_err(|error| error.to_string())
}

/// The number of a coordinate: of q, or beyond these of qd.
fn coordinate(model: &PlantModel, name: &str) -> Result<usize, Failure> {
    let n = model.joints.len();
    let of = |prefix: &str, first: usize| {
        let joint = name.strip_prefix(prefix)?;
        model.find_joint(joint).map(|joint| first + joint)
    };
    of("qd_", n).or_else(|| of("q_", 0)).ok_or_else(|| {
        let why = format!("--vary: `{name}` is no q_JOINT or qd_JOINT of {}", model.name);
        Failure::Walk(model.name.clone(), why)
    })
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
    let mut scenario = disturbed(&arguments.scenario)?;
    let name = scenario.name.clone();
    let model = scenario.plant.model().clone();
    let (names, reach) = (pair(&arguments.vary, "--vary")?, pair(&arguments.reach, "--reach")?);
    let deviations = match arguments.noise {
        Some(deviation) => {
            let count = arguments.starts as usize;
            noise(scenario.plant.as_ref(), deviation, count, arguments.seed)
        }
        None => {
            let entries = [coordinate(&model, &names[0])?, coordinate(&model, &names[1])?];
            if entries[0] == entries[1] {
                let why = format!("`{}` twice\n  hint: name two coordinates", names[0]);
                return Err(Failure::Walk("--vary".to_owned(), why));
            }
            grid(model.joints.len(), entries, reach, arguments.grid as usize)
        }
    };
    check_outputs(&outputs)?;
    let progress = Progress::new();
    progress.show("following the cycle");
    let found = cycle(&mut scenario).map_err(|why| Failure::Walk(name.clone(), why))?;
    let starts = basin(
        &|| disturbed(&arguments.scenario).ok(),
        &found.cycle,
        &deviations,
        &BasinOptions { cycles: arguments.steps as usize },
        &|done, all| progress.show_count("starts", done, all),
    );
    progress.clear();
    let (cycles, starts) = (arguments.steps, &starts[..]);
    let answer = BasinAnswer { name: &name, model: &model, cycles, starts };
    if let Some(path) = &arguments.output {
        write_whole(path, basin_log(&answer).to_csv().as_bytes())?;
    }
    if let Some(path) = &arguments.svg {
        let grid = arguments.grid as usize;
        let map = basin_picture(&answer, [&names[0], &names[1]], reach, grid);
        write_whole(path, map.as_bytes())?;
    }
    match (is_answered, arguments.json) {
        (true, _) => {}
        (_, true) => write_json(out, &basin_json(&answer))?,
        (_, false) => {
            write!(out, "{}", basin_text(&answer))?;
            say_written(out, &outputs)?;
        }
    }
    Ok(Answer::Done)
}

pub(crate) fn run_push(arguments: &PushArguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [arguments.svg.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let mut scenario = pushable(&arguments.scenario)?;
    let name = scenario.name.clone();
    check_walker(scenario.plant.as_mut())
        .map_err(|error| Failure::Walk(name.clone(), error.to_string()))?;
    let model = scenario.plant.model().clone();
    let link = pushed_link(&model, arguments.link.as_deref())?;
    check_outputs(&outputs)?;
    let (start, period_s) = match cycle(&mut scenario) {
        Ok(found) => (found.cycle.chart.base, found.cycle.period_s),
        Err(_) => {
            let Simulation { end_s, .. } = scenario.simulation;
            (scenario.initial.clone(), end_s - scenario.initial.t_s)
        }
    };
    let count = arguments.times as usize;
    let directions = if model.planar {
        vec![[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]
    } else {
        vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]
    };
    let options = PushOptions {
        point: PointModel { name: "pushed".to_owned(), link, position: [0.0; 3] },
        times_s: (0..count).map(|k| period_s * k as f64 / count as f64).collect(),
        directions,
        most_ns: arguments.most,
        coarse: 8,
        resolution_ns: arguments.resolution.unwrap_or(arguments.most / 256.0),
        after_s: arguments.after,
    };
    let progress = Progress::new();
    let found =
        least_pushes(&|| pushable(&arguments.scenario).ok(), &start, &options, &|done, all| {
            progress.show_count("pushes", done, all);
        });
    progress.clear();
    let answer = PushAnswer { name: &name, model: &model, options: &options, found: &found };
    if let Some(path) = &arguments.svg {
        write_whole(path, push_picture(&answer).as_bytes())?;
    }
    match (is_answered, arguments.json) {
        (true, _) => {}
        (_, true) => write_json(out, &push_json(&answer))?,
        (_, false) => {
            write!(out, "{}", push_text(&answer))?;
            say_written(out, &outputs)?;
        }
    }
    Ok(Answer::Done)
}

fn pushed_link(model: &PlantModel, name: Option<&str>) -> Result<usize, Failure> {
    let Some(name) = name else {
        // the frame of the base's last generated joint is that of its body
        let base = model.joints.iter().rposition(|joint| !joint.drivable);
        let is_base = |link: &String| base.is_some_and(|base| *link == model.joints[base].name);
        return Ok(model.links.iter().position(is_base).unwrap_or(0));
    };
    let found = model.links.iter().position(|link| link == name);
    found.ok_or_else(|| {
        Failure::Walk(model.name.clone(), format!("--link: no link is called `{name}`"))
    })
}
