//! Code to steps.

use super::calls::Callee;
use super::steps::{Comparison, Operation, Source, Step, Straight, Value};
use super::turns::{MAGNITUDE, SIGN, Turn};
use crate::lanes::Lanes;
use denavit_codegen::arena::Handle;
use denavit_codegen::expr::Relation;
use denavit_codegen::program::{
    self, BinaryOperation, FusedOperation, Instruction, Leaf, Routine, Slot, UnaryOperation,
};
use denavit_runtime::FUSES;
use std::collections::BTreeMap;

/// How sines and cosines are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Turns {
    /// By steps, of ordinary angles alone.
    Inline,
    /// By calls, of all angles.
    Called,
}

/// Angles whose steps are put between each other: those of one wait for each other. More of them
/// would need more registers than there are.
const fn abreast(lanes: Lanes) -> usize {
    match lanes {
        Lanes::Eight => 4,
        _ => 2,
    }
}

/// The masks that angles side by side have; others are taken.
const FIRST_MASK: u8 = 2;

/// The steps of `routine`; its constants come after those that there are.
pub(super) fn lower(
    routine: &Routine,
    prelude: &[f64],
    lanes: Lanes,
    turns: Turns,
    constants: &[f64],
) -> Straight {
    let slots = routine.code.slots;
    let mut lowering = Lowering {
        lanes,
        turns,
        straight: Straight::default(),
        numbers: BTreeMap::new(),
        values: vec![Value::MAX; slots],
        entries: vec![Vec::new(); slots],
    };
    for &number in constants {
        lowering.number(number);
    }
    lowering.leaves(routine, prelude);
    lowering.instructions(&routine.code.instructions);
    lowering.straight.drop_unused();
    lowering.straight
}

/// Code on its way to steps.
pub(super) struct Lowering {
    pub(super) lanes: Lanes,
    turns: Turns,
    pub(super) straight: Straight,
    /// The value of each constant, by its bits.
    numbers: BTreeMap<u64, Value>,
    /// The value of each slot that is assigned.
    values: Vec<Value>,
    /// The entries of the results that each slot is.
    entries: Vec<Vec<u32>>,
}

fn index_u32(index: usize) -> u32 {
    u32::try_from(index).expect("functions have fewer than 2^32 numbers")
}

impl Lowering {
    pub(super) fn new_value(&mut self) -> Value {
        self.straight.value(Source::Step)
    }

    /// The value of a constant.
    pub(super) fn number(&mut self, number: f64) -> Value {
        if let Some(&value) = self.numbers.get(&number.to_bits()) {
            return value;
        }
        let row = index_u32(self.straight.constants.len());
        self.straight.constants.push(number);
        let value = self.straight.value(Source::Constant(row));
        self.numbers.insert(number.to_bits(), value);
        value
    }

    fn step(&mut self, operation: Operation, operands: &[Value]) -> Value {
        let result = self.new_value();
        self.straight.steps.push(Step::new(operation, operands, [Some(result), None]));
        result
    }

    /// Leaves, and results that are leaves.
    fn leaves(&mut self, routine: &Routine, prelude: &[f64]) {
        for (entry, output) in routine.code.outputs.iter().enumerate() {
            self.entries[output.index()].push(index_u32(entry));
        }
        let mut first = Vec::with_capacity(routine.arguments.len());
        let mut columns = 0;
        for argument in &routine.arguments {
            first.push(columns);
            columns += argument.len;
        }
        for (slot, leaf) in routine.code.leaves.iter() {
            let value = match *leaf {
                Leaf::Constant(number) => self.number(number),
                Leaf::Prelude(row) => self.number(prelude[row]),
                Leaf::Argument { argument, entry } => {
                    self.straight.value(Source::Column(index_u32(first[argument] + entry)))
                }
                Leaf::Parameter(_) => unreachable!("routines have a prelude's values instead"),
            };
            self.assign(slot, value);
        }
    }

    /// Gives a slot its value, which is written at once where it is a result.
    fn assign(&mut self, slot: Slot, value: Value) {
        self.values[slot.index()] = value;
        for entry in std::mem::take(&mut self.entries[slot.index()]) {
            self.straight.steps.push(Step::new(Operation::Store(entry), &[value], [None; 2]));
        }
    }

    fn value(&self, slot: Slot) -> Value {
        self.values[slot.index()]
    }

    fn instructions(&mut self, instructions: &[Instruction]) {
        let mut next = 0;
        while next < instructions.len() {
            let turns = self.independent_turns(&instructions[next..]);
            next += turns.len().max(1);
            if !turns.is_empty() {
                self.turn(&turns);
            } else if let Instruction::Value { result, operation } = instructions[next - 1] {
                let value = self.operation(operation);
                self.assign(result, value);
            }
        }
    }

    /// The first sines and cosines, if code begins with them, that do not wait for each other.
    fn independent_turns(&self, instructions: &[Instruction]) -> Vec<[Slot; 3]> {
        let mut turns: Vec<[Slot; 3]> = Vec::new();
        for instruction in instructions {
            let Instruction::SinCos { sine, cosine, angle } = *instruction else { break };
            let waits = turns.iter().any(|turn| turn[..2].contains(&angle));
            if waits || turns.len() == abreast(self.lanes) {
                break;
            }
            turns.push([sine, cosine, angle]);
        }
        turns
    }

