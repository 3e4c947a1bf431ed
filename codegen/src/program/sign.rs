//! Changes of sign, put where they cost nothing.
//!
//! The graph keeps one of `a - b` and `b - a` and negates it for the other. Here a negation is
//! taken back into the difference below it, through products and quotients that nothing else uses.

use super::passes::Pass;
use super::renumber::close_gaps;
use super::{BinaryOperation, Code, Instruction, Operation, Slot, UnaryOperation};
use crate::arena::Handle;

pub(super) const ABSORB_SIGNS: Pass = Pass { name: "absorb_signs", rewrite: absorb_signs };

/// How far a sign is followed down through products.
const MAX_DEPTH: usize = 12;

/// The same code with fewer negations. Values do not change, not in the last bit: `b - a` is
/// exactly `-(a - b)` in floating point, and so are products and quotients of a changed sign.
fn absorb_signs(code: &mut Code) {
    let mut signs = Signs::new(code);
    for index in 0..code.instructions.len() {
        let Some((result, operand)) = negation(&code.instructions[index]) else { continue };
        if signs.flip(code, operand, MAX_DEPTH) {
            signs.renamed[result.index()] = Some(operand);
        }
    }
    signs.finish(code);
}

/// Result and operand of a negation.
fn negation(instruction: &Instruction) -> Option<(Slot, Slot)> {
    match *instruction {
        Instruction::Value {
            result,
            operation: Operation::Unary(UnaryOperation::Neg, operand),
        } => Some((result, operand)),
        _ => None,
    }
}

struct Signs {
    uses: Vec<u32>,
    /// The instruction that assigns each slot.
    made_by: Vec<Option<usize>>,
    /// Results of negations that now are what they negated.
    renamed: Vec<Option<Slot>>,
}

impl Signs {
    fn new(code: &Code) -> Self {
        let mut made_by = vec![None; code.slots];
        for (index, instruction) in code.instructions.iter().enumerate() {
            instruction.for_each_result(|result| made_by[result.index()] = Some(index));
        }
        Self { uses: code.uses(), made_by, renamed: vec![None; code.slots] }
    }

    /// Makes the instruction of `slot`, which one operand uses, give the opposite value.
    fn flip(&self, code: &mut Code, slot: Slot, depth: usize) -> bool {
        let Some(index) = self.made_by[slot.index()] else { return false };
        if self.uses[slot.index()] != 1 || depth == 0 {
            return false;
        }
        let Instruction::Value { operation: Operation::Binary(kind, a, b), .. } =
            code.instructions[index]
        else {
            return false;
        };
        match kind {
            BinaryOperation::Sub => {
                set_operation(code, index, Operation::Binary(BinaryOperation::Sub, b, a));
                true
            }
            BinaryOperation::Mul | BinaryOperation::Div => {
                self.flip(code, a, depth - 1) || self.flip(code, b, depth - 1)
            }
            _ => false,
        }
    }

    /// Drops the negations that were absorbed and closes the gaps in the numbering.
    fn finish(&self, code: &mut Code) {
        let is_absorbed = |instruction: &Instruction| {
            negation(instruction).is_some_and(|(result, _)| self.renamed[result.index()].is_some())
        };
        code.instructions.retain(|instruction| !is_absorbed(instruction));
        close_gaps(code, |slot| self.renamed[slot.index()].unwrap_or(slot));
    }
}

fn set_operation(code: &mut Code, index: usize, new: Operation) {
    if let Instruction::Value { operation, .. } = &mut code.instructions[index] {
        *operation = new;
    }
}
