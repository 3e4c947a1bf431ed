//! Slots numbered anew after a pass has dropped instructions.

use super::{Code, Instruction, Operation, Slot};
use crate::arena::Handle;

/// Numbers the slots in the order in which they are assigned, so that none is left out. What reads
/// a slot reads `stands_for` of it from now on, which must still be assigned.
pub(super) fn close_gaps(code: &mut Code, stands_for: impl Fn(Slot) -> Slot) {
    let mut number: Vec<Option<Slot>> = vec![None; code.slots];
    let mut slots = 0;
    let mut assign = |slot: Slot| {
        number[slot.index()] = Some(Slot::from_index(slots));
        slots += 1;
    };
    code.leaves.keys().for_each(&mut assign);
    code.instructions.iter().for_each(|instruction| instruction.for_each_result(&mut assign));
    code.slots = slots;
    let renumbered =
        |slot: Slot| number[stands_for(slot).index()].expect("what is used is assigned");
    code.instructions.iter_mut().for_each(|step| renumber(step, &renumbered));
    code.outputs.iter_mut().for_each(|output| *output = renumbered(*output));
}

fn renumber(instruction: &mut Instruction, number: &dyn Fn(Slot) -> Slot) {
    match instruction {
        Instruction::SinCos { sine, cosine, angle } => {
            [sine, cosine, angle].into_iter().for_each(|slot| *slot = number(*slot));
        }
        Instruction::Value { result, operation } => {
            *result = number(*result);
            match operation {
                Operation::Unary(_, a) => *a = number(*a),
                Operation::Binary(_, a, b) => [a, b].into_iter().for_each(|s| *s = number(*s)),
                Operation::Fused(_, operands) => operands.iter_mut().for_each(|s| *s = number(*s)),
                Operation::Select { sides: [left, right], then, otherwise, .. } => {
                    [left, right, then, otherwise].into_iter().for_each(|s| *s = number(*s));
                }
            }
        }
    }
}
