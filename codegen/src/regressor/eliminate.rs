//! Gauss-Jordan on the relations, over the rational functions of the known parameters.
//!
//! Eliminating from the last column backwards leaves each dependent column as a combination of
//! columns before it that stay: the same as Gauss-Jordan on B from the first column forwards
//! (thesis 3.4), on a matrix with a few entries a row instead of a million rows.

use super::dependence::{Place, Relation};
use crate::expr::{Dag, ExprId, Node, UnaryFunction};
use crate::fundamental::{CanonicalError, Field, Fraction, Polynomial, canonical_generic};
use std::collections::{BTreeMap, BTreeSet};

/// A dependent column: itself, with coefficient 1, and columns that stay; the sum vanishes.
pub(super) type Reduced = BTreeMap<usize, Fraction>;

/// A combination of places that vanishes.
pub(super) type Row = BTreeMap<Place, Fraction>;

/// For each dependent column, by its index, its relation. `order` lists the columns, those to keep
/// first.
pub(super) fn eliminate(
    dag: &mut Dag,
    relations: &[Relation],
    order: &[usize],
) -> Result<BTreeMap<usize, Reduced>, CanonicalError> {
    let (field, mut rows) = rows(dag, relations)?;
    // Features are no columns: they go first.
    let is_feature = |place: &Place| matches!(place, Place::Feature(_));
    let features = places(&rows).into_iter().filter(is_feature).collect::<Vec<_>>();
    forget(&field, &mut rows, &features)?;
    let order: Vec<Place> = order.iter().rev().map(|&column| Place::Column(column)).collect();
    let done = gauss_jordan(&field, rows, &order)?;
    let column_of = |place: Place| match place {
        Place::Column(column) => Some(column),
        Place::Feature(_) => None,
    };
    let reduced = done.into_iter().filter_map(|(place, row)| {
        let row = row.into_iter().filter_map(|(place, value)| Some((column_of(place)?, value)));
        Some((column_of(place)?, row.collect()))
    });
    Ok(reduced.collect())
}

/// The relations over the field of what they are made of.
pub(super) fn rows(
    dag: &mut Dag,
    relations: &[Relation],
) -> Result<(Field, Vec<Row>), CanonicalError> {
    let exprs: Vec<_> = relations.iter().flat_map(|relation| relation.values().copied()).collect();
    let polynomials = canonical_generic(dag, &exprs)?;
    let field = field_of(dag, &polynomials);
    let mut polynomials = polynomials.into_iter();
    let rows = relations
        .iter()
        .map(|relation| {
            let values = polynomials.by_ref().take(relation.len()).map(Fraction::polynomial);
            let row = relation.keys().copied().zip(values);
            row.filter(|(_, value)| !value.is_zero()).collect()
        })
        .collect();
    Ok((field, rows))
}

/// All places of rows, in order.
pub(super) fn places(rows: &[Row]) -> BTreeSet<Place> {
    rows.iter().flat_map(|row| row.keys().copied()).collect()
}

/// Takes places out of rows, and the rows away that this takes.
pub(super) fn forget(
    field: &Field,
    rows: &mut Vec<Row>,
    places: &[Place],
) -> Result<(), CanonicalError> {
    for &place in places {
        if let Some(pivot) = take_pivot(field, rows, place)? {
            for row in rows.iter_mut() {
                field.subtract_row(row, &pivot, place)?;
            }
        }
    }
    Ok(())
}

/// The row of each place that has a pivot, places being taken in `order`; no other row has it.
pub(super) fn gauss_jordan(
    field: &Field,
    mut rows: Vec<Row>,
    order: &[Place],
) -> Result<BTreeMap<Place, Row>, CanonicalError> {
    let mut done: Vec<(Place, Row)> = Vec::new();
    for &place in order {
        if let Some(pivot) = take_pivot(field, &mut rows, place)? {
            for row in rows.iter_mut().chain(done.iter_mut().map(|(_, row)| row)) {
                field.subtract_row(row, &pivot, place)?;
            }
            done.push((place, pivot));
        }
    }
    Ok(done.into_iter().collect())
}

/// Takes the simplest row with an entry at `place`, scaled so that the entry is 1.
fn take_pivot(
    field: &Field,
    rows: &mut Vec<Row>,
    place: Place,
) -> Result<Option<Row>, CanonicalError> {
    let weight = |row: &Row| {
        let pivot = row.get(&place)?;
        let size: usize = row.values().map(Fraction::size).sum();
        Some((pivot.size() > 2, size))
    };
    let best = (0..rows.len())
        .filter_map(|index| Some((weight(&rows[index])?, index)))
        .min()
        .map(|(_, index)| index);
    let Some(index) = best else { return Ok(None) };
    let mut row = rows.swap_remove(index);
    if !row[&place].is_one() {
        let inverse = field.inverse(&row[&place])?;
        for value in row.values_mut() {
            *value = field.multiply(value, &inverse)?;
        }
    }
    Ok(Some(row))
}

/// The field of what the polynomials are made of: which atoms are sines.
fn field_of(dag: &mut Dag, polynomials: &[Polynomial]) -> Field {
    let mut atoms: Vec<ExprId> = polynomials
        .iter()
        .flat_map(|polynomial| polynomial.terms())
        .flat_map(|(monomial, _)| monomial.powers().iter().map(|&(atom, _)| atom))
        .collect();
    atoms.sort_unstable();
    atoms.dedup();
    let mut cosine_of = BTreeMap::new();
    for atom in atoms {
        if let Node::Unary(UnaryFunction::Sin, angle) = dag.node(atom) {
            cosine_of.insert(atom, dag.cos(angle));
        }
    }
    Field::new(cosine_of)
}
