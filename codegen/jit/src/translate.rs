//! Straight-line code to instructions of the code generator.
//!
//! The same translation serves one sample and two at once: the instructions of the generator are
//! alike for numbers and for pairs of them. Each computes what the runtime's scalar does, in the
//! order of the code, so results have the bits of the interpreter.

use crate::external::ANGLES;
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::types::{F64, F64X2, I64X2};
use cranelift_codegen::ir::{
    FuncRef, InstBuilder, MemFlags, StackSlot, StackSlotData, StackSlotKind, Type, Value,
};
use cranelift_frontend::FunctionBuilder;
use denavit_codegen::arena::Handle;
use denavit_codegen::expr::Relation;
use denavit_codegen::program::{
    BinaryOperation, Code, FusedOperation, Instruction, Leaf, Operation, Slot, UnaryOperation,
};
use denavit_runtime::FUSES;

/// How many samples are computed at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Width {
    One,
    Two,
}

impl Width {
    pub(crate) const fn lanes(self) -> usize {
        match self {
            Self::One => 1,
            Self::Two => 2,
        }
    }

    pub(crate) const fn kind(self) -> Type {
        match self {
            Self::One => F64,
            Self::Two => F64X2,
        }
    }
}

/// The functions that code may call.
#[derive(Clone, Copy)]
pub(crate) struct Callees {
    pub(crate) sincos: FuncRef,
    pub(crate) tangent: FuncRef,
    pub(crate) exponential: FuncRef,
    pub(crate) logarithm: FuncRef,
    pub(crate) hyperbolic_tangent: FuncRef,
    pub(crate) arctangent2: FuncRef,
}

/// Where the leaves are read.
pub(crate) struct Places {
    /// The address of the numbers that do not change from call to call.
    pub(crate) table: Value,
    /// The row of each leaf in that table.
    pub(crate) rows: Vec<Option<i32>>,
    /// The address and the offset of each leaf that is an argument.
    pub(crate) arguments: Vec<Option<(Value, i32)>>,
}

/// Memory that does not fault and is not written while the code runs. Pairs need not be aligned.
pub(crate) fn constant_memory() -> MemFlags {
    MemFlags::new().with_notrap().with_readonly()
}

pub(crate) struct Translation<'a, 'b> {
    builder: &'a mut FunctionBuilder<'b>,
    width: Width,
    callees: Callees,
    code: &'a Code,
    places: Places,
    values: Vec<Option<Value>>,
    angles: StackSlot,
    results: StackSlot,
}

impl<'a, 'b> Translation<'a, 'b> {
    pub(crate) fn new(
        builder: &'a mut FunctionBuilder<'b>,
        width: Width,
        callees: Callees,
        code: &'a Code,
        places: Places,
    ) -> Self {
        let mut slot = |numbers: usize| {
            let size = u32::try_from(8 * numbers).expect("a few numbers");
            let data = StackSlotData::new(StackSlotKind::ExplicitSlot, size, 5);
            builder.create_sized_stack_slot(data)
        };
        let (angles, results) = (slot(ANGLES), slot(2 * ANGLES));
        let values = vec![None; code.slots];
        Self { builder, width, callees, code, places, values, angles, results }
    }

