//! Relations that no rule about a tree tells: those of one geometry, or of an unusual choice of
//! terms. The columns that are left are written out as f^T B, and B is eliminated (thesis 3.3-3.5).

use super::column::Regressor;
use super::dependence::{Place, Relation};
use super::settle::without_denominators;
use crate::arena::Handle;
use crate::expr::{ClassSet, Dag, ExprId, SymbolId};
use crate::fundamental::{Basis, Decomposition, Expansion, Matrix, decompose, echelon};

/// Memory for it: twenty times what PUMA 560 takes, all terms in.
pub(super) const MEMORY_BYTES: usize = 320 << 20;

/// The relations among `columns`, which are to be kept in this order. None if they are too large to
/// be written out.
pub(super) fn coincidences(
    regressor: &Regressor,
    dag: &mut Dag,
    columns: &[usize],
) -> Option<Vec<Relation>> {
    let rows: Vec<Vec<ExprId>> = (0..regressor.joints.len())
        .map(|row| columns.iter().map(|&column| regressor.columns[column].entries[row]).collect())
        .collect();
    let decomposition = written_out(dag, &rows, MEMORY_BYTES)?;
    let order: Vec<usize> = (0..columns.len()).collect();
    let echelon = echelon(dag, &decomposition, &order).ok()?;
    let dependent = order.into_iter().filter(|place| !echelon.pivots.contains(place));
    let mut relations = Vec::new();
    for place in dependent {
        let mut amounts = vec![(columns[place], dag.integer(-1))];
        for (pivot, factor) in echelon.relation(place) {
            amounts.push((columns[pivot], factor.to_expr(dag)));
        }
        let amounts = without_denominators(dag, &amounts)?.into_iter();
        relations.push(amounts.map(|(column, amount)| (Place::Column(column), amount)).collect());
    }
    Some(relations)
}

/// A matrix as trigonometric polynomials, which are canonical. None if it takes more memory.
pub(super) fn written_out(
    dag: &mut Dag,
    rows: &[Vec<ExprId>],
    memory_bytes: usize,
) -> Option<Decomposition> {
    let known: Vec<bool> =
        dag.symbols().values().map(|symbol| !ClassSet::of(symbol.class).is_run_time()).collect();
    let is_known = |id: SymbolId| known[id.index()];
    let matrix = Matrix { rows, is_known: &is_known, chains: &[] };
    let expansion = &mut Expansion { memory_bytes, progress: &mut |_| {} };
    decompose(dag, &matrix, &[Basis::Fourier], expansion).ok()?.pop()
}
