//! A routine, compiled for several samples at a time: as many as a register of this processor
//! holds.

use crate::compiler::{Unsupported, check_entries};
use crate::lanes::Lanes;
use crate::pairs::Pairs;
use crate::wide::{Layout, Wide};
use denavit_codegen::program::{EvaluateBatch, Routine, ShapeMismatch};

/// A routine made ready to be called on many samples for one set of parameters, as machine code.
///
/// Results have the same bits for every number of lanes.
#[derive(Clone, Debug)]
pub struct CompiledBatch {
    code: BatchCode,
    lanes: Lanes,
    inputs: usize,
    outputs: usize,
}

/// Machine code for blocks of samples.
#[derive(Clone, Debug)]
enum BatchCode {
    Pairs(Pairs),
    Wide(Wide),
}

impl CompiledBatch {
    /// Compiles `routine` for as many samples at a time as this processor has lanes, with the
    /// prelude's values as [`prelude_values`](denavit_codegen::program::prelude_values) gives them.
    ///
    /// # Errors
    /// If there is no code generator for this processor.
    ///
    /// # Panics
    /// If the routine reads beyond its arguments.
    pub fn new(routine: &Routine, prelude: &[f64]) -> Result<Self, Unsupported> {
        Self::with_lanes(routine, prelude, Lanes::widest())
    }

    /// Compiles `routine` for this number of samples at a time.
    ///
    /// # Errors
    /// If there is no code generator for this processor, or it does not have so many lanes.
    ///
    /// # Panics
    /// If the routine reads beyond its arguments.
    pub fn with_lanes(
        routine: &Routine,
        prelude: &[f64],
        lanes: Lanes,
    ) -> Result<Self, Unsupported> {
        check_entries(routine);
        if !lanes.is_available() {
            let reason = format!("it has no registers for {} samples", lanes.count());
            return Err(Unsupported::because(reason));
        }
        let code = match lanes {
            Lanes::Two => BatchCode::Pairs(Pairs::new(routine, prelude)?),
            wide => BatchCode::Wide(Wide::new(routine, prelude, wide, &Layout::Columns)?),
        };
        Ok(Self {
            code,
            lanes,
            inputs: routine.arguments.iter().map(|argument| argument.len).sum(),
            outputs: routine.code.outputs.len(),
        })
    }

    /// How many samples are computed at a time.
    pub fn lanes(&self) -> Lanes {
        self.lanes
    }

    // Machine code can only be called unsafely.
    #[allow(unsafe_code)]
    fn call(&mut self, inputs: &mut [*const f64], outputs: &mut [*mut f64], blocks: usize) {
        assert!(inputs.len() == self.inputs && outputs.len() == self.outputs);
        // SAFETY: there is an address for each column; that each has numbers for the blocks is what
        // `evaluate` compared, and the outputs are borrowed by it alone.
        unsafe {
            match &mut self.code {
                BatchCode::Pairs(code) => code.call(inputs, outputs, blocks),
                BatchCode::Wide(code) => code.call(inputs, outputs, blocks),
            }
        }
    }

    /// The samples after the last whole block, in a block that the last one fills.
    fn evaluate_rest(&mut self, inputs: &[&[f64]], outputs: &mut [&mut [f64]], rest: usize) {
        let lanes = self.lanes.count();
        let mut given = Vec::with_capacity(self.inputs * lanes);
        for column in inputs {
            let there = &column[column.len() - rest..];
            given.extend((0..lanes).map(|lane| there[lane.min(rest - 1)]));
        }
        let mut results = vec![0.0; self.outputs * lanes];
        let mut from: Vec<*const f64> = given.chunks_exact(lanes).map(<[f64]>::as_ptr).collect();
        let mut to: Vec<*mut f64> =
            results.chunks_exact_mut(lanes).map(<[f64]>::as_mut_ptr).collect();
        self.call(&mut from, &mut to, 1);
        for (column, results) in outputs.iter_mut().zip(results.chunks_exact(lanes)) {
            let first = column.len() - rest;
            column[first..].copy_from_slice(&results[..rest]);
        }
    }
}

impl EvaluateBatch for CompiledBatch {
    fn inputs(&self) -> usize {
        self.inputs
    }

    fn outputs(&self) -> usize {
        self.outputs
    }

    fn evaluate(
        &mut self,
        inputs: &[&[f64]],
        outputs: &mut [&mut [f64]],
    ) -> Result<(), ShapeMismatch> {
        let samples = ShapeMismatch::check_columns(self.inputs, inputs, self.outputs, outputs)?;
        let (blocks, rest) = (samples / self.lanes.count(), samples % self.lanes.count());
        if blocks > 0 {
            let mut from: Vec<*const f64> = inputs.iter().map(|column| column.as_ptr()).collect();
            let mut to: Vec<*mut f64> =
                outputs.iter_mut().map(|column| column.as_mut_ptr()).collect();
            self.call(&mut from, &mut to, blocks);
        }
        if rest > 0 {
            self.evaluate_rest(inputs, outputs, rest);
        }
        Ok(())
    }
}
