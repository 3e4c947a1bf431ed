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
use std::ops::Range;
use std::sync::{Mutex, OnceLock, PoisonError};

/// Numbers that a thread takes at a time: they stay in a processor's nearest cache, so that what is
/// asked of them before the function reads them costs little.
const NUMBERS_AT_A_TIME: usize = 3 << 10;

/// Samples that a thread takes at a time: at least so many, or their slices cost more than the
/// function, and at most so many, or small batches would be work for one thread.
const FEWEST_AT_A_TIME: usize = 16;
const MOST_AT_A_TIME: usize = 256;

/// Blocks that a thread takes one after the other: memory is read ahead, and comes from the system
/// in pages, so that neighbours are for one thread.
const BLOCKS_AT_A_TIME: usize = 8;

/// Instructions, of all samples, below which other threads are woken for longer than they work: a
/// processor has about a million in 0.1 ms.
const FEWEST_FOR_THREADS: usize = 1 << 20;

/// An argument of many samples, in whatever order its numbers are in memory.
pub trait Samples: Sync {
    /// Number of entries of a sample.
    fn entries(&self) -> usize;

    /// Number of samples.
    fn samples(&self) -> usize;

    /// The numbers of some samples, one sample after the other: where they are, or in `room`, where
    /// they are copied to if they stand otherwise in memory.
    fn rows<'a>(&'a self, samples: Range<usize>, room: &'a mut Vec<f64>) -> &'a [f64];

    /// Hears of rows that a function has just read, and that are near the processor therefore: to
    /// ask something of them costs least now.
    fn were_read(&self, rows: &[f64]) {
        let _ = rows;
    }
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

    /// Calls the function on every sample, by this thread and those of rayon's pool. `outputs` has
    /// a slice for each array of the result; sample after sample, entries as in [`OutputShape`].
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
        let batch = self.batch.get_or_init(|| NativeRows::new(&self.routine, &[]));
        let outputs = outputs.iter_mut().map(|output| &mut **output).collect();
        let left = Mutex::new(Left { samples: 0..samples, outputs, widths: &widths });
        let at_a_time = rows * BLOCKS_AT_A_TIME.min(samples.div_ceil(4 * rows)).max(1);
        let work = || {
            let mut worker =
                Worker { batch: batch.clone(), rooms: vec![Vec::new(); arguments.len()] };
            // no thread panics while it has the lock
            let next = || left.lock().unwrap_or_else(PoisonError::into_inner).take(at_a_time);
            std::iter::from_fn(next).try_for_each(|mut part| {
                std::iter::from_fn(|| part.take(rows))
                    .try_for_each(|block| worker.run(block, arguments))
            })
        };
        let threads = match samples * self.routine.code.instructions.len() < FEWEST_FOR_THREADS {
            true => 1,
            false => rayon::current_num_threads(),
        };
        // This thread works, too: it need not wait until others are awake.
        let others = Mutex::new(Ok(()));
        let own = rayon::in_place_scope(|scope| {
            for _ in 1..threads {
                scope.spawn(|_| {
                    if let Err(fault) = work() {
                        *others.lock().unwrap_or_else(PoisonError::into_inner) = Err(fault);
                    }
                });
            }
            work()
        });
        own.and(others.into_inner().unwrap_or_else(PoisonError::into_inner))
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

/// Samples that are still to be computed, with their parts of the outputs.
struct Left<'a> {
    samples: Range<usize>,
    outputs: Vec<&'a mut [f64]>,
    /// Numbers of a sample, by output.
    widths: &'a [usize],
}

impl<'a> Left<'a> {
    /// The next samples: so many, or those that there are.
    fn take(&mut self, most: usize) -> Option<Left<'a>> {
        let count = most.min(self.samples.len());
        if count == 0 {
            return None;
        }
        let first = self.samples.start;
        self.samples.start += count;
        let split = |(output, &width): (&mut &'a mut [f64], &usize)| {
            let (part, rest) = std::mem::take(output).split_at_mut(count * width);
            *output = rest;
            part
        };
        let outputs = self.outputs.iter_mut().zip(self.widths).map(split).collect();
        Some(Left { samples: first..first + count, outputs, widths: self.widths })
    }
}

/// What a thread needs of its own.
struct Worker {
    batch: NativeRows,
    /// For each argument, where its rows are copied to if they have to be.
    rooms: Vec<Vec<f64>>,
}

impl Worker {
    /// Calls the function on some samples.
    fn run(
        &mut self,
        mut block: Left<'_>,
        arguments: &[&dyn Samples],
    ) -> Result<(), ShapeMismatch> {
        let samples = block.samples;
        let given: Vec<&[f64]> = arguments
            .iter()
            .zip(&mut self.rooms)
            .map(|(argument, room)| argument.rows(samples.clone(), room))
            .collect();
        self.batch.evaluate(samples.len(), &given, &mut block.outputs)?;
        arguments.iter().zip(&given).for_each(|(argument, rows)| argument.were_read(rows));
        Ok(())
    }
}

#[cfg(test)]
mod tests;
