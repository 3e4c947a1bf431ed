//! The statements of a function: straight-line code as text.
//!
//! A value that is used once is written where it is used while the line stays short; every other
//! one gets a name. The operations and their order of evaluation are those of the code, whatever
//! the language is.

mod sines;

use self::sines::name_sines;
use super::names::Names;
use super::syntax::{Binding, Call, Syntax, Term};
use crate::arena::Handle;
use crate::program::{BinaryOperation, Code, Instruction, Leaf, Operation, Slot, UnaryOperation};
use std::ops::Range;

/// Longest right side of a declaration; the line stays within 100 columns.
const LONGEST: usize = 72;

/// Longest statement, without its indentation.
const LONGEST_LINE: usize = 92;

/// How the leaves of code are written, and which values have a name of their own.
pub(super) struct Vocabulary {
    /// The names that no value may take.
    pub(super) names: Names,
    /// The text of each leaf that is no constant, by slot.
    pub(super) leaves: Vec<Option<String>>,
    /// The names of values that have one: fields of the prelude.
    pub(super) named: Vec<Option<String>>,
    /// Entries of arrays, by slot, that are assigned as soon as their value is there; without them
    /// outputs are read when all is done.
    pub(super) entries: Vec<Vec<String>>,
}

/// Writes the statements of one code.
pub(super) struct Body<'a> {
    code: &'a Code,
    syntax: &'a dyn Syntax,
    terms: Vec<Option<Term>>,
    /// Values that wait to be written where they are used.
    waiting: Vec<Option<Term>>,
    named: Vec<Option<String>>,
    entries: Vec<Vec<String>>,
    names: Names,
    uses: Vec<u32>,
    /// The instruction that uses a slot last; `usize::MAX` for an output that is read at the end.
    last_use: Vec<Option<usize>>,
    next: usize,
    /// The statement that declares each constant.
    constants: Vec<Option<String>>,
    declared: Vec<bool>,
    lines: Vec<String>,
}

impl<'a> Body<'a> {
    pub(super) fn new(code: &'a Code, syntax: &'a dyn Syntax, vocabulary: Vocabulary) -> Self {
        let Vocabulary { mut names, leaves, mut named, entries } = vocabulary;
        let mut terms = vec![None; code.slots];
        let mut constants = vec![None; code.slots];
        for (slot, leaf) in code.leaves.iter() {
            let text = match leaf {
                Leaf::Constant(value) => {
                    let (name, declaration) = constant(*value, syntax, &mut names);
                    constants[slot.index()] = Some(declaration);
                    name
                }
                _ => leaves[slot.index()].clone().expect("each leaf has a text"),
            };
            terms[slot.index()] = Some(Term::atom(text));
        }
        name_sines(code, &mut names, &mut named);
        let mut last_use = vec![None; code.slots];
        for (index, instruction) in code.instructions.iter().enumerate() {
            instruction.for_each_operand(|operand| last_use[operand.index()] = Some(index));
        }
        for output in code.outputs.iter().filter(|output| entries[output.index()].is_empty()) {
            last_use[output.index()] = Some(usize::MAX);
        }
        Self {
            code,
            syntax,
            terms,
            waiting: vec![None; code.slots],
            named,
            entries,
            names,
            uses: code.uses(),
            last_use,
            next: 1,
            constants,
            declared: vec![false; code.slots],
            lines: Vec::new(),
        }
    }

    /// Writes all instructions: as they are, or in blocks, where the language has a longest one,
    /// that hand on what is used after them.
    pub(super) fn write_all(&mut self) {
        let (length, longest) = (self.code.instructions.len(), self.syntax.longest_block());
        if length <= longest {
            self.write(0..length);
            return;
        }
        let mut statements = Vec::new();
        for start in (0..length).step_by(longest) {
            let block = start..length.min(start + longest);
            self.write(block.clone());
            let lines = self.take_lines();
            let slots = self.used_after(block).into_iter();
            let names: Vec<String> = slots.map(|slot| self.text(slot).to_owned()).collect();
            statements.extend(self.syntax.block(lines, &names));
        }
        self.lines = statements;
    }

    /// Whether the code is written in blocks.
    pub(super) fn is_in_blocks(&self) -> bool {
        self.code.instructions.len() > self.syntax.longest_block()
    }

