//! An order of the instructions in which values are short-lived.
//!
//! Outputs are computed one after the other, each from its operands, the operand first that needs
//! more registers (Sethi and Ullman's rule, with shared values counted as if they were not). Before
//! all of them come the sines and cosines of angles that need no other sine: one after the other,
//! so that they can be computed side by side. The order depends on the code alone.

use super::passes::Pass;
use super::{Code, Instruction, Slot};
use crate::arena::Handle;

pub(super) const SCHEDULE: Pass =
    Pass { name: "schedule", rewrite: |code| code.instructions = schedule(code) };

/// The instructions of `code` in the new order; those that no output needs are dropped. Of two
/// orders of the outputs, as they stand and as their values were made, it is the one in which
/// fewer values must be read again after they had to leave the registers.
pub fn schedule(code: &Code) -> Vec<Instruction> {
    let definition = definitions(code);
    let mut as_made = code.outputs.clone();
    as_made.sort_unstable();
    let [as_they_stand, as_made] =
        [&code.outputs, &as_made].map(|outputs| ordered(code, &definition, outputs));
    let misses = |order: &[Instruction]| register_misses(code, order);
    if misses(&as_made) < misses(&as_they_stand) { as_made } else { as_they_stand }
}

/// The instructions in the order in which `outputs` need them.
fn ordered(code: &Code, definition: &[Option<usize>], outputs: &[Slot]) -> Vec<Instruction> {
    let needs = registers_needed(code, definition);
    let mut placed = vec![false; code.instructions.len()];
    let mut order = Vec::with_capacity(code.instructions.len());
    let mut stack: Vec<(usize, bool)> = Vec::new();
    let turns = first_turns(code, definition);
    let angles = turns.iter().filter_map(|&turn| angle_of(code, turn, definition));
    let ends = outputs.iter().filter_map(|output| definition[output.index()]);
    for end in angles.chain(turns.iter().copied()).chain(ends) {
        stack.push((end, false));
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

/// The sines and cosines that some output needs and whose angles need no sine or cosine.
fn first_turns(code: &Code, definition: &[Option<usize>]) -> Vec<usize> {
    let mut is_needed = vec![false; code.slots];
    code.outputs.iter().for_each(|output| is_needed[output.index()] = true);
    for instruction in code.instructions.iter().rev() {
        let mut is_live = false;
        instruction.for_each_result(|result| is_live |= is_needed[result.index()]);
        if is_live {
            instruction.for_each_operand(|operand| is_needed[operand.index()] = true);
        }
    }
    let mut has_turned = vec![false; code.instructions.len()];
    let mut turns = Vec::new();
    for (index, instruction) in code.instructions.iter().enumerate() {
        let mut after_turn = false;
        instruction.for_each_operand(|operand| {
            after_turn |= definition[operand.index()].is_some_and(|maker| has_turned[maker]);
        });
        has_turned[index] = after_turn;
        if let Instruction::SinCos { sine, cosine, .. } = instruction {
            has_turned[index] = true;
            let is_live = is_needed[sine.index()] || is_needed[cosine.index()];
            turns.extend((!after_turn && is_live).then_some(index));
        }
    }
    turns
}

/// The instruction that computes the angle of a sine and cosine; none for an argument.
fn angle_of(code: &Code, turn: usize, definition: &[Option<usize>]) -> Option<usize> {
    match code.instructions[turn] {
        Instruction::SinCos { angle, .. } => definition[angle.index()],
        Instruction::Value { .. } => None,
    }
}

/// Registers of a common processor.
const REGISTERS: usize = 16;

/// How often a value is read that is in no register, when the value that leaves the registers is
/// always that which is needed last. Leaves are read from memory, and outputs written to it, as it
/// is.
fn register_misses(code: &Code, order: &[Instruction]) -> usize {
    let mut readers = Readers::new(code, order);
    let mut held: Vec<Slot> = Vec::with_capacity(REGISTERS + 1);
    let mut misses = 0;
    for (step, instruction) in order.iter().enumerate() {
        let mut take = |slot: Slot, readers: &Readers| {
            let is_held = held.contains(&slot);
            if !is_held {
                held.push(slot);
            }
            held.retain(|&slot| readers.next(slot).is_some());
            if held.len() > REGISTERS {
                let (row, _) = held
                    .iter()
                    .enumerate()
                    .max_by_key(|&(_, &slot)| readers.next(slot))
                    .expect("it holds more than there are registers");
                held.swap_remove(row);
            }
            is_held
        };
        instruction.for_each_operand(|operand| {
            readers.leave_behind(operand, step);
            if operand.index() >= code.leaves.len() {
                misses += usize::from(!take(operand, &readers));
            }
        });
        instruction.for_each_result(|result| {
            take(result, &readers);
        });
    }
    misses
}

/// The steps that read each slot and are still to come. All stand in one table, those of a slot
/// side by side: code may have millions of slots.
struct Readers {
    steps: Vec<u32>,
    /// For each slot, where its steps begin and end.
    rows: Vec<[u32; 2]>,
}

impl Readers {
    fn new(code: &Code, order: &[Instruction]) -> Self {
        let mut rows = vec![[0_u32; 2]; code.slots];
        for instruction in order {
            instruction.for_each_operand(|operand| rows[operand.index()][1] += 1);
        }
        let mut end = 0;
        for row in &mut rows {
            end += row[1];
            *row = [end, end];
        }
        let mut steps = vec![0; end as usize];
        // from the back, so that each row begins with its first step
        let mut step = index_u32(order.len());
        for instruction in order.iter().rev() {
            step -= 1;
            instruction.for_each_operand(|operand| {
                let [begin, _] = &mut rows[operand.index()];
                *begin -= 1;
                steps[*begin as usize] = step;
            });
        }
        Self { steps, rows }
    }

    fn next(&self, slot: Slot) -> Option<u32> {
        let [begin, end] = self.rows[slot.index()];
        (begin < end).then(|| self.steps[begin as usize])
    }

    /// Takes a step away from a slot, however often it reads it.
    fn leave_behind(&mut self, slot: Slot, step: usize) {
        while self.next(slot).is_some_and(|next| next as usize == step) {
            self.rows[slot.index()][0] += 1;
        }
    }
}

fn index_u32(index: usize) -> u32 {
    u32::try_from(index).expect("fewer than 2^32 instructions")
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
