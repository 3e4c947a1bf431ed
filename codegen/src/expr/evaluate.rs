//! The value of expressions over any ring.

use super::dag::{BinaryFunction, Dag, ExprId, Node, Relation, SymbolId, UnaryFunction};
use crate::arena::Handle;
use crate::number::Rational;
use std::fmt;

/// Why an expression has no value at a point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EvaluateError {
    /// A symbol has no value at the point.
    MissingSymbol(String),
    /// A division by zero.
    DivisionByZero,
    /// The function's value leaves the ring, as sin(1) leaves the rationals.
    NotInRing(UnaryFunction),
    /// The function's value leaves the ring.
    NotInRingBinary(BinaryFunction),
    /// Pi is not a member of the ring.
    PiNotInRing,
}

impl fmt::Display for EvaluateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MissingSymbol(name) => write!(f, "the symbol {name} has no value here"),
            Self::DivisionByZero => write!(f, "division by zero"),
            Self::NotInRing(function) => write!(
                f,
                "{} of this argument is not a rational number; evaluate over f64 instead, or keep \
                 the expression symbolic",
                format!("{function:?}").to_lowercase()
            ),
            Self::NotInRingBinary(function) => write!(
                f,
                "{} of these arguments is not a rational number; evaluate over f64 instead",
                format!("{function:?}").to_lowercase()
            ),
            Self::PiNotInRing => {
                write!(f, "pi is not a rational number; evaluate over f64 instead")
            }
        }
    }
}

impl std::error::Error for EvaluateError {}

/// What evaluation needs of a ring: its operations, and its own reading of symbols and functions.
pub trait Ring {
    /// A member of the ring.
    type Value: Clone;

    /// The image of a rational number.
    fn constant(&mut self, value: &Rational) -> Result<Self::Value, EvaluateError>;
    /// The image of pi.
    fn pi(&mut self) -> Result<Self::Value, EvaluateError>;
    /// The value of a symbol at the point.
    fn symbol(&mut self, dag: &Dag, id: SymbolId) -> Result<Self::Value, EvaluateError>;
    /// `-a`.
    fn neg(&mut self, a: &Self::Value) -> Self::Value;
    /// `a + b`.
    fn add(&mut self, a: &Self::Value, b: &Self::Value) -> Self::Value;
    /// `a - b`.
    fn sub(&mut self, a: &Self::Value, b: &Self::Value) -> Self::Value;
    /// `a b`.
    fn mul(&mut self, a: &Self::Value, b: &Self::Value) -> Self::Value;
    /// `a / b`.
    fn div(&mut self, a: &Self::Value, b: &Self::Value) -> Result<Self::Value, EvaluateError>;
    /// A function of one argument. The argument is given as an expression too, with the table of
    /// values found so far, because over a finite field an angle is more than its residue.
    fn unary(
        &mut self,
        function: UnaryFunction,
        dag: &Dag,
        argument: ExprId,
        values: &[Option<Self::Value>],
    ) -> Result<Self::Value, EvaluateError>;
    /// A function of two arguments, as expressions and by their values.
    fn binary(
        &mut self,
        function: BinaryFunction,
        dag: &Dag,
        arguments: [ExprId; 2],
        values: [&Self::Value; 2],
    ) -> Result<Self::Value, EvaluateError>;
    /// `then` where `left relation right`, else `otherwise`; the sides as those of `binary`.
    fn select(
        &mut self,
        relation: Relation,
        dag: &Dag,
        sides: [ExprId; 2],
        values: [&Self::Value; 2],
        then: &Self::Value,
        otherwise: &Self::Value,
    ) -> Self::Value;
}

/// The values of `outputs`, in order. One pass over the reachable nodes, no recursion.
pub fn evaluate<R: Ring>(
    dag: &Dag,
    outputs: &[ExprId],
    ring: &mut R,
) -> Result<Vec<R::Value>, EvaluateError> {
    let mut values: Vec<Option<R::Value>> = vec![None; dag.len()];
    for expr in dag.topological(outputs) {
        let value = {
            let of = |id: ExprId| values[id.index()].as_ref().expect("operands come first");
            match dag.node(expr) {
                Node::Constant(id) => ring.constant(dag.constant_value(id))?,
                Node::Pi => ring.pi()?,
                Node::Symbol(id) => ring.symbol(dag, id)?,
                Node::Neg(a) => ring.neg(of(a)),
                Node::Add(a, b) => ring.add(of(a), of(b)),
                Node::Sub(a, b) => ring.sub(of(a), of(b)),
                Node::Mul(a, b) => ring.mul(of(a), of(b)),
                Node::Div(a, b) => ring.div(of(a), of(b))?,
                Node::Pow(a, n) => power(ring, of(a), n),
                Node::Unary(function, a) => ring.unary(function, dag, a, &values)?,
                Node::Binary(function, a, b) => {
                    ring.binary(function, dag, [a, b], [of(a), of(b)])?
                }
                Node::Select { relation, left, right, then, otherwise } => {
                    let (sides, values) = ([left, right], [of(left), of(right)]);
                    ring.select(relation, dag, sides, values, of(then), of(otherwise))
                }
            }
        };
        values[expr.index()] = Some(value);
    }
    Ok(outputs
        .iter()
        .map(|output| values[output.index()].clone().expect("outputs are reachable"))
        .collect())
}

fn power<R: Ring>(ring: &mut R, base: &R::Value, n: u32) -> R::Value {
    let mut result: Option<R::Value> = None;
    for bit in (0..32 - n.leading_zeros()).rev() {
        result = result.map(|value| ring.mul(&value, &value));
        if n >> bit & 1 == 1 {
            result = Some(match result {
                Some(value) => ring.mul(&value, base),
                None => base.clone(),
            });
        }
    }
    result.expect("exponents are at least 2")
}
