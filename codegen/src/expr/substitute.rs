//! Substitution and free symbols.

use super::dag::{Dag, ExprId, Node, SymbolId};
use crate::arena::Handle;
use rustc_hash::FxHashMap;

/// The outputs with each key of `replacements` (a symbol or any other expression) replaced, all at
/// once: a replacement is not searched again. Rebuilt through the folding constructors.
pub fn substitute(
    dag: &mut Dag,
    outputs: &[ExprId],
    replacements: &FxHashMap<ExprId, ExprId>,
) -> Vec<ExprId> {
    let mut image: FxHashMap<ExprId, ExprId> = FxHashMap::default();
    for expr in dag.topological(outputs) {
        let new = match replacements.get(&expr) {
            Some(&new) => new,
            None => rebuild(dag, expr, |operand| image[&operand]),
        };
        image.insert(expr, new);
    }
    outputs.iter().map(|output| image[output]).collect()
}

/// The node of `expr` made again from the images of its operands.
pub(crate) fn rebuild(dag: &mut Dag, expr: ExprId, image: impl Fn(ExprId) -> ExprId) -> ExprId {
    match dag.node(expr) {
        Node::Constant(_) | Node::Pi | Node::Symbol(_) => expr,
        Node::Neg(a) => dag.neg(image(a)),
        Node::Add(a, b) => dag.add(image(a), image(b)),
        Node::Sub(a, b) => dag.sub(image(a), image(b)),
        Node::Mul(a, b) => dag.mul(image(a), image(b)),
        Node::Div(a, b) => dag.div(image(a), image(b)),
        Node::Pow(a, n) => dag.power(image(a), n),
        Node::Unary(function, a) => dag.unary(function, image(a)),
        Node::Binary(function, a, b) => dag.binary(function, image(a), image(b)),
        Node::Select { relation, left, right, then, otherwise } => {
            dag.select(relation, (image(left), image(right)), image(then), image(otherwise))
        }
    }
}

/// The symbols that the outputs depend on, in the order of their making.
pub fn free_symbols(dag: &Dag, outputs: &[ExprId]) -> Vec<SymbolId> {
    let mut symbols: Vec<SymbolId> = dag
        .topological(outputs)
        .into_iter()
        .filter_map(|expr| match dag.node(expr) {
            Node::Symbol(id) => Some(id),
            _ => None,
        })
        .collect();
    symbols.sort_by_key(|id| id.index());
    symbols
}
