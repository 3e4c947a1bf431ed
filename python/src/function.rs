//! Calls of a robot's functions on arrays of numpy.

use crate::arrays::{Given, Rows, zeros};
use crate::failure::internal;
use denavit_plants::{RobotFunction, Samples};
use numpy::{PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyTuple};

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
    let arrays: Vec<_> = function
        .outputs()
        .iter()
        .map(|output| zeros(py, &[&[samples], &output.shape[..]].concat()))
        .collect();
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
