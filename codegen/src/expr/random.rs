//! Random graphs for tests: a recipe of steps, each of which applies an operation to results of
//! earlier ones, so that proptest can shrink it and operands come to be shared.

use super::dag::{BinaryFunction, Dag, ExprId, Node, Relation, UnaryFunction};
use super::symbol::SymbolClass;
use crate::number::ratio;
use proptest::prelude::*;

/// One step: an operation (by number) and the earlier results it takes (by number).
#[derive(Clone, Copy)]
pub(crate) struct Step {
    operation: Operation,
    operands: [u8; 4],
}

impl std::fmt::Debug for Step {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?}{:?}", self.operation, self.operands)
    }
}

/// What a step does.
#[derive(Clone, Copy, Debug)]
enum Operation {
    Neg,
    Add,
    Sub,
    Mul,
    Div,
    Inverse,
    Pow(u32),
    Unary(UnaryFunction),
    Binary(BinaryFunction),
    Select(Relation),
}

/// Which operations a recipe may hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Sums, products and powers.
    Polynomial,
    /// Also sines and cosines.
    Trigonometric,
    /// Every operation.
    Any,
}

/// Recipes of up to `length` steps.
pub(crate) fn recipes(kind: Kind, length: usize) -> impl Strategy<Value = Vec<Step>> {
    let step = (operations(kind), any::<[u8; 4]>())
        .prop_map(|(operation, operands)| Step { operation, operands });
    prop::collection::vec(step, 1..=length)
}

fn operations(kind: Kind) -> BoxedStrategy<Operation> {
    use UnaryFunction::{Abs, Cos, Exp, Log, Sign, Sin, Sqrt, Tan, Tanh};
    let ring = prop_oneof![
        1 => Just(Operation::Neg),
        4 => Just(Operation::Add),
        4 => Just(Operation::Sub),
        6 => Just(Operation::Mul),
        1 => (2_u32..=3).prop_map(Operation::Pow),
    ];
    let trigonometric = prop::sample::select(vec![Sin, Cos]).prop_map(Operation::Unary);
    let unary = prop::sample::select(vec![Tan, Sqrt, Exp, Log, Tanh, Abs, Sign]);
    let binary =
        prop::sample::select(vec![BinaryFunction::Atan2, BinaryFunction::Min, BinaryFunction::Max]);
    let relation = prop::sample::select(vec![Relation::Less, Relation::LessEqual, Relation::Equal]);
    match kind {
        Kind::Polynomial => ring.boxed(),
        Kind::Trigonometric => prop_oneof![4 => ring, 1 => trigonometric].boxed(),
        Kind::Any => prop_oneof![
            16 => ring,
            4 => trigonometric,
            2 => Just(Operation::Div),
            1 => (2..70u32).prop_map(Operation::Pow),
            1 => Just(Operation::Inverse),
            3 => unary.prop_map(Operation::Unary),
            1 => binary.prop_map(Operation::Binary),
            1 => relation.prop_map(Operation::Select),
        ]
        .boxed(),
    }
}

/// The atoms that every recipe starts from: constants, pi, parameters, variables.
fn atoms(dag: &mut Dag, kind: Kind) -> Vec<ExprId> {
    let mut atoms: Vec<ExprId> =
        [(-1, 1), (2, 1), (3, 2), (-5, 7), (1, 2)].map(|(p, q)| dag.constant(ratio(p, q))).into();
    for (name, class) in [
        ("l1", SymbolClass::Geometry),
        ("m1", SymbolClass::Inertia),
        ("N1", SymbolClass::Drive),
        ("q1", SymbolClass::Configuration),
        ("q2", SymbolClass::Configuration),
        ("qd1", SymbolClass::Rate),
        ("qdd10", SymbolClass::Acceleration),
    ] {
        atoms.push(dag.symbol(name, class));
    }
    if kind == Kind::Any {
        atoms.push(dag.pi());
    }
    atoms
}

/// Follows a recipe, each node made by `make`; answers all results. Steps that would divide by the
/// constant 0 are left out.
pub(crate) fn build(
    dag: &mut Dag,
    kind: Kind,
    recipe: &[Step],
    make: fn(&mut Dag, Node) -> ExprId,
) -> Vec<ExprId> {
    let mut results = atoms(dag, kind);
    let first = results.len();
    let (zero, one) = (dag.zero(), dag.one());
    for step in recipe {
        // Later results are taken more often than earlier ones: deep graphs.
        let [a, b, c, d] = step.operands.map(|number| {
            let back = usize::from(number) * usize::from(number) * results.len() / (256 * 256);
            results[results.len() - 1 - back]
        });
        let node = match step.operation {
            Operation::Neg => Node::Neg(a),
            Operation::Add => Node::Add(a, b),
            Operation::Sub => Node::Sub(a, b),
            Operation::Mul => Node::Mul(a, b),
            Operation::Div if b == zero => continue,
            Operation::Div => Node::Div(a, b),
            Operation::Inverse if a == zero => continue,
            Operation::Inverse => Node::Div(one, a),
            Operation::Pow(n) => Node::Pow(a, n),
            Operation::Unary(function) => Node::Unary(function, a),
            Operation::Binary(function) => Node::Binary(function, a, b),
            Operation::Select(relation) => {
                Node::Select { relation, left: a, right: b, then: c, otherwise: d }
            }
        };
        results.push(make(dag, node));
    }
    results.split_off(first)
}
