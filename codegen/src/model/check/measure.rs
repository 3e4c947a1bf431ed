//! Dimensions of expressions, and their values where the file gives values to all symbols: both
//! computed once per node of the graph, as it grows.

use crate::arena::Handle;
use crate::expr::{BinaryFunction, Dag, ExprId, Node, UnaryFunction, rebuild};
use crate::model::unit::Dimension;
use crate::number::{Rational, ratio};
use num_traits::{Signed, Zero};
use rustc_hash::FxHashMap;

/// Values longer than this (some 400 digits) are no quantities of robots.
const MAX_VALUE_BITS: u64 = 1400;
/// Values of 2^1023 and above would not fit the numbers of emitted code.
const MAX_VALUE_EXPONENT: u64 = 1023;
/// An approximation gives up beyond this many nodes.
const MAX_APPROXIMATED_NODES: usize = 10_000;

/// What is known of the dimension of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Measure {
    /// A number as it is written: takes any dimension in a sum, none in a product.
    Number,
    /// A quantity of this dimension.
    Quantity(Dimension),
    /// It depends on something without a unit.
    Unknown,
}

/// What is wrong with a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NodeFault {
    MixedSum(Dimension, Dimension),
    FunctionOfQuantity(Dimension),
    DivisionByZero,
    /// The root of a negative number, or the logarithm of one that is not positive.
    NotReal,
    HugeValue,
}

/// Facts about the nodes of a graph, in step with it up to the last [`Facts::update`].
#[derive(Debug, Default)]
pub(super) struct Facts {
    measures: Vec<Measure>,
    /// The node with every symbol replaced by its value; none where a symbol has none.
    values: Vec<Option<ExprId>>,
    units: FxHashMap<ExprId, Dimension>,
    symbol_values: FxHashMap<ExprId, ExprId>,
}

impl Facts {
    /// States dimension and value of a new symbol; before the next update.
    pub(super) fn declare(
        &mut self,
        symbol: ExprId,
        dimension: Option<Dimension>,
        value: Option<ExprId>,
    ) {
        self.units.extend(dimension.map(|dimension| (symbol, dimension)));
        self.symbol_values.extend(value.map(|value| (symbol, value)));
    }

    pub(super) fn measure(&self, expr: ExprId) -> Measure {
        self.measures[expr.index()]
    }

    /// The value of an expression, free of symbols.
    pub(super) fn value(&self, expr: ExprId) -> Option<ExprId> {
        self.values[expr.index()]
    }

    /// Follows the graph to its present end; the faults of the nodes that are new.
    pub(super) fn update(&mut self, dag: &mut Dag) -> Vec<NodeFault> {
        let mut faults = Vec::new();
        // values are nodes too, so the graph may grow on the way; the value of a value is itself
        while self.measures.len() < dag.len() {
            let expr = ExprId::from_index(self.measures.len());
            let measure = self.new_measure(dag, expr, &mut faults);
            self.measures.push(measure);
            let value = self.new_value(dag, expr, &mut faults);
            self.values.push(value);
        }
        faults
    }

    fn new_value(
        &self,
        dag: &mut Dag,
        expr: ExprId,
        faults: &mut Vec<NodeFault>,
    ) -> Option<ExprId> {
        let node = dag.node(expr);
        if let Node::Symbol(_) = node {
            return self.symbol_values.get(&expr).copied();
        }
        let mut known = true;
        node.for_each_operand(|operand| known &= self.values[operand.index()].is_some());
        if !known {
            return None;
        }
        let value_of = |operand: ExprId| self.values[operand.index()].unwrap_or(operand);
        if let Node::Div(_, divisor) = node
            && dag.as_constant(value_of(divisor)).is_some_and(Zero::is_zero)
        {
            faults.push(NodeFault::DivisionByZero);
            return None;
        }
        if let Node::Unary(function, argument) = node
            && let Some(argument) = dag.as_constant(value_of(argument))
            && match function {
                UnaryFunction::Sqrt => argument.is_negative(),
                UnaryFunction::Log => !argument.is_positive(),
                _ => false,
            }
        {
            faults.push(NodeFault::NotReal);
            return None;
        }
        let value = rebuild(dag, expr, value_of);
        if is_huge(dag, value) {
            faults.push(NodeFault::HugeValue);
            return None;
        }
        Some(value)
    }

