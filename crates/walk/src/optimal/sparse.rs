//! Sparse matrices as they are assembled: entries in any order, those of one place added up.

use clarabel::algebra::CscMatrix;

/// Entries of a sparse matrix in the order in which they were found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triplets {
    /// Row, column and value.
    pub entries: Vec<(usize, usize, f64)>,
}

impl Triplets {
    /// Adds a value to an entry; zeros stay, so that the pattern does not depend on values.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.entries.push((row, column, value));
    }

    /// The matrix times a vector, added to `result`.
    pub fn multiply(&self, x: &[f64], result: &mut [f64]) {
        for &(row, column, value) in &self.entries {
            result[row] += value * x[column];
        }
    }

    /// x^T A x of a symmetric matrix of which this is the upper triangle.
    pub fn quadratic(&self, x: &[f64]) -> f64 {
        let term = |&(row, column, value): &(usize, usize, f64)| {
            let twice = if row == column { 1.0 } else { 2.0 };
            twice * value * x[row] * x[column]
        };
        self.entries.iter().map(term).sum()
    }

    /// The matrix by columns, entries of one place added up in the order of their assembly.
    pub(super) fn compressed(&self, rows: usize, columns: usize) -> CscMatrix<f64> {
        let mut counts = vec![0; columns + 1];
        self.entries.iter().for_each(|entry| counts[entry.1 + 1] += 1);
        for column in 0..columns {
            counts[column + 1] += counts[column];
        }
        let mut sorted = vec![(0, 0.0); self.entries.len()];
        let mut next = counts.clone();
        for &(row, column, value) in &self.entries {
            sorted[next[column]] = (row, value);
            next[column] += 1;
        }
        let (mut starts, mut at, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in 0..columns {
            let entries = &mut sorted[counts[column]..counts[column + 1]];
            // stable: sums are formed in the order of assembly
            entries.sort_by_key(|entry| entry.0);
            let first = at.len();
            for &(row, value) in entries.iter() {
                match at[first..].last() {
                    Some(&last) if last == row => *values.last_mut().expect("an entry") += value,
                    _ => {
                        at.push(row);
                        values.push(value);
                    }
                }
            }
            starts.push(at.len());
        }
        CscMatrix::new(rows, columns, starts, at, values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_of_one_place_add_up() {
        let mut matrix = Triplets::default();
        for (row, column, value) in [(1, 0, 2.0), (0, 1, 3.0), (1, 0, 0.5), (0, 0, 1.0)] {
            matrix.add(row, column, value);
        }
        let compressed = matrix.compressed(2, 2);
        assert_eq!(compressed.colptr, [0, 2, 3]);
        assert_eq!(compressed.rowval, [0, 1, 0]);
        assert_eq!(compressed.nzval, [1.0, 2.5, 3.0]);
    }
}
