//! `denavit walk zmp|fri|capture|momentum`: balance along a run or a log.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::files::{read_log, read_model_with_effects};
use super::super::json::write_json;
use super::super::outputs::{check_outputs, on_stdout, say_written, write_whole};
use super::super::progress::Progress;
use super::super::simulate::open;
use super::balance_log::{events, series, turning_bodies};
use clap::Args;
use denavit::plants::{PlantError, PlantModel, plant_of};
use denavit::report::{Align, BalanceCurve, BalancePicture, Table, percent};
use denavit::simulate::scenario::RunScheme;
use denavit::walk::balance::{
    BalanceError, Course, Criterion, Grid, Instant, Margins, course_of_log, course_on_grid,
};
use serde_json::{Map, Value, json as value};
use std::io::Write;
use std::path::{Path, PathBuf};

/// What is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum What {
    Zmp,
    Fri,
    Capture,
    Momentum,
}

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A scenario (path or shipped name), or the path of a log with --model
    #[arg(value_name = "SCENARIO|LOG")]
    input: PathBuf,
    /// The model of the robot in a log
    #[arg(long, value_name = "MODEL")]
    model: Option<PathBuf>,
    /// Judge the whole run, not one cycle of the gait
    #[arg(long, conflicts_with = "model")]
    whole: bool,
    /// Distance of the instants that are looked at [default: 0.0005, more of runs over 100 s]
    #[arg(long, value_name = "SECONDS", value_parser = period, conflicts_with = "model")]
    period: Option<f64>,
    /// Where the criteria go, row by row, as CSV; - is standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Where the events go, as CSV: impulses, and velocities before and after; - is standard output
    #[arg(long, value_name = "FILE", conflicts_with = "model")]
    events: Option<PathBuf>,
    /// Draw the point with the edges of the support polygon over time; - is standard output
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// The answer as JSON
    #[arg(long)]
    json: bool,
}

pub(super) fn period(text: &str) -> Result<f64, String> {
    let period: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (1e-6..=1.0).contains(&period) { Ok(period) } else { Err("not from 1e-6 to 1 s".into()) }
}

/// A judged robot: its name, its description, and what was found.
pub(super) struct Judged {
    pub(super) name: String,
    pub(super) model: PlantModel,
    pub(super) course: Course,
    /// What its reader must know beside.
    pub(super) notes: Vec<String>,
}

/// Distance of instants where nobody asks for another one \[s\].
const PERIOD_S: f64 = 5e-4;

pub(crate) fn run(
    what: What,
    arguments: &Arguments,
    out: &mut dyn Write,
) -> Result<Answer, Failure> {
    let outputs = [arguments.output.as_ref(), arguments.events.as_ref(), arguments.svg.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let judged = judge(arguments)?;
    check_outputs(&outputs)?;
    if let Some(path) = &arguments.output {
        write_whole(path, series(&judged).to_csv().as_bytes())?;
    }
    if let Some(path) = &arguments.events {
        write_whole(path, events(&judged).to_csv().as_bytes())?;
    }
    if let Some(path) = &arguments.svg {
        write_whole(path, draw(what, &judged).as_bytes())?;
    }
    match (is_answered, arguments.json) {
        (true, _) => {}
        (_, true) => write_json(out, &answer(what, &judged))?,
        (_, false) => {
            print(out, what, &judged)?;
            say_written(out, &outputs)?;
        }
    }
    // a criterion that is not met is no fall: only a run that ends is
    let stopped = judged.course.run.as_ref().is_some_and(|run| run.stop.word() != "end");
    Ok(if stopped { Answer::Negative } else { Answer::Done })
}

fn judge(arguments: &Arguments) -> Result<Judged, Failure> {
    let name = arguments.input.display().to_string();
    if let Some(model) = &arguments.model {
        return judge_log(name, &arguments.input, model);
    }
    if arguments.input.extension().is_some_and(|extension| extension == "csv") {
        let why = "a log says nothing of its robot\n  hint: name the robot's model: --model MODEL";
        return Err(Failure::Walk(name, why.to_owned()));
    }
    let mut scenario = open(&arguments.input)?;
    let grid = arguments.period.map_or(Grid::From(PERIOD_S), Grid::Every);
    let progress = Progress::new();
    progress.show(&format!("simulating {}", scenario.name));
    let course = course_on_grid(&mut scenario, grid, arguments.whole)
        .map_err(|error| Failure::Walk(name, error.to_string()))?;
    drop(progress);
    let mut notes = Vec::new();
    if scenario.scheme == RunScheme::TimeStepping {
        notes.push("judged from event to event, though the scenario is one of steps".to_owned());
    }
    let chosen =
        course.period_s.filter(|period_s| grid == Grid::From(PERIOD_S) && *period_s > PERIOD_S);
    notes.extend(chosen.map(|period_s| {
        format!("the run is long: an instant every {period_s} s; --period {PERIOD_S} takes more")
    }));
    let model = scenario.plant.model().clone();
    Ok(Judged { name: scenario.name, model, course, notes })
}

fn judge_log(name: String, log: &Path, model: &Path) -> Result<Judged, Failure> {
    let robot = read_model_with_effects(model, None)?;
    let file = read_log(log)?;
    let parameters = file.parameters(&robot.name, robot.hash).map_err(Failure::Log)?;
    let mut plant = plant_of(&robot, &parameters).map_err(|error| match error {
        PlantError::UnknownParameter(parameter, _) => {
            Failure::Log(file.unknown_parameter(&parameter))
        }
        error => Failure::Walk(robot.name.clone(), error.to_string()),
    })?;
    let course = course_of_log(plant.as_mut(), &file).map_err(|error| match error {
        BalanceError::Log(faults) => Failure::Log(faults),
        error => Failure::Walk(name.clone(), error.to_string()),
    })?;
    let model = plant.model().clone();
    let mut notes = Vec::new();
    if !parameters.is_empty() {
        let all = parameters.iter().map(|one| format!("{} = {}", one.parameter, one.value));
        notes.push(format!("by the log's header {}", all.collect::<Vec<_>>().join(", ")));
    }
    Ok(Judged { name, model, course, notes })
}

fn criteria(what: What) -> &'static [(&'static str, Criterion)] {
    match what {
        What::Zmp => &[("exact", Criterion::ZeroMoment), ("cart_table", Criterion::CartTable)],
        What::Fri => &[("fri", Criterion::FootRotation)],
        What::Capture => &[("capture", Criterion::Capture)],
        What::Momentum => &[],
    }
}

