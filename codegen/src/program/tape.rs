//! Code as the interpreters run it: on few registers, in runs of one operation.
//!
//! Choosing what to do next is what an interpreter spends its time on, because no processor can
//! predict that choice over thousands of instructions. So instructions that are ready are taken
//! together with all others of their kind: a run needs one choice. Each instruction still computes
//! what it did from the same operands, so no bit changes.

use super::{BinaryOperation, Code, FusedOperation, Instruction, Leaf, Operation, UnaryOperation};
use crate::arena::Handle;
use crate::expr::Relation;
use std::ops::Range;

/// Sines and cosines that are computed at a time.
pub(super) const SIDE_BY_SIDE: usize = 4;

/// A register: an index into the values.
pub(super) type Register = u32;

/// Consecutive steps of one kind: rows of the table of that kind.
#[derive(Clone, Debug)]
pub(super) enum Run {
    Unary(UnaryOperation, Range<usize>),
    Binary(BinaryOperation, Range<usize>),
    Fused(FusedOperation, Range<usize>),
    SinCos(Range<usize>),
    Select(Relation, Range<usize>),
}

/// Code on registers. The leaves stand in the first registers, in order, and are never
/// overwritten; the others are used again once their value is dead.
#[derive(Clone, Debug, Default)]
pub(super) struct Tape {
    pub(super) leaves: Vec<Leaf>,
    pub(super) runs: Vec<Run>,
    /// Result, operand.
    pub(super) unary: Vec<[Register; 2]>,
    /// Result, left operand, right operand.
    pub(super) binary: Vec<[Register; 3]>,
    /// Result, three operands.
    pub(super) fused: Vec<[Register; 4]>,
    /// Sine, cosine, angle.
    pub(super) sincos: Vec<[Register; 3]>,
    /// Result, left and right side, value if the relation holds, value if not.
    pub(super) select: Vec<[Register; 5]>,
    pub(super) outputs: Vec<Register>,
    pub(super) registers: usize,
}

/// What the steps of a run have in common.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Unary(UnaryOperation),
    Binary(BinaryOperation),
    Fused(FusedOperation),
    SinCos,
    Select(Relation),
}

impl Kind {
    fn of(instruction: &Instruction) -> Self {
        match instruction {
            Instruction::SinCos { .. } => Self::SinCos,
            Instruction::Value { operation, .. } => match operation {
                Operation::Unary(function, _) => Self::Unary(*function),
                Operation::Binary(function, ..) => Self::Binary(*function),
                Operation::Fused(function, _) => Self::Fused(*function),
                Operation::Select { relation, .. } => Self::Select(*relation),
            },
        }
    }
}

impl Tape {
    /// The tape of verified code.
    pub(super) fn new(code: &Code) -> Self {
        let leaves: Vec<Leaf> = code.leaves.values().copied().collect();
        let mut tape = Self { leaves, ..Self::default() };
        let order = in_runs(code);
        let mut allocation = Allocation::new(code, &order);
        let mut kind = None;
        for (step, &index) in order.iter().enumerate() {
            let instruction = &code.instructions[index];
            let operands = allocation.operands(step, instruction);
            let [first, second] = allocation.results(instruction);
            let [a, b, c, d] = operands;
            if kind != Some(Kind::of(instruction)) || tape.waits(a) {
                kind = Some(Kind::of(instruction));
                tape.begin(Kind::of(instruction));
            }
            let end = match tape.runs.last_mut().expect("a run has begun") {
                Run::Unary(_, rows) => {
                    tape.unary.push([first, a]);
                    &mut rows.end
                }
                Run::Binary(_, rows) => {
                    tape.binary.push([first, a, b]);
                    &mut rows.end
                }
                Run::Fused(_, rows) => {
                    tape.fused.push([first, a, b, c]);
                    &mut rows.end
                }
                Run::SinCos(rows) => {
                    tape.sincos.push([first, second, a]);
                    &mut rows.end
                }
                Run::Select(_, rows) => {
                    tape.select.push([first, a, b, c, d]);
                    &mut rows.end
                }
            };
            *end += 1;
        }
        let register = |output: &super::Slot| allocation.register_of[output.index()];
        tape.outputs = code.outputs.iter().map(register).collect();
        tape.registers = allocation.registers;
        tape
    }

    /// Whether this is the angle of a sine of one that is computed side by side with it, in the run
    /// so far: all angles are read before.
    fn waits(&self, angle: Register) -> bool {
        let Some(Run::SinCos(rows)) = self.runs.last() else { return false };
        let beside = rows.end.saturating_sub(SIDE_BY_SIDE - 1).max(rows.start);
        self.sincos[beside..rows.end].iter().any(|row| row[..2].contains(&angle))
    }

