//! `denavit walk poincare`: the cycle of a gait, and whether deviations from it die.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::files::FILES;
use super::super::outputs::{check_outputs, on_stdout, print_answer, write_given, write_whole};
use super::super::progress::Progress;
use clap::Args;
use denavit::report::answer::{
    cycle_json, cycle_text, is_stable, multipliers_picture, returns_picture,
};
use denavit::walk::poincare::{PoincareOptions, WantedSection, analyse};
use std::io::Write;
use std::path::PathBuf;

/// Find the cycle of a gait and its Floquet multipliers (thesis 4.2.2, 4.4.5)
///
/// The state that comes back to itself is found by Newton's method. The multipliers are those of
/// the linearised return map inside the manifold of the contacts, from the variational equation
/// with saltation at events; central differences and other sections check them. Deviations die
/// where all are inside the unit circle: else, and where the checks contradict each other, the
/// command exits with 1.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit walk poincare planar_biped_limit_cycle_gait --unchecked --svg circle.svg
  denavit walk poincare compass_gait --section strike --json")]
pub(crate) struct Arguments {
    /// A scenario or a gait, which is designed first: the path of its file, or a shipped name
    #[arg(value_name = "SCENARIO|GAIT")]
    scenario: PathBuf,
    /// Where the cycle is looked at: strike, or a share of the cycle from 0 to 1 [default: the
    /// middle of the longest time without an event]
    #[arg(long, value_name = "SECTION", value_parser = section)]
    section: Option<WantedSection>,
    /// Steps from the start on before the cycle is looked for
    #[arg(
        long,
        value_name = "STEPS",
        default_value_t = 4,
        value_parser = clap::value_parser!(u32).range(0..=1000)
    )]
    approach: u32,
    /// Leave out the comparison with central differences and with other sections
    #[arg(long)]
    unchecked: bool,
    /// How far two velocities are off the cycle at the start of the way back to it
    #[arg(long, value_name = "RATE", default_value_t = 0.1, value_parser = off)]
    off: f64,
    /// Cycles for which the way back is followed
    #[arg(
        long,
        value_name = "CYCLES",
        default_value_t = 12,
        value_parser = clap::value_parser!(u32).range(1..=1000)
    )]
    returns: u32,
    /// Draw the way back on the section (thesis figure 4.8); - is standard output
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Draw the multipliers in the unit circle (thesis figure 4.9); - is standard output
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// The answer as JSON
    #[arg(long)]
    json: bool,
}

fn off(text: &str) -> Result<f64, String> {
    let off: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (1e-6..=10.0).contains(&off) { Ok(off) } else { Err("not from 1e-6 to 10 rad/s".into()) }
}

fn section(text: &str) -> Result<WantedSection, String> {
    if text == "strike" {
        return Ok(WantedSection::Strike);
    }
    match text.parse::<f64>() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(WantedSection::Phase(share)),
        _ => Err("`strike`, or a share of the cycle from 0 to 1".to_owned()),
    }
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [arguments.svg.as_ref(), arguments.map.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let progress = Progress::new();
    progress.show("reading, and designing a gait");
    let mut scenario = FILES.scenario_or_gait(&arguments.scenario)?;
    check_outputs(&outputs)?;
    let options = PoincareOptions {
        section: arguments.section.unwrap_or_default(),
        approach_steps: arguments.approach as usize,
        checks: !arguments.unchecked,
        returns: (arguments.off, arguments.returns as usize),
        ..PoincareOptions::default()
    };
    progress.show("following the cycle");
    let found = analyse(&mut scenario, &options).map_err(|error| {
        let hint = match options.section {
            WantedSection::Strike => "\n  hint: leave out --section: the clock says when to look",
            _ => "",
        };
        Failure::Walk(scenario.name.clone(), format!("{error}{hint}"))
    })?;
    progress.clear();
    write_given(&arguments.svg, || multipliers_picture(&scenario, &found))?;
    if let (Some(path), Some(convergence)) = (&arguments.map, &found.convergence) {
        write_whole(path, returns_picture(&scenario, &found, convergence).as_bytes())?;
    }
    let shown = (is_answered, arguments.json);
    print_answer(
        out,
        shown,
        || cycle_json(&scenario, &found),
        || cycle_text(&scenario, &found),
        &outputs,
    )?;
    let good = is_stable(&found) && found.contradiction().is_none();
    Ok(if good { Answer::Done } else { Answer::Negative })
}
