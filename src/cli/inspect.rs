//! `denavit inspect`: what a model file says, as denavit understands it.

use super::Answer;
use super::failure::Failure;
use super::files::read_model_with_effects;
use super::json::write_json;
use super::options::{EffectsOption, ModelArgument, ShapesOption};
use super::outputs::{on_stdout, print_answer, write_whole};
use clap::Args;
use denavit::program::CodeError;
use denavit::report::symbolic::{model_json, model_text, robot_faults_json};
use denavit::report::{Pose, inspection_page, picture};
use std::io::Write;
use std::path::PathBuf;

/// Show a model: tree, rows, masses, drives, contacts, assumptions
///
/// A file that is wrong is answered with all its faults, each with place, cause and hint, and exit
/// code 2.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit inspect tulip
  denavit inspect puma560 --svg puma560.svg
  denavit inspect puma560 --html puma560.html
  denavit inspect scara --json")]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    #[command(flatten)]
    effects: EffectsOption,
    /// Draw the robot at its zero pose, with the frames of its links; - is standard output
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write a page: the robot in three dimensions, with sliders for its joints, its numbers and
    /// its equations; - is standard output
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    #[command(flatten)]
    shapes: ShapesOption,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [arguments.svg.as_ref(), arguments.html.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let effects = arguments.effects.effects.as_deref();
    let robot =
        read_model_with_effects(&arguments.model.model, effects).inspect_err(|failure| {
            let Failure::Work(error) = failure else { return };
            if let Some(faults) = error.robot_faults().filter(|_| arguments.json) {
                // where nobody reads them, the failure says them, too
                let _ = write_json(out, &robot_faults_json(&faults)).map(|()| out.flush());
            }
        })?;
    let wrong = |error| CodeError::Lower(robot.name.clone(), error);
    if let Some(file) = &arguments.svg {
        let pose = Pose::zero(&robot).map_err(wrong)?;
        write_whole(file, picture(&robot, &pose).as_bytes())?;
    }
    if let Some(file) = &arguments.html {
        let shapes = arguments.shapes.read(&arguments.model.model)?;
        let page = inspection_page(&robot, env!("CARGO_PKG_VERSION"), shapes.as_ref());
        write_whole(file, page.map_err(wrong)?.render().as_bytes())?;
    }
    let shown = (is_answered, arguments.json);
    print_answer(out, shown, || model_json(&robot), || model_text(&robot), &outputs)?;
    Ok(Answer::Done)
}
