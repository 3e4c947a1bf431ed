//! Which values are in registers, and which in the scratch memory.

use super::assemble::{FIRST_SLOT, Place};
use super::steps::{Source, Straight, Value};

/// A value that is not used any more.
pub(super) const NEVER: u32 = u32::MAX;

/// When values are used next.
pub(super) struct Uses {
    /// By operand of all steps, one after the other: the step that uses the value after this one.
    after: Vec<u32>,
    /// By value: the next step that uses it.
    pub(super) next: Vec<u32>,
    read: usize,
}

impl Uses {
    pub(super) fn new(straight: &Straight) -> Self {
        let count = straight.steps.iter().map(|step| step.operands().len()).sum();
        let mut after = vec![NEVER; count];
        let mut next = vec![NEVER; straight.sources.len()];
        let mut end = count;
        for (at, step) in straight.steps.iter().enumerate().rev() {
            let at = u32::try_from(at).expect("fewer than 2^32 steps");
            let operands = step.operands();
            end -= operands.len();
            for (after, &operand) in after[end..].iter_mut().zip(operands) {
                *after = next[operand as usize];
            }
            operands.iter().for_each(|&operand| next[operand as usize] = at);
        }
        Self { after, next, read: 0 }
    }

    /// Goes beyond the next step, whose operands these are.
    pub(super) fn pass(&mut self, operands: &[Value]) {
        for &operand in operands {
            self.next[operand as usize] = self.after[self.read];
            self.read += 1;
        }
    }

    fn of(&self, value: Value) -> u32 {
        self.next[value as usize]
    }
}

/// No register, or no slot.
const NONE: u32 = u32::MAX;

/// The vector registers and the slots.
pub(super) struct Registers {
    /// By register.
    pub(super) holds: Vec<Option<Value>>,
    /// By value.
    register: Vec<u32>,
    slot: Vec<u32>,
    free_slots: Vec<u32>,
    pub(super) slots: u32,
    /// Registers that the current step needs, bit by bit.
    pinned: u32,
}

impl Registers {
    pub(super) fn new(count: u8, values: usize) -> Self {
        Self {
            holds: vec![None; usize::from(count)],
            register: vec![NONE; values],
            slot: vec![NONE; values],
            free_slots: Vec::new(),
            slots: FIRST_SLOT,
            pinned: 0,
        }
    }

    /// The register of a value that is in one.
    pub(super) fn register(&self, value: Value) -> Option<u8> {
        u8::try_from(self.register[value as usize]).ok()
    }

    /// Where a value is in memory, if it is.
    pub(super) fn memory(&self, value: Value, source: Source) -> Option<Place> {
        match source {
            Source::Constant(row) => Some(Place::Table(row)),
            _ if self.slot[value as usize] != NONE => {
                Some(Place::Scratch(self.slot[value as usize]))
            }
            Source::Column(column) => Some(Place::Column(column)),
            Source::Step => None,
        }
    }

    /// Begins a step: registers of these values stay.
    pub(super) fn pin(&mut self, operands: &[Value]) {
        self.pinned = 0;
        for &operand in operands {
            self.pinned |= self.register(operand).map_or(0, |register| 1 << register);
        }
    }

    /// The register to take for a value: a free one, or that of the value that is used last.
    pub(super) fn candidate(&self, uses: &Uses) -> u8 {
        let mut best = None;
        for (register, held) in (0_u8..).zip(&self.holds) {
            let Some(value) = *held else { return register };
            let when = uses.of(value);
            let is_pinned = self.pinned & (1 << register) != 0;
            if !is_pinned && best.is_none_or(|(_, latest)| when > latest) {
                best = Some((register, when));
            }
        }
        best.expect("no step needs all registers").0
    }

    /// Puts a value in a register, in the place of what was there.
    pub(super) fn put(&mut self, register: u8, value: Value) {
        self.empty(register);
        self.holds[usize::from(register)] = Some(value);
        self.register[value as usize] = u32::from(register);
        self.pinned |= 1 << register;
    }

    pub(super) fn empty(&mut self, register: u8) {
        if let Some(old) = self.holds[usize::from(register)].take() {
            self.register[old as usize] = NONE;
        }
    }

    /// A slot for a value.
    pub(super) fn give_slot(&mut self, value: Value) -> u32 {
        let slot = self.free_slots.pop().unwrap_or_else(|| {
            self.slots += 1;
            self.slots - 1
        });
        self.slot[value as usize] = slot;
        slot
    }

    /// Takes the slot of a value that is not used any more.
    pub(super) fn free_slot(&mut self, value: Value) {
        let slot = std::mem::replace(&mut self.slot[value as usize], NONE);
        if slot != NONE {
            self.free_slots.push(slot);
        }
    }
}
