//! Routines of models that are read at run time, at the speed of compiled code.
//!
//! They become machine code in memory where there is a code generator for the processor, and are
//! interpreted elsewhere. Bits are the same either way.

use denavit_codegen::program::{
    BatchEvaluator, Evaluate, EvaluateBatch, Evaluator, OutputShape, Routine, ShapeMismatch,
};
use denavit_jit::{Compiled, CompiledBatch, CompiledRows, Unsupported};

/// Whether routines are compiled on this machine, or why not.
///
/// # Errors
/// If there is no code generator for this processor: everything works, but is interpreted.
pub fn native_code() -> Result<(), Unsupported> {
    denavit_jit::is_supported()
}

/// A routine, compiled or interpreted.
#[derive(Clone, Debug)]
pub enum Native<C, I> {
    /// As machine code.
    Compiled(C),
    /// Step by step.
    Interpreted(Box<I>),
}

/// A routine, called for one sample at a time.
pub(crate) type NativeRoutine = Native<Compiled, Evaluator<f64>>;

/// A routine, called for many samples at once.
pub type NativeBatch = Native<CompiledBatch, BatchEvaluator<f64>>;

impl NativeRoutine {
    /// Makes `routine` ready, with the values of the prelude.
    pub(crate) fn new(routine: &Routine, prelude: &[f64]) -> Self {
        let interpret = |_| Self::Interpreted(Box::new(Evaluator::new(routine, prelude)));
        Compiled::new(routine, prelude).map_or_else(interpret, Self::Compiled)
    }

    /// Calls a routine that several threads share. Where it is interpreted each call has memory of
    /// its own.
    pub(crate) fn call(
        &self,
        arguments: &[&[f64]],
        outputs: &mut [f64],
    ) -> Result<(), ShapeMismatch> {
        match self {
            Self::Compiled(routine) => routine.call(arguments, outputs),
            Self::Interpreted(routine) => routine.clone().evaluate(arguments, outputs),
        }
    }
}

impl NativeBatch {
    /// Makes `routine` ready, with the values of the prelude.
    pub fn new(routine: &Routine, prelude: &[f64]) -> Self {
        let interpret = |_| Self::Interpreted(Box::new(BatchEvaluator::new(routine, prelude)));
        CompiledBatch::new(routine, prelude).map_or_else(interpret, Self::Compiled)
    }
}

/// A routine, called for many samples whose numbers stand side by side.
#[derive(Clone, Debug)]
pub(crate) enum NativeRows {
    /// Machine code that reads and writes rows.
    Rows(Box<CompiledRows>),
    /// Rows become columns, and columns rows.
    Columns(Box<InColumns>),
}

/// A batch with the columns of a few samples.
#[derive(Clone, Debug)]
pub(crate) struct InColumns {
    batch: NativeBatch,
    /// Numbers of a sample, by argument and by output.
    widths: [Vec<usize>; 2],
    /// Columns of the arguments, then of the results.
    columns: Vec<f64>,
}

impl NativeRows {
    /// Makes `routine` ready, with the values of the prelude.
    pub(crate) fn new(routine: &Routine, prelude: &[f64]) -> Self {
        match CompiledRows::new(routine, prelude) {
            Ok(code) => Self::Rows(Box::new(code)),
            Err(_) => Self::in_columns(routine, prelude),
        }
    }

    /// The same where no machine code reads rows.
    pub(crate) fn in_columns(routine: &Routine, prelude: &[f64]) -> Self {
        Self::Columns(Box::new(InColumns::new(routine, prelude)))
    }

    /// Calls the routine on samples: an argument has the numbers of one sample after those of the
    /// other, and so has an output.
    pub(crate) fn evaluate(
        &mut self,
        samples: usize,
        arguments: &[&[f64]],
        outputs: &mut [&mut [f64]],
    ) -> Result<(), ShapeMismatch> {
        match self {
            Self::Rows(code) => code.evaluate(samples, arguments, outputs),
            Self::Columns(code) => code.evaluate(samples, arguments, outputs),
        }
    }
}

impl InColumns {
    fn new(routine: &Routine, prelude: &[f64]) -> Self {
        Self {
            batch: NativeBatch::new(routine, prelude),
            widths: [
                routine.arguments.iter().map(|argument| argument.len).collect(),
                routine.outputs.iter().map(OutputShape::len).collect(),
            ],
            columns: Vec::new(),
        }
    }

    fn evaluate(
        &mut self,
        samples: usize,
        arguments: &[&[f64]],
        outputs: &mut [&mut [f64]],
    ) -> Result<(), ShapeMismatch> {
        if samples == 0 {
            return Ok(());
        }
        // Columns begin an odd number of lines of a cache apart, or they would share the same few.
        let stride = samples.next_multiple_of(16) + 8;
        self.columns.resize((self.batch.inputs() + self.batch.outputs()) * stride, 0.0);
        let (given, found) = self.columns.split_at_mut(self.batch.inputs() * stride);
        let mut columns = given.chunks_exact_mut(stride);
        for (rows, &width) in arguments.iter().zip(&self.widths[0]) {
            for (entry, column) in (0..width).zip(&mut columns) {
                for (own, row) in column.iter_mut().zip(rows.chunks_exact(width)) {
                    *own = row[entry];
                }
            }
        }
        let inputs: Vec<&[f64]> = given.chunks_exact(stride).map(|c| &c[..samples]).collect();
        let mut results: Vec<&mut [f64]> =
            found.chunks_exact_mut(stride).map(|column| &mut column[..samples]).collect();
        self.batch.evaluate(&inputs, &mut results)?;
        let mut columns = results.iter();
        for (rows, &width) in outputs.iter_mut().zip(&self.widths[1]) {
            for (entry, column) in (0..width).zip(&mut columns) {
                for (row, value) in rows.chunks_exact_mut(width).zip(column.iter()) {
                    row[entry] = *value;
                }
            }
        }
        Ok(())
    }
}

impl<C: Evaluate, I: Evaluate> Evaluate for Native<C, I> {
    fn outputs(&self) -> usize {
        match self {
            Self::Compiled(routine) => routine.outputs(),
            Self::Interpreted(routine) => routine.outputs(),
        }
    }

    fn evaluate(&mut self, arguments: &[&[f64]], outputs: &mut [f64]) -> Result<(), ShapeMismatch> {
        match self {
            Self::Compiled(routine) => routine.evaluate(arguments, outputs),
            Self::Interpreted(routine) => routine.evaluate(arguments, outputs),
        }
    }
}

impl<C: EvaluateBatch, I: EvaluateBatch> EvaluateBatch for Native<C, I> {
    fn inputs(&self) -> usize {
        match self {
            Self::Compiled(routine) => routine.inputs(),
            Self::Interpreted(routine) => routine.inputs(),
        }
    }

    fn outputs(&self) -> usize {
        match self {
            Self::Compiled(routine) => routine.outputs(),
            Self::Interpreted(routine) => routine.outputs(),
        }
    }

    fn evaluate(
        &mut self,
        inputs: &[&[f64]],
        outputs: &mut [&mut [f64]],
    ) -> Result<(), ShapeMismatch> {
        match self {
            Self::Compiled(routine) => routine.evaluate(inputs, outputs),
            Self::Interpreted(routine) => routine.evaluate(inputs, outputs),
        }
    }
}
