//! `denavit evaluate`: the functions of a model as numbers, in states of a file.

use super::Answer;
use super::failure::Failure;
use super::files::{read_file, read_model_with_effects};
use super::json::write_json;
use super::options::{EffectsOption, FunctionList, ModelArgument};
use clap::Args;
use denavit::program::States;
use denavit::report::symbolic::evaluated_json;
use std::io::Write;
use std::path::PathBuf;

/// Evaluate the functions of a model in given states
///
/// A file has the states: {"states": [{"q": [0.1, ..], "qd": [..], "qdd": [..], "tau": [..]}]}, one
/// number for each joint of the model, in its order; what is left out is 0. The answer is JSON: the
/// names of joints and links and, state by state, each function with its arrays, rows within rows.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit evaluate planar_2r --functions mass_matrix,gravity_vector
  denavit evaluate panda --functions link_jacobian,link_transforms")]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    #[command(flatten)]
    effects: EffectsOption,
    /// The states; - is standard input. Without it: at rest, all joints at 0
    #[arg(long, value_name = "FILE")]
    at: Option<PathBuf>,
    #[command(flatten)]
    functions: FunctionList,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let effects = arguments.effects.effects.as_deref();
    let robot = read_model_with_effects(&arguments.model.model, effects)?;
    let states = match &arguments.at {
        None => States::at_rest(&robot),
        Some(file) => States::read(&read_file(file)?, &robot)
            .map_err(|error| Failure::States(file.display().to_string(), error))?,
    };
    let found = states.evaluate(&robot, &arguments.functions.wanted())?;
    arguments.functions.refuse_missing(&robot.name, found.functions.iter().copied())?;
    write_json(out, &evaluated_json(&robot, &found))?;
    Ok(Answer::Done)
}
