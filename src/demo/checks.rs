//! Generated functions against equations of motion that were derived in another way.

use super::compiled::Compiled;
use super::states::State;
use denavit::dynamics::methods::{self, Method};
use denavit::expr::{Dag, ExprId};
use denavit::function::{Argument, Form, Function, FunctionName, Output};
use denavit::model::Robot;
use denavit::numerics::Random;
use denavit::program::{CodeError, Evaluator, lower, parameter_defaults, prelude_values};
use denavit::report::{Align, Table};
use serde::Serialize;

/// How many states each check is made at.
const STATES: usize = 50;

/// What was compared, and how far apart it was.
#[derive(Serialize)]
pub(super) struct Check {
    what: String,
    states: usize,
    /// Largest difference of an entry, relative to the largest entry of the same result.
    max_relative_difference: f64,
    tolerance: f64,
}

impl Check {
    fn new(what: &str, tolerance: f64) -> Self {
        let what = what.to_owned();
        Self { what, states: 0, max_relative_difference: 0.0, tolerance }
    }

    /// Whether no difference is beyond the tolerance; what is not a number is.
    pub(super) fn passed(&self) -> bool {
        self.states > 0 && self.max_relative_difference <= self.tolerance
    }

    fn compare(&mut self, found: &[f64], expected: &[f64]) {
        let largest = expected.iter().fold(f64::MIN_POSITIVE, |max, x| max.max(x.abs()));
        let mut worst = if found.len() == expected.len() { 0.0 } else { f64::INFINITY };
        for (a, b) in found.iter().zip(expected) {
            let difference = (a - b).abs() / largest;
            let difference = if difference.is_nan() { f64::INFINITY } else { difference };
            worst = difference.max(worst);
        }
        self.max_relative_difference = self.max_relative_difference.max(worst);
        self.states += 1;
    }
}

/// Compares at random states: with the equations of motion of the thesis's four methods, which are
/// derived now and interpreted, and the generated functions with each other.
pub(super) fn run(robot: &Robot, compiled: &Compiled, seed: u64) -> Result<Vec<Check>, CodeError> {
    let mut methods = Vec::new();
    for method in Method::ALL {
        let what = format!("inverse_dynamics = {method}, derived now and interpreted");
        methods.push((Check::new(&what, 1e-11), Independent::new(robot, method)?));
    }
    let mut terms = Check::new("D qdd + C qd + G + torque of drives = inverse_dynamics", 1e-11);
    let mut round_trip = Check::new("forward_dynamics(inverse_dynamics(qdd)) = qdd", 1e-8);
    let mut energy = Check::new("qd' D qd / 2 = kinetic_energy", 1e-12);
    let mut random = Random::new(seed);
    for _ in 0..STATES {
        let state = State::random(&mut random, robot.degrees_of_freedom());
        let State { q, qd, qdd } = &state;
        let tau = (compiled.inverse_dynamics)([q, qd, qdd]);
        let mut drives = vec![0.0; tau.len()];
        for (check, independent) in &mut methods {
            let [expected, own] = independent.torques(&state);
            check.compare(&tau, &expected);
            drives = own;
        }
        let mass = (compiled.mass_matrix)(q);
        let parts = [
            product(&mass, qdd),
            product(&(compiled.coriolis_matrix)([q, qd]), qd),
            (compiled.gravity_vector)(q),
            drives,
        ];
        let sum: Vec<f64> =
            (0..tau.len()).map(|j| parts.iter().map(|part| part[j]).sum()).collect();
        terms.compare(&sum, &tau);
        round_trip.compare(&(compiled.forward_dynamics)([q, qd, &tau]), qdd);
        let momentum = product(&mass, qd);
        let half_square: f64 = qd.iter().zip(&momentum).map(|(a, b)| a * b / 2.0).sum();
        energy.compare(&[half_square], &[(compiled.kinetic_energy)([q, qd])]);
    }
    let mut checks: Vec<Check> = methods.into_iter().map(|(check, _)| check).collect();
    checks.extend([terms, round_trip, energy]);
    Ok(checks)
}

