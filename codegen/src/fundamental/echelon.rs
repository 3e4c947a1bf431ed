//! Gauss-Jordan on B itself: B_E, and theta = B_Eu theta0 (thesis 3.3-3.5).
//!
//! B has many rows, most of them copies of few. Modulo 2^61 - 1 the sparsest independent ones are
//! chosen; on these the elimination is exact, over the rational functions of the known parameters;
//! and then every row of B is checked, exactly, to be a combination of the rows of B_Eu. A row that
//! is not (the prime was unlucky) joins the chosen ones, so that the result never depends on luck.

use super::decompose::Decomposition;
use super::fraction::{Field, Fraction};
use super::polynomial::TooManyTerms;
use crate::expr::{Dag, EvaluateError, ExprId, Node, Residues, UnaryFunction, evaluate};
use crate::number::Residue;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// Why B was not eliminated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EchelonError {
    /// The rational functions on the way have too many terms.
    TooManyTerms,
    /// The coefficients have no value at a random point.
    Evaluate(EvaluateError),
}

impl fmt::Display for EchelonError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooManyTerms => write!(
                f,
                "the relations between the columns of B have too many terms\n  hint: keep other \
                 columns, or give the known parameters numbers"
            ),
            Self::Evaluate(error) => write!(f, "the coefficients of B have no value: {error}"),
        }
    }
}

impl std::error::Error for EchelonError {}

impl From<TooManyTerms> for EchelonError {
    fn from(_: TooManyTerms) -> Self {
        Self::TooManyTerms
    }
}

/// The rows of B_E that are not 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Echelon {
    /// The pivot columns, in the order looked at.
    pub pivots: Vec<usize>,
    /// B_Eu: for each pivot the entries of its row by column, 1 at the pivot itself.
    pub rows: Vec<BTreeMap<usize, Fraction>>,
}

impl Echelon {
    /// The rank of B.
    pub fn rank(&self) -> usize {
        self.pivots.len()
    }

    /// What a column is the sum of: pivots with their factors; none for a column that is 0.
    pub fn relation(&self, column: usize) -> Vec<(usize, &Fraction)> {
        let entries = self.pivots.iter().zip(&self.rows);
        entries.filter_map(|(&pivot, row)| Some((pivot, row.get(&column)?))).collect()
    }
}

/// A row of B: coefficients (by number) at places in the order of the columns.
type SparseRow = Vec<(usize, u32)>;

/// A row over the known field, by places.
type ExactRow = BTreeMap<usize, Fraction>;

/// B_Eu. `order` lists the columns, those to keep first; columns that it leaves out are not looked
/// at.
pub fn echelon(
    dag: &mut Dag,
    decomposition: &Decomposition,
    order: &[usize],
) -> Result<Echelon, EchelonError> {
    let rows = distinct_rows(decomposition, order);
    let polynomials = &decomposition.coefficients;
    let exprs: Vec<ExprId> = polynomials.iter().map(|value| value.to_expr(dag)).collect();
    let residues =
        evaluate(dag, &exprs, &mut Residues::new(0x6563_686c)).map_err(EchelonError::Evaluate)?;
    let field = field_of(dag, &exprs);
    let values: Vec<Fraction> =
        polynomials.iter().map(|value| Fraction::polynomial(value.clone())).collect();
    let exact = |row: &SparseRow| -> ExactRow {
        row.iter().map(|&(place, value)| (place, values[value as usize].clone())).collect()
    };
    let mut chosen: Vec<usize> = independent_rows(&rows, &residues, order.len());
    loop {
        let reduced = gauss_jordan(&field, chosen.iter().map(|&row| exact(&rows[row])).collect())?;
        let mut missed = None;
        for (index, row) in rows.iter().enumerate() {
            if !is_combination(&field, exact(row), &reduced)? {
                missed = Some(index);
                break;
            }
        }
        match missed {
            Some(index) => chosen.push(index),
            None => {
                let named = |row: ExactRow| {
                    row.into_iter().map(|(place, value)| (order[place], value)).collect()
                };
                let pivots = reduced.iter().map(|(place, _)| order[*place]).collect();
                return Ok(Echelon {
                    pivots,
                    rows: reduced.into_iter().map(|(_, row)| named(row)).collect(),
                });
            }
        }
    }
}

