//! Substitution and free symbols.

use super::dag::{Dag, ExprId, Node, SymbolId};
use super::symbol::Symbol;
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
    let node = dag.node(expr).map_operands(image);
    dag.make(node)
}

/// The outputs of another graph, made again in `dag`; `symbol_of` gives what stands for each of its
/// symbols.
pub fn import(
    dag: &mut Dag,
    from: &Dag,
    outputs: &[ExprId],
    mut symbol_of: impl FnMut(&mut Dag, &Symbol) -> ExprId,
) -> Vec<ExprId> {
    let mut image: FxHashMap<ExprId, ExprId> = FxHashMap::default();
    for expr in from.topological(outputs) {
        let new = match from.node(expr) {
            Node::Constant(id) => dag.constant(from.constant_value(id).clone()),
            Node::Symbol(id) => symbol_of(dag, &from.symbols()[id]),
            node => {
                let node = node.map_operands(|operand| image[&operand]);
                dag.make(node)
            }
        };
        image.insert(expr, new);
    }
    outputs.iter().map(|output| image[output]).collect()
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
