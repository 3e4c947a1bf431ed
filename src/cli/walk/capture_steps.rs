//! `denavit walk capture-steps`: pushes, the steps predicted, and the steps made.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::files::FILES;
use super::super::outputs::print_answer;
use super::super::progress::Progress;
use super::number::{impulse, within};
use clap::Args;
use denavit::report::answer::{capture_steps_json, capture_steps_text};
use denavit::workflow::push_stepping_robot;
use std::io::Write;
use std::path::PathBuf;

/// Push a robot that steps onto its capture point: the steps predicted, and the steps it makes
///
/// Impulses along x, at the point and the time of the scenario's first push, which they replace.
/// The prediction is that of the linear inverted pendulum with sole, step time and longest step of
/// the controller (`walk capturability`), from the capture point just after the push.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit walk capture-steps planar_biped_capture_step --most 20 --pushes 5
  denavit walk capture-steps planar_biped_capture_step --impulses 6,14,-12")]
pub(crate) struct Arguments {
    /// The path of a scenario file, or the name of a shipped scenario
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// The strongest impulse, forward and backward [N s]
    #[arg(long, value_name = "NS", default_value = "28", value_parser = within(1e-6..=1e6, "N s"))]
    most: f64,
    /// How many impulses, from the strongest backward to the strongest forward
    #[arg(
        long,
        value_name = "COUNT",
        default_value_t = 15,
        value_parser = clap::value_parser!(u32).range(2..=1001)
    )]
    pushes: u32,
    /// These impulses instead, backward negative [N s]
    #[arg(
        long,
        value_name = "NS,..",
        value_delimiter = ',',
        allow_hyphen_values = true,
        value_parser = impulse,
        conflicts_with_all = ["most", "pushes"]
    )]
    impulses: Vec<f64>,
    /// How long the robot has to come to rest after the push
    #[arg(
        long,
        value_name = "SECONDS",
        default_value = "4",
        value_parser = within(1e-3..=1e3, "s")
    )]
    after: f64,
    /// The answer as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let last = f64::from(arguments.pushes - 1);
    let graded = (0..arguments.pushes)
        .map(|index| arguments.most * (2.0 * f64::from(index) / last - 1.0))
        .collect();
    let impulses_ns = match arguments.impulses.is_empty() {
        true => graded,
        false => arguments.impulses.clone(),
    };
    let (path, after_s) = (&arguments.scenario, arguments.after);
    let progress = Progress::new();
    let (name, pushes) =
        push_stepping_robot(&FILES, path, &impulses_ns, after_s, &mut progress.observer())?;
    progress.clear();
    let how = (false, arguments.json);
    let (json, text) =
        (|| capture_steps_json(&name, &pushes), || capture_steps_text(&name, &pushes));
    print_answer(out, how, json, text, &[])?;
    Ok(Answer::Done)
}
