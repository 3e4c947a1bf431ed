//! Rows of a least-squares problem, condensed to a triangle as they come: R of [W | y] = Q R.
//!
//! A triangle says everything about its rows that a linear estimate asks, since
//! R^T R = [W | y]^T [W | y], without the squares ever being formed. Triangles of parts make the
//! triangle of the whole.

use nalgebra::{DMatrix, DVector};

/// R of the rows so far.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangle {
    /// Columns of W, and y: square, upper triangular.
    r: DMatrix<f64>,
    /// Sums of the columns of W, and y.
    sums: DVector<f64>,
    rows: usize,
}

impl Triangle {
    /// No rows of `width` columns.
    pub fn new(width: usize) -> Self {
        let size = width + 1;
        Self { r: DMatrix::zeros(size, size), sums: DVector::zeros(size), rows: 0 }
    }

    /// From the columns of R from the top to the diagonal, sums of the columns of its rows, and
    /// their number.
    pub fn of_entries(entries: &[f64], sums: Vec<f64>, rows: usize) -> Self {
        let size = sums.len();
        let mut entries = entries.iter();
        let mut r = DMatrix::zeros(size, size);
        for column in 0..size {
            for (entry, given) in r.column_mut(column).iter_mut().take(column + 1).zip(&mut entries)
            {
                *entry = *given;
            }
        }
        Self { r, sums: DVector::from_vec(sums), rows }
    }

    /// Sums of the columns of W, and of y.
    pub fn sums(&self) -> &DVector<f64> {
        &self.sums
    }

    /// Number of rows condensed.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Columns of W.
    pub fn width(&self) -> usize {
        self.r.ncols() - 1
    }

    /// R of [W | y].
    pub fn matrix(&self) -> &DMatrix<f64> {
        &self.r
    }

    /// Adds rows: `columns` are those of W and y, all of one length.
    pub fn push(&mut self, columns: &[&[f64]]) {
        let added = columns.first().map_or(0, |column| column.len());
        let size = self.r.ncols();
        assert_eq!(columns.len(), size, "one column for each of W, and y");
        if added == 0 {
            return;
        }
        let mut stacked = DMatrix::zeros(size + added, size);
        for (index, column) in columns.iter().enumerate() {
            let mut target = stacked.column_mut(index);
            target.rows_mut(0, size).copy_from(&self.r.column(index));
            target.rows_mut(size, added).as_mut_slice().copy_from_slice(column);
            self.sums[index] += column.iter().sum::<f64>();
        }
        self.r = upper(stacked);
        self.rows += added;
    }

    /// Adds the rows of another.
    pub fn merge(&mut self, other: &Self) {
        let size = self.r.ncols();
        let mut stacked = DMatrix::zeros(2 * size, size);
        stacked.rows_mut(0, size).copy_from(&self.r);
        stacked.rows_mut(size, size).copy_from(&other.r);
        self.r = upper(stacked);
        self.sums += &other.sums;
        self.rows += other.rows;
    }

    /// |W phi - y|^2.
    pub fn squares(&self, phi: &[f64]) -> f64 {
        let residual = self.residual(phi);
        residual.iter().map(|entry| entry * entry).sum()
    }

    /// The sum of y - W phi.
    pub fn sum(&self, phi: &[f64]) -> f64 {
        let fitted: f64 = self.sums.iter().zip(phi).map(|(sum, phi)| sum * phi).sum();
        self.sums[self.width()] - fitted
    }

    /// Q^T (y - W phi).
    fn residual(&self, phi: &[f64]) -> Vec<f64> {
        let size = self.r.ncols();
        let of_row = |row: usize| {
            let fitted: f64 = (row..size - 1).map(|place| self.r[(row, place)] * phi[place]).sum();
            self.r[(row, size - 1)] - fitted
        };
        (0..size).map(of_row).collect()
    }

    /// W^T (y - W phi): 0 where phi is the estimate of these rows alone.
    pub fn score(&self, phi: &[f64]) -> Vec<f64> {
        let residual = self.residual(phi);
        let of_column =
            |place: usize| (0..=place).map(|row| self.r[(row, place)] * residual[row]).sum();
        (0..self.width()).map(of_column).collect()
    }

    /// |y|^2.
    pub fn target_squares(&self) -> f64 {
        self.r.column(self.width()).norm_squared()
    }
}

/// R of a matrix with at least as many rows as columns, by Householder's reflections.
pub(super) fn upper(stacked: DMatrix<f64>) -> DMatrix<f64> {
    stacked.qr().unpack_r()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_make_the_whole_and_squares_are_those_of_the_rows() {
        let column = |seed: u64| {
            let mut random = crate::Random::new(seed);
            (0..90).map(|_| random.normal()).collect::<Vec<f64>>()
        };
        let columns: Vec<Vec<f64>> = (1..=4).map(column).collect();
        let mut whole = Triangle::new(3);
        whole.push(&columns.iter().map(Vec::as_slice).collect::<Vec<_>>());
        let (mut first, mut second) = (Triangle::new(3), Triangle::new(3));
        first.push(&columns.iter().map(|column| &column[..40]).collect::<Vec<_>>());
        second.push(&columns.iter().map(|column| &column[40..]).collect::<Vec<_>>());
        let phi = [0.3, -1.2, 2.0];
        let residual = |k: usize| {
            columns[3][k] - (0..3).map(|place| columns[place][k] * phi[place]).sum::<f64>()
        };
        let squares: f64 = (0..90).map(|k| residual(k).powi(2)).sum();
        let score: f64 = (0..90).map(|k| columns[1][k] * residual(k)).sum();
        let sum: f64 = (0..90).map(residual).sum();
        first.merge(&second);
        assert_eq!(first.rows(), 90);
        for triangle in [&whole, &first] {
            assert!((triangle.squares(&phi) - squares).abs() < 1e-10);
            assert!((triangle.score(&phi)[1] - score).abs() < 1e-10);
            assert!((triangle.sum(&phi) - sum).abs() < 1e-10);
        }
    }
}
