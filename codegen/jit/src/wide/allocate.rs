//! Gives values registers, step by step, and writes the instructions.
//!
//! Where all registers are taken, the value that is used last of all goes to memory (Belady): code
//! without branches knows all uses. Constants and columns of the arguments are in memory anyhow,
//! and so are values that went there once. Most instructions read one operand from memory.

use super::arithmetic::Form;
use super::assemble::{Assembler, OPERANDS, Place};
use super::calls::Callee;
use super::registers::{NEVER, Registers, Uses};
use super::steps::{Operation, Source, Step, Straight, Value};

/// Writes a function of these steps; the number of slots that it needs.
pub(super) fn assemble(straight: &Straight, assembler: &mut Assembler) -> usize {
    let values = straight.sources.len();
    let registers = Registers::new(assembler.registers(), values);
    let uses = Uses::new(straight);
    let blocks = assembler.begin(straight.watches);
    let mut allocation = Allocation { straight, assembler, registers, uses };
    for step in &straight.steps {
        allocation.step(step);
    }
    let slots = allocation.registers.slots as usize;
    assembler.end(blocks);
    slots
}

struct Allocation<'a> {
    straight: &'a Straight,
    assembler: &'a mut Assembler,
    registers: Registers,
    uses: Uses,
}

impl Allocation<'_> {
    fn step(&mut self, step: &Step) {
        let operands = step.operands();
        self.registers.pin(operands);
        self.uses.pass(operands);
        match step.operation {
            Operation::Call(callee) => self.call(callee, step),
            Operation::Watch => self.watch(operands),
            Operation::Store(column) => {
                let from = self.in_register(operands[0]);
                self.assembler.store_column(from, column);
            }
            Operation::Test(mask) => {
                let a = self.in_register(operands[0]);
                let b = self.place(operands[1]);
                self.assembler.test_bits(mask, a, b);
            }
            _ => self.compute(step.operation, operands, step.results[0].expect("a result")),
        }
        for &value in operands.iter().chain(step.results.iter().flatten()) {
            if self.is_dead(value) {
                self.leave_register(value);
                // Not before: the step may have read it there, and what it displaced is elsewhere.
                self.registers.free_slot(value);
            }
        }
    }

    fn is_dead(&self, value: Value) -> bool {
        self.uses.next[value as usize] == NEVER
    }

    fn source(&self, value: Value) -> Source {
        self.straight.sources[value as usize]
    }

    fn leave_register(&mut self, value: Value) {
        if let Some(register) = self.registers.register(value) {
            self.registers.empty(register);
        }
    }

    /// Makes a register free for a value.
    fn take(&mut self, value: Value) -> u8 {
        let register = self.registers.candidate(&self.uses);
        if let Some(old) = self.registers.holds[usize::from(register)] {
            self.save(old, register);
        }
        self.registers.put(register, value);
        register
    }

    /// Sees that a value is in memory before it leaves its register.
    fn save(&mut self, value: Value, register: u8) {
        let is_there = match self.registers.memory(value, self.source(value)) {
            None => false,
            // Rows are read once: that takes as long as several numbers.
            Some(Place::Column(_)) => self.assembler.reads_columns(),
            Some(_) => true,
        };
        if !is_there {
            let slot = self.registers.give_slot(value);
            self.assembler.keep(register, slot);
        }
    }

    fn memory(&self, value: Value) -> Place {
        let memory = self.registers.memory(value, self.source(value));
        memory.expect("what is used is in a register or in memory")
    }

    /// The register of an operand.
    fn in_register(&mut self, value: Value) -> u8 {
        if let Some(register) = self.registers.register(value) {
            return register;
        }
        let memory = self.memory(value);
        let register = self.take(value);
        self.assembler.load(register, memory);
        register
    }

    /// The place of an operand that may be in memory. It gets a register if it is used again before
    /// the value that would have to leave it; constants are many, and read as fast.
    fn place(&mut self, value: Value) -> Place {
        if let Some(register) = self.registers.register(value) {
            return Place::Register(register);
        }
        let memory = self.memory(value);
        if matches!(memory, Place::Column(_)) && !self.assembler.reads_columns() {
            return Place::Register(self.in_register(value));
        }
        let is_constant = matches!(memory, Place::Table(_));
        let candidate = self.registers.candidate(&self.uses);
        let held = self.registers.holds[usize::from(candidate)];
        let until = held.map_or(NEVER, |held| self.uses.next[held as usize]);
        if is_constant || self.uses.next[value as usize] >= until {
            return memory;
        }
        Place::Register(self.in_register(value))
    }

    fn is_in_register(&self, value: Value) -> bool {
        self.registers.register(value).is_some()
    }

    /// Operands that may change places: the first one in a register, if one of them is.
    fn ordered(&self, a: Value, b: Value) -> (Value, Value) {
        if self.is_in_register(b) && !self.is_in_register(a) { (b, a) } else { (a, b) }
    }

    /// The register of the result, when all operands are where they are read.
    fn result(&mut self, operands: &[Value], result: Value) -> u8 {
        for &operand in operands {
            if self.is_dead(operand) {
                self.leave_register(operand);
            }
        }
        self.take(result)
    }

    fn compute(&mut self, operation: Operation, operands: &[Value], result: Value) {
        match operation {
            Operation::Add | Operation::Mul | Operation::And | Operation::Xor => {
                let (a, b) = self.ordered(operands[0], operands[1]);
                self.binary(operation, a, b, operands, result);
            }
            Operation::Sub | Operation::Div | Operation::AddBits | Operation::Compare(_) => {
                self.binary(operation, operands[0], operands[1], operands, result);
            }
            Operation::Sqrt => {
                let a = self.place(operands[0]);
                let to = self.result(operands, result);
                self.assembler.square_root(to, a);
            }
            Operation::ShiftLeft(bits) => {
                let a = self.in_register(operands[0]);
                let to = self.result(operands, result);
                self.assembler.shift_left(to, a, bits);
            }
            Operation::MulAdd | Operation::MulSub | Operation::NegMulAdd => {
                self.fused(operation, operands, result);
            }
            Operation::XorAnd => {
                let a = self.in_register(operands[1]);
                let b = self.place(operands[2]);
                let to = self.overwritten(operands[0], result);
                self.assembler.xor_and(to, a, b);
            }
            Operation::Choose => {
                let mask = self.in_register(operands[0]);
                let b = self.in_register(operands[2]);
                let a = self.place(operands[1]);
                let to = self.result(operands, result);
                self.assembler.choose(to, mask, a, b);
            }
            Operation::ChooseBy(mask) => {
                let b = self.in_register(operands[1]);
                let a = self.place(operands[0]);
                let to = self.result(operands, result);
                self.assembler.choose_by(Some(mask), to, a, b);
            }
            Operation::Select(comparison) => {
                let left = self.in_register(operands[0]);
                let right = self.place(operands[1]);
                let otherwise = self.in_register(operands[3]);
                let then = self.place(operands[2]);
                self.assembler.test_comparison(comparison, left, right);
                let to = self.result(operands, result);
                self.assembler.choose_by(None, to, then, otherwise);
            }
            Operation::Watch | Operation::Store(_) | Operation::Test(_) | Operation::Call(_) => {
                unreachable!("no value is computed")
            }
        }
    }

    fn binary(&mut self, operation: Operation, a: Value, b: Value, all: &[Value], result: Value) {
        let left = self.in_register(a);
        let right = self.place(b);
        let to = self.result(all, result);
        match operation {
            Operation::Compare(comparison) => self.assembler.compare(comparison, to, left, right),
            _ => self.assembler.binary(operation, to, left, right),
        }
    }

    /// A register with the value of an operand that the instruction overwrites with its result: its
    /// own where that is not needed any more, else a copy.
    fn overwritten(&mut self, operand: Value, result: Value) -> u8 {
        match self.registers.register(operand) {
            Some(register) if self.is_dead(operand) => {
                self.registers.put(register, result);
                register
            }
            Some(register) => {
                let to = self.take(result);
                self.assembler.load(to, Place::Register(register));
                to
            }
            None => {
                let memory = self.memory(operand);
                let to = self.take(result);
                self.assembler.load(to, memory);
                to
            }
        }
    }

    /// a b + c and its kin. The instruction overwrites one operand: if one is in a register for the
    /// last time that one, else one that has to be read from memory, else c.
    fn fused(&mut self, operation: Operation, operands: &[Value], result: Value) {
        let [a, b, c] = [operands[0], operands[1], operands[2]];
        let dies = |this: &Self, value| this.is_in_register(value) && this.is_dead(value);
        let all = [c, a, b];
        let dying = all.into_iter().find(|&value| dies(self, value));
        let distant = || all.into_iter().find(|&value| !self.is_in_register(value));
        let over = dying.or_else(distant).unwrap_or(c);
        let (form, middle, last) = if over == c {
            let (a, b) = self.ordered(a, b);
            (Form::F231, a, b)
        } else {
            let other = if over == a { b } else { a };
            match self.is_in_register(other) {
                true => (Form::F213, other, c),
                false => (Form::F132, c, other),
            }
        };
        let middle = self.in_register(middle);
        let last = self.place(last);
        let to = self.overwritten(over, result);
        self.assembler.fused(operation, form, to, middle, last);
    }

    fn watch(&mut self, operands: &[Value]) {
        let a = self.in_register(operands[0]);
        match operands.get(1) {
            Some(&limit) => {
                let limit = self.place(limit);
                self.assembler.watch_order(a, limit);
            }
            None => self.assembler.watch_bit(a),
        }
    }

    /// Operands and results are in memory, and no register keeps its value.
    fn call(&mut self, callee: Callee, step: &Step) {
        for (&operand, slot) in step.operands().iter().zip(OPERANDS) {
            let register = self.in_register(operand);
            self.assembler.keep(register, slot);
        }
        for register in 0..self.assembler.registers() {
            if let Some(value) = self.registers.holds[usize::from(register)] {
                if !self.is_dead(value) {
                    self.save(value, register);
                }
                self.registers.empty(register);
            }
        }
        let slots = step
            .results
            .map(|result| result.map_or(OPERANDS[1], |result| self.registers.give_slot(result)));
        self.assembler.call(callee, slots, self.straight.watches);
    }
}
