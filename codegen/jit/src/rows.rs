//! A routine, compiled for several samples at a time whose numbers stand side by side.

use crate::compiler::{Unsupported, check_entries};
use crate::lanes::Lanes;
use crate::wide::{Layout, Wide};
use denavit_codegen::program::{OutputShape, Routine, ShapeMismatch};

/// Arguments, and outputs, that a function may have: a list on the stack costs nothing.
const ARRAYS: usize = 8;

/// A routine made ready to be called on many samples in rows, for one set of parameters, as machine
/// code: without a transposition before and after.
///
/// Results have the bits of [`CompiledBatch`](crate::CompiledBatch).
#[derive(Clone, Debug)]
pub struct CompiledRows {
    code: Wide,
    lanes: Lanes,
    /// Name and numbers of a sample, of each argument.
    arguments: Vec<(&'static str, usize)>,
    /// Numbers of a sample, of each output.
    outputs: Vec<usize>,
}

impl CompiledRows {
    /// Compiles `routine` for as many samples at a time as this processor has lanes, with the
    /// prelude's values as [`prelude_values`](denavit_codegen::program::prelude_values) gives them.
    ///
    /// # Errors
    /// If this processor has only registers for two: then columns are faster. If the function has
    /// more than eight arguments or outputs.
    ///
    /// # Panics
    /// If the routine reads beyond its arguments.
    pub fn new(routine: &Routine, prelude: &[f64]) -> Result<Self, Unsupported> {
        Self::with_lanes(routine, prelude, Lanes::widest())
    }

    /// Compiles `routine` for this number of samples at a time.
    ///
    /// # Errors
    /// If it is two, or this processor does not have so many lanes. If the function has more than
    /// eight arguments or outputs.
    ///
    /// # Panics
    /// If the routine reads beyond its arguments.
    pub fn with_lanes(
        routine: &Routine,
        prelude: &[f64],
        lanes: Lanes,
    ) -> Result<Self, Unsupported> {
        check_entries(routine);
        if lanes == Lanes::Two || !lanes.is_available() {
            let reason = format!("no code reads rows of {} samples on it", lanes.count());
            return Err(Unsupported::because(reason));
        }
        if routine.arguments.len() > ARRAYS || routine.outputs.len() > ARRAYS {
            return Err(Unsupported::because(format!("functions have up to {ARRAYS} arrays")));
        }
        let code = Wide::new(routine, prelude, lanes, &Layout::rows(routine))?;
        Ok(Self {
            code,
            lanes,
            arguments: routine.arguments.iter().map(|a| (a.name, a.len)).collect(),
            outputs: routine.outputs.iter().map(OutputShape::len).collect(),
        })
    }

    /// How many samples are computed at a time.
    pub fn lanes(&self) -> Lanes {
        self.lanes
    }

    /// Calls the routine on every sample. An argument has the numbers of one sample after those of
    /// the other, and so has an output.
    ///
    /// # Errors
    /// If there are more or fewer arguments or outputs, or they are of other lengths than
    /// `samples`; nothing is computed then.
    pub fn evaluate(
        &mut self,
        samples: usize,
        arguments: &[&[f64]],
        outputs: &mut [&mut [f64]],
    ) -> Result<(), ShapeMismatch> {
        ShapeMismatch::check("arguments", self.arguments.len(), arguments.len())?;
        ShapeMismatch::check("outputs", self.outputs.len(), outputs.len())?;
        for (&(name, width), argument) in self.arguments.iter().zip(arguments) {
            ShapeMismatch::check(name, samples.saturating_mul(width), argument.len())?;
        }
        for (&width, output) in self.outputs.iter().zip(outputs.iter()) {
            ShapeMismatch::check("an output", samples.saturating_mul(width), output.len())?;
        }
        let (blocks, rest) = (samples / self.lanes.count(), samples % self.lanes.count());
        if blocks > 0 {
            self.call(arguments, outputs, blocks);
        }
        if rest > 0 {
            self.evaluate_rest(rest, arguments, outputs);
        }
        Ok(())
    }

    // Machine code can only be called unsafely.
    #[allow(unsafe_code)]
    fn call(&mut self, arguments: &[&[f64]], outputs: &mut [&mut [f64]], blocks: usize) {
        let samples = blocks * self.lanes.count();
        assert!(arguments.len() == self.arguments.len() && outputs.len() == self.outputs.len());
        let mut from = [std::ptr::null(); ARRAYS];
        for ((&(_, width), argument), address) in
            self.arguments.iter().zip(arguments).zip(&mut from)
        {
            assert!(argument.len() >= samples * width, "rows for all blocks");
            *address = argument.as_ptr();
        }
        let mut to = [std::ptr::null_mut(); ARRAYS];
        for ((&width, output), address) in self.outputs.iter().zip(outputs).zip(&mut to) {
            assert!(output.len() >= samples * width, "rows for all blocks");
            *address = output.as_mut_ptr();
        }
        // SAFETY: there is an address of rows for each argument and each output, and the outputs
        // are borrowed by this call alone.
        unsafe { self.code.call(&mut from, &mut to, blocks) };
    }

    /// The samples after the last whole block, in a block that the last one fills.
    fn evaluate_rest(&mut self, rest: usize, arguments: &[&[f64]], outputs: &mut [&mut [f64]]) {
        let lanes = self.lanes.count();
        let mut given = Vec::with_capacity(arguments.len());
        for (&(_, width), argument) in self.arguments.iter().zip(arguments) {
            let mut rows = argument[argument.len() - rest * width..].to_vec();
            for _ in rest..lanes {
                rows.extend_from_within(rows.len() - width..);
            }
            given.push(rows);
        }
        let mut results: Vec<Vec<f64>> =
            self.outputs.iter().map(|&width| vec![0.0; width * lanes]).collect();
        let from: Vec<&[f64]> = given.iter().map(|rows| &rows[..]).collect();
        let mut to: Vec<&mut [f64]> = results.iter_mut().map(|rows| &mut rows[..]).collect();
        self.call(&from, &mut to, 1);
        for ((&width, output), rows) in self.outputs.iter().zip(outputs).zip(&results) {
            let first = output.len() - rest * width;
            output[first..].copy_from_slice(&rows[..rest * width]);
        }
    }
}
