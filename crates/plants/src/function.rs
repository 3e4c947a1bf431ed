//! Any function of a robot, with the values of its model, for callers that share it.
//!
//! A [`Plant`](super::Plant) is what a simulation needs of a robot, in memory of its own. Here is
//! each function by itself, called from any thread: on one sample, or on many by all processors.

use super::native::{NativeRoutine, NativeRows};
use crate::error::Error;
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::Robot;
use denavit_codegen::program::{ArgumentShape, OutputShape, Routine, ShapeMismatch, lower};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::OnceLock;

/// Numbers that a thread takes at a time: they stay in a processor's nearest cache, so that what is
/// asked of them before the function reads them costs little.
const NUMBERS_AT_A_TIME: usize = 3 << 10;

/// Samples that a thread takes at a time: at least so many, or their slices cost more than the
/// function, and at most so many, or small batches would be work for one thread.
const FEWEST_AT_A_TIME: usize = 16;
const MOST_AT_A_TIME: usize = 256;

/// Below so many samples other threads are woken for longer than they work.
const FEWEST_FOR_THREADS: usize = 2 * MOST_AT_A_TIME;

/// An argument of many samples, in whatever order its numbers are in memory.
pub trait Samples: Sync {
    /// Number of entries of a sample.
    fn entries(&self) -> usize;

    /// Number of samples.
    fn samples(&self) -> usize;

    /// The numbers of some samples, one sample after the other: where they are, or in `room`, where
    /// they are copied to if they stand otherwise in memory.
    fn rows<'a>(&'a self, samples: Range<usize>, room: &'a mut Vec<f64>) -> &'a [f64];
}

/// A function of a robot as machine code, or interpreted where there is no code generator.
#[derive(Debug)]
pub struct RobotFunction {
    routine: Routine,
    single: NativeRoutine,
    /// Made when many samples come first.
    batch: OnceLock<NativeRows>,
}

impl RobotFunction {
    /// The functions of a name: one, one for each link, or none where the robot does not have it.
    ///
    /// # Errors
    /// If the model lacks numbers, or has numbers that computer arithmetic does not hold.
    pub fn of(robot: &Robot, name: FunctionName) -> Result<Vec<Self>, Error> {
        let derivation = derive(robot, Flavour::Baked, &[name])?;
        let program = lower(&derivation.dag, &derivation.functions)?;
        let made = program.routines.into_iter().map(|routine| {
            // baked: there is nothing left that depends on parameters alone
            let single = NativeRoutine::new(&routine, &[]);
            Self { routine, single, batch: OnceLock::new() }
        });
        Ok(made.collect())
    }

    /// The link, where there is one function for each.
    pub fn link(&self) -> Option<&str> {
        self.routine.link.as_deref()
    }

    /// The arguments, in the order of the call.
    pub fn arguments(&self) -> &[ArgumentShape] {
        &self.routine.arguments
    }

    /// The arrays of the result.
    pub fn outputs(&self) -> &[OutputShape] {
        &self.routine.outputs
    }

    /// Calls the function; the entries of all outputs, one after the other, go to `outputs`.
    ///
    /// # Errors
    /// If a slice has a wrong length; nothing is computed then.
    pub fn call(&self, arguments: &[&[f64]], outputs: &mut [f64]) -> Result<(), ShapeMismatch> {
        self.single.call(arguments, outputs)
    }

    /// Calls the function on every sample, by all threads of rayon's pool. `outputs` has a slice
    /// for each array of the result; sample after sample, entries as in [`OutputShape`].
    ///
    /// Samples do not touch each other, and each has the bits of a single call, so that results do
    /// not depend on the number of threads.
    ///
    /// # Errors
    /// If the arguments do not fit the function or each other, or an output does not fit them;
    /// nothing is computed then.
    pub fn call_on_samples(
        &self,
        arguments: &[&dyn Samples],
        outputs: &mut [&mut [f64]],
    ) -> Result<(), ShapeMismatch> {
        let samples = self.samples(arguments, outputs)?;
        let widths: Vec<usize> = self.outputs().iter().map(OutputShape::len).collect();
        let inputs: usize = self.arguments().iter().map(|argument| argument.len).sum();
        let wide = inputs + widths.iter().sum::<usize>();
        let rows = NUMBERS_AT_A_TIME / wide.max(1);
        let rows = rows.clamp(FEWEST_AT_A_TIME, MOST_AT_A_TIME).next_multiple_of(FEWEST_AT_A_TIME);
        let mut blocks: Vec<Vec<&mut [f64]>> = Vec::new();
        blocks.resize_with(samples.div_ceil(rows), || Vec::with_capacity(widths.len()));
        for (output, &width) in outputs.iter_mut().zip(&widths) {
            // an output may have no entries
            let mut parts = output.chunks_mut((rows * width).max(1));
            blocks.iter_mut().for_each(|block| block.push(parts.next().unwrap_or_default()));
        }
        let batch = self.batch.get_or_init(|| NativeRows::new(&self.routine, &[]));
        let worker = || Worker { batch: batch.clone(), rooms: vec![Vec::new(); arguments.len()] };
        let run = |worker: &mut Worker, (block, outputs): (usize, Vec<&mut [f64]>)| {
            let first = block * rows;
            worker.run(first..samples.min(first + rows), arguments, outputs)
        };
        let blocks = blocks.into_iter().enumerate();
        if samples < FEWEST_FOR_THREADS {
            let mut worker = worker();
            return { blocks }.try_for_each(|block| run(&mut worker, block));
        }
        let blocks: Vec<_> = blocks.collect();
        blocks.into_par_iter().map_init(worker, run).collect()
    }

    /// The number of samples, if all sizes fit.
    fn samples(
        &self,
        arguments: &[&dyn Samples],
        outputs: &[&mut [f64]],
    ) -> Result<usize, ShapeMismatch> {
        ShapeMismatch::check("arguments", self.arguments().len(), arguments.len())?;
        ShapeMismatch::check("outputs", self.outputs().len(), outputs.len())?;
        let samples = arguments.first().map_or(0, |first| first.samples());
        for (shape, argument) in self.arguments().iter().zip(arguments) {
            ShapeMismatch::check(shape.name, shape.len, argument.entries())?;
            ShapeMismatch::check(shape.name, samples, argument.samples())?;
        }
        for (shape, output) in self.outputs().iter().zip(outputs) {
            ShapeMismatch::check(shape.name, samples * shape.len(), output.len())?;
        }
        Ok(samples)
    }
}

/// What a thread needs of its own.
struct Worker {
    batch: NativeRows,
    /// For each argument, where its rows are copied to if they have to be.
    rooms: Vec<Vec<f64>>,
}

impl Worker {
    /// Calls the function on some samples; `outputs` are their parts of the result.
    fn run(
        &mut self,
        samples: Range<usize>,
        arguments: &[&dyn Samples],
        mut outputs: Vec<&mut [f64]>,
    ) -> Result<(), ShapeMismatch> {
        let given: Vec<&[f64]> = arguments
            .iter()
            .zip(&mut self.rooms)
            .map(|(argument, room)| argument.rows(samples.clone(), room))
            .collect();
        self.batch.evaluate(samples.len(), &given, &mut outputs)
    }
}

#[cfg(test)]
mod tests;
