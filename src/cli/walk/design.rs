//! `denavit walk design`: from a gait file to a scenario that walks.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::files::FILES;
use super::super::outputs::{check_outputs, on_stdout, print_answer, write_given, write_whole};
use super::super::progress::Progress;
use clap::Args;
use denavit::report::answer::{designed_json, designed_picture, designed_text};
use denavit::workflow::design_gait;
use std::io::Write;
use std::path::PathBuf;

/// Design a gait: from a file of a few lines to a scenario that walks (thesis 4.4.2, 4.4.3)
///
/// Gaits are walking primitives, walks by the linear inverted pendulum, walks in space on planned
/// footsteps, and limit cycles; docs/reference/gait.md describes their files. Residuals of inverse
/// kinematics and margins are reported at every posture and between. A gait that cannot be exits
/// with 2, and is named with posture, time and residual.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit walk design planar_biped_primitives -o primitives.json --svg joints.svg
  denavit walk design planar_biped_inverted_pendulum -o pendulum.json
  denavit walk design tulip_walk -o walk.json")]
pub(crate) struct Arguments {
    /// The path of a gait file, or the name of a shipped gait
    #[arg(value_name = "GAIT")]
    gait: PathBuf,
    /// Where the scenario goes, complete, for `denavit simulate`; - is standard output
    #[arg(short, long, value_name = "SCENARIO")]
    output: Option<PathBuf>,
    /// Where the joint references alone go (denavit-trajectory/1); - is standard output
    #[arg(long, value_name = "FILE")]
    trajectory: Option<PathBuf>,
    /// Draw joint angles over a step with the postures marked (thesis figure 4.2); - is standard
    /// output
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// The answer as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs =
        [arguments.output.as_ref(), arguments.trajectory.as_ref(), arguments.svg.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let gait = FILES.gait(&arguments.gait)?;
    let refused = || Failure::Walk(arguments.gait.display().to_string(), NO_TRAJECTORY.to_owned());
    if arguments.trajectory.is_some() && !gait.has_trajectory() {
        return Err(refused());
    }
    check_outputs(&outputs)?;
    let progress = Progress::new();
    progress.show(&format!("designing {}", arguments.gait.display()));
    let designed = design_gait(&FILES, &gait, &arguments.gait, arguments.output.as_deref())?;
    progress.clear();
    write_given(&arguments.output, || designed.scenario.clone())?;
    if let Some(path) = &arguments.trajectory {
        let text = designed.trajectory.as_ref().ok_or_else(refused)?;
        write_whole(path, text.as_bytes())?;
    }
    write_given(&arguments.svg, || designed_picture(&designed))?;
    let shown = (is_answered, arguments.json);
    print_answer(out, shown, || designed_json(&designed), || designed_text(&designed), &outputs)?;
    Ok(Answer::Done)
}

/// Why a gait has no file of references.
const NO_TRAJECTORY: &str = "references alone do not walk a limit cycle, which has torques and \
                             gains of its own\n  hint: leave out --trajectory, and take -o";
