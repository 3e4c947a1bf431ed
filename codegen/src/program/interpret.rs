//! The reference interpreter: one sample at a time, over any scalar of the runtime.
//!
//! It computes through the same [`Scalar`] as emitted code, in the same order, so the two agree
//! bit for bit.

use super::ShapeMismatch;
use super::tape::{Register, Run, SIDE_BY_SIDE, Tape};
use super::{
    BinaryOperation, Code, FusedOperation, Leaf, Program, Routine, UnaryOperation, constant_values,
};
use crate::expr::{ExprId, Relation};
use crate::model::Robot;
use denavit_runtime::{Scalar, Transcendental};

/// The values of the prelude for parameters in the order of [`Program::parameters`]; always in
/// `f64`, because regrouped parameters mix magnitudes.
pub fn prelude_values(program: &Program, parameters: &[f64]) -> Result<Vec<f64>, ShapeMismatch> {
    ShapeMismatch::check("parameters", program.parameters.len(), parameters.len())?;
    Ok(run(&program.prelude, |leaf| match leaf {
        Leaf::Constant(value) => value,
        Leaf::Parameter(row) => parameters[row],
        Leaf::Prelude(_) | Leaf::Argument { .. } => unreachable!("no leaves of a prelude"),
    }))
}

/// The values that the model gives to the parameters of a program, in the order of
/// [`Program::parameters`]; none where it gives none.
pub fn parameter_defaults(program: &Program, robot: &Robot) -> Vec<Option<f64>> {
    let default = |name: &String| {
        let id = robot.find_parameter(name)?;
        robot.parameters[id].default
    };
    let defaults: Vec<Option<ExprId>> = program.parameters.iter().map(default).collect();
    let given: Vec<ExprId> = defaults.iter().flatten().copied().collect();
    let mut values = constant_values(&robot.dag, &given).into_iter();
    defaults.iter().map(|default| default.and_then(|_| values.next())).collect()
}

/// The outputs of code that runs once.
pub(super) fn run<S: Transcendental>(code: &Code, leaf: impl FnMut(Leaf) -> S) -> Vec<S> {
    let tape = Tape::new(code);
    let mut registers: Vec<S> = tape.leaves.iter().copied().map(leaf).collect();
    registers.resize(tape.registers, S::ZERO);
    execute(&tape, &mut registers);
    tape.outputs.iter().map(|&output| registers[output as usize]).collect()
}

/// A routine made ready to be called many times for one set of parameters.
#[derive(Clone, Debug)]
pub struct Evaluator<S> {
    tape: Tape,
    registers: Vec<S>,
    /// Name and length of each argument.
    arguments: Vec<(&'static str, usize)>,
    /// For each leaf that is an argument: its register, the argument, the entry.
    inputs: Vec<(usize, usize, usize)>,
}

impl<S: Transcendental> Evaluator<S> {
    /// Makes `routine` ready, with the prelude's values as [`prelude_values`] gives them.
    pub fn new(routine: &Routine, prelude: &[f64]) -> Self {
        let tape = Tape::new(&routine.code);
        let arguments = routine.arguments.iter().map(|a| (a.name, a.len)).collect();
        let inputs = argument_leaves(&tape);
        let mut registers = initial_registers(&tape, prelude);
        registers.resize(tape.registers, S::ZERO);
        Self { tape, registers, arguments, inputs }
    }

    /// Number of output entries.
    pub fn outputs(&self) -> usize {
        self.tape.outputs.len()
    }

