//! The functions of a robot as numbers, in states of a file.

use super::{CodeError, CodeOptions, Evaluator, Lowered, OutputShape, Routine};
use crate::derive::Flavour;
use crate::function::FunctionName;
use crate::model::Robot;
use serde::Deserialize;
use std::fmt;

/// What functions are evaluated in: one number for each joint, in the order of the joints.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct StateOfMotion {
    /// Positions \[rad, m\].
    q: Vec<f64>,
    /// Velocities \[rad/s, m/s\].
    qd: Vec<f64>,
    /// Accelerations \[rad/s^2, m/s^2\].
    qdd: Vec<f64>,
    /// Torques \[N m, N\].
    tau: Vec<f64>,
    /// The right-hand side of `mass_matrix_solve`.
    b: Vec<f64>,
}

/// States, each with one number for each joint.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct States {
    states: Vec<StateOfMotion>,
}

/// Why a text holds no states of a robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StatesError(String);

impl fmt::Display for StatesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "these are no states: {}", self.0)
    }
}

impl std::error::Error for StatesError {}

/// What functions gave in states.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated {
    /// The functions that the robot has.
    pub functions: Vec<FunctionName>,
    /// State by state, what each function gave.
    pub states: Vec<Vec<CalledFunction>>,
}

/// What a function gave in a state.
#[derive(Clone, Debug, PartialEq)]
pub struct CalledFunction {
    /// Its name, with the link where there is one.
    pub name: String,
    /// Its outputs, in order.
    pub arrays: Vec<NumberArray>,
}

/// An output as numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct NumberArray {
    /// The name of the array.
    pub name: &'static str,
    /// Its dimensions, outermost first.
    pub shape: Vec<usize>,
    /// The entries, last index fastest.
    pub entries: Vec<f64>,
}

impl States {
    /// A robot at rest, all joints at 0.
    pub fn at_rest(robot: &Robot) -> Self {
        let mut state = StateOfMotion::default();
        let joints = robot.degrees_of_freedom();
        state.lists().into_iter().for_each(|(_, values)| values.resize(joints, 0.0));
        Self { states: vec![state] }
    }

    /// The states of a JSON text, `{"states": [{"q": [0.1, ..], ..}]}`; what is left out is 0.
    pub fn read(text: &[u8], robot: &Robot) -> Result<Self, StatesError> {
        let mut read: Self =
            serde_json::from_slice(text).map_err(|error| StatesError(error.to_string()))?;
        let joints = robot.degrees_of_freedom();
        for (at, state) in read.states.iter_mut().enumerate() {
            for (name, values) in state.lists() {
                if values.is_empty() {
                    values.resize(joints, 0.0);
                }
                if values.len() != joints {
                    return Err(StatesError(format!(
                        "`{name}` of state {} has {} numbers for {joints} joints",
                        at + 1,
                        values.len()
                    )));
                }
            }
        }
        Ok(read)
    }

    /// Evaluates functions of a robot, with the values of its file, in each state.
    pub fn evaluate(
        &self,
        robot: &Robot,
        functions: &[FunctionName],
    ) -> Result<Evaluated, CodeError> {
        let functions = functions.to_vec();
        let options = CodeOptions { flavour: Flavour::Baked, functions, ..CodeOptions::default() };
        let program = Lowered::new(robot, &options)?.program;
        // baked: there is nothing left that depends on parameters alone
        let mut evaluators: Vec<(&Routine, Evaluator<f64>)> = program
            .routines
            .iter()
            .map(|routine| (routine, Evaluator::new(routine, &[])))
            .collect();
        let in_state = |state: &StateOfMotion| {
            let of = |(routine, evaluator): &mut (&Routine, Evaluator<f64>)| CalledFunction {
                name: routine.full_name(),
                arrays: called(routine, evaluator, state),
            };
            evaluators.iter_mut().map(of).collect()
        };
        let states = self.states.iter().map(in_state).collect();
        let functions = program.routines.iter().map(|routine| routine.name).collect();
        Ok(Evaluated { functions, states })
    }
}

impl StateOfMotion {
    /// The lists by name.
    fn lists(&mut self) -> [(&'static str, &mut Vec<f64>); 5] {
        let Self { q, qd, qdd, tau, b } = self;
        [("q", q), ("qd", qd), ("qdd", qdd), ("tau", tau), ("b", b)]
    }
}

/// The outputs of a function in a state.
fn called(
    routine: &Routine,
    evaluator: &mut Evaluator<f64>,
    state: &StateOfMotion,
) -> Vec<NumberArray> {
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
        NumberArray { name: output.name, shape: output.shape.clone(), entries: own.to_vec() }
    });
    arrays.collect()
}
