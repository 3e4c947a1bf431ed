//! Many samples at once, in structure-of-arrays: each register holds a block of samples, so the
//! cost of walking the code is shared and the arithmetic vectorises.
//!
//! Each lane computes exactly what [`Evaluator`](super::Evaluator) computes: the two agree bit for
//! bit, also in the remainder.

use super::interpret::{ShapeMismatch, argument_leaves, binary, initial_registers, select, unary};
use super::tape::{Choice, Step, Tape};
use super::{BinaryOperation, Routine, UnaryOperation};
use denavit_runtime::Transcendental;

/// Samples in a block.
pub const LANES: usize = 16;

type Block<S> = [S; LANES];

/// A routine made ready to be called on many samples for one set of parameters.
#[derive(Clone, Debug)]
pub struct BatchEvaluator<S> {
    tape: Tape,
    registers: Vec<Block<S>>,
    /// For each leaf that is an argument: its register and its column.
    inputs: Vec<(usize, usize)>,
    columns: usize,
}

impl<S: Transcendental> BatchEvaluator<S> {
    /// Makes `routine` ready, with the prelude's values as
    /// [`prelude_values`](super::prelude_values) gives them.
    pub fn new(routine: &Routine, prelude: &[f64]) -> Self {
        let tape = Tape::new(&routine.code);
        let mut first = Vec::with_capacity(routine.arguments.len());
        let mut columns = 0;
        for argument in &routine.arguments {
            first.push(columns);
            columns += argument.len;
        }
        let inputs = argument_leaves(&tape)
            .into_iter()
            .map(|(register, argument, entry)| (register, first[argument] + entry))
            .collect();
        let leaves: Vec<S> = initial_registers(&tape, prelude);
        let mut registers: Vec<Block<S>> = leaves.into_iter().map(|value| [value; LANES]).collect();
        registers.resize(tape.registers, [S::ZERO; LANES]);
        Self { tape, registers, inputs, columns }
    }

    /// Number of argument entries: of all arguments, one after the other.
    pub fn inputs(&self) -> usize {
        self.columns
    }

    /// Number of output entries: of all outputs, one after the other.
    pub fn outputs(&self) -> usize {
        self.tape.outputs.len()
    }

    /// Calls the routine on every sample. `inputs[i][k]` is argument entry i of sample k,
    /// `outputs[j][k]` receives output entry j of sample k; all columns have the same length.
    pub fn evaluate(
        &mut self,
        inputs: &[&[S]],
        outputs: &mut [&mut [S]],
    ) -> Result<(), ShapeMismatch> {
        ShapeMismatch::check("input columns", self.columns, inputs.len())?;
        ShapeMismatch::check("output columns", self.tape.outputs.len(), outputs.len())?;
        let first = inputs.first().map(|column| column.len());
        let Some(samples) = first.or_else(|| outputs.first().map(|column| column.len())) else {
            return Ok(());
        };
        for column in inputs {
            ShapeMismatch::check("samples of an input column", samples, column.len())?;
        }
        for column in outputs.iter() {
            ShapeMismatch::check("samples of an output column", samples, column.len())?;
        }
        for start in (0..samples).step_by(LANES) {
            let lanes = LANES.min(samples - start);
            self.load(inputs, start, lanes);
            execute(&self.tape, &mut self.registers);
            for (column, &register) in outputs.iter_mut().zip(&self.tape.outputs) {
                let block = &self.registers[register as usize];
                column[start..start + lanes].copy_from_slice(&block[..lanes]);
            }
        }
        Ok(())
    }

    /// Fills the argument registers; the lanes beyond the last sample repeat it, so that they
    /// stay in the ordinary range of every function.
    fn load(&mut self, inputs: &[&[S]], start: usize, lanes: usize) {
        for &(register, column) in &self.inputs {
            let samples = &inputs[column][start..start + lanes];
            let block = &mut self.registers[register];
            block[..lanes].copy_from_slice(samples);
            block[lanes..].fill(samples[lanes - 1]);
        }
    }
}

fn execute<S: Transcendental>(tape: &Tape, registers: &mut [Block<S>]) {
    use BinaryOperation::{Add, Div, Mul, Sub};
    for step in &tape.steps {
        match *step {
            // One arm for each common operation, so that the choice stands outside the loop.
            Step::Binary(Add, to, from) => pairwise(registers, to, from, |a, b| a + b),
            Step::Binary(Sub, to, from) => pairwise(registers, to, from, |a, b| a - b),
            Step::Binary(Mul, to, from) => pairwise(registers, to, from, |a, b| a * b),
            Step::Binary(Div, to, from) => pairwise(registers, to, from, |a, b| a / b),
            Step::Binary(function, to, from) => {
                pairwise(registers, to, from, |a, b| binary(function, a, b));
            }
            Step::Unary(UnaryOperation::Neg, to, from) => each(registers, to, from, |a| -a),
            Step::Unary(function, to, from) => each(registers, to, from, |a| unary(function, a)),
            Step::SinCos([sine, cosine], angle) => {
                let pairs = registers[angle as usize].map(S::sincos);
                registers[sine as usize] = pairs.map(|(s, _)| s);
                registers[cosine as usize] = pairs.map(|(_, c)| c);
            }
            Step::Select(to, choice) => {
                let Choice { relation, sides, then, otherwise } = tape.choices[choice as usize];
                let [left, right, then, otherwise] =
                    [sides[0], sides[1], then, otherwise].map(|at| registers[at as usize]);
                registers[to as usize] = std::array::from_fn(|lane| {
                    select(relation, [left[lane], right[lane]], then[lane], otherwise[lane])
                });
            }
        }
    }
}

#[inline]
fn each<S: Copy>(registers: &mut [Block<S>], to: u32, from: u32, function: impl Fn(S) -> S) {
    registers[to as usize] = registers[from as usize].map(function);
}

#[inline]
fn pairwise<S: Copy>(
    registers: &mut [Block<S>],
    to: u32,
    [left, right]: [u32; 2],
    function: impl Fn(S, S) -> S,
) {
    let (a, b) = (registers[left as usize], registers[right as usize]);
    registers[to as usize] = std::array::from_fn(|lane| function(a[lane], b[lane]));
}
