//! The statements of a function: straight-line code as text.
//!
//! A value that is used once is written where it is used while the line stays short; every other
//! one gets a `let`. The operations and their order of evaluation are those of the code.

mod sines;

use self::sines::name_sines;
use super::arrays::{Place, list};
use super::names::Names;
use crate::arena::Handle;
use crate::expr::Relation;
use crate::program::{
    BinaryOperation, Code, FusedOperation, Instruction, Leaf, Operation, Slot, UnaryOperation,
};
use std::ops::Range;

/// Longest right side of a `let`; the line stays within 100 columns.
const LONGEST: usize = 72;

/// Longest statement, without its indentation.
const LONGEST_LINE: usize = 92;

/// Most instructions in one block.
const BLOCK: usize = 2_000;

/// How tightly the outermost operation of a text binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Sign,
    Atom,
}

/// A value as text.
#[derive(Clone, Debug)]
struct Term {
    text: String,
    binding: Binding,
}

impl Term {
    fn atom(text: String) -> Self {
        Self { text, binding: Binding::Atom }
    }

    /// Appends the text, in brackets if it binds less tightly than `least`.
    fn write(&self, least: Binding, to: &mut String) {
        match self.binding < least {
            true => to.extend(["(", &self.text, ")"]),
            false => to.push_str(&self.text),
        }
    }

    /// The text, in brackets if it binds less tightly than `least`.
    fn within(&self, least: Binding) -> String {
        let mut text = String::with_capacity(self.text.len() + 2);
        self.write(least, &mut text);
        text
    }
}

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
    pub(super) fn new(code: &'a Code, vocabulary: Vocabulary) -> Self {
        let Vocabulary { mut names, leaves, mut named, entries } = vocabulary;
        let mut terms = vec![None; code.slots];
        let mut constants = vec![None; code.slots];
        for (slot, leaf) in code.leaves.iter() {
            let text = match leaf {
                Leaf::Constant(value) => {
                    let (name, declaration) = constant(*value, &mut names);
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

    /// Writes all instructions: as they are, or in blocks of [`BLOCK`] that hand on what is used
    /// after them. Each `let` opens a scope within that of the one before, and rustc runs out of
    /// stack where some 2500 are nested (1.95, with debug information).
    pub(super) fn write_all(&mut self) {
        let length = self.code.instructions.len();
        if length <= BLOCK {
            self.write(0..length);
            return;
        }
        let mut statements = Vec::new();
        for start in (0..length).step_by(BLOCK) {
            let block = start..length.min(start + BLOCK);
            self.write(block.clone());
            let lines = self.take_lines();
            let slots = self.used_after(block).into_iter();
            let names: Vec<_> = slots.map(|slot| vec![self.text(slot).to_owned()]).collect();
            if names.is_empty() {
                statements.push("{".to_owned());
                statements.extend(lines.iter().map(|line| format!("    {line}")));
                statements.push("}".to_owned());
                continue;
            }
            let names = list(names, Place { indent: 8, followed: true });
            statements.push(format!("let {} = {{", names.join("\n")));
            statements.extend(lines.iter().chain(&names).map(|line| format!("    {line}")));
            statements.push("};".to_owned());
        }
        self.lines = statements;
    }

    /// Whether the code is written in blocks.
    pub(super) fn is_in_blocks(&self) -> bool {
        self.code.instructions.len() > BLOCK
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
                let line = format!("{entry} = {};", term.text);
                (line.len() <= LONGEST_LINE).then_some(line)
            }
            _ => None,
        }
    }

    /// Assigns a value that has a text to its entries.
    pub(super) fn store(&mut self, slot: Slot) {
        for entry in std::mem::take(&mut self.entries[slot.index()]) {
            self.declare(slot);
            let line = format!("{entry} = {};", self.text(slot));
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
        &self.terms[slot.index()].as_ref().expect("values are assigned before their use").text
    }

    fn term(&mut self, operation: &Operation) -> Term {
        match *operation {
            Operation::Unary(function, a) => self.unary(function, a),
            Operation::Binary(function, a, b) => self.binary(function, a, b),
            Operation::Fused(function, operands) => {
                let name = match function {
                    FusedOperation::ProductPlus => "product_plus",
                    FusedOperation::ProductMinus => "product_minus",
                    FusedOperation::MinusProduct => "minus_product",
                };
                let [a, b, c] = self.operands(operands, 20, Binding::Atom);
                let a = a.within(Binding::Atom);
                Term::atom(format!("{a}.{name}({}, {})", b.text, c.text))
            }
            Operation::Select { relation, sides, then, otherwise } => {
                let operands = [sides[0], sides[1], then, otherwise];
                let all = self.operands(operands, 30, Binding::Sum).map(|term| term.text);
                let name = match relation {
                    Relation::Less => "select_less",
                    Relation::LessEqual => "select_less_equal",
                    Relation::Equal => "select_equal",
                };
                Term::atom(format!("S::{name}({})", all.join(", ")))
            }
        }
    }

    fn unary(&mut self, function: UnaryOperation, a: Slot) -> Term {
        let method = match function {
            UnaryOperation::Neg => {
                let [a] = self.operands([a], 3, Binding::Sign);
                // Two signs in a row read badly; the laws leave none.
                let text = format!("-{}", a.within(Binding::Atom));
                return Term { text, binding: Binding::Sign };
            }
            UnaryOperation::Tan => "tangent",
            UnaryOperation::Sqrt => "sqrt",
            UnaryOperation::Exp => "exponential",
            UnaryOperation::Log => "logarithm",
            UnaryOperation::Tanh => "hyperbolic_tangent",
            UnaryOperation::Abs => "abs",
            UnaryOperation::Sign => "sign",
        };
        let [a] = self.operands([a], 22, Binding::Atom);
        Term::atom(format!("{}.{method}()", a.within(Binding::Atom)))
    }

    fn binary(&mut self, function: BinaryOperation, a: Slot, b: Slot) -> Term {
        let (symbol, binding) = match function {
            BinaryOperation::Add => ("+", Binding::Sum),
            BinaryOperation::Sub => ("-", Binding::Sum),
            BinaryOperation::Mul => ("*", Binding::Product),
            BinaryOperation::Div => ("/", Binding::Product),
            BinaryOperation::Atan2 => return self.method("arctangent2", a, b),
            BinaryOperation::Min => return self.method("lesser", a, b),
            BinaryOperation::Max => return self.method("greater", a, b),
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

    fn method(&mut self, name: &str, a: Slot, b: Slot) -> Term {
        let [a, b] = self.operands([a, b], 20, Binding::Atom);
        Term::atom(format!("{}.{name}({})", a.within(Binding::Atom), b.text))
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
        self.lines.push(["let ", &name, " = ", &term.text, ";"].concat());
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
fn constant(value: f64, names: &mut Names) -> (String, String) {
    // The sign of a zero is part of its value.
    let (known, value) = match value.to_bits() {
        0 => (Some("zero"), "S::ZERO".to_owned()),
        0x3ff0_0000_0000_0000 => (Some("one"), "S::ONE".to_owned()),
        _ => (None, format!("S::from_f64({value:?})")),
    };
    let numbered = (1..).map(|number| format!("k{number}"));
    let mut candidates = known.map(str::to_owned).into_iter().chain(numbered);
    let name = candidates.find(|name| names.claim(name)).expect("numbers do not end");
    let declaration = format!("let {name} = {value};");
    (name, declaration)
}
