//! Calls of a robot's functions on arrays of numpy.

use crate::arrays::{Given, Rows, unfilled, zeros};
use crate::failure::{Failure, Wrong, internal};
use denavit::function::FunctionName;
use denavit::model::Robot;
use denavit::plants::{RobotFunction, Samples};
use numpy::{PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyTuple};
use std::sync::OnceLock;

/// Calls a function on one sample, or on the rows of arrays. The result is an array, a number where
/// it has no dimension, or a tuple where the function has several results.
pub(crate) fn call<'py>(
    py: Python<'py>,
    function: &RobotFunction,
    name: &str,
    given: &[Given<'py>],
) -> PyResult<Bound<'py, PyAny>> {
    for (argument, one) in function.arguments().iter().zip(given) {
        one.check(argument.len, name)?;
    }
    match given.iter().all(Given::is_one) {
        true => call_one(py, function, given),
        false => call_rows(py, function, given),
    }
}

/// Functions have up to six arguments.
const MOST: usize = 8;

fn call_one<'py>(
    py: Python<'py>,
    function: &RobotFunction,
    given: &[Given<'py>],
) -> PyResult<Bound<'py, PyAny>> {
    let mut rooms: [Vec<f64>; MOST] = Default::default();
    let mut arguments: [&[f64]; MOST] = [&[]; MOST];
    for ((argument, room), one) in arguments.iter_mut().zip(&mut rooms).zip(given) {
        *argument = one.one(room)?;
    }
    let arguments = &arguments[..given.len()];
    match function.outputs() {
        [output] if output.shape.is_empty() => {
            let mut number = [0.0];
            function.call(arguments, &mut number).map_err(internal)?;
            Ok(PyFloat::new(py, number[0]).into_any())
        }
        [output] => {
            let array = zeros(py, &output.shape);
            let mut room = array.readwrite();
            let numbers = room.as_slice_mut().map_err(internal)?;
            function.call(arguments, numbers).map_err(internal)?;
            drop(room);
            Ok(array.into_any())
        }
        outputs => {
            let mut numbers = vec![0.0; outputs.iter().map(|output| output.len()).sum()];
            function.call(arguments, &mut numbers).map_err(internal)?;
            let mut rest = &numbers[..];
            let mut parts = Vec::with_capacity(outputs.len());
            for output in outputs {
                let (own, others) = rest.split_at(output.len());
                rest = others;
                parts.push(match output.shape.is_empty() {
                    true => PyFloat::new(py, own[0]).into_any(),
                    false => filled(py, &output.shape, own)?.into_any(),
                });
            }
            Ok(PyTuple::new(py, parts)?.into_any())
        }
    }
}

fn filled<'py>(
    py: Python<'py>,
    shape: &[usize],
    numbers: &[f64],
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let array = zeros(py, shape);
    array.readwrite().as_slice_mut().map_err(internal)?.copy_from_slice(numbers);
    Ok(array)
}

fn call_rows<'py>(
    py: Python<'py>,
    function: &RobotFunction,
    given: &[Given<'py>],
) -> PyResult<Bound<'py, PyAny>> {
    let many = given.iter().find(|one| !one.is_one());
    let samples = many.map_or(1, Given::samples);
    let rows = given.iter().map(|one| one.rows(samples)).collect::<PyResult<Vec<Rows<'_>>>>()?;
    let arrays = function
        .outputs()
        .iter()
        .map(|output| unfilled(py, [&[samples], &output.shape[..]].concat()))
        .collect::<PyResult<Vec<_>>>()?;
    {
        let mut rooms: Vec<_> = arrays.iter().map(|array| array.readwrite()).collect();
        let mut outputs = Vec::with_capacity(rooms.len());
        for room in &mut rooms {
            outputs.push(room.as_slice_mut().map_err(internal)?);
        }
        let arguments: Vec<&dyn Samples> = rows.iter().map(|one| one as _).collect();
        // nothing of Python is touched until all samples are done
        py.detach(|| function.call_on_samples(&arguments, &mut outputs)).map_err(internal)?;
    }
    if let Some((one, _)) = given.iter().zip(&rows).find(|(_, rows)| !rows.is_finite()) {
        return Err(one.not_finite());
    }
    let mut arrays = arrays;
    match arrays.len() {
        1 => Ok(arrays.remove(0).into_any()),
        _ => Ok(PyTuple::new(py, arrays)?.into_any()),
    }
}

