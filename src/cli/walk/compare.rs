//! `denavit walk compare`: what each criterion says of each run, and what comes out.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::files::FILES;
use super::super::outputs::{check_outputs, on_stdout, print_answer, write_given};
use super::super::progress::Progress;
use clap::Args;
use denavit::report::answer::{comparison_json, comparison_page, comparison_text};
use denavit::walk::comparison::CASES;
use denavit::workflow::compare_criteria;
use std::io::Write;
use std::path::PathBuf;

/// Compare the criteria of stability on runs: what each misses (thesis 4.2, 4.4.6)
///
/// Each scenario is run. A criterion that is met in a run that falls, or missed in one that does
/// not, is marked: such a criterion is not sufficient, or not necessary. Without scenarios the
/// examples of the thesis's chapter 4 are run. Where the no-slip law has no answer to an impact,
/// friction of 0.8 stands in, unless the scenario says otherwise.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  denavit walk compare planar_biped_zmp_gait planar_biped_switched_off --html comparison.html")]
pub(crate) struct Arguments {
    /// Paths of scenario files, or names of shipped scenarios
    #[arg(value_name = "SCENARIO")]
    scenarios: Vec<PathBuf>,
    /// Distance of the instants that are looked at
    #[arg(
        long,
        value_name = "SECONDS",
        default_value = "0.001",
        value_parser = super::balance::period
    )]
    period: f64,
    /// Write a page; - is standard output
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// The answer as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [arguments.html.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let shipped = || CASES.iter().map(|case| PathBuf::from(case.scenario)).collect();
    let scenarios: Vec<PathBuf> =
        if arguments.scenarios.is_empty() { shipped() } else { arguments.scenarios.clone() };
    // all faults before the first run
    scenarios.iter().try_for_each(|path| FILES.scenario(path).map(|_| ()))?;
    check_outputs(&outputs)?;
    let progress = Progress::new();
    let mut all = Vec::new();
    for (index, path) in scenarios.iter().enumerate() {
        let share = index as f64 / scenarios.len() as f64;
        progress.show_part("comparing", Some(share), &path.display().to_string());
        all.push(compare_criteria(&FILES, path, arguments.period)?);
    }
    progress.clear();
    write_given(&arguments.html, || comparison_page(&all).render())?;
    let shown = (is_answered, arguments.json);
    print_answer(out, shown, || comparison_json(&all), || comparison_text(&all), &outputs)?;
    Ok(Answer::Done)
}
