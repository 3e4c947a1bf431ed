//! Derivatives: one forward pass over the graph, whose result is part of the graph again.

use super::dag::{BinaryFunction, Dag, ExprId, Node, Relation, UnaryFunction};
use rustc_hash::FxHashMap;

/// The derivative of `outputs` along a direction: each symbol of `seeds` moves at the given rate,
/// all others rest. One symbol with rate 1 gives a partial derivative; q at rate qd and qd at rate
/// qdd give the derivative with respect to time.
///
/// At kinks the derivative of the branch in force is taken: |x|' = sign(x) x', sign' = 0.
pub fn derivative(
    dag: &mut Dag,
    outputs: &[ExprId],
    seeds: &FxHashMap<ExprId, ExprId>,
) -> Vec<ExprId> {
    let mut rates: FxHashMap<ExprId, ExprId> = FxHashMap::default();
    for expr in dag.topological(outputs) {
        let rate = node_rate(dag, expr, seeds, &rates);
        // Nodes that rest are not kept: most of a graph rests along one direction.
        if rate != dag.zero() {
            rates.insert(expr, rate);
        }
    }
    let zero = dag.zero();
    outputs.iter().map(|output| rates.get(output).copied().unwrap_or(zero)).collect()
}

fn node_rate(
    dag: &mut Dag,
    expr: ExprId,
    seeds: &FxHashMap<ExprId, ExprId>,
    rates: &FxHashMap<ExprId, ExprId>,
) -> ExprId {
    let zero = dag.zero();
    let rate = |operand: ExprId| rates.get(&operand).copied().unwrap_or(zero);
    match dag.node(expr) {
        Node::Constant(_) | Node::Pi => zero,
        Node::Symbol(_) => seeds.get(&expr).copied().unwrap_or(zero),
        Node::Neg(a) => dag.neg(rate(a)),
        Node::Add(a, b) => dag.add(rate(a), rate(b)),
        Node::Sub(a, b) => dag.sub(rate(a), rate(b)),
        Node::Mul(a, b) => {
            let left = dag.mul(rate(a), b);
            let right = dag.mul(a, rate(b));
            dag.add(left, right)
        }
        // (a / b)' = (a' - (a / b) b') / b
        Node::Div(a, b) => {
            let correction = dag.mul(expr, rate(b));
            let numerator = dag.sub(rate(a), correction);
            if numerator == zero { zero } else { dag.div(numerator, b) }
        }
        // (a^n)' = n a^(n-1) a'
        Node::Pow(a, n) => {
            let factor = dag.integer(i64::from(n));
            let power = dag.power(a, n - 1);
            let slope = dag.mul(factor, power);
            dag.mul(slope, rate(a))
        }
        Node::Unary(function, a) if rate(a) != zero => {
            let slope = unary_slope(dag, function, a, expr);
            dag.mul(slope, rate(a))
        }
        Node::Unary(..) => zero,
        Node::Binary(function, a, b) => binary_rate(dag, function, [a, b], [rate(a), rate(b)]),
        Node::Select { relation, left, right, then, otherwise } => {
            dag.select(relation, left, right, rate(then), rate(otherwise))
        }
    }
}

/// f'(a), where `value` is the expression f(a).
fn unary_slope(dag: &mut Dag, function: UnaryFunction, a: ExprId, value: ExprId) -> ExprId {
    let one = dag.one();
    match function {
        UnaryFunction::Sin => dag.cos(a),
        UnaryFunction::Cos => {
            let sin = dag.sin(a);
            dag.neg(sin)
        }
        UnaryFunction::Tan => {
            let square = dag.mul(value, value);
            dag.add(one, square)
        }
        UnaryFunction::Sqrt => {
            let twice = dag.add(value, value);
            dag.div(one, twice)
        }
        UnaryFunction::Exp => value,
        UnaryFunction::Log => dag.div(one, a),
        UnaryFunction::Tanh => {
            let square = dag.mul(value, value);
            dag.sub(one, square)
        }
        UnaryFunction::Abs => dag.unary(UnaryFunction::Sign, a),
        UnaryFunction::Sign => dag.zero(),
    }
}

fn binary_rate(
    dag: &mut Dag,
    function: BinaryFunction,
    [a, b]: [ExprId; 2],
    [rate_a, rate_b]: [ExprId; 2],
) -> ExprId {
    match function {
        BinaryFunction::Min => dag.select(Relation::Less, a, b, rate_a, rate_b),
        BinaryFunction::Max => dag.select(Relation::Less, a, b, rate_b, rate_a),
        // atan2(y, x)' = (x y' - y x') / (x^2 + y^2)
        BinaryFunction::Atan2 => {
            let (left, right) = (dag.mul(b, rate_a), dag.mul(a, rate_b));
            let numerator = dag.sub(left, right);
            let (yy, xx) = (dag.mul(a, a), dag.mul(b, b));
            let square = dag.add(xx, yy);
            if numerator == dag.zero() { numerator } else { dag.div(numerator, square) }
        }
    }
}
