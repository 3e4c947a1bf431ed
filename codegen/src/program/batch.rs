//! Many samples at once, in structure-of-arrays: each register holds a block of samples, so the
//! cost of walking the code is shared and the arithmetic vectorises.
//!
//! Each lane computes exactly what [`Evaluator`](super::Evaluator) computes: the two agree bit for
//! bit, also in the remainder.

use super::ShapeMismatch;
use super::interpret::{argument_leaves, binary, fused, initial_registers, select, unary};
use super::tape::{Register, Run, Tape};
use super::{BinaryOperation, Routine};
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
        let expected = self.tape.outputs.len();
        let samples = ShapeMismatch::check_columns(self.columns, inputs, expected, outputs)?;
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

fn execute<S: Transcendental>(tape: &Tape, values: &mut [Block<S>]) {
    use BinaryOperation::{Add, Mul, Sub};
    for run in &tape.runs {
        match run {
            // The common operations have loops of their own, without a choice inside.
            Run::Binary(Add, rows) => pairwise(values, &tape.binary[rows.clone()], |a, b| a + b),
            Run::Binary(Sub, rows) => pairwise(values, &tape.binary[rows.clone()], |a, b| a - b),
            Run::Binary(Mul, rows) => pairwise(values, &tape.binary[rows.clone()], |a, b| a * b),
            Run::Binary(function, rows) => {
                let function = |a, b| binary(*function, a, b);
                pairwise(values, &tape.binary[rows.clone()], function);
            }
            Run::Fused(function, rows) => {
                for &[to, a, b, c] in &tape.fused[rows.clone()] {
                    let [a, b, c] = [a, b, c].map(|at| values[at as usize]);
                    values[to as usize] =
                        std::array::from_fn(|lane| fused(*function, a[lane], b[lane], c[lane]));
                }
            }
            Run::Unary(function, rows) => {
                for &[to, from] in &tape.unary[rows.clone()] {
                    values[to as usize] = values[from as usize].map(|a| unary(*function, a));
                }
            }
            Run::SinCos(rows) => {
                for &[sine, cosine, angle] in &tape.sincos[rows.clone()] {
                    let (sines, cosines) = S::sincos_all(values[angle as usize]);
                    values[sine as usize] = sines;
                    values[cosine as usize] = cosines;
                }
            }
            Run::Select(relation, rows) => {
                for &[to, left, right, then, otherwise] in &tape.select[rows.clone()] {
                    let [left, right, then, otherwise] =
                        [left, right, then, otherwise].map(|at| values[at as usize]);
                    values[to as usize] = std::array::from_fn(|lane| {
                        let sides = [left[lane], right[lane]];
                        select(*relation, sides, then[lane], otherwise[lane])
                    });
                }
            }
        }
    }
}

#[inline]
fn pairwise<S: Copy>(
    values: &mut [Block<S>],
    rows: &[[Register; 3]],
    function: impl Fn(S, S) -> S,
) {
    for &[to, left, right] in rows {
        let (a, b) = (values[left as usize], values[right as usize]);
        values[to as usize] = std::array::from_fn(|lane| function(a[lane], b[lane]));
    }
}
