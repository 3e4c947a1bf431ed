//! Straight-line code: what functions become before they are counted, interpreted or emitted.
//!
//! - [`lower`]: expressions to code; what depends on parameters alone goes to one shared prelude
//! - [`schedule`]: an order of the instructions in which values are short-lived
//! - [`fuse`]: products and the sums that they go into as one operation, where that is wanted
//! - [`verify`]: each slot defined once and before its use; called after each pass, in all profiles
//! - [`counts`]: what a call costs
//! - [`Lowered`]: a robot's functions as code, in one call, with what each costs
//! - [`States`]: the functions of a robot as numbers, in given states
//! - [`Evaluator`]: the reference interpreter; [`BatchEvaluator`]: many samples at once
//! - [`Evaluate`], [`EvaluateBatch`]: what they and compiled code have in common
//!
//! A program is the first stage that holds floats: constants are the nearest `f64` of the exact
//! ones. Nothing is decided by their values.

mod batch;
mod cost;
mod evaluate;
mod fuse;
mod interpret;
mod lower;
mod lowered;
mod passes;
mod renumber;
mod schedule;
mod sign;
mod states;
mod tape;
mod verify;

pub use crate::expr::Operations as Counts;
pub use batch::{BatchEvaluator, LANES};
pub use cost::{code_counts, counts};
pub use evaluate::{Evaluate, EvaluateBatch, ShapeMismatch};
pub use fuse::fuse;
pub use interpret::{Evaluator, parameter_defaults, prelude_values};
pub use lower::{LowerError, constant_values, lower};
pub use lowered::{CodeError, CodeOptions, FunctionCount, Lowered};
pub use schedule::{peak_live, schedule};
pub use states::{CalledFunction, Evaluated, NumberArray, States, StatesError};
pub use verify::{Fault, verify};

use crate::arena::{Handle, PrimaryMap};
use crate::expr::Relation;
use crate::function::{Form, FunctionName};

crate::handle!(
    /// A value of a [`Code`]: a leaf, or a result of an instruction. Assigned once.
    pub Slot,
    "t"
);

/// What is there before the first instruction runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Leaf {
    /// A number.
    Constant(f64),
    /// Row of [`Program::parameters`]; in the prelude only.
    Parameter(usize),
    /// Row of the outputs of [`Program::prelude`]; in routines only.
    Prelude(usize),
    /// An entry of an argument; in routines only.
    Argument {
        /// Row of [`Routine::arguments`].
        argument: usize,
        /// Which of its entries.
        entry: usize,
    },
}

/// Operations on one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // the names are the documentation
pub enum UnaryOperation {
    Neg,
    Tan,
    Sqrt,
    Exp,
    Log,
    Tanh,
    Abs,
    Sign,
}

/// Operations on two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // the names are the documentation
pub enum BinaryOperation {
    Add,
    Sub,
    Mul,
    Div,
    Atan2,
    Min,
    Max,
}

/// A product and the sum or difference that it goes into, from three values a, b, c.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FusedOperation {
    /// a b + c
    ProductPlus,
    /// a b - c
    ProductMinus,
    /// a - b c
    MinusProduct,
}

/// How a value is computed from others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// From one value.
    Unary(UnaryOperation, Slot),
    /// From two, left then right.
    Binary(BinaryOperation, Slot, Slot),
    /// From three, in the order of the formula; see [`fuse`].
    Fused(FusedOperation, [Slot; 3]),
    /// `then` where `left relation right` holds, `otherwise` elsewhere; both are computed.
    Select {
        /// The condition's relation.
        relation: Relation,
        /// The two sides of the condition.
        sides: [Slot; 2],
        /// The value where the condition holds.
        then: Slot,
        /// The value where it does not.
        otherwise: Slot,
    },
}

/// One step of straight-line code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Instruction {
    /// `result = operation`.
    Value {
        /// The slot that is assigned.
        result: Slot,
        /// What is assigned to it.
        operation: Operation,
    },
    /// `(sine, cosine) = sincos(angle)`: both are assigned, even if one is never used.
    SinCos {
        /// Receives the sine.
        sine: Slot,
        /// Receives the cosine.
        cosine: Slot,
        /// The angle \[rad\].
        angle: Slot,
    },
}