    fn new_measure(&self, dag: &Dag, expr: ExprId, faults: &mut Vec<NodeFault>) -> Measure {
        use Measure::{Number, Quantity, Unknown};
        let of = |operand: ExprId| self.measures[operand.index()];
        let dimension = |result: Option<Dimension>| result.map_or(Unknown, Quantity);
        match dag.node(expr) {
            Node::Constant(_) | Node::Pi => Number,
            Node::Symbol(_) => dimension(self.units.get(&expr).copied()),
            Node::Neg(a) | Node::Unary(UnaryFunction::Abs, a) => of(a),
            Node::Unary(UnaryFunction::Sign, _) => Number,
            Node::Unary(UnaryFunction::Sqrt, a) => match of(a) {
                Quantity(inside) => dimension(inside.root()),
                other => other,
            },
            Node::Pow(a, n) => match of(a) {
                Quantity(base) => dimension(i32::try_from(n).ok().and_then(|n| base.power(n))),
                other => other,
            },
            Node::Mul(a, b) => match (of(a), of(b)) {
                (Number, other) | (other, Number) => other,
                (Quantity(a), Quantity(b)) => dimension(a.times(b)),
                _ => Unknown,
            },
            Node::Div(a, b) => match (of(a), of(b)) {
                (other, Number) => other,
                (Number, Quantity(b)) => dimension(Dimension::NONE.per(b)),
                (Quantity(a), Quantity(b)) => dimension(a.per(b)),
                _ => Unknown,
            },
            Node::Unary(_, a) => {
                match of(a) {
                    Quantity(inside) if inside != Dimension::NONE => {
                        faults.push(NodeFault::FunctionOfQuantity(inside));
                    }
                    _ => {}
                }
                Quantity(Dimension::NONE)
            }
            Node::Binary(BinaryFunction::Atan2, a, b) => {
                sum(of(a), of(b), faults);
                Quantity(Dimension::NONE)
            }
            Node::Add(a, b) | Node::Sub(a, b) | Node::Binary(_, a, b) => sum(of(a), of(b), faults),
            Node::Select { left, right, then, otherwise, .. } => {
                sum(of(left), of(right), faults);
                sum(of(then), of(otherwise), faults)
            }
        }
    }
}

/// Whether a symbol-free value is too large or too long; the graph leaves powers unfolded that
/// would be.
fn is_huge(dag: &Dag, value: ExprId) -> bool {
    if let Node::Pow(base, _) = dag.node(value) {
        return dag.as_constant(base).is_some();
    }
    dag.as_constant(value).is_some_and(|constant| {
        let (numerator, denominator) = (constant.numer().bits(), constant.denom().bits());
        numerator.max(denominator) > MAX_VALUE_BITS || numerator > denominator + MAX_VALUE_EXPONENT
    })
}

/// The measure of a sum, or of anything else whose operands must agree.
fn sum(a: Measure, b: Measure, faults: &mut Vec<NodeFault>) -> Measure {
    match (a, b) {
        (Measure::Number | Measure::Unknown, other) | (other, Measure::Number) => other,
        (known, Measure::Unknown) => known,
        (Measure::Quantity(left), Measure::Quantity(right)) => {
            if left != right {
                faults.push(NodeFault::MixedSum(left, right));
                return Measure::Unknown;
            }
            a
        }
    }
}

/// A rational near the value of a symbol-free expression, to tell signs and order: exact but for
/// pi, which is off by 2e-38; none for functions that leave the rationals.
pub(in crate::model) fn approximate(dag: &Dag, value: ExprId) -> Option<Rational> {
    if let Some(constant) = dag.as_constant(value) {
        return Some(constant.clone());
    }
    let mut done: FxHashMap<ExprId, Option<Rational>> = FxHashMap::default();
    let mut waiting = vec![value];
    while let Some(&expr) = waiting.last() {
        if done.len() > MAX_APPROXIMATED_NODES {
            return None;
        }
        let before = waiting.len();
        let node = dag.node(expr);
        node.for_each_operand(|operand| {
            if !done.contains_key(&operand) {
                waiting.push(operand);
            }
        });
        if waiting.len() == before {
            let result = approximate_node(dag, node, |operand| done.get(&operand)?.clone());
            done.insert(expr, result);
            waiting.pop();
        }
    }
    done.remove(&value).flatten()
}

/// A convergent of the continued fraction of pi, right to 2e-38.
pub(in crate::model) fn near_pi() -> Rational {
    ratio(2_646_693_125_139_304_345, 842_468_587_426_513_207)
}

fn approximate_node(
    dag: &Dag,
    node: Node,
    of: impl Fn(ExprId) -> Option<Rational>,
) -> Option<Rational> {
    let short = |value: Rational| {
        (value.numer().bits().max(value.denom().bits()) <= MAX_VALUE_BITS).then_some(value)
    };
    match node {
        Node::Constant(id) => Some(dag.constant_value(id).clone()),
        Node::Pi => Some(near_pi()),
        Node::Neg(a) => Some(-of(a)?),
        Node::Add(a, b) => short(of(a)? + of(b)?),
        Node::Sub(a, b) => short(of(a)? - of(b)?),
        Node::Mul(a, b) => short(of(a)? * of(b)?),
        Node::Div(a, b) => {
            let divisor = of(b)?;
            if divisor.is_zero() { None } else { short(of(a)? / divisor) }
        }
        Node::Pow(a, n) => {
            let base = of(a)?;
            let bits = base.numer().bits().max(base.denom().bits()) * u64::from(n);
            (bits <= MAX_VALUE_BITS).then(|| num_traits::pow(base, n as usize))
        }
        Node::Unary(UnaryFunction::Abs, a) => Some(of(a)?.abs()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::to_f64;

    #[test]
    fn pi_is_near_enough_to_tell_signs() {
        let mut dag = Dag::new();
        let pi = dag.pi();
        let half = dag.constant(ratio(1, 2));
        let quarter_turn = dag.mul(half, pi);
        let near = approximate(&dag, quarter_turn).expect("a number");
        assert_eq!(to_f64(&near), std::f64::consts::FRAC_PI_2);
        let root = dag.unary(UnaryFunction::Sqrt, pi);
        assert_eq!(approximate(&dag, root), None);
    }
}
