//! The Python package `denavit`: this module is its `denavit._denavit`.
//!
//! - [`model`]: models and their functions, on arrays of numpy
//! - [`arrays`]: arrays in and out, without copies of large ones
//! - [`formula`]: functions as LaTeX
//! - [`run`]: use cases of the command: simulate, identify, diagnose, ..
//! - [`failure`]: what is wrong, as exceptions with place and hint

mod arrays;
mod failure;
mod formula;
mod function;
mod keyword;
mod model;
mod run;

use pyo3::prelude::*;

/// The compiled part of `denavit`. Use `import denavit`.
#[pymodule]
mod _denavit {
    #[pymodule_export]
    use super::model::Model;
    #[pymodule_export]
    use super::run::{run, shipped_gaits, shipped_models, shipped_scenarios, simulate};
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
