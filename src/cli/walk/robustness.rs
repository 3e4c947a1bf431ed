//! `denavit walk basin` and `denavit walk push`: what a gait endures.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::json::write_json;
use super::super::outputs::{check_outputs, on_stdout, say_written, write_whole};
use super::super::progress::Progress;
use super::super::simulate::open;
use super::number::within;
use clap::Args;
use denavit::plants::{PlantModel, PointModel};
use denavit::report::{Align, HeatMap, Table};
use denavit::simulate::scenario::Scenario;
use denavit::simulate::{Log, Simulation};
use denavit::walk::balance::check_walker;
use denavit::walk::poincare::{PoincareAnalysis, PoincareOptions, analyse};
use denavit::walk::robustness::{
    BasinOptions, BasinStart, LeastPush, PushOptions, basin, grid, least_pushes, noise,
};
use serde_json::json as value;
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
    let mut scenario = open(path)?;
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
    if let Some(path) = &arguments.output {
        write_whole(path, starts_log(&name, &model, &starts).to_csv().as_bytes())?;
    }
    if let Some(path) = &arguments.svg {
        let map = draw_basin(&name, [&names[0], &names[1]], reach, arguments, &starts);
        write_whole(path, map.as_bytes())?;
    }
    match (is_answered, arguments.json) {
        (true, _) => {}
        (_, true) => write_json(out, &basin_answer((&name, &model), arguments, &starts))?,
        (_, false) => {
            print_basin(out, &name, arguments, &starts)?;
            super::say_what_is_no_fall(out, &model)?;
            say_written(out, &outputs)?;
        }
    }
    Ok(Answer::Done)
}

/// Outcomes with how often each occurred, in the order of the alphabet.
fn counted(starts: &[BasinStart]) -> Vec<(&'static str, usize)> {
    let mut words: Vec<&'static str> = starts.iter().map(|start| start.outcome.word()).collect();
    words.sort_unstable();
    words.dedup();
    let count = |word: &'static str| starts.iter().filter(|s| s.outcome.word() == word).count();
    words.into_iter().map(|word| (word, count(word))).collect()
}

fn basin_answer(
    (name, model): (&str, &PlantModel),
    arguments: &BasinArguments,
    starts: &[BasinStart],
) -> serde_json::Value {
    let outcomes: serde_json::Map<String, serde_json::Value> =
        counted(starts).into_iter().map(|(word, count)| (word.to_owned(), count.into())).collect();
    value!({
        "scenario": name,
        "starts": starts.len(),
        "cycles": arguments.steps,
        "outcomes": outcomes,
        "falls_are_seen": !model.fall_points.is_empty(),
        "walks": starts.iter().filter(|start| start.outcome.walks()).count(),
    })
}

fn print_basin(
    out: &mut dyn Write,
    name: &str,
    arguments: &BasinArguments,
    starts: &[BasinStart],
) -> Result<(), Failure> {
    writeln!(out, "{name}: {} starts, {} cycles each\n", starts.len(), arguments.steps)?;
    let mut table = Table::new(&[("outcome", Align::Left), ("starts", Align::Right)]);
    for (word, count) in counted(starts) {
        table.push(vec![word.to_owned(), count.to_string()]);
    }
    Ok(write!(out, "{table}")?)
}

/// Starts row by row: deviations, cycles walked, distance at the end.
fn starts_log(name: &str, model: &PlantModel, starts: &[BasinStart]) -> Log {
    let mut columns = vec!["t".to_owned()];
    for prefix in ["q", "qd"] {
        columns.extend(model.joints.iter().map(|joint| format!("{prefix}_{}", joint.name)));
    }
    columns.extend(["walks", "cycles", "distance"].map(str::to_owned));
    let mut values = Vec::new();
    for (index, start) in starts.iter().enumerate() {
        values.push(index as f64);
        values.extend(&start.deviation.q);
        values.extend(&start.deviation.qd);
        values.push(f64::from(u8::from(start.outcome.walks())));
        values.push(start.cycles as f64);
        values.push(start.distance);
    }
    let header = vec![
        ("basin_of".to_owned(), name.to_owned()),
        ("t".to_owned(), "number of the start".to_owned()),
    ];
    Log { header, columns, values }
}

