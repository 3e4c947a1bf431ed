//! Products of small dense matrices and vectors, and derivatives by vectors of symbols.

use crate::expr::{Dag, ExprId, derivative};
use crate::spatial::{Matrix, Vector, dot, transpose};

/// `A v`.
pub(super) fn apply(dag: &mut Dag, a: Matrix, v: Vector) -> Vector {
    a.map(|row| dot(dag, row, v))
}

/// `A B`.
pub(super) fn multiply(dag: &mut Dag, a: Matrix, b: Matrix) -> Matrix {
    let columns = transpose(b);
    a.map(|row| columns.map(|column| dot(dag, row, column)))
}

/// The identity.
pub(super) fn identity(dag: &Dag) -> Matrix {
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| if row == column { dag.one() } else { dag.zero() }))
}

/// The sum of the products of two lists, entry by entry.
pub(super) fn inner(dag: &mut Dag, a: &[ExprId], b: &[ExprId]) -> ExprId {
    a.iter().zip(b).fold(dag.zero(), |sum, (&x, &y)| {
        let product = dag.mul(x, y);
        dag.add(sum, product)
    })
}

/// `A v` for a matrix given by rows.
pub(super) fn apply_rows(dag: &mut Dag, rows: &[Vec<ExprId>], v: &[ExprId]) -> Vec<ExprId> {
    rows.iter().map(|row| inner(dag, row, v)).collect()
}

/// The sum of two lists, entry by entry.
pub(super) fn add_lists(dag: &mut Dag, a: &[ExprId], b: &[ExprId]) -> Vec<ExprId> {
    a.iter().zip(b).map(|(&x, &y)| dag.add(x, y)).collect()
}

/// d outputs[i] / d symbols[j], by rows i.
pub(super) fn jacobian(dag: &mut Dag, outputs: &[ExprId], symbols: &[ExprId]) -> Vec<Vec<ExprId>> {
    let mut rows = vec![Vec::with_capacity(symbols.len()); outputs.len()];
    for &symbol in symbols {
        let column = partial(dag, outputs, symbol);
        rows.iter_mut().zip(column).for_each(|(row, entry)| row.push(entry));
    }
    rows
}

/// The derivatives of `outputs` by one symbol.
pub(super) fn partial(dag: &mut Dag, outputs: &[ExprId], symbol: ExprId) -> Vec<ExprId> {
    let one = dag.one();
    derivative(dag, outputs, &std::iter::once((symbol, one)).collect())
}

/// The derivatives of `outputs` in time, while each symbol of `positions` moves at its rate.
pub(super) fn rate(
    dag: &mut Dag,
    outputs: &[ExprId],
    positions: &[ExprId],
    rates: &[ExprId],
) -> Vec<ExprId> {
    derivative(dag, outputs, &positions.iter().copied().zip(rates.iter().copied()).collect())
}
