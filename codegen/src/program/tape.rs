//! Code with its slots mapped to few registers: what the interpreters run.

use super::{BinaryOperation, Code, Instruction, Leaf, Operation, UnaryOperation};
use crate::arena::Handle;
use crate::expr::Relation;

/// A register.
pub(super) type Register = u32;

/// A step, on registers.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    Unary(UnaryOperation, Register, Register),
    Binary(BinaryOperation, Register, [Register; 2]),
    SinCos([Register; 2], Register),
    /// The operands stand in [`Tape::choices`].
    Select(Register, u32),
}

/// Operands of a selection.
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice {
    pub(super) relation: Relation,
    pub(super) sides: [Register; 2],
    pub(super) then: Register,
    pub(super) otherwise: Register,
}

/// Steps on registers. The leaves stand in the first registers, in order, and are never
/// overwritten; the others are used again once their value is dead.
#[derive(Clone, Debug, Default)]
pub(super) struct Tape {
    pub(super) leaves: Vec<Leaf>,
    pub(super) steps: Vec<Step>,
    pub(super) choices: Vec<Choice>,
    pub(super) outputs: Vec<Register>,
    pub(super) registers: usize,
}

impl Tape {
    /// The tape of verified code.
    pub(super) fn new(code: &Code) -> Self {
        let leaves: Vec<Leaf> = code.leaves.values().copied().collect();
        let registers = leaves.len();
        let mut tape = Self { leaves, registers, ..Self::default() };
        let mut allocation = Allocation::new(code);
        for (index, instruction) in code.instructions.iter().enumerate() {
            let operands = allocation.operands(index, instruction);
            let step = match *instruction {
                Instruction::SinCos { sine, cosine, .. } => {
                    let results = [sine, cosine].map(|slot| allocation.assign(slot.index()));
                    [sine, cosine].iter().for_each(|slot| allocation.drop_unused(slot.index()));
                    Step::SinCos(results, operands[0])
                }
                Instruction::Value { result, operation } => {
                    let register = allocation.assign(result.index());
                    allocation.drop_unused(result.index());
                    match operation {
                        Operation::Unary(function, _) => {
                            Step::Unary(function, register, operands[0])
                        }
                        Operation::Binary(function, ..) => {
                            Step::Binary(function, register, [operands[0], operands[1]])
                        }
                        Operation::Select { relation, .. } => {
                            let [left, right, then, otherwise] = operands;
                            let sides = [left, right];
                            tape.choices.push(Choice { relation, sides, then, otherwise });
                            Step::Select(register, index_u32(tape.choices.len() - 1))
                        }
                    }
                }
            };
            tape.steps.push(step);
        }
        tape.outputs =
            code.outputs.iter().map(|slot| allocation.register_of[slot.index()]).collect();
        tape.registers = allocation.registers;
        tape
    }
}

/// Which register holds which slot while the code is walked.
struct Allocation {
    leaves: usize,
    last_use: Vec<Option<usize>>,
    register_of: Vec<Register>,
    free: Vec<Register>,
    registers: usize,
}

impl Allocation {
    fn new(code: &Code) -> Self {
        let leaves = code.leaves.len();
        let mut last_use = vec![None; code.slots];
        for (index, instruction) in code.instructions.iter().enumerate() {
            instruction.for_each_operand(|operand| last_use[operand.index()] = Some(index));
        }
        code.outputs.iter().for_each(|output| last_use[output.index()] = Some(usize::MAX));
        // A leaf's register is its slot; the others are overwritten as they are assigned.
        let register_of = (0..code.slots).map(index_u32).collect();
        Self { leaves, last_use, register_of, free: Vec::new(), registers: leaves }
    }

    /// The registers of the operands; those read for the last time become free.
    fn operands(&mut self, index: usize, instruction: &Instruction) -> [Register; 4] {
        let (mut registers, mut count) = ([0; 4], 0);
        let mut dead = Vec::with_capacity(4);
        instruction.for_each_operand(|operand| {
            let register = self.register_of[operand.index()];
            registers[count] = register;
            count += 1;
            let is_last = self.last_use[operand.index()] == Some(index);
            if is_last && operand.index() >= self.leaves && !dead.contains(&register) {
                dead.push(register);
            }
        });
        self.free.extend(dead);
        registers
    }

    fn assign(&mut self, slot: usize) -> Register {
        let register = self.free.pop().unwrap_or_else(|| {
            self.registers += 1;
            index_u32(self.registers - 1)
        });
        self.register_of[slot] = register;
        register
    }

    /// A result that nobody reads (the other half of a sine and cosine) frees its register at
    /// once; the two halves were given different ones before.
    fn drop_unused(&mut self, slot: usize) {
        if self.last_use[slot].is_none() {
            self.free.push(self.register_of[slot]);
        }
    }
}

fn index_u32(index: usize) -> u32 {
    u32::try_from(index).expect("fewer than 2^32 slots")
}
