//! Rank and pivots modulo p = 2^61 - 1, from columns at random points.
//!
//! Parameters keep one random value, positions, rates and accelerations change from point to point;
//! sines and cosines are points of the unit circle. What is independent there is independent; what
//! is dependent there is so in truth but for a chance below 1e-12, and is proved apart.

use super::column::Regressor;
use crate::expr::{EvaluateError, Residues, evaluate};
use crate::number::Residue;

/// The echelon form of the columns at random points.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ranking {
    /// The columns that are no combination of those before them, in the order looked at.
    pub pivots: Vec<usize>,
    /// For each other column its coefficients over `pivots`.
    pub dependent: Vec<(usize, Vec<Residue>)>,
    /// The rows (point, joint) in which the pivots were found, in the same order.
    pub rows: Vec<(u64, usize)>,
}

/// Seeds of the points begin here.
pub(super) const FIRST_POINT: u64 = 0x6465_6e61_7669_7400;

/// The seed of the known parameters' values.
pub(super) const PARAMETERS: u64 = 0x7061_7261_6d65_7400;

/// The rows of R0 at one random point; `columns` gives the order.
pub(super) fn rows_at(
    regressor: &Regressor,
    columns: &[usize],
    point: u64,
) -> Result<Vec<Vec<Residue>>, EvaluateError> {
    let n = regressor.joints.len();
    let outputs: Vec<_> = (0..n)
        .flat_map(|row| columns.iter().map(move |&column| regressor.columns[column].entries[row]))
        .collect();
    let mut ring = Residues::with_parameters(point, PARAMETERS);
    let values = evaluate(&regressor.dag, &outputs, &mut ring)?;
    Ok(values.chunks(columns.len().max(1)).map(<[Residue]>::to_vec).collect())
}

/// Rank and dependencies of the columns, taken in `order`.
pub fn rank(regressor: &Regressor, order: &[usize]) -> Result<Ranking, EvaluateError> {
    let mut echelon: Vec<(usize, Vec<Residue>)> = Vec::new();
    let mut rows = Vec::new();
    let mut idle = 0;
    let mut point = FIRST_POINT;
    // New points until ten rows in a row, of two points at least, add nothing.
    while idle < 10 + 2 * regressor.joints.len() && echelon.len() < order.len() {
        for (joint, row) in rows_at(regressor, order, point)?.into_iter().enumerate() {
            if insert(&mut echelon, row) {
                rows.push((point, joint));
                idle = 0;
            } else {
                idle += 1;
            }
        }
        point += 1;
    }
    Ok(ranking(order, echelon, rows))
}

/// Reduces a row by those before; keeps it if something is left.
pub(super) fn insert(echelon: &mut Vec<(usize, Vec<Residue>)>, mut row: Vec<Residue>) -> bool {
    for (pivot, known) in echelon.iter() {
        let factor = row[*pivot];
        if factor != Residue::ZERO {
            for (value, &other) in row.iter_mut().zip(known).skip(*pivot) {
                *value = *value - factor * other;
            }
        }
    }
    let Some(pivot) = row.iter().position(|&value| value != Residue::ZERO) else { return false };
    let inverse = row[pivot].inverse().expect("a pivot is not 0");
    row.iter_mut().for_each(|value| *value = *value * inverse);
    echelon.push((pivot, row));
    // Rows are reduced in the order of their pivots.
    echelon.sort_by_key(|(pivot, _)| *pivot);
    true
}

fn ranking(
    order: &[usize],
    mut echelon: Vec<(usize, Vec<Residue>)>,
    rows: Vec<(u64, usize)>,
) -> Ranking {
    for k in (0..echelon.len()).rev() {
        let (pivot, row) = echelon[k].clone();
        for (_, above) in &mut echelon[..k] {
            let factor = above[pivot];
            if factor != Residue::ZERO {
                for (value, &other) in above.iter_mut().zip(&row).skip(pivot) {
                    *value = *value - factor * other;
                }
            }
        }
    }
    let is_pivot = |place: usize| echelon.iter().any(|&(pivot, _)| pivot == place);
    let dependent = (0..order.len())
        .filter(|&place| !is_pivot(place))
        .map(|place| (order[place], echelon.iter().map(|(_, row)| row[place]).collect()))
        .collect();
    let pivots = echelon.iter().map(|&(pivot, _)| order[pivot]).collect();
    Ranking { pivots, dependent, rows }
}
