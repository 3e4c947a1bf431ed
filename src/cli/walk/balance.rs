//! `denavit walk zmp|fri|capture|momentum`: balance along a run or a log.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::files::{read_log, read_model_with_effects};
use super::super::json::write_json;
use super::super::outputs::{check_outputs, on_stdout, say_written, write_whole};
use super::super::simulate::open;
use clap::Args;
use denavit::plants::{PlantModel, plant_of};
use denavit::report::{Align, BalanceCurve, BalancePicture, Table, percent};
use denavit::simulate::{EventKind, Log};
use denavit::walk::balance::{
    BalanceError, Course, Criterion, Instant, Margins, course_of_log, course_of_scenario,
};
use serde_json::{Map, Value, json as value};
use std::io::Write;
use std::path::PathBuf;

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
    /// Distance of the instants that are looked at
    #[arg(
        long,
        value_name = "SECONDS",
        default_value = "0.0005",
        value_parser = period,
        conflicts_with = "model"
    )]
    period: f64,
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
}

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
    let failure = |error: BalanceError| Failure::Walk(name.clone(), error.to_string());
    if let Some(model) = &arguments.model {
        let robot = read_model_with_effects(model, None)?;
        let mut plant = plant_of(&robot, &[])
            .map_err(|error| Failure::Walk(robot.name.clone(), error.to_string()))?;
        let log = read_log(&arguments.input)?;
        let course = course_of_log(plant.as_mut(), &log).map_err(failure)?;
        return Ok(Judged { name, model: plant.model().clone(), course });
    }
    if arguments.input.extension().is_some_and(|extension| extension == "csv") {
        let why = "a log says nothing of its robot\n  hint: name the robot's model: --model MODEL";
        return Err(Failure::Walk(name, why.to_owned()));
    }
    let mut scenario = open(&arguments.input)?;
    let course =
        course_of_scenario(&mut scenario, arguments.period, arguments.whole).map_err(failure)?;
    let model = scenario.plant.model().clone();
    Ok(Judged { name: scenario.name, model, course })
}

const POINTS: [(&str, Criterion); 4] = [
    ("zmp", Criterion::ZeroMoment),
    ("cart_table", Criterion::CartTable),
    ("fri", Criterion::FootRotation),
    ("capture", Criterion::Capture),
];

/// All criteria, row by row; docs/walking.md lists the columns.
fn series(judged: &Judged) -> Log {
    let mut columns = vec!["t".to_owned()];
    let axes = ["x", "y", "z"];
    for vector in ["com", "com_velocity", "com_acceleration", "angular_momentum", "cop"] {
        columns.extend(axes.map(|axis| format!("{vector}_{axis}")));
    }
    for (name, _) in POINTS {
        columns.extend(axes.map(|axis| format!("{name}_{axis}")));
        columns.push(format!("{name}_margin"));
    }
    columns.extend(["support_low", "support_high", "feet", "contacts"].map(str::to_owned));
    let bodies = turning_bodies(judged);
    for body in &bodies {
        let name = &judged.model.joints[*body].name;
        columns.extend(axes.map(|axis| format!("angular_momentum_{name}_{axis}")));
    }
    let mut values = Vec::new();
    for instant in &judged.course.instants {
        values.push(instant.t_s);
        values.extend(instant.center_of_mass.as_flattened());
        values.extend(instant.angular_momentum);
        values.extend(instant.center_of_pressure_m);
        for (_, criterion) in POINTS {
            values.extend(criterion.point(instant).unwrap_or([f64::NAN; 3]));
            values.push(criterion.margin(instant).unwrap_or(f64::NAN));
        }
        values.extend(instant.support.range().unwrap_or([f64::NAN; 2]));
        values.push(feet(instant));
        values.push(instant.closed as f64);
        bodies.iter().for_each(|body| values.extend(instant.body_momenta[*body]));
    }
    let header = vec![
        ("denavit", env!("CARGO_PKG_VERSION").to_owned()),
        ("criteria_of", judged.name.clone()),
        ("model", judged.model.name.clone()),
        ("over", judged.course.over.word().to_owned()),
    ];
    let header = header.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
    Log { header, columns, values }
}

fn feet(instant: &Instant) -> f64 {
    use denavit::walk::balance::Phase;
    match instant.phase {
        Phase::Flight => 0.0,
        Phase::Flat | Phase::Toe => 1.0,
        Phase::Double => 2.0,
    }
}

/// Events with their impulses, and the velocities before and after.
fn events(judged: &Judged) -> Log {
    let model = &judged.model;
    let mut columns = ["t", "kind", "energy"].map(str::to_owned).to_vec();
    let points = model.contacts.iter();
    columns.extend(points.clone().map(|contact| format!("closed_{}", contact.name)));
    for contact in points {
        columns.extend(["x", "y", "z"].map(|axis| format!("p_{}_{axis}", contact.name)));
    }
    for prefix in ["q", "qd_before", "qd_after"] {
        columns.extend(model.joints.iter().map(|joint| format!("{prefix}_{}", joint.name)));
    }
    let mut values = Vec::new();
    for event in judged.course.run.iter().flat_map(|run| &run.events) {
        values.push(event.t_s);
        values.push(match event.kind {
            EventKind::Start => 0.0,
            EventKind::Touch(_) => 1.0,
            EventKind::Limit | EventKind::LeastLoads => 2.0,
            EventKind::SlipEnds(_) => 3.0,
            EventKind::Jump(_) => 4.0,
            EventKind::Push => 5.0,
            EventKind::Plan => 6.0,
        });
        values.push(event.energy_j);
        let contacts = 0..model.contacts.len();
        values.extend(contacts.clone().map(|c| f64::from(u8::from(event.closed.contains(&c)))));
        for contact in contacts {
            let hits = event.impulses.iter().filter(|(hit, _)| *hit == contact);
            let sum =
                hits.fold([0.0; 3], |sum, (_, p)| [sum[0] + p[0], sum[1] + p[1], sum[2] + p[2]]);
            values.extend(sum);
        }
        [&event.q, &event.before, &event.after].into_iter().for_each(|part| values.extend(part));
    }
    let kinds = "0 start, 1 touch, 2 limit of forces, 3 end of slipping, 4 jump, 5 push, 6 plan";
    let header = [
        ("denavit".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("events_of".to_owned(), judged.name.clone()),
        ("kinds".to_owned(), kinds.to_owned()),
    ];
    Log { header: header.to_vec(), columns, values }
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

/// The joints whose bodies turn, or go round the centre of mass.
fn turning_bodies(judged: &Judged) -> Vec<usize> {
    let turns = |instant: &Instant, body: usize| instant.body_momenta[body] != [0.0; 3];
    let instants = &judged.course.instants;
    let all = 0..judged.model.joints.len();
    all.filter(|body| instants.iter().any(|instant| turns(instant, *body))).collect()
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
    writeln!(out, "{}: over one {over} of {:.4} s\n", judged.name, course.duration_s())?;
    if what == What::Momentum {
        writeln!(out, "{}", momentum_table(judged))?;
    } else {
        let columns = [
            ("point", Align::Left),
            ("least margin [mm]", Align::Right),
            ("at [s]", Align::Right),
            ("largest [mm]", Align::Right),
            ("outside", Align::Right),
        ];
        let mut table = Table::new(&columns);
        margin_cells(what, course).into_iter().for_each(|cells| table.push(cells));
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