pub(super) fn draw(what: What, judged: &Judged) -> String {
    let (course, colours) = (&judged.course, ["#1f6fb4", "#d9822b"]);
    let times: Vec<f64> = course.instants.iter().map(|instant| instant.t_s).collect();
    let along = |criterion: Criterion| -> Vec<f64> {
        let ground = judged.model.ground;
        let x = |i: &Instant| criterion.point(i).map_or(f64::NAN, |p| ground.along(&p)[0]);
        course.instants.iter().map(x).collect()
    };
    let mut curves: Vec<BalanceCurve> = Vec::new();
    for ((name, criterion), colour) in criteria(what).iter().zip(colours) {
        curves.push(BalanceCurve { name, colour, values: along(*criterion) });
    }
    if what == What::Momentum {
        let values = course.instants.iter().map(|i| i.angular_momentum[1]).collect();
        curves.push(BalanceCurve { name: "angular momentum", colour: colours[0], values });
    }
    let range = |end: usize| -> Vec<f64> {
        course.instants.iter().map(|i| i.support.range().map_or(f64::NAN, |r| r[end])).collect()
    };
    let band = (what != What::Momentum).then(|| [range(0), range(1)]);
    let subtitle = format!("{}, over one {}", judged.model.name, course.over.word());
    let (title, unit) = match what {
        What::Zmp => ("zero moment point", "forward [m]"),
        What::Fri => ("foot rotation indicator", "forward [m]"),
        What::Capture => ("capture point", "forward [m]"),
        What::Momentum => ("centroidal angular momentum, forward", "[kg m\u{b2}/s]"),
    };
    let title = format!("{}: {title}", judged.name.replace('_', " "));
    let (times, curves) = (&times[..], &curves[..]);
    BalancePicture { title: &title, subtitle: &subtitle, unit, times, curves, band }.draw()
}

fn margins_json(margins: Option<Margins>) -> Value {
    margins.map_or(Value::Null, |margins| {
        value!({
            "margin_min_m": margins.least_m,
            "margin_min_at_s": margins.at_s,
            "margin_max_m": margins.largest_m,
            "outside_share": margins.outside,
        })
    })
}

fn answer(what: What, judged: &Judged) -> Value {
    let course = &judged.course;
    let shares = course.shares();
    let mut answer = Map::new();
    let mut set = |key: &str, entry: Value| answer.insert(key.to_owned(), entry);
    set("of", value!(judged.name));
    set("model", value!(judged.model.name));
    set("over", value!(course.over.word()));
    set("scheme", value!(course.scheme));
    set("period_s", value!(course.period_s));
    set("duration_s", value!(course.duration_s()));
    for (name, criterion) in criteria(what) {
        set(name, margins_json(course.margins(*criterion)));
    }
    match what {
        What::Zmp => {
            set("force_vs_momentum_max_m", value!(course.forces_against_momentum_m()));
        }
        What::Fri => {
            set("still_foot_apart_max_m", value!(course.still_foot_apart_m()));
        }
        What::Momentum => {
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                let [low, high] = range(course, |instant| instant.angular_momentum[axis]);
                set(&format!("angular_momentum_{name}"), value!([low, high]));
            }
            let mut bodies = Map::new();
            for body in turning_bodies(judged) {
                let by_axis = [0, 1, 2].map(|a| range(course, |i| i.body_momenta[body][a]));
                bodies.insert(judged.model.joints[body].name.clone(), value!(by_axis));
            }
            set("angular_momentum_of_bodies", Value::Object(bodies));
        }
        What::Capture => {}
    }
    set(
        "shares",
        value!({
            "flat": shares.flat,
            "toe": shares.toe,
            "double": shares.double,
            "flight": shares.flight,
            "one_point": shares.one_point,
        }),
    );
    if let Some(run) = &course.run {
        set("stop", value!(run.stop.word()));
    }
    Value::Object(answer)
}