    /// Calls the routine; the entries of all outputs, one after the other, go to `outputs`.
    pub fn evaluate(&mut self, arguments: &[&[S]], outputs: &mut [S]) -> Result<(), ShapeMismatch> {
        ShapeMismatch::check("arguments", self.arguments.len(), arguments.len())?;
        for (&(name, len), argument) in self.arguments.iter().zip(arguments) {
            ShapeMismatch::check(name, len, argument.len())?;
        }
        ShapeMismatch::check("outputs", self.tape.outputs.len(), outputs.len())?;
        for &(register, argument, entry) in &self.inputs {
            self.registers[register] = arguments[argument][entry];
        }
        execute(&self.tape, &mut self.registers);
        for (output, &register) in outputs.iter_mut().zip(&self.tape.outputs) {
            *output = self.registers[register as usize];
        }
        Ok(())
    }
}

/// Register, argument and entry of each leaf that is an argument.
pub(super) fn argument_leaves(tape: &Tape) -> Vec<(usize, usize, usize)> {
    let inputs = tape.leaves.iter().enumerate().filter_map(|(register, leaf)| match *leaf {
        Leaf::Argument { argument, entry } => Some((register, argument, entry)),
        _ => None,
    });
    inputs.collect()
}

/// The leaves' registers: constants and prelude values set, arguments zero.
pub(super) fn initial_registers<S: Scalar>(tape: &Tape, prelude: &[f64]) -> Vec<S> {
    let leaf = |leaf: &Leaf| match *leaf {
        Leaf::Constant(value) => S::from_f64(value),
        Leaf::Prelude(row) => S::from_f64(prelude[row]),
        Leaf::Argument { .. } | Leaf::Parameter(_) => S::ZERO,
    };
    tape.leaves.iter().map(leaf).collect()
}

fn execute<S: Transcendental>(tape: &Tape, values: &mut [S]) {
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
                    values[to as usize] = fused(*function, a, b, c);
                }
            }
            Run::Unary(function, rows) => {
                for &[to, from] in &tape.unary[rows.clone()] {
                    values[to as usize] = unary(*function, values[from as usize]);
                }
            }
            Run::SinCos(rows) => {
                for rows in tape.sincos[rows.clone()].chunks(SIDE_BY_SIDE) {
                    let angle = |row: usize| rows.get(row).unwrap_or(&rows[0])[2] as usize;
                    let angles: [S; SIDE_BY_SIDE] = std::array::from_fn(|row| values[angle(row)]);
                    let (sines, cosines) = S::sincos_all(angles);
                    for (row, &[sine, cosine, _]) in rows.iter().enumerate() {
                        values[sine as usize] = sines[row];
                        values[cosine as usize] = cosines[row];
                    }
                }
            }
            Run::Select(relation, rows) => {
                for &[to, left, right, then, otherwise] in &tape.select[rows.clone()] {
                    let [left, right, then, otherwise] =
                        [left, right, then, otherwise].map(|at| values[at as usize]);
                    values[to as usize] = select(*relation, [left, right], then, otherwise);
                }
            }
        }
    }
}

#[inline]
fn pairwise<S: Copy>(values: &mut [S], rows: &[[Register; 3]], function: impl Fn(S, S) -> S) {
    for &[to, left, right] in rows {
        values[to as usize] = function(values[left as usize], values[right as usize]);
    }
}

#[inline]
pub(super) fn unary<S: Transcendental>(function: UnaryOperation, a: S) -> S {
    match function {
        UnaryOperation::Neg => -a,
        UnaryOperation::Tan => a.tangent(),
        UnaryOperation::Sqrt => a.sqrt(),
        UnaryOperation::Exp => a.exponential(),
        UnaryOperation::Log => a.logarithm(),
        UnaryOperation::Tanh => a.hyperbolic_tangent(),
        UnaryOperation::Abs => a.abs(),
        UnaryOperation::Sign => a.sign(),
    }
}

#[inline]
pub(super) fn binary<S: Transcendental>(function: BinaryOperation, a: S, b: S) -> S {
    match function {
        BinaryOperation::Add => a + b,
        BinaryOperation::Sub => a - b,
        BinaryOperation::Mul => a * b,
        BinaryOperation::Div => a / b,
        BinaryOperation::Atan2 => a.arctangent2(b),
        BinaryOperation::Min => a.lesser(b),
        BinaryOperation::Max => a.greater(b),
    }
}

#[inline]
pub(super) fn fused<S: Scalar>(function: FusedOperation, a: S, b: S, c: S) -> S {
    match function {
        FusedOperation::ProductPlus => a.product_plus(b, c),
        FusedOperation::ProductMinus => a.product_minus(b, c),
        FusedOperation::MinusProduct => a.minus_product(b, c),
    }
}

#[inline]
pub(super) fn select<S: Scalar>(relation: Relation, sides: [S; 2], then: S, otherwise: S) -> S {
    match relation {
        Relation::Less => S::select_less(sides[0], sides[1], then, otherwise),
        Relation::LessEqual => S::select_less_equal(sides[0], sides[1], then, otherwise),
        Relation::Equal => S::select_equal(sides[0], sides[1], then, otherwise),
    }
}
