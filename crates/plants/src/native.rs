//! Routines of models that are read at run time, at the speed of compiled code.
//!
//! They become machine code in memory where there is a code generator for the processor, and are
//! interpreted elsewhere. Bits are the same either way.

use denavit_codegen::program::{
    BatchEvaluator, Evaluate, EvaluateBatch, Evaluator, Routine, ShapeMismatch,
};
use denavit_jit::{Compiled, CompiledBatch, Unsupported};

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