/// The functions of one name, or why there are none.
type Made = OnceLock<Result<Vec<RobotFunction>, String>>;

/// The functions of a robot, each made when it is called first.
pub(crate) struct RobotFunctions {
    robot: Robot,
    made: Vec<Made>,
}

const FUNCTIONS: usize = FunctionName::BaseParameters as usize + 1;

impl RobotFunctions {
    pub(crate) fn new(robot: &Robot) -> Self {
        Self { robot: robot.clone(), made: (0..FUNCTIONS).map(|_| OnceLock::new()).collect() }
    }

    /// All functions of a name, at least one.
    fn all(&self, name: FunctionName) -> PyResult<&[RobotFunction]> {
        let made = &self.made[name as usize];
        let make = || RobotFunction::of(&self.robot, name).map_err(|error| error.to_string());
        // functions of large robots take a second: other threads of Python go on, and may wait here
        let made = match made.get() {
            Some(made) => made,
            None => Python::attach(|py| py.detach(|| made.get_or_init(make))),
        };
        match made {
            Ok(functions) if !functions.is_empty() => Ok(functions),
            Ok(_) => Err(missing(&self.robot, name).into()),
            Err(why) => {
                let cause = format!("{}: {why}", self.robot.name);
                Err(Failure::one("ModelError", Wrong::new(cause)).into())
            }
        }
    }

    /// The function of a name; the first where there is one for each link.
    pub(crate) fn one(&self, name: FunctionName) -> PyResult<&RobotFunction> {
        Ok(&self.all(name)?[0])
    }

    /// The function of a link.
    pub(crate) fn of_link(&self, name: FunctionName, link: &str) -> PyResult<&RobotFunction> {
        let all = self.all(name)?;
        all.iter().find(|one| one.link() == Some(link)).ok_or_else(|| {
            let known: Vec<&str> = all.iter().filter_map(RobotFunction::link).collect();
            let cause = format!("{name} has no link `{link}`");
            let hint = match known.is_empty() {
                true => format!("{name} is a function of the whole robot"),
                false => format!("links are {}", known.join(", ")),
            };
            Failure::argument(Wrong::new(cause).hint(hint)).into()
        })
    }
}

fn missing(robot: &Robot, name: FunctionName) -> Failure {
    let why = match name.as_str() {
        one if one.contains("contact") => "contact points are declared under \"contacts\"",
        "zero_moment_point" | "cart_table_zmp" | "foot_rotation_indicator" | "capture_point" => {
            "points of the ground are those of robots with a floating base and contact points"
        }
        "state_rates" => "it has no effects with states",
        _ => "its mass matrix has no inverse, or an effect depends on what is asked for",
    };
    let cause = format!("{} has no {name}", robot.name);
    Failure::one("FunctionMissing", Wrong::new(cause).hint(why))
}

/// The function of a name.
pub(crate) fn function_name(name: &str) -> PyResult<FunctionName> {
    FunctionName::parse(name).ok_or_else(|| {
        let all = FunctionName::ALL.iter().chain(&FunctionName::WALKING);
        let all: Vec<&str> =
            all.chain(&FunctionName::REGRESSORS).map(|name| name.as_str()).collect();
        let cause = format!("there is no function `{name}`");
        let hint = format!("functions are {}", all.join(", "));
        Failure::argument(Wrong::new(cause).hint(hint)).into()
    })
}
