//! `denavit evaluate`: the functions of a model as numbers, in states of a file.

use super::Answer;
use super::failure::Failure;
use super::files::{read_file, read_model_with_effects};
use super::json::{Ordered, write_json};
use super::options::{EffectsOption, FunctionList, ModelArgument};
use clap::Args;
use denavit::derive::{Flavour, derive};
use denavit::model::Robot;
use denavit::program::{Evaluator, OutputShape, Routine, lower};
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::{Path, PathBuf};

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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct States {
    states: Vec<State>,
}

#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct State {
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
    tau: Vec<f64>,
    b: Vec<f64>,
}

#[derive(Serialize)]
struct Answered<'a> {
    model: &'a str,
    joints: Vec<&'a str>,
    links: Vec<&'a str>,
    states: Vec<Ordered<Ordered<Nested>>>,
}

/// An array of any number of dimensions.
#[derive(Serialize)]
#[serde(untagged)]
enum Nested {
    Number(f64),
    List(Vec<Nested>),
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let effects = arguments.effects.effects.as_deref();
    let robot = read_model_with_effects(&arguments.model.model, effects)?;
    let states = states(arguments.at.as_deref(), &robot)?;
    let wanted = arguments.functions.wanted();
    let derivation = derive(&robot, Flavour::Baked, &wanted).map_err(Failure::Bake)?;
    let program = lower(&derivation.dag, &derivation.functions)
        .map_err(|error| Failure::Lower(robot.name.clone(), error))?;
    let found = program.routines.iter().map(|routine| routine.name);
    arguments.functions.refuse_missing(&robot.name, found)?;
    // baked: there is nothing left that depends on parameters alone
    let mut evaluators: Vec<(&Routine, Evaluator<f64>)> =
        program.routines.iter().map(|routine| (routine, Evaluator::new(routine, &[]))).collect();
    let answers = states.iter().map(|state| {
        let of = |(routine, evaluator): &mut (&Routine, Evaluator<f64>)| {
            (routine.full_name(), called(routine, evaluator, state))
        };
        Ordered(evaluators.iter_mut().map(of).collect())
    });
    let states: Vec<_> = answers.collect();
    let name = |link| robot.links[link].name.as_str();
    let answer = Answered {
        model: &robot.name,
        joints: robot.joints().map(|(link, _)| name(link)).collect(),
        links: robot.links.values().map(|link| link.name.as_str()).collect(),
        states,
    };
    write_json(out, &answer)?;
    Ok(Answer::Done)
}

/// The states of a file, with one number for each joint; one of zeros without a file.
fn states(file: Option<&Path>, robot: &Robot) -> Result<Vec<State>, Failure> {
    let name = file.map_or(String::new(), |file| file.display().to_string());
    let refused = |said: String| Failure::States(name.clone(), said);
    let mut states = match file {
        None => vec![State::default()],
        Some(file) => {
            let read = serde_json::from_slice::<States>(&read_file(file)?);
            read.map_err(|error| refused(error.to_string()))?.states
        }
    };
    let joints = robot.degrees_of_freedom();
    for (at, state) in states.iter_mut().enumerate() {
        let State { q, qd, qdd, tau, b } = state;
        let all = [("q", q), ("qd", qd), ("qdd", qdd), ("tau", tau), ("b", b)];
        for (name, values) in all {
            if values.is_empty() {
                values.resize(joints, 0.0);
            }
            if values.len() != joints {
                let said = format!(
                    "`{name}` of state {} has {} numbers for {joints} joints",
                    at + 1,
                    values.len()
                );
                return Err(refused(said));
            }
        }
    }
    Ok(states)
}

/// The outputs of a function in a state, by name.
fn called(routine: &Routine, evaluator: &mut Evaluator<f64>, state: &State) -> Ordered<Nested> {
    let given = |name: &str| match name {
        "q" => &state.q[..],
        "qd" => &state.qd,
        "qdd" => &state.qdd,
        "tau" => &state.tau,
        "b" => &state.b,
        // states of laws of effects, which begin at 0
        _ => &[],
    };
    let zeros: Vec<Vec<f64>> = routine.arguments.iter().map(|shape| vec![0.0; shape.len]).collect();
    let arguments: Vec<&[f64]> = routine
        .arguments
        .iter()
        .zip(&zeros)
        .map(|(shape, zeros)| match given(shape.name) {
            found if found.len() == shape.len => found,
            _ => &zeros[..],
        })
        .collect();
    let mut entries = vec![0.0; evaluator.outputs()];
    evaluator
        .evaluate(&arguments, &mut entries)
        .expect("arguments and outputs have the routine's sizes");
    let mut rest = &entries[..];
    let arrays = routine.outputs.iter().map(|output: &OutputShape| {
        let (own, others) = rest.split_at(output.len());
        rest = others;
        (output.name.to_owned(), nested(own, &output.shape))
    });
    Ordered(arrays.collect())
}

fn nested(entries: &[f64], shape: &[usize]) -> Nested {
    match shape {
        [] => entries.first().map_or(Nested::List(Vec::new()), |&entry| Nested::Number(entry)),
        [first, rest @ ..] => {
            let size = entries.len().checked_div(*first).unwrap_or(0).max(1);
            Nested::List(entries.chunks(size).map(|part| nested(part, rest)).collect())
        }
    }
}
