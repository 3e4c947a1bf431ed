//! Rows of redundant contacts that say all that the others say: a flat foot that sticks has six.

use super::cholesky::{backward, factorise, forward};

/// Rows whose diagonal falls below this part of the largest, once those chosen are taken out, say
/// nothing new.
const DEPENDENT: f64 = 1e-8;

/// Independent rows, and the forces in them that make given accelerations vanish.
#[derive(Clone, Debug, Default)]
pub(crate) struct IndependentRows {
    /// The rows, by number.
    pub(crate) chosen: Vec<usize>,
    left: Vec<f64>,
    factor: Vec<f64>,
}

impl IndependentRows {
    /// Chooses rows of G, each time the one of which most is left.
    pub(crate) fn choose(&mut self, delassus: &[f64], rows: usize) {
        self.chosen.clear();
        self.left.clear();
        self.left.extend_from_slice(delassus);
        let mut largest = 0.0_f64;
        while self.chosen.len() < rows {
            let free = (0..rows).filter(|row| !self.chosen.contains(row));
            let of_left = free.map(|row| (row, self.left[row * (rows + 1)]));
            let Some((next, pivot)) = of_left.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            largest = largest.max(pivot);
            if pivot.is_nan() || pivot <= DEPENDENT * largest {
                break;
            }
            self.chosen.push(next);
            let line = self.left[next * rows..(next + 1) * rows].to_vec();
            for row in 0..rows {
                let factor = line[row] / pivot;
                for (entry, other) in self.left[row * rows..].iter_mut().zip(&line) {
                    *entry -= factor * other;
                }
            }
        }
        self.chosen.sort_unstable();
    }

    /// Factors G, that of the chosen rows; false if they are not independent.
    pub(crate) fn factor(&mut self, delassus: &[f64]) -> bool {
        self.factor.clear();
        self.factor.extend_from_slice(delassus);
        factorise(&mut self.factor, self.chosen.len()).is_ok()
    }

    /// x := -G^-1 x, with G as it was factored last.
    pub(crate) fn cancel(&self, x: &mut [f64]) {
        forward(&self.factor, x);
        backward(&self.factor, x);
        x.iter_mut().for_each(|entry| *entry = -*entry);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// G = J J^T with a third row that is the sum of the first two.
    #[test]
    fn dependent_rows_are_left_out() {
        let jacobian = [[1.0, 0.0, 2.0], [0.0, 3.0, 1.0], [1.0, 3.0, 3.0]];
        let product = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let all: Vec<f64> =
            jacobian.iter().flat_map(|a| jacobian.iter().map(move |b| product(a, b))).collect();
        let mut rows = IndependentRows::default();
        rows.choose(&all, 3);
        assert_eq!(rows.chosen.len(), 2);
        let few: Vec<f64> = rows
            .chosen
            .iter()
            .flat_map(|i| rows.chosen.iter().map(|j| all[3 * i + j]).collect::<Vec<_>>())
            .collect();
        let mut force = [0.7, -0.2];
        assert!(rows.factor(&few));
        rows.cancel(&mut force);
        for (i, wanted) in [0.7, -0.2].into_iter().enumerate() {
            let made: f64 = (0..2).map(|j| few[2 * i + j] * force[j]).sum();
            assert!((made + wanted).abs() < 1e-14);
        }
    }
}
