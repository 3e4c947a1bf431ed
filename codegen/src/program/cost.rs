//! What a call costs: operations, counted by kind.
//!
//! Formulations are compared before they are lowered, by
//! [`Operations::price`](crate::expr::Operations::price); this is what the chosen one came to.

use super::{
    BinaryOperation, Code, Instruction, Leaf, Operation, Program, Routine, UnaryOperation,
};
use crate::arena::Handle;
use crate::expr::Operations;

/// The operations of a piece of code, without a prelude.
pub fn code_counts(code: &Code) -> Operations {
    let mut counts = Operations::default();
    code.instructions.iter().for_each(|instruction| count(&mut counts, instruction));
    counts
}

/// The operations of a routine of `program`.
pub fn counts(program: &Program, routine: &Routine) -> Operations {
    Operations { prelude: prelude_operations(program, routine), ..code_counts(&routine.code) }
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

fn count(counts: &mut Operations, instruction: &Instruction) {
    if let Instruction::Value { operation: Operation::Fused(..), .. } = instruction {
        // Two operations in one instruction.
        counts.mul += 1;
        counts.add += 1;
        return;
    }
    use BinaryOperation::{Add, Atan2, Div, Max, Min, Mul, Sub};
    use UnaryOperation::{Abs, Exp, Log, Neg, Sign, Sqrt, Tan, Tanh};
    *(match instruction {
        Instruction::SinCos { .. } => &mut counts.sincos,
        Instruction::Value { operation, .. } => match operation {
            Operation::Fused(..) => unreachable!("counted above"),
            Operation::Unary(Neg, _) => &mut counts.neg,
            Operation::Unary(Sqrt, _) => &mut counts.sqrt,
            Operation::Unary(Tan | Exp | Log | Tanh, _) => &mut counts.function,
            Operation::Binary(Atan2, ..) => &mut counts.function,
            Operation::Unary(Abs | Sign, _) | Operation::Select { .. } => &mut counts.select,
            Operation::Binary(Min | Max, ..) => &mut counts.select,
            Operation::Binary(Add | Sub, ..) => &mut counts.add,
            Operation::Binary(Mul, ..) => &mut counts.mul,
            Operation::Binary(Div, ..) => &mut counts.div,
        },
    }) += 1;
}
