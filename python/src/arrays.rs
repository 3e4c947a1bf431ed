//! Arrays of numpy as arguments, without copies of those that hold doubles.

use crate::failure::{Failure, Wrong};
use denavit::plants::Samples;
use numpy::PyUntypedArrayMethods;
use numpy::ndarray::{ArrayView2, Axis};
use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray};
use pyo3::PyTypeInfo;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyTuple;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// An argument: of one sample, or with a sample in each row.
pub(crate) struct Given<'py> {
    name: &'static str,
    array: PyReadonlyArrayDyn<'py, f64>,
}

static AS_DOUBLES: PyOnceLock<Py<PyAny>> = PyOnceLock::new();

impl<'py> Given<'py> {
    /// Reads an argument: an array of doubles as it is; lists, integers and the like as new arrays.
    pub(crate) fn new(name: &'static str, value: &Bound<'py, PyAny>) -> PyResult<Self> {
        let py = value.py();
        // other kinds of arrays, as masked ones, say more than their numbers
        if value.get_type().is(PyUntypedArray::type_object(py))
            && let Ok(array) = value.cast::<PyArrayDyn<f64>>()
        {
            return Self::read(name, array);
        }
        let make = AS_DOUBLES.get_or_try_init(py, || {
            Ok::<_, PyErr>(py.import("denavit._arrays")?.getattr("as_doubles")?.unbind())
        })?;
        let array = make.bind(py).call1((name, value))?;
        Self::read(name, array.cast::<PyArrayDyn<f64>>()?)
    }

    fn read(name: &'static str, array: &Bound<'py, PyArrayDyn<f64>>) -> PyResult<Self> {
        let array = array.try_readonly().map_err(|_| {
            Failure::argument(Wrong::new(format!("`{name}` is being written to elsewhere")))
        })?;
        if !(1..=2).contains(&array.ndim()) {
            let cause = format!("`{name}` has {} dimensions", array.ndim());
            let hint = "one sample is a vector, many are the rows of a matrix";
            return Err(Failure::argument(Wrong::new(cause).hint(hint)).into());
        }
        Ok(Self { name, array })
    }

    /// Whether there is one sample, and no row of them.
    pub(crate) fn is_one(&self) -> bool {
        self.array.ndim() == 1
    }

    /// Number of samples.
    pub(crate) fn samples(&self) -> usize {
        if self.is_one() { 1 } else { self.array.shape()[0] }
    }

    /// Refuses another number of entries.
    pub(crate) fn check(&self, entries: usize, of: &str) -> PyResult<()> {
        let found = self.array.shape()[self.array.ndim() - 1];
        if found == entries {
            return Ok(());
        }
        let (name, shape) = (self.name, self.array.shape());
        let cause = format!("`{name}` has the shape {}", shown(shape));
        let hint =
            format!("{of} takes ({entries},) for one sample, or (samples, {entries}) for many",);
        Err(Failure::argument(Wrong::new(cause).hint(hint)).into())
    }

    /// The numbers of one sample. All are finite.
    pub(crate) fn one<'s>(&'s self, room: &'s mut Vec<f64>) -> PyResult<&'s [f64]> {
        let numbers = match self.array.as_slice() {
            Ok(numbers) => numbers,
            Err(_) => {
                room.extend(self.array.as_array().iter());
                &room[..]
            }
        };
        match numbers.iter().all(|number| number.is_finite()) {
            true => Ok(numbers),
            false => Err(self.not_finite()),
        }
    }

