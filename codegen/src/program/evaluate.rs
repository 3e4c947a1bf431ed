//! Routines made ready to be called, whatever runs them: an interpreter or machine code.

use super::{BatchEvaluator, Evaluator};
use std::fmt;

/// A slice whose length is not that of the argument, output or parameters it stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShapeMismatch {
    /// What it stands for.
    pub of: &'static str,
    /// The length that it must have.
    pub expected: usize,
    /// The length that it has.
    pub found: usize,
}

impl ShapeMismatch {
    /// Whether a length is the expected one.
    pub fn check(of: &'static str, expected: usize, found: usize) -> Result<(), ShapeMismatch> {
        if expected == found { Ok(()) } else { Err(Self { of, expected, found }) }
    }

    /// The number of samples of input and output columns, each given with the number of columns
    /// that there must be; all of one length.
    pub fn check_columns<S>(
        expected_inputs: usize,
        inputs: &[&[S]],
        expected_outputs: usize,
        outputs: &[&mut [S]],
    ) -> Result<usize, ShapeMismatch> {
        Self::check("input columns", expected_inputs, inputs.len())?;
        Self::check("output columns", expected_outputs, outputs.len())?;
        let first = inputs.first().map(|column| column.len());
        let samples = first.or_else(|| outputs.first().map(|column| column.len())).unwrap_or(0);
        for column in inputs {
            Self::check("samples of an input column", samples, column.len())?;
        }
        for column in outputs {
            Self::check("samples of an output column", samples, column.len())?;
        }
        Ok(samples)
    }
}

impl fmt::Display for ShapeMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} values expected, {} given", self.of, self.expected, self.found)
    }
}

impl std::error::Error for ShapeMismatch {}

/// A routine that is called for one sample at a time.
pub trait Evaluate {
    /// Number of output entries.
    fn outputs(&self) -> usize;

    /// Calls the routine; the entries of all outputs, one after the other, go to `outputs`.
    ///
    /// # Errors
    /// If a slice has a wrong length; nothing is computed then.
    fn evaluate(&mut self, arguments: &[&[f64]], outputs: &mut [f64]) -> Result<(), ShapeMismatch>;
}

/// A routine that is called for many samples at once.
pub trait EvaluateBatch {
    /// Number of argument entries: of all arguments, one after the other.
    fn inputs(&self) -> usize;

    /// Number of output entries: of all outputs, one after the other.
    fn outputs(&self) -> usize;

    /// Calls the routine on every sample. `inputs[i][k]` is argument entry i of sample k,
    /// `outputs[j][k]` receives output entry j of sample k; all columns have the same length.
    ///
    /// # Errors
    /// If there are more or fewer columns, or of other lengths; nothing is computed then.
    fn evaluate(
        &mut self,
        inputs: &[&[f64]],
        outputs: &mut [&mut [f64]],
    ) -> Result<(), ShapeMismatch>;
}

impl Evaluate for Evaluator<f64> {
    fn outputs(&self) -> usize {
        self.outputs()
    }

    fn evaluate(&mut self, arguments: &[&[f64]], outputs: &mut [f64]) -> Result<(), ShapeMismatch> {
        self.evaluate(arguments, outputs)
    }
}

impl EvaluateBatch for BatchEvaluator<f64> {
    fn inputs(&self) -> usize {
        self.inputs()
    }

    fn outputs(&self) -> usize {
        self.outputs()
    }

    fn evaluate(
        &mut self,
        inputs: &[&[f64]],
        outputs: &mut [&mut [f64]],
    ) -> Result<(), ShapeMismatch> {
        self.evaluate(inputs, outputs)
    }
}