/// A row-major square matrix times a vector.
fn product(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    let row = |row: &[f64]| row.iter().zip(vector).map(|(a, b)| a * b).sum();
    matrix.chunks(vector.len().max(1)).map(row).collect()
}

/// The equations of motion by a method that shares nothing with the generated functions.
struct Independent {
    evaluator: Evaluator<f64>,
    joints: usize,
}

impl Independent {
    fn new(robot: &Robot, method: Method) -> Result<Self, CodeError> {
        let mut dag = robot.dag.clone();
        let derived = methods::derive(&mut dag, robot, method);
        let joints = robot.degrees_of_freedom();
        let outputs = [("tau", derived.inverse_dynamics), ("drives", derived.drive_torque)];
        let function = Function {
            name: FunctionName::InverseDynamics,
            link: None,
            arguments: arguments(robot),
            outputs: outputs.map(|(name, entries)| output(name, entries)).into(),
            form: Form::Plain,
        };
        let evaluator = evaluator(&dag, robot, function)?;
        Ok(Self { evaluator, joints })
    }

    /// tau, and the part of it that friction, springs and offsets ask for.
    fn torques(&mut self, state: &State) -> [Vec<f64>; 2] {
        let mut outputs = vec![0.0; self.evaluator.outputs()];
        self.evaluator
            .evaluate(&[&state.q, &state.qd, &state.qdd], &mut outputs)
            .expect("a state has one entry for each joint");
        let drives = outputs.split_off(self.joints);
        [outputs, drives]
    }
}

fn evaluator(dag: &Dag, robot: &Robot, function: Function) -> Result<Evaluator<f64>, CodeError> {
    let program =
        lower(dag, &[function]).map_err(|error| CodeError::Lower(robot.name.clone(), error))?;
    let defaults = parameter_defaults(&program, robot);
    // shipped models give every value; a hole would show as a failed check
    let parameters: Vec<f64> =
        defaults.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect();
    let prelude = prelude_values(&program, &parameters).expect("one value for each parameter");
    let routine = program.routines.first().expect("one function was lowered");
    Ok(Evaluator::new(routine, &prelude))
}

fn arguments(robot: &Robot) -> Vec<Argument> {
    let symbols = |name, of: fn(&denavit::model::JointVariables) -> ExprId| Argument {
        name,
        symbols: robot.joints().map(|(_, variables)| of(variables)).collect(),
    };
    vec![symbols("q", |v| v.q), symbols("qd", |v| v.qd), symbols("qdd", |v| v.qdd)]
}

fn output(name: &'static str, entries: Vec<ExprId>) -> Output {
    Output { name, shape: vec![entries.len()], entries, doc: String::new(), details: Vec::new() }
}

/// The checks as a table.
pub(super) fn table(checks: &[Check]) -> Table {
    use Align::{Left, Right};
    let mut table = Table::new(&[
        ("", Left),
        ("check", Left),
        ("states", Right),
        ("max relative difference", Right),
        ("allowed", Right),
    ]);
    for check in checks {
        table.push(vec![
            if check.passed() { "ok" } else { "FAILED" }.to_owned(),
            check.what.clone(),
            check.states.to_string(),
            format!("{:.1e}", check.max_relative_difference),
            format!("{:.0e}", check.tolerance),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_and_a_nan_fail_a_check() {
        let passes = |found: &[f64]| {
            let mut check = Check::new("test", 1e-12);
            check.compare(&[1.0, 2.0], &[1.0, 2.0]);
            check.compare(found, &[1.0, 2.0]);
            check.passed()
        };
        assert!(passes(&[1.0, 2.0]));
        assert!(!passes(&[1.0, 2.0 + 1e-9]));
        assert!(!passes(&[f64::NAN, 2.0]));
        assert!(!passes(&[1.0]));
        assert!(!Check::new("nothing compared", 1.0).passed());
    }
}
