//! `denavit walk page`: a gait on one page, with the figures of thesis chapter 4.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::files::FILES;
use super::super::outputs::{check_outputs, on_stdout, say_written, write_whole};
use super::super::progress::Progress;
use super::balance::period;
use clap::Args;
use denavit::report::answer::gait_page;
use denavit::walk::balance::course_of_scenario;
use denavit::walk::poincare::{PoincareOptions, analyse};
use std::io::Write;
use std::path::PathBuf;

/// Show a gait on one page: joints, snapshots, zero moment point, returns, multipliers
///
/// The pictures are those of thesis figures 4.2 to 4.5 and 4.7 to 4.9, over one cycle of the gait,
/// or over the whole run where it has none; tables say what each criterion finds, speed and energy.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  denavit walk page planar_biped_limit_cycle_gait -o gait.html")]
pub(crate) struct Arguments {
    /// A scenario or a gait, which is designed first: the path of its file, or a shipped name
    #[arg(value_name = "SCENARIO|GAIT")]
    scenario: PathBuf,
    /// Distance of the instants that are looked at
    #[arg(long, value_name = "SECONDS", default_value = "0.001", value_parser = period)]
    period: f64,
    /// Where the page goes; - is standard output
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [Some(&arguments.output)];
    let is_answered = on_stdout(&outputs, false)?;
    let progress = Progress::new();
    progress.show("reading, and designing a gait");
    let mut scenario = FILES.scenario_or_gait(&arguments.scenario)?;
    check_outputs(&outputs)?;
    let name = arguments.scenario.display().to_string();
    progress.show("simulating");
    let course = course_of_scenario(&mut scenario, arguments.period, false)
        .map_err(|error| Failure::Walk(name, error.to_string()))?;
    let options =
        PoincareOptions { checks: false, returns: (0.1, 12), ..PoincareOptions::default() };
    // a gait without a cycle has a page, too: it says why there is none
    progress.show("following the cycle");
    let cycle = analyse(&mut scenario, &options);
    progress.clear();
    let page = gait_page(&mut scenario, course, cycle.map_err(|error| error.to_string()));
    write_whole(&arguments.output, page.render().as_bytes())?;
    if !is_answered {
        say_written(out, &outputs)?;
    }
    Ok(Answer::Done)
}