impl Instruction {
    /// Calls `visit` with each operand, left to right.
    pub fn for_each_operand(&self, mut visit: impl FnMut(Slot)) {
        match *self {
            Self::SinCos { angle, .. } => visit(angle),
            Self::Value { operation, .. } => match operation {
                Operation::Unary(_, a) => visit(a),
                Operation::Binary(_, a, b) => [a, b].into_iter().for_each(visit),
                Operation::Fused(_, operands) => operands.into_iter().for_each(visit),
                Operation::Select { sides: [left, right], then, otherwise, .. } => {
                    [left, right, then, otherwise].into_iter().for_each(visit);
                }
            },
        }
    }

    /// Calls `visit` with each slot that is assigned.
    pub fn for_each_result(&self, mut visit: impl FnMut(Slot)) {
        match *self {
            Self::SinCos { sine, cosine, .. } => [sine, cosine].into_iter().for_each(visit),
            Self::Value { result, .. } => visit(result),
        }
    }

    /// Whether the scalar must be `Transcendental`.
    pub fn is_transcendental(&self) -> bool {
        use UnaryOperation::{Exp, Log, Sqrt, Tan, Tanh};
        match self {
            Self::Value { operation: Operation::Unary(function, _), .. } => {
                matches!(function, Tan | Sqrt | Exp | Log | Tanh)
            }
            Self::Value { operation: Operation::Binary(function, ..), .. } => {
                *function == BinaryOperation::Atan2
            }
            _ => false,
        }
    }
}

/// Straight-line code. The first slots are the leaves, in order; each other slot is assigned by
/// one instruction.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Code {
    /// What the first slots hold.
    pub leaves: PrimaryMap<Slot, Leaf>,
    /// The steps, in order of execution.
    pub instructions: Vec<Instruction>,
    /// The results.
    pub outputs: Vec<Slot>,
    /// Number of slots, leaves included.
    pub slots: usize,
}

impl Code {
    /// How often each slot is used, as an operand or as an output.
    pub fn uses(&self) -> Vec<u32> {
        let mut uses = vec![0; self.slots];
        for instruction in &self.instructions {
            instruction.for_each_operand(|operand| uses[operand.index()] += 1);
        }
        self.outputs.iter().for_each(|output| uses[output.index()] += 1);
        uses
    }

    /// Whether products are fused with sums.
    pub fn is_fused(&self) -> bool {
        let is_fused = |step: &Instruction| {
            matches!(step, Instruction::Value { operation: Operation::Fused(..), .. })
        };
        self.instructions.iter().any(is_fused)
    }

    /// Whether the scalar must be `Transcendental`.
    pub fn is_transcendental(&self) -> bool {
        self.instructions.iter().any(Instruction::is_transcendental)
    }
}

/// An argument of a routine: a vector.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ArgumentShape {
    /// `q`, `qd`, `qdd`, `tau` or `b`.
    pub name: &'static str,
    /// Number of entries.
    pub len: usize,
}

/// An output of a routine: an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputShape {
    /// The name of the array.
    pub name: &'static str,
    /// Its dimensions, outermost first; entries are stored last index fastest.
    pub shape: Vec<usize>,
    /// One line that says what the entries are.
    pub doc: String,
    /// What each entry is, where that takes a line of its own.
    pub details: Vec<String>,
}

impl OutputShape {
    /// Number of entries.
    pub fn len(&self) -> usize {
        self.shape.iter().product()
    }

    /// Whether there is no entry.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A function of a model, lowered.
#[derive(Clone, Debug, PartialEq)]
pub struct Routine {
    /// Which function.
    pub name: FunctionName,
    /// Of which link, where there is one function for each link.
    pub link: Option<String>,
    /// The arguments, in the order of the call.
    pub arguments: Vec<ArgumentShape>,
    /// The outputs; their entries one after the other are the outputs of `code`.
    pub outputs: Vec<OutputShape>,
    /// The formulation it was derived by.
    pub form: Form,
    /// Its code.
    pub code: Code,
}

impl Routine {
    /// The name, with the link where there is one: `link_jacobian_foot`.
    pub fn full_name(&self) -> String {
        match &self.link {
            Some(link) => format!("{}_{link}", self.name),
            None => self.name.to_string(),
        }
    }
}

/// The functions of one model with the prelude that they share.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Program {
    /// The names of the parameters, in the order of the leaves of the prelude.
    pub parameters: Vec<String>,
    /// What depends on parameters alone: run once for each set of parameters.
    pub prelude: Code,
    /// The functions.
    pub routines: Vec<Routine>,
}

impl Program {
    /// The routine of a function, of a link where there is one for each link.
    pub fn find(&self, name: FunctionName, link: Option<&str>) -> Option<&Routine> {
        self.routines.iter().find(|routine| routine.name == name && routine.link.as_deref() == link)
    }
}
