//! Steps of straight-line code as the processor has them.

use super::calls::Callee;

/// A value of several samples: a leaf, or assigned by one step.
pub(super) type Value = u32;

/// Where a value is from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    /// A step assigns it.
    Step,
    /// A row of the table of constants.
    Constant(u32),
    /// A column of the arguments.
    Column(u32),
}

/// What comparisons ask; the processor's numbers. None holds of NaN, but the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Comparison {
    Equal = 0x00,
    Less = 0x11,
    LessEqual = 0x12,
    Greater = 0x1e,
    NotGreater = 0x1a,
}

/// What a step does, with the number of its operands.
#[derive(Clone, Copy, Debug)]
pub(super) enum Operation {
    /// a + b
    Add,
    /// a - b
    Sub,
    /// a b
    Mul,
    /// a / b
    Div,
    /// The square root.
    Sqrt,
    /// a b + c, rounded once
    MulAdd,
    /// a b - c, rounded once
    MulSub,
    /// c - a b, rounded once
    NegMulAdd,
    /// Bits that both have.
    And,
    /// Bits that one of both has.
    Xor,
    /// The sum of the bits as integers.
    AddBits,
    /// Bits moved up.
    ShiftLeft(u8),
    /// Of eight: the bits of a, changed where both b and c have ones.
    XorAnd,
    /// Of four: all bits where a is to b as asked, else none.
    Compare(Comparison),
    /// Of four: b where a has its highest bit, else c.
    Choose,
    /// Of eight: c where a is to b as asked, else d.
    Select(Comparison),
    /// Of eight: remembers in a mask where a and b have a bit in common.
    Test(u8),
    /// Of eight: a where the mask is set, else b.
    ChooseBy(u8),
    /// Remembers that an angle is not ordinary. Of eight: unless a is not greater than b; of four:
    /// where a has its highest bit.
    Watch,
    /// Writes a to a column of the results.
    Store(u32),
    /// Calls the runtime with one or two values.
    Call(Callee),
}

/// One step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub(super) operation: Operation,
    operands: [Value; 4],
    count: u8,
    /// The value that it assigns; calls may assign two.
    pub(super) results: [Option<Value>; 2],
}

impl Step {
    pub(super) fn new(
        operation: Operation,
        operands: &[Value],
        results: [Option<Value>; 2],
    ) -> Self {
        let mut own = [0; 4];
        own[..operands.len()].copy_from_slice(operands);
        Self { operation, operands: own, count: operands.len() as u8, results }
    }

    pub(super) fn operands(&self) -> &[Value] {
        &self.operands[..usize::from(self.count)]
    }

    /// Whether the step matters beyond its results.
    fn has_effect(&self) -> bool {
        matches!(self.operation, Operation::Watch | Operation::Store(_) | Operation::Test(_))
    }
}

/// A routine as steps.
#[derive(Debug, Default)]
pub(super) struct Straight {
    pub(super) steps: Vec<Step>,
    /// Of each value.
    pub(super) sources: Vec<Source>,
    pub(super) constants: Vec<f64>,
    /// Whether angles are watched.
    pub(super) watches: bool,
}

impl Straight {
    pub(super) fn value(&mut self, source: Source) -> Value {
        self.sources.push(source);
        u32::try_from(self.sources.len() - 1).expect("fewer than 2^32 values")
    }

    /// Leaves out steps whose results nobody uses.
    pub(super) fn drop_unused(&mut self) {
        let mut is_used = vec![false; self.sources.len()];
        let mut kept = Vec::with_capacity(self.steps.len());
        for step in self.steps.drain(..).rev() {
            let is_wanted = |result: &Option<Value>| result.is_some_and(|r| is_used[r as usize]);
            if step.has_effect() || step.results.iter().any(is_wanted) {
                step.operands().iter().for_each(|&operand| is_used[operand as usize] = true);
                kept.push(step);
            }
        }
        kept.reverse();
        self.steps = kept;
    }
}