    /// The samples as rows, one for all of them where there is only one.
    pub(crate) fn rows(&self, samples: usize) -> PyResult<Rows<'_>> {
        let view = self.array.as_array();
        let shape = self.array.shape().to_vec();
        let entries = shape[shape.len() - 1];
        let many = if self.is_one() { view.insert_axis(Axis(0)) } else { view };
        let fits = self.samples() == samples || self.samples() == 1;
        let view = many.into_dimensionality::<numpy::ndarray::Ix2>().ok().filter(|_| fits);
        let is_repeated = self.samples() != samples;
        match view {
            Some(view) => {
                Ok(Rows { view, samples, entries, is_repeated, has_others: AtomicBool::new(false) })
            }
            None => {
                let cause = format!("`{}` has {} samples", self.name, self.samples());
                let hint = format!("others have {samples}; one vector stands for all samples");
                Err(Failure::argument(Wrong::new(cause).hint(hint)).into())
            }
        }
    }

    /// The first number that is infinite or none at all.
    pub(crate) fn not_finite(&self) -> PyErr {
        let view = self.array.as_array();
        let found = view.indexed_iter().find(|(_, number)| !number.is_finite());
        let Some((place, number)) = found else {
            return Failure::argument(Wrong::new(format!("`{}` changed", self.name))).into();
        };
        let place: Vec<String> = (0..view.ndim()).map(|axis| place[axis].to_string()).collect();
        let cause = format!("`{}[{}]` is {number}", self.name, place.join(", "));
        Failure::argument(Wrong::new(cause).hint("every number must be finite")).into()
    }
}

/// A shape as Python writes it.
pub(crate) fn shown(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        all => {
            let all: Vec<String> = all.iter().map(ToString::to_string).collect();
            format!("({})", all.join(", "))
        }
    }
}

/// Samples in rows of an array in any order in memory.
pub(crate) struct Rows<'a> {
    view: ArrayView2<'a, f64>,
    samples: usize,
    entries: usize,
    is_repeated: bool,
    /// Whether a number was read that is not finite.
    has_others: AtomicBool,
}

impl Rows<'_> {
    /// Whether all numbers that were read are finite.
    pub(crate) fn is_finite(&self) -> bool {
        !self.has_others.load(Ordering::Relaxed)
    }

    /// Copies samples that do not stand one after the other: column by column, as they are in
    /// arrays of Fortran's order.
    fn copy(&self, samples: Range<usize>, room: &mut Vec<f64>) {
        room.resize(samples.len() * self.entries, 0.0);
        for entry in 0..self.entries {
            let own = room[entry..].iter_mut().step_by(self.entries);
            if self.is_repeated {
                own.for_each(|own| *own = self.view[[0, entry]]);
                continue;
            }
            let column = self.view.column(entry);
            let numbers = column.split_at(Axis(0), samples.start).1;
            own.zip(numbers).for_each(|(own, number)| *own = *number);
        }
    }
}

impl Samples for Rows<'_> {
    fn entries(&self) -> usize {
        self.entries
    }

    fn samples(&self) -> usize {
        self.samples
    }

    fn rows<'a>(&'a self, samples: Range<usize>, room: &'a mut Vec<f64>) -> &'a [f64] {
        match self.view.as_slice() {
            Some(numbers) if !self.is_repeated => {
                &numbers[samples.start * self.entries..samples.end * self.entries]
            }
            _ => {
                self.copy(samples, room);
                &room[..]
            }
        }
    }

    fn were_read(&self, rows: &[f64]) {
        if !are_finite(rows) {
            self.has_others.store(true, Ordering::Relaxed);
        }
    }
}

/// Whether all numbers are finite. Sums of others are not, however they come about; a sum of finite
/// ones that is too large is looked at again. Sixteen sums side by side wait for no other.
fn are_finite(numbers: &[f64]) -> bool {
    let mut sums = [0.0; 16];
    let parts = numbers.chunks_exact(16);
    let rest = parts.remainder();
    for part in parts {
        for (sum, number) in sums.iter_mut().zip(part) {
            *sum += number;
        }
    }
    let all = sums.iter().chain(rest).sum::<f64>();
    all.is_finite() || numbers.iter().all(|number| number.is_finite())
}

/// A new array of zeros.
pub(crate) fn zeros<'py>(py: Python<'py>, shape: &[usize]) -> Bound<'py, PyArrayDyn<f64>> {
    PyArrayDyn::zeros(py, shape, false)
}

static EMPTY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();

/// A new array, for results that fill it. Memory that numpy has had before would have to be filled
/// with zeros, which takes as long as a function of a small robot.
pub(crate) fn unfilled<'py>(
    py: Python<'py>,
    shape: Vec<usize>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let make = EMPTY
        .get_or_try_init(py, || Ok::<_, PyErr>(py.import("numpy")?.getattr("empty")?.unbind()))?;
    Ok(make.bind(py).call1((PyTuple::new(py, shape)?,))?.cast_into::<PyArrayDyn<f64>>()?)
}