    fn begin(&mut self, kind: Kind) {
        let empty = |len: usize| len..len;
        self.runs.push(match kind {
            Kind::Unary(function) => Run::Unary(function, empty(self.unary.len())),
            Kind::Binary(function) => Run::Binary(function, empty(self.binary.len())),
            Kind::Fused(function) => Run::Fused(function, empty(self.fused.len())),
            Kind::SinCos => Run::SinCos(empty(self.sincos.len())),
            Kind::Select(relation) => Run::Select(relation, empty(self.select.len())),
        });
    }
}

/// The instructions in an order of few runs: of the kinds that have ready instructions, the one
/// with most of them, until none of it is left.
fn in_runs(code: &Code) -> Vec<usize> {
    let mut users = vec![Vec::new(); code.slots];
    let mut missing = vec![0_u32; code.instructions.len()];
    for (index, instruction) in code.instructions.iter().enumerate() {
        instruction.for_each_operand(|operand| {
            if operand.index() >= code.leaves.len() {
                users[operand.index()].push(index);
                missing[index] += 1;
            }
        });
    }
    let mut ready: Vec<(Kind, Vec<usize>)> = Vec::new();
    let make_ready = |ready: &mut Vec<(Kind, Vec<usize>)>, index: usize| {
        let kind = Kind::of(&code.instructions[index]);
        match ready.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, indices)) => indices.push(index),
            None => ready.push((kind, vec![index])),
        }
    };
    let free = (0..missing.len()).filter(|&index| missing[index] == 0).collect::<Vec<_>>();
    free.into_iter().for_each(|index| make_ready(&mut ready, index));

    let mut order = Vec::with_capacity(code.instructions.len());
    while let Some(place) = (0..ready.len()).max_by_key(|&place| ready[place].1.len())
        && !ready[place].1.is_empty()
    {
        while !ready[place].1.is_empty() {
            for index in std::mem::take(&mut ready[place].1) {
                order.push(index);
                code.instructions[index].for_each_result(|result| {
                    for &user in &users[result.index()] {
                        missing[user] -= 1;
                        if missing[user] == 0 {
                            make_ready(&mut ready, user);
                        }
                    }
                });
            }
        }
    }
    order
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
    fn new(code: &Code, order: &[usize]) -> Self {
        let leaves = code.leaves.len();
        let mut last_use = vec![None; code.slots];
        for (step, &index) in order.iter().enumerate() {
            code.instructions[index]
                .for_each_operand(|operand| last_use[operand.index()] = Some(step));
        }
        code.outputs.iter().for_each(|output| last_use[output.index()] = Some(usize::MAX));
        // A leaf's register is its slot; the others are overwritten as they are assigned.
        let register_of = (0..code.slots).map(index_u32).collect();
        Self { leaves, last_use, register_of, free: Vec::new(), registers: leaves }
    }

    /// The registers of the operands; those read for the last time become free.
    fn operands(&mut self, step: usize, instruction: &Instruction) -> [Register; 4] {
        let (mut registers, mut count) = ([0; 4], 0);
        let (mut dead, mut dead_count) = ([0; 4], 0);
        instruction.for_each_operand(|operand| {
            let register = self.register_of[operand.index()];
            registers[count] = register;
            count += 1;
            let is_last = self.last_use[operand.index()] == Some(step);
            let is_leaf = operand.index() < self.leaves;
            if is_last && !is_leaf && !dead[..dead_count].contains(&register) {
                dead[dead_count] = register;
                dead_count += 1;
            }
        });
        self.free.extend(&dead[..dead_count]);
        registers
    }

    /// Registers for the results: a second one for the cosine. A result that nobody reads frees its
    /// register at once.
    fn results(&mut self, instruction: &Instruction) -> [Register; 2] {
        let (mut registers, mut count) = ([0; 2], 0);
        instruction.for_each_result(|result| {
            let register = self.free.pop().unwrap_or_else(|| {
                self.registers += 1;
                index_u32(self.registers - 1)
            });
            self.register_of[result.index()] = register;
            registers[count] = register;
            count += 1;
        });
        let mut at = 0;
        instruction.for_each_result(|result| {
            if self.last_use[result.index()].is_none() {
                self.free.push(registers[at]);
            }
            at += 1;
        });
        registers
    }
}

fn index_u32(index: usize) -> u32 {
    u32::try_from(index).expect("fewer than 2^32 slots")
}