    fn turn(&mut self, turns: &[[Slot; 3]]) {
        let mut streams = Vec::with_capacity(turns.len());
        let mut results = Vec::with_capacity(turns.len());
        for (mask, &[_, _, angle]) in (FIRST_MASK..).zip(turns) {
            let angle = self.value(angle);
            if self.turns == Turns::Called {
                let pair = [self.new_value(), self.new_value()];
                let call = Operation::Call(Callee::SinCos);
                streams.push(vec![Step::new(call, &[angle], pair.map(Some))]);
                results.push(pair);
            } else {
                let mut turn = Turn { lowering: self, steps: Vec::new(), mask };
                results.push(turn.run(angle));
                streams.push(turn.steps);
            }
        }
        // All streams have the same number of steps.
        for at in 0..streams[0].len() {
            self.straight.steps.extend(streams.iter().map(|stream| stream[at]));
        }
        for (&[sine, cosine, _], results) in turns.iter().zip(results) {
            self.assign(sine, results[0]);
            self.assign(cosine, results[1]);
        }
    }

    fn operation(&mut self, operation: program::Operation) -> Value {
        match operation {
            program::Operation::Unary(function, a) => {
                let a = self.value(a);
                self.unary(function, a)
            }
            program::Operation::Binary(function, a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                self.binary(function, a, b)
            }
            program::Operation::Fused(function, operands) => {
                let operands = operands.map(|slot| self.value(slot));
                self.fused(function, operands)
            }
            program::Operation::Select { relation, sides, then, otherwise } => {
                let sides = sides.map(|slot| self.value(slot));
                let (then, otherwise) = (self.value(then), self.value(otherwise));
                self.select(relation, sides, then, otherwise)
            }
        }
    }

    fn unary(&mut self, function: UnaryOperation, a: Value) -> Value {
        let call = |callee| Operation::Call(callee);
        match function {
            UnaryOperation::Neg => {
                let sign = self.number(SIGN);
                self.step(Operation::Xor, &[a, sign])
            }
            UnaryOperation::Abs => {
                let magnitude = self.number(MAGNITUDE);
                self.step(Operation::And, &[a, magnitude])
            }
            // Correctly rounded, as the runtime's.
            UnaryOperation::Sqrt => self.step(Operation::Sqrt, &[a]),
            UnaryOperation::Sign => {
                let [zero, one, minus_one] = [0.0, 1.0, -1.0].map(|number| self.number(number));
                let not_positive = self.select(Relation::Less, [a, zero], minus_one, a);
                self.select(Relation::Less, [zero, a], one, not_positive)
            }
            UnaryOperation::Tan => self.step(call(Callee::Tan), &[a]),
            UnaryOperation::Exp => self.step(call(Callee::Exp), &[a]),
            UnaryOperation::Log => self.step(call(Callee::Log), &[a]),
            UnaryOperation::Tanh => self.step(call(Callee::Tanh), &[a]),
        }
    }

    fn binary(&mut self, function: BinaryOperation, a: Value, b: Value) -> Value {
        match function {
            BinaryOperation::Add => self.step(Operation::Add, &[a, b]),
            BinaryOperation::Sub => self.step(Operation::Sub, &[a, b]),
            BinaryOperation::Mul => self.step(Operation::Mul, &[a, b]),
            BinaryOperation::Div => self.step(Operation::Div, &[a, b]),
            BinaryOperation::Atan2 => self.step(Operation::Call(Callee::Atan2), &[a, b]),
            // The runtime's laws: of equals the left one, and NaN if either is.
            BinaryOperation::Min => {
                let chosen = self.select(Relation::LessEqual, [a, b], a, b);
                self.select(Relation::Equal, [a, a], chosen, a)
            }
            BinaryOperation::Max => {
                let chosen = self.select(Relation::LessEqual, [b, a], a, b);
                self.select(Relation::Equal, [a, a], chosen, a)
            }
        }
    }

    fn fused(&mut self, function: FusedOperation, [a, b, c]: [Value; 3]) -> Value {
        if FUSES {
            return match function {
                FusedOperation::ProductPlus => self.step(Operation::MulAdd, &[a, b, c]),
                FusedOperation::ProductMinus => self.step(Operation::MulSub, &[a, b, c]),
                FusedOperation::MinusProduct => self.step(Operation::NegMulAdd, &[b, c, a]),
            };
        }
        let [left, right] = match function {
            FusedOperation::MinusProduct => [b, c],
            _ => [a, b],
        };
        let product = self.step(Operation::Mul, &[left, right]);
        match function {
            FusedOperation::ProductPlus => self.step(Operation::Add, &[product, c]),
            FusedOperation::ProductMinus => self.step(Operation::Sub, &[product, c]),
            FusedOperation::MinusProduct => self.step(Operation::Sub, &[a, product]),
        }
    }

    fn select(
        &mut self,
        relation: Relation,
        [left, right]: [Value; 2],
        then: Value,
        otherwise: Value,
    ) -> Value {
        let comparison = match relation {
            Relation::Less => Comparison::Less,
            Relation::LessEqual => Comparison::LessEqual,
            Relation::Equal => Comparison::Equal,
        };
        if self.lanes == Lanes::Eight {
            return self.step(Operation::Select(comparison), &[left, right, then, otherwise]);
        }
        let holds = self.step(Operation::Compare(comparison), &[left, right]);
        self.step(Operation::Choose, &[holds, then, otherwise])
    }
}
