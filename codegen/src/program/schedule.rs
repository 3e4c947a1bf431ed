//! An order of the instructions in which values are short-lived.
//!
//! Outputs are computed one after the other, each from its operands, the operand first that needs
//! more registers (Sethi and Ullman's rule, with shared values counted as if they were not). The
//! order depends on the code alone.

use super::{Code, Instruction, Slot};
use crate::arena::Handle;

/// The instructions of `code` in the new order; those that no output needs are dropped.
pub fn schedule(code: &Code) -> Vec<Instruction> {
    let definition = definitions(code);
    let needs = registers_needed(code, &definition);
    let mut placed = vec![false; code.instructions.len()];
    let mut order = Vec::with_capacity(code.instructions.len());
    let mut stack: Vec<(usize, bool)> = Vec::new();
    for output in &code.outputs {
        stack.extend(definition[output.index()].map(|index| (index, false)));
        while let Some((index, operands_done)) = stack.pop() {
            if placed[index] {
                continue;
            }
            if operands_done {
                placed[index] = true;
                order.push(code.instructions[index]);
                continue;
            }
            stack.push((index, true));
            let first = stack.len();
            code.instructions[index].for_each_operand(|operand| {
                let operand = definition[operand.index()].filter(|&index| !placed[index]);
                stack.extend(operand.map(|index| (index, false)));
            });
            // The last one on the stack comes first. The sort is stable: of equals, the left
            // operand is the first on the stack, so turn them around before.
            stack[first..].reverse();
            stack[first..].sort_by_key(|&(index, _)| needs[index]);
        }
    }
    order
}

/// The largest number of values, leaves not counted, that are needed at one time.
pub fn peak_live(code: &Code) -> usize {
    let mut last_use = vec![None; code.slots];
    for (index, instruction) in code.instructions.iter().enumerate() {
        instruction.for_each_operand(|operand| last_use[operand.index()] = Some(index));
    }
    code.outputs.iter().for_each(|output| last_use[output.index()] = Some(usize::MAX));
    let (mut live, mut peak) = (0, 0);
    for (index, instruction) in code.instructions.iter().enumerate() {
        instruction
            .for_each_result(|result| live += usize::from(last_use[result.index()].is_some()));
        peak = peak.max(live);
        let mut seen: Vec<Slot> = Vec::with_capacity(4);
        instruction.for_each_operand(|operand| {
            let is_leaf = operand.index() < code.leaves.len();
            if last_use[operand.index()] == Some(index) && !is_leaf && !seen.contains(&operand) {
                seen.push(operand);
            }
        });
        live -= seen.len();
    }
    peak
}

/// Which instruction assigns each slot; none for leaves.
fn definitions(code: &Code) -> Vec<Option<usize>> {
    let mut definition = vec![None; code.slots];
    for (index, instruction) in code.instructions.iter().enumerate() {
        instruction.for_each_result(|result| definition[result.index()] = Some(index));
    }
    definition
}

/// Registers that each instruction needs for itself and its operands, leaves being free. The
/// instructions of `code` stand in some valid order.
fn registers_needed(code: &Code, definition: &[Option<usize>]) -> Vec<u32> {
    let mut needs = vec![0; code.instructions.len()];
    for (index, instruction) in code.instructions.iter().enumerate() {
        let mut operands = Vec::with_capacity(4);
        instruction.for_each_operand(|operand| {
            operands.extend(definition[operand.index()].map(|index: usize| needs[index]));
        });
        operands.sort_unstable_by(|a, b| b.cmp(a));
        let of_operands = (0..).zip(operands).map(|(held, need): (u32, u32)| need + held).max();
        needs[index] = of_operands.unwrap_or(0).max(1);
    }
    needs
}
