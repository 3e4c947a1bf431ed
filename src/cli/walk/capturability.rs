//! `denavit walk capturability`: in how many steps a robot can come to rest.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::json::write_json;
use super::super::outputs::{check_outputs, on_stdout, say_written, write_whole};
use super::super::simulate::open;
use super::number::within;
use clap::Args;
use denavit::report::{Align, CaptureReach, Table};
use denavit::walk::capturability::{Capturability, CaptureRegion, StepLimits, Steps};
use denavit::walk::capture_step::step_limits;
use serde_json::{Value, json as value};
use std::io::Write;
use std::path::PathBuf;

/// From which capture points no step, one, or more are enough (Koolen and others 2012)
///
/// The linear inverted pendulum with a sole, a least step time and a longest step. Places are
/// forward from the ankle that stands. A scenario whose controller steps (`gait`: `capture_step`)
/// says what it can do; of others the sole and the height of the centre of mass at the start count.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit walk capturability planar_biped_capture_step --svg reach.svg
  denavit walk capturability planar_biped_zmp_gait --step-time 0.4 --capture 0.2")]
pub(crate) struct Arguments {
    /// The path of a scenario file, or the name of a shipped scenario
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// Height of the centre of mass above the ground
    #[arg(long, value_name = "METRES", value_parser = within(1e-3..=1e3, "m"))]
    height: Option<f64>,
    /// The least time of a step
    #[arg(long, value_name = "SECONDS", value_parser = within(1e-3..=1e2, "s"))]
    step_time: Option<f64>,
    /// The longest step from ankle to ankle, either way
    #[arg(long, value_name = "METRES", value_parser = within(0.0..=1e3, "m"))]
    longest_step: Option<f64>,
    /// The largest number of steps that is listed
    #[arg(
        long,
        value_name = "COUNT",
        default_value_t = 5,
        value_parser = clap::value_parser!(u32).range(0..=1000)
    )]
    steps: u32,
    /// A capture point, forward from the ankle that stands: how many steps it needs, and where the
    /// foot may land
    #[arg(
        long,
        value_name = "METRES",
        allow_negative_numbers = true,
        value_parser = within(-1e3..=1e3, "m")
    )]
    capture: Option<f64>,
    /// Draw the reaches over the sole; - is standard output
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// The answer as JSON
    #[arg(long)]
    json: bool,
}

