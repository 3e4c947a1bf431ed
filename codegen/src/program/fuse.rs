//! Products fused with the sums that they go into.
//!
//! A processor with fused multiply-add takes a product and a sum in one instruction, in the time of
//! one of them, and rounds once instead of twice. So results differ in their last bits from those
//! without fusing, and depend on whether the target has the instruction; hence nothing is fused
//! unless it is asked for.

use super::passes::{Pass, run_on_routine};
use super::renumber::close_gaps;
use super::schedule::SCHEDULE;
use super::{BinaryOperation, Code, FusedOperation, Instruction, Operation, Program, Slot};
use crate::arena::Handle;

const FUSE: Pass = Pass { name: "fuse", rewrite: fuse_code };

/// Fuses products in all functions of a program; the prelude, which runs once, is left alone.
pub fn fuse(program: &mut Program) {
    for routine in &mut program.routines {
        run_on_routine(&[FUSE, SCHEDULE], routine, program.prelude.outputs.len());
    }
}

fn fuse_code(code: &mut Code) {
    let products = Products::new(code);
    let mut is_fused = vec![false; code.slots];
    for index in 0..code.instructions.len() {
        let Instruction::Value { result, operation: Operation::Binary(kind, a, b) } =
            code.instructions[index]
        else {
            continue;
        };
        let Some((product, operation)) = products.fused(kind, a, b) else { continue };
        is_fused[product.index()] = true;
        code.instructions[index] = Instruction::Value { result, operation };
    }
    code.instructions.retain(|instruction| match instruction {
        Instruction::Value { result, .. } => !is_fused[result.index()],
        Instruction::SinCos { .. } => true,
    });
    close_gaps(code, |slot| slot);
}

/// The products of a code that one operand uses.
struct Products {
    /// Factors, by slot of the product.
    factors: Vec<Option<[Slot; 2]>>,
    /// Number of operations on the longest way to each slot.
    depth: Vec<u32>,
}

impl Products {
    fn new(code: &Code) -> Self {
        let uses = code.uses();
        let mut depth = vec![0; code.slots];
        let mut factors = vec![None; code.slots];
        for instruction in &code.instructions {
            let mut deepest = 0;
            instruction.for_each_operand(|slot| deepest = deepest.max(depth[slot.index()]));
            instruction.for_each_result(|slot| depth[slot.index()] = deepest + 1);
            if let Instruction::Value {
                result,
                operation: Operation::Binary(BinaryOperation::Mul, a, b),
            } = *instruction
                && uses[result.index()] == 1
            {
                factors[result.index()] = Some([a, b]);
            }
        }
        Self { factors, depth }
    }

    /// A sum or difference with one of its operands, a product, taken in. Of two products the one
    /// that is there later: the other is computed meanwhile.
    fn fused(&self, kind: BinaryOperation, a: Slot, b: Slot) -> Option<(Slot, Operation)> {
        let (left, right) = (self.factors[a.index()], self.factors[b.index()]);
        let is_left = match (left, right) {
            (Some(_), Some(_)) => self.depth[a.index()] > self.depth[b.index()],
            (left, _) => left.is_some(),
        };
        let (product, other, factors) = if is_left { (a, b, left?) } else { (b, a, right?) };
        let [x, y] = factors;
        let operation = match (kind, is_left) {
            (BinaryOperation::Add, _) => {
                Operation::Fused(FusedOperation::ProductPlus, [x, y, other])
            }
            (BinaryOperation::Sub, true) => {
                Operation::Fused(FusedOperation::ProductMinus, [x, y, other])
            }
            (BinaryOperation::Sub, false) => {
                Operation::Fused(FusedOperation::MinusProduct, [other, x, y])
            }
            _ => return None,
        };
        Some((product, operation))
    }
}