fn draw_basin(
    name: &str,
    names: [&str; 2],
    reach: [f64; 2],
    arguments: &BasinArguments,
    starts: &[BasinStart],
) -> String {
    let count = arguments.grid as usize;
    let values = reach.map(|reach| -> Vec<f64> {
        let share = |index: usize| 2.0 * index as f64 / (count - 1) as f64 - 1.0;
        (0..count).map(|index| reach * share(index)).collect()
    });
    let cell = |start: &BasinStart| {
        let share = start.cycles as f64 / f64::from(arguments.steps);
        let text = if start.outcome.walks() { String::new() } else { start.cycles.to_string() };
        (Some(1.0 - share.min(1.0)), text)
    };
    let cells: Vec<(Option<f64>, String)> = starts.iter().map(cell).collect();
    let title = format!("{}: basin of attraction", name.replace('_', " "));
    let subtitle =
        format!("cycles walked of {}, from deviations off the fixed point", arguments.steps);
    let meaning = ["walks all cycles", "walks none"];
    let axes = [(names[0], &values[0][..]), (names[1], &values[1][..])];
    HeatMap { title: &title, subtitle: &subtitle, axes, cells: &cells, meaning }.draw()
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
    if let Some(path) = &arguments.svg {
        write_whole(path, draw_push(&name, &options, &found).as_bytes())?;
    }
    match (is_answered, arguments.json) {
        (true, _) => {}
        (_, true) => write_json(out, &push_answer(&name, (&model, link), (&options, &found)))?,
        (_, false) => {
            print_push(out, &name, (&model, link), (&options, &found))?;
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

/// A direction in words.
fn direction_word(direction: [f64; 3]) -> &'static str {
    match direction {
        [x, _, _] if x > 0.5 => "forward",
        [x, _, _] if x < -0.5 => "backward",
        [_, y, _] if y > 0.5 => "left",
        _ => "right",
    }
}

fn push_answer(
    name: &str,
    (model, link): (&PlantModel, usize),
    (options, found): (&PushOptions, &[LeastPush]),
) -> serde_json::Value {
    let one = |push: &LeastPush| {
        value!({
            "at_s": push.at_s,
            "direction": direction_word(push.direction),
            "least_impulse_ns": push.impulse_ns,
            "outcome": push.outcome.word(),
        })
    };
    let pushes: Vec<serde_json::Value> = found.iter().map(one).collect();
    value!({
        "scenario": name,
        "link": model.links[link],
        "resolution_ns": options.resolution_ns,
        "falls_are_seen": !model.fall_points.is_empty(),
        "pushes": pushes,
    })
}

fn print_push(
    out: &mut dyn Write,
    name: &str,
    (model, link): (&PlantModel, usize),
    (options, found): (&PushOptions, &[LeastPush]),
) -> Result<(), Failure> {
    let (at, to) = (&model.links[link], options.resolution_ns);
    writeln!(out, "{name}: the least impulse at {at} that fells it, to {to:.2} N s at most\n")?;
    let columns = [
        ("direction", Align::Left),
        ("at [s]", Align::Right),
        ("impulse [N s]", Align::Right),
        ("then", Align::Left),
    ];
    let mut table = Table::new(&columns);
    for push in found {
        table.push(vec![
            direction_word(push.direction).to_owned(),
            format!("{:.3}", push.at_s),
            push.impulse_ns.map_or_else(|| "-".to_owned(), |impulse| format!("{impulse:.2}")),
            push.outcome.word().to_owned(),
        ]);
    }
    write!(out, "{table}")?;
    super::say_what_is_no_fall(out, model)
}

fn draw_push(name: &str, options: &PushOptions, found: &[LeastPush]) -> String {
    let cell = |push: &LeastPush| {
        let text = push.impulse_ns.map_or_else(|| "-".to_owned(), |p| format!("{p:.1}"));
        (Some(push.impulse_ns.unwrap_or(options.most_ns) / options.most_ns), text)
    };
    let cells: Vec<(Option<f64>, String)> = found.iter().map(cell).collect();
    let rows: Vec<f64> = (1..=options.directions.len()).map(|row| row as f64).collect();
    let words: Vec<&str> = options.directions.iter().map(|d| direction_word(*d)).collect();
    let title = format!("{}: least push that fells", name.replace('_', " "));
    let subtitle = format!("impulse [N s]; rows from below: {}", words.join(", "));
    let strongest = format!("{} N s", options.most_ns);
    let axes = [("time in the cycle [s]", &options.times_s[..]), ("direction", &rows[..])];
    HeatMap {
        title: &title,
        subtitle: &subtitle,
        axes,
        cells: &cells,
        meaning: ["none", &strongest],
    }
    .draw()
}