    /// Translates all instructions; `store` gets the entry and the value of each output as soon as
    /// it is there.
    pub(crate) fn run(mut self, mut store: impl FnMut(&mut FunctionBuilder<'_>, usize, Value)) {
        let mut entries: Vec<Vec<usize>> = vec![Vec::new(); self.code.slots];
        for (entry, output) in self.code.outputs.iter().enumerate() {
            entries[output.index()].push(entry);
        }
        let mut write = |this: &mut Self, slot: Slot| {
            if !entries[slot.index()].is_empty() {
                let value = this.value(slot);
                entries[slot.index()]
                    .iter()
                    .for_each(|&entry| store(&mut *this.builder, entry, value));
            }
        };
        for leaf in self.code.leaves.keys() {
            write(&mut self, leaf);
        }
        let mut next = 0;
        while next < self.code.instructions.len() {
            let turns = self.turns(next);
            if !turns.is_empty() {
                self.sincos(&turns);
                next += turns.len();
                for slot in turns.iter().flat_map(|turn| &turn[..2]) {
                    write(&mut self, *slot);
                }
                continue;
            }
            if let Instruction::Value { result, operation } = self.code.instructions[next] {
                let value = self.operation(operation);
                self.values[result.index()] = Some(value);
                write(&mut self, result);
            }
            next += 1;
        }
    }

    /// The value of a slot; leaves are read at their first use.
    fn value(&mut self, slot: Slot) -> Value {
        if let Some(value) = self.values[slot.index()] {
            return value;
        }
        let kind = self.width.kind();
        let value = match (self.places.arguments[slot.index()], self.places.rows[slot.index()]) {
            (Some((address, offset)), _) => {
                self.builder.ins().load(kind, constant_memory(), address, offset)
            }
            (None, Some(row)) => {
                let size = i32::try_from(8 * self.width.lanes()).expect("8 or 16");
                self.builder.ins().load(kind, constant_memory(), self.places.table, row * size)
            }
            (None, None) => unreachable!("what is used is assigned"),
        };
        self.values[slot.index()] = Some(value);
        value
    }

    /// Up to as many sines and cosines as one call takes, that do not wait for each other.
    fn turns(&self, first: usize) -> Vec<[Slot; 3]> {
        let mut turns: Vec<[Slot; 3]> = Vec::new();
        for instruction in &self.code.instructions[first..] {
            let Instruction::SinCos { sine, cosine, angle } = *instruction else { break };
            let is_full = turns.len() * self.width.lanes() == ANGLES;
            if is_full || turns.iter().any(|turn| turn[..2].contains(&angle)) {
                break;
            }
            turns.push([sine, cosine, angle]);
        }
        turns
    }

    fn sincos(&mut self, turns: &[[Slot; 3]]) {
        let size = 8 * self.width.lanes();
        let offset = |place: usize| i32::try_from(place * size).expect("a few numbers");
        for place in 0..ANGLES / self.width.lanes() {
            // Places that no angle needs repeat the last one.
            let angle = self.value(turns[place.min(turns.len() - 1)][2]);
            self.builder.ins().stack_store(angle, self.angles, offset(place));
        }
        let pointer = self.builder.func.dfg.value_type(self.places.table);
        let angles = self.builder.ins().stack_addr(pointer, self.angles, 0);
        let results = self.builder.ins().stack_addr(pointer, self.results, 0);
        self.builder.ins().call(self.callees.sincos, &[angles, results]);
        let kind = self.width.kind();
        for (place, &[sine, cosine, _]) in turns.iter().enumerate() {
            for (slot, start) in [(sine, 0), (cosine, 8 * ANGLES)] {
                let at = offset(place) + i32::try_from(start).expect("a few numbers");
                let value = self.builder.ins().stack_load(kind, self.results, at);
                self.values[slot.index()] = Some(value);
            }
        }
    }

    fn operation(&mut self, operation: Operation) -> Value {
        match operation {
            Operation::Unary(function, a) => {
                let a = self.value(a);
                self.unary(function, a)
            }
            Operation::Binary(function, a, b) => {
                let [a, b] = [a, b].map(|slot| self.value(slot));
                self.binary(function, a, b)
            }
            Operation::Fused(function, operands) => {
                let operands = operands.map(|slot| self.value(slot));
                self.fused(function, operands)
            }
            Operation::Select { relation, sides, then, otherwise } => {
                let [left, right] = sides.map(|slot| self.value(slot));
                let [then, otherwise] = [then, otherwise].map(|slot| self.value(slot));
                self.select(relation, [left, right], then, otherwise)
            }
        }
    }

    fn unary(&mut self, function: UnaryOperation, a: Value) -> Value {
        let callees = self.callees;
        match function {
            UnaryOperation::Neg => self.builder.ins().fneg(a),
            UnaryOperation::Abs => self.builder.ins().fabs(a),
            // Correctly rounded, as the runtime's.
            UnaryOperation::Sqrt => self.builder.ins().sqrt(a),
            UnaryOperation::Sign => {
                let [zero, one, minus_one] = [0.0, 1.0, -1.0].map(|value| self.number(value));
                let not_positive = self.select(Relation::Less, [a, zero], minus_one, a);
                self.select(Relation::Less, [zero, a], one, not_positive)
            }
            UnaryOperation::Tan => self.call(callees.tangent, &[a]),
            UnaryOperation::Exp => self.call(callees.exponential, &[a]),
            UnaryOperation::Log => self.call(callees.logarithm, &[a]),
            UnaryOperation::Tanh => self.call(callees.hyperbolic_tangent, &[a]),
        }
    }

    fn binary(&mut self, function: BinaryOperation, a: Value, b: Value) -> Value {
        match function {
            BinaryOperation::Add => self.builder.ins().fadd(a, b),
            BinaryOperation::Sub => self.builder.ins().fsub(a, b),
            BinaryOperation::Mul => self.builder.ins().fmul(a, b),
            BinaryOperation::Div => self.builder.ins().fdiv(a, b),
            BinaryOperation::Atan2 => self.call(self.callees.arctangent2, &[a, b]),
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
        match (function, FUSES) {
            (FusedOperation::ProductPlus, true) => self.builder.ins().fma(a, b, c),
            (FusedOperation::ProductMinus, true) => {
                let c = self.builder.ins().fneg(c);
                self.builder.ins().fma(a, b, c)
            }
            (FusedOperation::MinusProduct, true) => {
                let b = self.builder.ins().fneg(b);
                self.builder.ins().fma(b, c, a)
            }
            (FusedOperation::ProductPlus, false) => {
                let product = self.builder.ins().fmul(a, b);
                self.builder.ins().fadd(product, c)
            }
            (FusedOperation::ProductMinus, false) => {
                let product = self.builder.ins().fmul(a, b);
                self.builder.ins().fsub(product, c)
            }
            (FusedOperation::MinusProduct, false) => {
                let product = self.builder.ins().fmul(b, c);
                self.builder.ins().fsub(a, product)
            }
        }
    }

    fn select(
        &mut self,
        relation: Relation,
        [left, right]: [Value; 2],
        then: Value,
        otherwise: Value,
    ) -> Value {
        let condition = match relation {
            Relation::Less => FloatCC::LessThan,
            Relation::LessEqual => FloatCC::LessThanOrEqual,
            Relation::Equal => FloatCC::Equal,
        };
        let holds = self.builder.ins().fcmp(condition, left, right);
        match self.width {
            Width::One => self.builder.ins().select(holds, then, otherwise),
            Width::Two => {
                let memory = MemFlags::new();
                let [then, otherwise] = [then, otherwise]
                    .map(|value| self.builder.ins().bitcast(I64X2, lane_order(memory), value));
                let chosen = self.builder.ins().bitselect(holds, then, otherwise);
                self.builder.ins().bitcast(F64X2, lane_order(memory), chosen)
            }
        }
    }

    fn number(&mut self, value: f64) -> Value {
        let number = self.builder.ins().f64const(value);
        match self.width {
            Width::One => number,
            Width::Two => self.builder.ins().splat(F64X2, number),
        }
    }

    /// Calls a function of numbers, lane by lane.
    fn call(&mut self, callee: FuncRef, operands: &[Value]) -> Value {
        let lane_of = |this: &mut Self, lane: u8| {
            let operands: Vec<Value> = operands
                .iter()
                .map(|&operand| match this.width {
                    Width::One => operand,
                    Width::Two => this.builder.ins().extractlane(operand, lane),
                })
                .collect();
            let call = this.builder.ins().call(callee, &operands);
            this.builder.inst_results(call)[0]
        };
        let first = lane_of(self, 0);
        match self.width {
            Width::One => first,
            Width::Two => {
                let second = lane_of(self, 1);
                let both = self.builder.ins().splat(F64X2, first);
                self.builder.ins().insertlane(both, second, 1)
            }
        }
    }
}

/// Bits are cast in the order of lanes of small ends first, on every target.
fn lane_order(memory: MemFlags) -> MemFlags {
    memory.with_endianness(cranelift_codegen::ir::Endianness::Little)
}

/// The leaves that do not change from call to call, in the order of the table.
fn constants(code: &Code) -> impl Iterator<Item = (Slot, Leaf)> {
    let leaves = code.leaves.iter().map(|(slot, leaf)| (slot, *leaf));
    leaves.filter(|(_, leaf)| !matches!(leaf, Leaf::Argument { .. }))
}

/// The row in the table of each leaf that has one.
pub(crate) fn table_rows(code: &Code) -> Vec<Option<i32>> {
    let mut rows = vec![None; code.slots];
    for (row, (slot, _)) in (0..).zip(constants(code)) {
        rows[slot.index()] = Some(row);
    }
    rows
}

/// The table, for values of the prelude.
pub(crate) fn table(code: &Code, prelude: &[f64]) -> Vec<f64> {
    let value = |(_, leaf): (Slot, Leaf)| match leaf {
        Leaf::Constant(value) => value,
        Leaf::Prelude(row) => prelude[row],
        Leaf::Argument { .. } | Leaf::Parameter(_) => unreachable!("no constants of a routine"),
    };
    constants(code).map(value).collect()
}