/// A capture point with the steps that it needs, and where the foot may land at the least time.
struct Wanted {
    capture_m: f64,
    steps: Steps,
    region: Option<CaptureRegion>,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [arguments.svg.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let mut scenario = open(&arguments.scenario)?;
    let name = scenario.name.clone();
    let failure = |why: String| Failure::Walk(name.clone(), why);
    let known = step_limits(&mut scenario).map_err(|error| failure(error.to_string()))?;
    let limits = StepLimits {
        height_m: arguments.height.unwrap_or(known.height_m),
        step_s: arguments.step_time.unwrap_or(known.step_s),
        longest_m: arguments.longest_step.map_or(known.longest_m, |longest| [longest; 2]),
        ..known
    };
    let found = Capturability::new(limits).map_err(|error| failure(error.to_string()))?;
    check_outputs(&outputs)?;
    let wanted = arguments.capture.map(|capture_m| wanted(&found, capture_m));
    if let Some(path) = &arguments.svg {
        write_whole(path, draw(&name, arguments, &found).as_bytes())?;
    }
    match (is_answered, arguments.json) {
        (true, _) => {}
        (_, true) => write_json(out, &answer(&name, arguments, &found, wanted.as_ref()))?,
        (_, false) => {
            print(out, &name, arguments, (&found, wanted.as_ref()))?;
            say_written(out, &outputs)?;
        }
    }
    Ok(Answer::Done)
}

fn wanted(found: &Capturability, capture_m: f64) -> Wanted {
    let steps = found.steps(capture_m);
    let region = match steps {
        Steps::Least(steps) => found.region(capture_m, found.limits().step_s, steps),
        Steps::Falls => None,
    };
    Wanted { capture_m, steps, region }
}

fn reaches(arguments: &Arguments, found: &Capturability) -> Vec<[f64; 2]> {
    (0..=arguments.steps as usize).map(|steps| found.reach_m(steps)).collect()
}

/// The number of steps, for JSON; null where it falls.
pub(super) fn steps_value(steps: Steps) -> Value {
    match steps {
        Steps::Least(steps) => steps.into(),
        Steps::Falls => Value::Null,
    }
}

fn answer(
    name: &str,
    arguments: &Arguments,
    found: &Capturability,
    wanted: Option<&Wanted>,
) -> Value {
    let limits = found.limits();
    let one = |(steps, [back, forward]): (usize, [f64; 2])| {
        let backward_m = -back;
        value!({ "steps": steps, "backward_m": backward_m, "forward_m": forward })
    };
    let reach: Vec<Value> = reaches(arguments, found).into_iter().enumerate().map(one).collect();
    let [back, forward] = found.limit_m();
    let capture = wanted.map(|wanted| {
        value!({
            "capture_m": wanted.capture_m,
            "steps": steps_value(wanted.steps),
            "region_m": wanted.region.map(|region| region.places_m),
        })
    });
    value!({
        "scenario": name,
        "height_m": limits.height_m,
        "omega_per_s": limits.omega(),
        "heel_m": limits.heel_m,
        "toe_m": limits.toe_m,
        "step_s": limits.step_s,
        "longest_step_m": limits.longest_m,
        "reach": reach,
        "limit": { "backward_m": -back, "forward_m": forward },
        "capture": capture,
    })
}

fn print(
    out: &mut dyn Write,
    name: &str,
    arguments: &Arguments,
    (found, wanted): (&Capturability, Option<&Wanted>),
) -> Result<(), Failure> {
    let limits = found.limits();
    writeln!(out, "{name}: capture points from which so many steps are enough\n")?;
    let [longest_back, longest_forward] = limits.longest_m;
    let mut table = Table::new(&[("", Align::Left), ("", Align::Right)]);
    for (what, size) in [
        ("height of the centre of mass", format!("{:.4} m", limits.height_m)),
        ("sqrt(g / z)", format!("{:.4} 1/s", limits.omega())),
        ("sole behind the ankle", format!("{:.4} m", limits.heel_m)),
        ("sole ahead of the ankle", format!("{:.4} m", limits.toe_m)),
        ("least step time", format!("{:.4} s", limits.step_s)),
        ("longest step backward", format!("{longest_back:.4} m")),
        ("longest step forward", format!("{longest_forward:.4} m")),
    ] {
        table.push(vec![what.to_owned(), size]);
    }
    writeln!(out, "{table}")?;
    let columns =
        [("steps", Align::Right), ("backward [m]", Align::Right), ("forward [m]", Align::Right)];
    let mut table = Table::new(&columns);
    let mut row = |steps: String, [back, forward]: [f64; 2]| {
        table.push(vec![steps, format!("{:.4}", -back), format!("{forward:.4}")]);
    };
    for (steps, reach) in reaches(arguments, found).into_iter().enumerate() {
        row(steps.to_string(), reach);
    }
    row("any".to_owned(), found.limit_m());
    write!(out, "{table}")?;
    if let Some(wanted) = wanted {
        let place = wanted.capture_m;
        writeln!(out)?;
        match wanted.steps {
            Steps::Falls => writeln!(out, "a capture point at {place} m: no number of steps")?,
            Steps::Least(steps) => writeln!(out, "a capture point at {place} m: {steps} at least")?,
        }
        if let Some(region) = wanted.region {
            let ([low, high], landing_s) = (region.places_m, region.landing_s);
            writeln!(out, "a foot that lands at {landing_s} s: from {low:.4} to {high:.4} m")?;
        }
    }
    Ok(())
}

fn draw(name: &str, arguments: &Arguments, found: &Capturability) -> String {
    let limits = found.limits();
    let title = format!("{}: capturability", name.replace('_', " "));
    let subtitle = format!(
        "capture points from which so many steps of {} s and {} m are enough",
        limits.step_s, limits.longest_m[1]
    );
    let marks: Vec<(f64, String)> =
        arguments.capture.map(|place| (place, "capture point".to_owned())).into_iter().collect();
    CaptureReach {
        title: &title,
        subtitle: &subtitle,
        sole_m: limits.sole_m(),
        reach_m: &reaches(arguments, found),
        limit_m: found.limit_m(),
        marks: &marks,
    }
    .draw()
}
