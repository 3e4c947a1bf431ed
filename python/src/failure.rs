//! What is wrong, as exceptions of the package: classes of `denavit.errors` with the fields
//! `file`, `line`, `column`, `cause` and `hint`.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyModule;

/// One thing that is wrong.
#[derive(Clone, Debug, Default)]
pub(crate) struct Wrong {
    /// The file, where one is to blame.
    pub(crate) file: Option<String>,
    /// Line and perhaps column, from 1.
    pub(crate) place: Option<(usize, Option<usize>)>,
    /// What is wrong.
    pub(crate) cause: String,
    /// What to do about it.
    pub(crate) hint: Option<String>,
}

impl Wrong {
    /// Something that is wrong with no file.
    pub(crate) fn new(cause: impl Into<String>) -> Self {
        Self { cause: cause.into(), ..Self::default() }
    }

    /// The same with a way out.
    pub(crate) fn hint(self, hint: impl Into<String>) -> Self {
        Self { hint: Some(hint.into()), ..self }
    }
}

/// Why a call has no answer.
#[derive(Debug)]
pub(crate) struct Failure {
    /// The class of the exception in `denavit.errors`.
    class: &'static str,
    /// All that is wrong, at least one.
    all: Vec<Wrong>,
}

impl Failure {
    /// One thing that is wrong.
    pub(crate) fn one(class: &'static str, wrong: Wrong) -> Self {
        Self { class, all: vec![wrong] }
    }

    /// An argument that does not fit.
    pub(crate) fn argument(wrong: Wrong) -> Self {
        Self::one("ArgumentError", wrong)
    }

    /// Several things that are wrong.
    pub(crate) fn all(class: &'static str, all: Vec<Wrong>) -> Self {
        Self { class, all }
    }
}

static RAISE: PyOnceLock<Py<PyAny>> = PyOnceLock::new();

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        Python::attach(|py| raised(py, &failure).unwrap_or_else(|error| error))
    }
}

/// The exception of a failure.
fn raised(py: Python<'_>, failure: &Failure) -> PyResult<PyErr> {
    let make = RAISE.get_or_try_init(py, || {
        Ok::<_, PyErr>(PyModule::import(py, "denavit.errors")?.getattr("_made")?.unbind())
    })?;
    let all: Vec<_> = failure
        .all
        .iter()
        .map(|one| {
            let (line, column) = one.place.unzip();
            let column = column.flatten();
            (one.file.as_deref(), line, column, one.cause.as_str(), one.hint.as_deref())
        })
        .collect();
    let exception = make.bind(py).call1((failure.class, all))?;
    Ok(PyErr::from_value(exception))
}

/// What should not happen, as an exception rather than a panic.
pub(crate) fn internal(what: impl std::fmt::Display) -> PyErr {
    PyRuntimeError::new_err(format!("denavit has a fault of its own: {what}"))
}
