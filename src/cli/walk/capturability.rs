//! `denavit walk capturability`: in how many steps a robot can come to rest.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::files::FILES;
use super::super::outputs::{check_outputs, on_stdout, print_answer, write_given};
use super::number::within;
use clap::Args;
use denavit::report::answer::{
    CapturabilityAnswer, capturability_json, capturability_picture, capturability_text,
};
use denavit::walk::capturability::{Capturability, StepLimits};
use denavit::walk::capture_step::step_limits;
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

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [arguments.svg.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let mut scenario = FILES.scenario(&arguments.scenario)?;
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
    let (steps, capture_m) = (arguments.steps, arguments.capture);
    let answer = CapturabilityAnswer { name: &name, found: &found, steps, capture_m };
    write_given(&arguments.svg, || capturability_picture(&answer))?;
    let shown = (is_answered, arguments.json);
    print_answer(
        out,
        shown,
        || capturability_json(&answer),
        || capturability_text(&answer),
        &outputs,
    )?;
    Ok(Answer::Done)
}