    /// The slots assigned in a range and used after it.
    fn used_after(&self, range: Range<usize>) -> Vec<Slot> {
        let mut slots = Vec::new();
        for instruction in &self.code.instructions[range.clone()] {
            instruction.for_each_result(|slot| {
                let is_used = self.last_use[slot.index()].is_some_and(|last| last >= range.end);
                slots.extend(is_used.then_some(slot));
            });
        }
        slots
    }

    /// Writes the instructions of a range; what is used after it gets a name.
    fn write(&mut self, range: Range<usize>) {
        let mut next = range.start;
        while next < range.end {
            let turns = self.turns(next..range.end);
            if !turns.is_empty() {
                self.sincos(&turns);
                next += turns.len();
                continue;
            }
            let instruction = self.code.instructions[next];
            next += 1;
            instruction.for_each_operand(|operand| self.declare(operand));
            match instruction {
                Instruction::SinCos { .. } => unreachable!("it is one of the turns"),
                Instruction::Value { result, operation } => {
                    let term = self.term(&operation);
                    let slot = result.index();
                    let used_here = self.last_use[slot].is_some_and(|last| last < range.end);
                    let may_wait = self.uses[slot] == 1 && used_here && self.named[slot].is_none();
                    if let Some(line) = self.entry_line(result, &term) {
                        self.lines.push(line);
                    } else if may_wait && term.text.len() <= LONGEST / 2 {
                        self.waiting[slot] = Some(term);
                    } else {
                        self.assign(result, &term);
                        self.store(result);
                    }
                }
            }
        }
    }

    /// The statement that assigns a value to the one entry that it is for; none if it is used
    /// elsewhere too, or if the line would become too long.
    fn entry_line(&self, slot: Slot, term: &Term) -> Option<String> {
        match &self.entries[slot.index()][..] {
            [entry] if self.uses[slot.index()] == 1 => {
                let line = self.syntax.store(entry, term);
                (line.len() <= LONGEST_LINE).then_some(line)
            }
            _ => None,
        }
    }

    /// Stores the numbers and arguments among the outputs: they are there from the start.
    pub(super) fn store_leaves(&mut self) {
        let code = self.code;
        let leaves = code.outputs.iter().filter(|slot| slot.index() < code.leaves.len());
        leaves.for_each(|&slot| self.store(slot));
    }

    /// Assigns a value that has a text to its entries.
    fn store(&mut self, slot: Slot) {
        for entry in std::mem::take(&mut self.entries[slot.index()]) {
            self.declare(slot);
            let line = self.syntax.store(&entry, self.known(slot));
            self.lines.push(line);
        }
    }

    /// The statements written since the last call. Constants are declared anew after it.
    pub(super) fn take_lines(&mut self) -> Vec<String> {
        self.declared.fill(false);
        std::mem::take(&mut self.lines)
    }

    /// Declares a constant, if the slot is one and is not declared yet.
    pub(super) fn declare(&mut self, slot: Slot) {
        if let Some(declaration) = &self.constants[slot.index()]
            && !std::mem::replace(&mut self.declared[slot.index()], true)
        {
            self.lines.push(declaration.clone());
        }
    }

    /// The text of a value that is there.
    pub(super) fn text(&self, slot: Slot) -> &str {
        &self.known(slot).text
    }

    fn known(&self, slot: Slot) -> &Term {
        self.terms[slot.index()].as_ref().expect("values are assigned before their use")
    }

    fn term(&mut self, operation: &Operation) -> Term {
        match *operation {
            Operation::Unary(function, a) => self.unary(function, a),
            Operation::Binary(function, a, b) => self.binary(function, a, b),
            Operation::Fused(function, operands) => {
                let operands = self.operands(operands, 20, Binding::Atom);
                self.call(Call::Fused(function), &operands)
            }
            Operation::Select { relation, sides, then, otherwise } => {
                let operands = [sides[0], sides[1], then, otherwise];
                let operands = self.operands(operands, 30, Binding::Sum);
                self.call(Call::Select(relation), &operands)
            }
        }
    }

    fn call(&self, call: Call, operands: &[Term]) -> Term {
        Term::atom(self.syntax.call(call, operands))
    }

