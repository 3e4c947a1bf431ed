//! Programs of the numbers of a model's file: what the regressor's columns are multiplied with, and
//! what must not be negative.

use crate::error::Error;
use denavit_codegen::expr::{ExprId, substitute};
use denavit_codegen::function::{Form, Function, FunctionName, Output};
use denavit_codegen::model::Robot;
use denavit_codegen::program::{Evaluator, OutputShape, Program, lower, prelude_values};
use denavit_codegen::regressor::BaseParameters;
use rustc_hash::FxHashMap;

/// theta0 as a function of the numbers of the file, constants folded in.
pub(super) fn theta0_program(base: &BaseParameters, robot: &Robot) -> Result<Program, Error> {
    let values = base.regressor.columns.iter().map(|column| column.value).collect();
    program_of(base, robot, values)
}

/// The masses and moments of inertia that are no numbers of the file by themselves; none if there
/// are none.
pub(super) fn not_negative_program(
    base: &BaseParameters,
    robot: &Robot,
) -> Result<Option<Program>, Error> {
    let entries = robot.links.values().filter_map(|link| link.body).flat_map(|body| {
        let [xx, yy, zz, ..] = body.inertia;
        [body.mass, xx, yy, zz]
    });
    let is_own = |entry: &ExprId| robot.parameters.values().any(|one| one.symbol == *entry);
    let is_number = |entry: &ExprId| base.regressor.dag.classes(*entry).is_empty();
    let values: Vec<ExprId> = entries.filter(|entry| !is_own(entry) && !is_number(entry)).collect();
    if values.is_empty() {
        return Ok(None);
    }
    program_of(base, robot, values).map(Some)
}

/// Values as a function of the numbers of the file, constants folded in.
fn program_of(base: &BaseParameters, robot: &Robot, values: Vec<ExprId>) -> Result<Program, Error> {
    let mut dag = base.regressor.dag.clone();
    let known = robot.parameters.values().filter(|parameter| parameter.known);
    let known: FxHashMap<ExprId, ExprId> =
        known.filter_map(|p| Some((p.symbol, p.default?))).collect();
    let entries = substitute(&mut dag, &values, &known);
    let name = FunctionName::BaseParameters;
    let shape = vec![entries.len()];
    let (doc, details) = (String::new(), Vec::new());
    let output = Output { name: name.as_str(), shape, entries, doc, details };
    let (arguments, outputs) = (Vec::new(), vec![output]);
    let function = Function { name, link: None, arguments, outputs, form: Form::Plain };
    Ok(lower(&dag, &[function])?)
}

/// The outputs of a program of parameters alone; a parameter without a value is 0.
pub(super) fn values_of(program: &Program, of_name: &dyn Fn(&str) -> Option<f64>) -> Vec<f64> {
    let given: Vec<f64> =
        program.parameters.iter().map(|name| of_name(name).unwrap_or(0.0)).collect();
    let prelude = prelude_values(program, &given).expect("one value for each parameter");
    let routine = &program.routines[0];
    let entries = |output: &OutputShape| output.shape.iter().product::<usize>();
    let mut values = vec![0.0; routine.outputs.iter().map(entries).sum()];
    let mut evaluator = Evaluator::<f64>::new(routine, &prelude);
    evaluator.evaluate(&[], &mut values).expect("one entry for each output");
    values
}
