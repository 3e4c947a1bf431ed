//! What a call costs: operations, counted by kind.
//!
//! Formulations are compared before they are lowered, by
//! [`Operations::price`](crate::expr::Operations::price); this is what the chosen one came to.

use super::{
    BinaryOperation, Code, Instruction, Leaf, Operation, Program, Routine, UnaryOperation,
};
use crate::arena::Handle;
use std::ops::AddAssign;

/// Operations of a function, by kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Counts {
    /// Multiplications.
    pub mul: usize,
    /// Additions and subtractions.
    pub add: usize,
    /// Changes of sign.
    pub neg: usize,
    /// Divisions.
    pub div: usize,
    /// Square roots.
    pub sqrt: usize,
    /// Sine and cosine of one angle, together one operation.
    pub sincos: usize,
    /// Selections, minima, maxima, absolute values and signs: all without a branch.
    pub select: usize,
    /// Other functions: tan, exp, log, tanh, atan2.
    pub function: usize,
    /// Operations, of any kind, of the prelude that this function needs; run once for each set of
    /// parameters.
    pub prelude: usize,
}

impl Counts {
    /// Operations of a call, of any kind; those of the prelude are not among them.
    pub fn total(&self) -> usize {
        let arithmetic = self.mul + self.add + self.neg + self.div;
        arithmetic + self.sqrt + self.sincos + self.select + self.function
    }

    fn count(&mut self, instruction: &Instruction) {
        use BinaryOperation::{Add, Atan2, Div, Max, Min, Mul, Sub};
        use UnaryOperation::{Abs, Exp, Log, Neg, Sign, Sqrt, Tan, Tanh};
        *(match instruction {
            Instruction::SinCos { .. } => &mut self.sincos,
            Instruction::Value { operation, .. } => match operation {
                Operation::Unary(Neg, _) => &mut self.neg,
                Operation::Unary(Sqrt, _) => &mut self.sqrt,
                Operation::Unary(Tan | Exp | Log | Tanh, _) => &mut self.function,
                Operation::Binary(Atan2, ..) => &mut self.function,
                Operation::Unary(Abs | Sign, _) | Operation::Select { .. } => &mut self.select,
                Operation::Binary(Min | Max, ..) => &mut self.select,
                Operation::Binary(Add | Sub, ..) => &mut self.add,
                Operation::Binary(Mul, ..) => &mut self.mul,
                Operation::Binary(Div, ..) => &mut self.div,
            },
        }) += 1;
    }
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.mul += other.mul;
        self.add += other.add;
        self.neg += other.neg;
        self.div += other.div;
        self.sqrt += other.sqrt;
        self.sincos += other.sincos;
        self.select += other.select;
        self.function += other.function;
        self.prelude += other.prelude;
    }
}

/// The operations of a piece of code, without a prelude.
pub fn code_counts(code: &Code) -> Counts {
    let mut counts = Counts::default();
    code.instructions.iter().for_each(|instruction| counts.count(instruction));
    counts
}

/// The operations of a routine of `program`.
pub fn counts(program: &Program, routine: &Routine) -> Counts {
    Counts { prelude: prelude_operations(program, routine), ..code_counts(&routine.code) }
}

/// Number of prelude instructions that the prelude values of a routine depend on.
fn prelude_operations(program: &Program, routine: &Routine) -> usize {
    let prelude = &program.prelude;
    let mut needed = vec![false; prelude.slots];
    for leaf in routine.code.leaves.values() {
        if let Leaf::Prelude(row) = leaf {
            needed[prelude.outputs[*row].index()] = true;
        }
    }
    let mut operations = 0;
    for instruction in prelude.instructions.iter().rev() {
        let mut is_needed = false;
        instruction.for_each_result(|result| is_needed |= needed[result.index()]);
        if is_needed {
            operations += 1;
            instruction.for_each_operand(|operand| needed[operand.index()] = true);
        }
    }
    operations
}