    fn unary(&mut self, function: UnaryOperation, a: Slot) -> Term {
        if function == UnaryOperation::Neg {
            let [a] = self.operands([a], 3, Binding::Sign);
            // Two signs in a row read badly; the laws leave none.
            let text = format!("-{}", a.within(Binding::Atom));
            return Term { text, binding: Binding::Sign };
        }
        let operands = self.operands([a], 22, Binding::Atom);
        self.call(Call::Unary(function), &operands)
    }

    fn binary(&mut self, function: BinaryOperation, a: Slot, b: Slot) -> Term {
        let (symbol, binding) = match function {
            BinaryOperation::Add => ("+", Binding::Sum),
            BinaryOperation::Sub => ("-", Binding::Sum),
            BinaryOperation::Mul => ("*", Binding::Product),
            BinaryOperation::Div => ("/", Binding::Product),
            BinaryOperation::Atan2 | BinaryOperation::Min | BinaryOperation::Max => {
                let operands = self.operands([a, b], 20, Binding::Atom);
                return self.call(Call::Binary(function), &operands);
            }
        };
        let [mut a, mut b] = self.operands([a, b], 7, binding);
        // Operators of one kind group to the left: brackets on the right side only. Products and
        // sums commute, bit by bit, so that most brackets go.
        let tighter = if binding == Binding::Sum { Binding::Product } else { Binding::Sign };
        let commutes = matches!(function, BinaryOperation::Add | BinaryOperation::Mul);
        if commutes && b.binding < tighter && a.binding >= tighter {
            std::mem::swap(&mut a, &mut b);
        }
        let mut text = String::with_capacity(a.text.len() + b.text.len() + 7);
        a.write(binding, &mut text);
        text.extend([" ", symbol, " "]);
        b.write(tighter, &mut text);
        Term { text, binding }
    }

    /// The operands' texts; those that wait are taken, or assigned first if the line would become
    /// too long or have brackets within brackets.
    fn operands<const N: usize>(
        &mut self,
        slots: [Slot; N],
        extra: usize,
        binding: Binding,
    ) -> [Term; N] {
        loop {
            let waiting = |slot: &Slot| self.waiting[slot.index()].as_ref();
            let length = |slot: &Slot| match waiting(slot) {
                Some(term) => term.text.len(),
                None => self.text(*slot).len(),
            };
            let nested = slots.iter().find(|slot| {
                waiting(slot).is_some_and(|term| {
                    term.text.contains('(') && (term.binding <= binding || extra > 7)
                })
            });
            let too_long = extra + slots.iter().map(length).sum::<usize>() > LONGEST;
            let longest = slots
                .iter()
                .filter(|slot| too_long && waiting(slot).is_some())
                .max_by_key(|slot| length(slot));
            let Some(&slot) = nested.or(longest) else { break };
            let term = self.waiting[slot.index()].take().expect("it was found waiting");
            self.assign(slot, &term);
        }
        slots.map(|slot| {
            let waiting = self.waiting[slot.index()].take();
            waiting.unwrap_or_else(|| Term::atom(self.text(slot).to_owned()))
        })
    }

    fn assign(&mut self, slot: Slot, term: &Term) {
        let name = self.name(slot);
        self.lines.push(self.syntax.declare(&name, &term.text));
    }

    /// The name of a slot; makes it readable by that name.
    fn name(&mut self, slot: Slot) -> String {
        let name = match self.named[slot.index()].take() {
            Some(name) => name,
            None => {
                // Numbers are given once; only the names given before can be in the way.
                let mut numbered = (self.next..).map(|number| (number, format!("t{number}")));
                let free = numbered.find(|(_, name)| self.names.is_free(name));
                let (number, name) = free.expect("numbers do not end");
                self.next = number + 1;
                name
            }
        };
        self.terms[slot.index()] = Some(Term::atom(name.clone()));
        name
    }
}

/// The name of a constant, and the statement that declares it.
fn constant(value: f64, syntax: &dyn Syntax, names: &mut Names) -> (String, String) {
    // The sign of a zero is part of its value.
    let known = match value.to_bits() {
        0 => Some("zero"),
        0x3ff0_0000_0000_0000 => Some("one"),
        _ => None,
    };
    let numbered = (1..).map(|number| format!("k{number}"));
    let mut candidates = known.map(str::to_owned).into_iter().chain(numbered);
    let name = candidates.find(|name| names.claim(name)).expect("numbers do not end");
    let declaration = syntax.declare(&name, &syntax.constant(value));
    (name, declaration)
}
