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

/// A routine, called for one sample at a time.
#[derive(Clone, Debug)]
pub(crate) enum NativeRoutine {
    Compiled(Compiled),
    Interpreted(Box<Evaluator<f64>>),
}

impl NativeRoutine {
    /// Makes `routine` ready, with the values of the prelude.
    pub(crate) fn new(routine: &Routine, prelude: &[f64]) -> Self {
        match Compiled::new(routine, prelude) {
            Ok(compiled) => Self::Compiled(compiled),
            Err(Unsupported { .. }) => {
                Self::Interpreted(Box::new(Evaluator::new(routine, prelude)))
            }
        }
    }
}

impl Evaluate for NativeRoutine {
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

/// A routine, called for many samples at once.
#[derive(Clone, Debug)]
pub(crate) enum NativeBatch {
    Compiled(CompiledBatch),
    Interpreted(Box<BatchEvaluator<f64>>),
}

impl NativeBatch {
    /// Makes `routine` ready, with the values of the prelude.
    pub(crate) fn new(routine: &Routine, prelude: &[f64]) -> Self {
        match CompiledBatch::new(routine, prelude) {
            Ok(compiled) => Self::Compiled(compiled),
            Err(Unsupported { .. }) => {
                Self::Interpreted(Box::new(BatchEvaluator::new(routine, prelude)))
            }
        }
    }
}

impl EvaluateBatch for NativeBatch {
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
