//! Least squares of condensed rows, and which directions of phi they say nothing about.

mod triangle;

pub use triangle::Triangle;

use nalgebra::{DMatrix, DVector, SVD};
use triangle::upper;

/// A direction is not excited if its singular value, of columns scaled to length 1, is below this
/// share of the largest.
pub const DEAD: f64 = 1e-9;

/// Rows count no more than this, so that squares of what is weighted are numbers: targets of 1e-160
/// have other squares than they can have.
const MOST_WEIGHT: f64 = 1e100;

/// What is known of phi from elsewhere: a sum of entries, what it is, and how surely.
#[derive(Clone, Debug, PartialEq)]
pub struct PriorRow {
    /// Factors of phi.
    pub factors: Vec<f64>,
    /// The value of the sum.
    pub value: f64,
    /// Its standard deviation.
    pub std: f64,
}

/// The solution of a least-squares problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// phi.
    pub phi: DVector<f64>,
    /// A factor of (W^T W)^+ = F F^T, of the excited directions; W is weighted.
    pub factor: DMatrix<f64>,
    /// Directions of phi that W says nothing about, as columns; entries are scaled as the columns
    /// of W are.
    pub dead: DMatrix<f64>,
    /// Largest over smallest singular value of W.
    pub condition: f64,
    /// The same of the columns of W scaled to length 1.
    pub scaled_condition: f64,
}

impl Solution {
    /// Number of directions that are determined.
    pub fn excited(&self) -> usize {
        self.factor.ncols()
    }

    /// (W^T W)^+: the covariance of phi if residuals are independent, of variance 1.
    pub fn covariance(&self) -> DMatrix<f64> {
        &self.factor * self.factor.transpose()
    }
}

/// The square system of weighted triangles, in groups with their weights, and of what is known
/// beforehand: R of [W | y]. Columns of the n-th triangle of each group are those of the places of
/// phi that `pattern` has at n.
pub fn stacked(
    groups: &[(&[Triangle], &[f64])],
    pattern: &[Vec<usize>],
    prior: &[PriorRow],
    rank: usize,
) -> DMatrix<f64> {
    let all = groups.iter().flat_map(|(own, weights)| own.iter().zip(*weights).enumerate());
    let used: Vec<(usize, (&Triangle, &f64))> =
        all.filter(|(_, (one, weight))| one.rows() > 0 && **weight > 0.0).collect();
    let height: usize = used.iter().map(|(_, (one, _))| one.width() + 1).sum();
    let height = (height + prior.len()).max(rank + 1);
    let mut stacked = DMatrix::zeros(height, rank + 1);
    let mut row = 0;
    for (own_pattern, (triangle, weight)) in used {
        let r = triangle.matrix();
        for own in 0..r.nrows() {
            for place in own..r.ncols() {
                let target = pattern[own_pattern].get(place).copied().unwrap_or(rank);
                stacked[(row, target)] = weight.min(MOST_WEIGHT) * r[(own, place)];
            }
            row += 1;
        }
    }
    for PriorRow { factors, value, std } in prior {
        for (place, factor) in factors.iter().enumerate() {
            stacked[(row, place)] = factor / std;
        }
        stacked[(row, rank)] = value / std;
        row += 1;
    }
    upper(stacked)
}

/// What follows from rows that say nothing.
fn nothing(start: &[f64]) -> Solution {
    let rank = start.len();
    Solution {
        phi: DVector::from_column_slice(start),
        factor: DMatrix::zeros(rank, 0),
        dead: DMatrix::identity(rank, rank),
        condition: f64::INFINITY,
        scaled_condition: f64::INFINITY,
    }
}

/// Solves min |W phi - y|^2 of R of [W | y]. In directions that W says nothing about phi stays at
/// `start`.
pub fn solve(r: &DMatrix<f64>, start: &[f64]) -> Solution {
    let rank = r.ncols() - 1;
    let w = r.view((0, 0), (rank, rank)).into_owned();
    let lengths: Vec<f64> = w.column_iter().map(|column| column.norm()).collect();
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    let is_there = |length: f64| length > 1e-150 * longest;
    let scale: Vec<f64> =
        lengths.iter().map(|&length| if is_there(length) { length } else { 1.0 }).collect();
    let mut scaled = w.clone();
    for (mut column, scale) in scaled.column_iter_mut().zip(&scale) {
        column /= *scale;
    }
    // singular values of what is no number are looked for without end
    if scaled.iter().any(|entry| !entry.is_finite()) {
        return nothing(start);
    }
    let start = DVector::from_column_slice(start);
    let target = r.view((0, rank), (rank, 1)).column(0) - &w * &start;
    let SVD { u, v_t, singular_values: sigma } = scaled.svd(true, true);
    let (u, v) = (u.expect("it was asked for"), v_t.expect("it was asked for").transpose());
    let largest = sigma.max();
    let excited: Vec<usize> =
        (0..rank).filter(|&place| sigma[place] > DEAD * largest && largest > 0.0).collect();
    let along = u.tr_mul(&target);
    let mut change = DVector::zeros(rank);
    let mut factor = DMatrix::zeros(rank, excited.len());
    for (column, &place) in excited.iter().enumerate() {
        change += v.column(place) * (along[place] / sigma[place]);
        factor.set_column(column, &(v.column(place) / sigma[place]));
    }
    let dead: Vec<usize> = (0..rank).filter(|place| !excited.contains(place)).collect();
    let mut dead_directions = DMatrix::zeros(rank, dead.len());
    for (column, &place) in dead.iter().enumerate() {
        dead_directions.set_column(column, &v.column(place));
    }
    for row in 0..rank {
        change[row] /= scale[row];
        factor.row_mut(row).iter_mut().for_each(|entry| *entry /= scale[row]);
        dead_directions.row_mut(row).iter_mut().for_each(|entry| *entry /= scale[row]);
    }
    let ratio = |values: &DVector<f64>| values.max() / values.min();
    Solution {
        phi: start + change,
        factor,
        dead: dead_directions,
        condition: ratio(&w.svd(false, false).singular_values),
        scaled_condition: ratio(&sigma),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Targets whose squares are 0, and rows that are no numbers, end a search that would go on.
    #[test]
    fn rows_beyond_numbers_say_nothing() {
        let mut triangle = Triangle::new(2);
        let columns: [&[f64]; 3] = [&[1.0, 2.0, 3.0], &[0.5, -1.0, 0.3], &[1e-160, 0.0, 2e-160]];
        triangle.push(&columns);
        for weight in [1e160, f64::INFINITY] {
            let r = stacked(&[(&[triangle.clone()], &[weight])], &[vec![0, 1]], &[], 2);
            assert!(r.iter().all(|entry| entry.is_finite()), "{weight}: {r}");
            assert_eq!(solve(&r, &[0.0, 0.0]).excited(), 2);
        }
        let none = solve(&DMatrix::from_element(3, 3, f64::NAN), &[1.0, 2.0]);
        assert_eq!((none.excited(), none.phi.as_slice()), (0, &[1.0, 2.0][..]));
    }
}
