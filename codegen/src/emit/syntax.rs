//! What languages write differently of straight-line code: a declaration, a number, a call.
//!
//! The walk over the code ([`super::body`]) is one for all of them, so that every language gets the
//! same operations in the same order.

use crate::expr::Relation;
use crate::program::{BinaryOperation, FusedOperation, UnaryOperation};

/// How tightly the outermost operation of a text binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Binding {
    Sum,
    Product,
    Sign,
    Atom,
}

/// A value as text.
#[derive(Clone, Debug)]
pub(super) struct Term {
    pub(super) text: String,
    pub(super) binding: Binding,
}

impl Term {
    pub(super) fn atom(text: String) -> Self {
        Self { text, binding: Binding::Atom }
    }

    /// Appends the text, in brackets if it binds less tightly than `least`.
    pub(super) fn write(&self, least: Binding, to: &mut String) {
        match self.binding < least {
            true => to.extend(["(", &self.text, ")"]),
            false => to.push_str(&self.text),
        }
    }

    /// The text, in brackets if it binds less tightly than `least`.
    pub(super) fn within(&self, least: Binding) -> String {
        let mut text = String::with_capacity(self.text.len() + 2);
        self.write(least, &mut text);
        text
    }
}

/// An operation that no language has a sign for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Call {
    /// A function of one value.
    Unary(UnaryOperation),
    /// A function of two values.
    Binary(BinaryOperation),
    /// A product and a sum, of three values.
    Fused(FusedOperation),
    /// A choice: the two sides of the relation, then the two values.
    Select(Relation),
}

impl Call {
    /// The method of the scalar that computes it: what the runtime calls it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Unary(function) => match function {
                UnaryOperation::Neg => unreachable!("it is written with its sign"),
                UnaryOperation::Tan => "tangent",
                UnaryOperation::Sqrt => "sqrt",
                UnaryOperation::Exp => "exponential",
                UnaryOperation::Log => "logarithm",
                UnaryOperation::Tanh => "hyperbolic_tangent",
                UnaryOperation::Abs => "abs",
                UnaryOperation::Sign => "sign",
            },
            Self::Binary(function) => match function {
                BinaryOperation::Atan2 => "arctangent2",
                BinaryOperation::Min => "lesser",
                BinaryOperation::Max => "greater",
                BinaryOperation::Add
                | BinaryOperation::Sub
                | BinaryOperation::Mul
                | BinaryOperation::Div => unreachable!("it is written with its sign"),
            },
            Self::Fused(function) => match function {
                FusedOperation::ProductPlus => "product_plus",
                FusedOperation::ProductMinus => "product_minus",
                FusedOperation::MinusProduct => "minus_product",
            },
            Self::Select(relation) => match relation {
                Relation::Less => "select_less",
                Relation::LessEqual => "select_less_equal",
                Relation::Equal => "select_equal",
            },
        }
    }
}

/// Sines and cosines that are computed side by side.
pub(super) struct Pack {
    /// The name of all of them, where [`Syntax::pack_name`] has one.
    pub(super) name: String,
    /// The angles.
    pub(super) angles: Vec<Term>,
    /// The names of the sines; none for one that is not used.
    pub(super) sines: Vec<Option<String>>,
    /// The names of the cosines.
    pub(super) cosines: Vec<Option<String>>,
}

/// How a language writes the statements of straight-line code.
pub(super) trait Syntax {
    /// The statement that gives a value a name.
    fn declare(&self, name: &str, value: &str) -> String;

    /// A number.
    fn constant(&self, value: f64) -> String;

    /// A call. Its text binds as an atom does.
    fn call(&self, call: Call, operands: &[Term]) -> String;

    /// The statements that compute sines and cosines, one pair or several.
    fn sincos(&self, pack: &Pack) -> Vec<String>;

    /// What sines and cosines are called together, where a language takes them apart afterwards.
    fn pack_name(&self) -> Option<&'static str> {
        None
    }

    /// The statement that puts a value into an entry of a result.
    fn store(&self, entry: &str, value: &Term) -> String {
        format!("{entry} = {};", value.text)
    }

    /// Most instructions that stand in one block.
    fn longest_block(&self) -> usize {
        usize::MAX
    }

    /// A block of statements that hands on some of its values by their names.
    fn block(&self, lines: Vec<String>, _names: &[String]) -> Vec<String> {
        lines
    }
}