fn range(course: &Course, value: impl Fn(&Instant) -> f64) -> [f64; 2] {
    let values = course.instants.iter().map(value);
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

/// The least and the largest angular momentum about each axis, of the robot and of its bodies.
fn momentum_table(judged: &Judged) -> Table {
    let course = &judged.course;
    let axes: &[(&str, usize)] = match judged.model.planar {
        true => &[("about y, to the left", 1)],
        false => &[("about x, forward", 0), ("about y, to the left", 1), ("about z, up", 2)],
    };
    let mut columns = vec![("angular momentum [kg m^2/s]", Align::Left)];
    columns.extend(axes.iter().map(|(name, _)| (*name, Align::Right)));
    let mut table = Table::new(&columns);
    let mut push = |name: &str, of: &dyn Fn(&Instant, usize) -> f64| {
        let ranges = axes.iter().map(|(_, axis)| {
            let [low, high] = range(course, |instant| of(instant, *axis));
            format!("{low:.4} to {high:.4}")
        });
        table.push([name.to_owned()].into_iter().chain(ranges).collect());
    };
    push("robot, about its centre of mass", &|instant, axis| instant.angular_momentum[axis]);
    for body in turning_bodies(judged) {
        push(&judged.model.joints[body].name, &|instant, axis| instant.body_momenta[body][axis]);
    }
    table
}

/// Each point of a criterion with its margins, as cells of a table.
pub(super) fn margin_cells(what: What, course: &Course) -> Vec<Vec<String>> {
    let cells = |(name, criterion): &(&str, Criterion)| {
        let found = course.margins(*criterion)?;
        Some(vec![
            name.replace('_', "-"),
            format!("{:.2}", 1e3 * found.least_m),
            format!("{:.4}", found.at_s),
            format!("{:.2}", 1e3 * found.largest_m),
            percent(found.outside),
        ])
    };
    criteria(what).iter().filter_map(cells).collect()
}

fn print(out: &mut dyn Write, what: What, judged: &Judged) -> Result<(), Failure> {
    let course = &judged.course;
    let shares = course.shares();
    let over = course.over.word();
    let scheme = match course.scheme.as_deref() {
        Some("event") => ", from event to event",
        Some("time_stepping") => ", by time stepping",
        _ => "",
    };
    writeln!(out, "{}: over one {over} of {:.4} s{scheme}", judged.name, course.duration_s())?;
    judged.notes.iter().try_for_each(|note| writeln!(out, "{note}"))?;
    writeln!(out)?;
    let rows = margin_cells(what, course);
    if course.instants.is_empty() {
        writeln!(out, "no instant has forces\n")?;
    } else if what == What::Momentum {
        writeln!(out, "{}", momentum_table(judged))?;
    } else if rows.is_empty() {
        let why = match what {
            What::Fri => "no foot ever stands alone, or something pushes whenever one does",
            _ => "nothing ever stands on the ground",
        };
        writeln!(out, "{why}\n")?;
    } else {
        let columns = [
            ("point", Align::Left),
            ("least margin [mm]", Align::Right),
            ("at [s]", Align::Right),
            ("largest [mm]", Align::Right),
            ("outside", Align::Right),
        ];
        let mut table = Table::new(&columns);
        rows.into_iter().for_each(|cells| table.push(cells));
        writeln!(out, "{table}")?;
    }
    if what == What::Zmp {
        let apart = course.forces_against_momentum_m();
        writeln!(out, "from forces and from momentum: apart by {apart:.1e} m at most")?;
    }
    if let (What::Fri, Some(apart)) = (what, course.still_foot_apart_m()) {
        writeln!(out, "apart from the zero moment point by {apart:.1e} m while the foot is still")?;
    }
    writeln!(
        out,
        "one foot flat {}, on an edge {}, two feet {}, flight {}; one point alone {}",
        percent(shares.flat),
        percent(shares.toe),
        percent(shares.double),
        percent(shares.flight),
        percent(shares.one_point)
    )?;
    if let Some(run) = course.run.as_ref().filter(|run| run.stop.word() != "end") {
        writeln!(out, "the run {} at {:.4} s", run.stop, run.end.t_s)?;
    }
    Ok(())
}