/// The different rows of B, those with few entries first.
fn distinct_rows(decomposition: &Decomposition, order: &[usize]) -> Vec<SparseRow> {
    let mut entries: Vec<(u32, u32, usize, u32)> = Vec::new();
    for (place, &column) in order.iter().enumerate() {
        let column = &decomposition.columns[column];
        entries.extend(column.iter().map(|e| (e.equation, e.function, place, e.coefficient)));
    }
    entries.sort_unstable();
    let rows = entries.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
    let row = |row: &[(u32, u32, usize, u32)]| -> SparseRow {
        row.iter().map(|&(_, _, place, coefficient)| (place, coefficient)).collect()
    };
    let distinct: BTreeSet<SparseRow> = rows.map(row).collect();
    let mut distinct: Vec<SparseRow> = distinct.into_iter().collect();
    distinct.sort_by_key(Vec::len);
    distinct
}

/// Rows that are independent modulo p, each chosen as early as possible.
fn independent_rows(rows: &[SparseRow], residues: &[Residue], columns: usize) -> Vec<usize> {
    let mut echelon: Vec<Option<Vec<Residue>>> = vec![None; columns];
    let mut chosen = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let mut dense = vec![Residue::ZERO; columns];
        row.iter().for_each(|&(place, value)| dense[place] = residues[value as usize]);
        for place in 0..columns {
            let factor = dense[place];
            if factor == Residue::ZERO {
                continue;
            }
            let Some(known) = &echelon[place] else {
                let inverse = factor.inverse().expect("it is not 0");
                dense.iter_mut().for_each(|value| *value = *value * inverse);
                echelon[place] = Some(dense);
                chosen.push(index);
                break;
            };
            for (value, &other) in dense.iter_mut().zip(known).skip(place) {
                *value = *value - factor * other;
            }
        }
    }
    chosen
}

/// The reduced echelon form: (pivot place, row) by increasing pivot.
fn gauss_jordan(
    field: &Field,
    mut rows: Vec<ExactRow>,
) -> Result<Vec<(usize, ExactRow)>, TooManyTerms> {
    let mut done: Vec<(usize, ExactRow)> = Vec::new();
    loop {
        rows.retain(|row| !row.is_empty());
        let Some(place) = rows.iter().filter_map(|row| row.keys().next().copied()).min() else {
            return Ok(done);
        };
        // The simplest row keeps the others simple.
        let weight = |row: &ExactRow| {
            let pivot = row.get(&place)?;
            Some((pivot.size(), row.values().map(Fraction::size).sum::<usize>()))
        };
        let best = (0..rows.len()).filter_map(|index| Some((weight(&rows[index])?, index))).min();
        let (_, index) = best.expect("a row begins at this place");
        let mut pivot = rows.swap_remove(index);
        if !pivot[&place].is_one() {
            let inverse = field.inverse(&pivot[&place])?;
            for value in pivot.values_mut() {
                *value = field.multiply(value, &inverse)?;
            }
        }
        for row in rows.iter_mut().chain(done.iter_mut().map(|(_, row)| row)) {
            field.subtract_row(row, &pivot, place)?;
        }
        done.push((place, pivot));
    }
}

fn is_combination(
    field: &Field,
    mut row: ExactRow,
    reduced: &[(usize, ExactRow)],
) -> Result<bool, TooManyTerms> {
    for (place, pivot) in reduced {
        field.subtract_row(&mut row, pivot, *place)?;
    }
    Ok(row.is_empty())
}

/// The field of the coefficients: which of their atoms are sines.
fn field_of(dag: &mut Dag, exprs: &[ExprId]) -> Field {
    let mut cosine_of = BTreeMap::new();
    for expr in dag.topological(exprs) {
        if let Node::Unary(UnaryFunction::Sin, angle) = dag.node(expr) {
            cosine_of.insert(expr, dag.cos(angle));
        }
    }
    Field::new(cosine_of)
}
