//! Square systems of any rank: the solution of least norm, and the null space.
//!
//! Gaussian elimination with full pivoting shows the rank; the solution that it gives is projected
//! onto the complement of the null space. The four points of a flat foot need this: 12 forces for 6
//! conditions.

/// A factored square matrix, and memory that grows to the largest and stays.
#[derive(Clone, Debug, Default)]
pub struct MinimumNorm {
    n: usize,
    rank: usize,
    /// Row-major: unit lower and upper factors of the permuted matrix.
    lu: Vec<f64>,
    rows: Vec<usize>,
    columns: Vec<usize>,
    /// Row-major, one orthonormal null vector per row.
    null: Vec<f64>,
    permuted: Vec<f64>,
}

impl MinimumNorm {
    /// No memory yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Factors `a` (row-major, n x n); pivots below `tolerance` times the largest entry are zero.
    pub fn factor(&mut self, a: &[f64], n: usize, tolerance: f64) {
        self.factor_range(a, n, tolerance);
        self.find_null_space();
    }

    /// As `factor`, for the range alone: null vectors wait for `find_null_space`.
    pub fn factor_range(&mut self, a: &[f64], n: usize, tolerance: f64) {
        assert_eq!(a.len(), n * n, "a square matrix");
        self.n = n;
        self.lu.clear();
        self.lu.extend_from_slice(a);
        for order in [&mut self.rows, &mut self.columns] {
            order.clear();
            order.extend(0..n);
        }
        self.rank = n;
        let mut threshold = 0.0;
        for step in 0..n {
            let (row, column) = self.largest_below(step);
            let pivot = self.lu[row * n + column].abs();
            if step == 0 {
                threshold = pivot * tolerance;
            }
            if pivot <= threshold || pivot.is_nan() {
                self.rank = step;
                break;
            }
            self.exchange(step, row, column);
            self.eliminate(step);
        }
        self.null.clear();
    }

    /// A = L R, with as many columns of L (n x rank) and rows of R (rank x n) as A has rank;
    /// row-major.
    pub fn full_rank_factors(&self, left: &mut Vec<f64>, right: &mut Vec<f64>) {
        let (n, rank) = (self.n, self.rank);
        for factor in [&mut *left, &mut *right] {
            factor.clear();
            factor.resize(n * rank, 0.0);
        }
        for (i, row) in self.rows.iter().enumerate() {
            let line = &mut left[row * rank..(row + 1) * rank];
            let known = i.min(rank);
            line[..known].copy_from_slice(&self.lu[i * n..i * n + known]);
            if i < rank {
                line[i] = 1.0;
            }
        }
        for i in 0..rank {
            for j in i..n {
                right[i * n + self.columns[j]] = self.lu[i * n + j];
            }
        }
    }

    /// Writes d of L d = b, by the independent rows; returns by how much the others are missed.
    pub fn reduce(&self, b: &[f64], d: &mut Vec<f64>) -> f64 {
        let (n, rank) = (self.n, self.rank);
        d.clear();
        let mut missed = 0.0_f64;
        for (i, row) in self.rows.iter().enumerate() {
            let line = &self.lu[i * n..i * n + i.min(rank)];
            let left = b[*row] - line.iter().zip(&*d).map(|(l, d)| l * d).sum::<f64>();
            if i < rank {
                d.push(left);
            } else {
                missed = missed.max(left.abs());
            }
        }
        missed
    }

    /// The numerical rank.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Number of null vectors.
    pub fn nullity(&self) -> usize {
        self.n - self.rank
    }

    /// Null vector number `index`; all are orthonormal.
    pub fn null_vector(&self, index: usize) -> &[f64] {
        &self.null[index * self.n..(index + 1) * self.n]
    }

    /// Writes the x of least norm among those that solve the independent rows of A x = b.
    ///
    /// Returns by how much the other rows are missed, in the units of b.
    pub fn solve(&mut self, b: &[f64], x: &mut [f64]) -> f64 {
        let (n, rank) = (self.n, self.rank);
        assert!(b.len() == n && x.len() == n, "the vectors fit the matrix");
        self.permuted.clear();
        self.permuted.extend(self.rows.iter().map(|&row| b[row]));
        let y = &mut self.permuted;
        for i in 0..n {
            let known = i.min(rank);
            let sum: f64 = (0..known).map(|j| self.lu[i * n + j] * y[j]).sum();
            y[i] -= sum;
        }
        let missed = y[rank..].iter().fold(0.0_f64, |worst, entry| worst.max(entry.abs()));
        for i in (0..rank).rev() {
            let sum: f64 = (i + 1..rank).map(|j| self.lu[i * n + j] * y[j]).sum();
            y[i] = (y[i] - sum) / self.lu[i * n + i];
        }
        x.fill(0.0);
        for i in 0..rank {
            x[self.columns[i]] = y[i];
        }
        for index in 0..self.nullity() {
            let along: f64 = self.null_vector(index).iter().zip(&*x).map(|(a, b)| a * b).sum();
            for (entry, direction) in x.iter_mut().zip(&self.null[index * n..]) {
                *entry -= along * direction;
            }
        }
        missed
    }

    /// Row and column of the largest entry that is left; of equal ones the first.
    fn largest_below(&self, step: usize) -> (usize, usize) {
        let n = self.n;
        let (mut best, mut row) = (-1.0, step);
        for (index, line) in self.lu.chunks_exact(n).enumerate().skip(step) {
            let size = largest(&line[step..]);
            if size > best {
                (best, row) = (size, index);
            }
        }
        let line = &self.lu[row * n + step..(row + 1) * n];
        let place = line.iter().position(|entry| entry.abs() == best);
        (row, step + place.unwrap_or(0))
    }

    fn exchange(&mut self, step: usize, row: usize, column: usize) {
        let n = self.n;
        self.rows.swap(step, row);
        self.columns.swap(step, column);
        for j in 0..n {
            self.lu.swap(step * n + j, row * n + j);
        }
        for i in 0..n {
            self.lu.swap(i * n + step, i * n + column);
        }
    }

    fn eliminate(&mut self, step: usize) {
        let n = self.n;
        let (upper, lower) = self.lu.split_at_mut((step + 1) * n);
        let pivot_row = &upper[step * n..];
        for line in lower.chunks_exact_mut(n) {
            let factor = line[step] / pivot_row[step];
            line[step] = factor;
            for (entry, pivot) in line[step + 1..].iter_mut().zip(&pivot_row[step + 1..]) {
                *entry -= factor * pivot;
            }
        }
    }

    /// The null vectors, after `factor_range`: x_free = e_k, U1 x_basic = -U2 e_k, then
    /// Gram-Schmidt, twice.
    pub fn find_null_space(&mut self) {
        let (n, rank) = (self.n, self.rank);
        self.null.clear();
        self.null.resize((n - rank) * n, 0.0);
        for index in 0..n - rank {
            let free = rank + index;
            let (done, rest) = self.null.split_at_mut(index * n);
            let vector = &mut rest[..n];
            vector[self.columns[free]] = 1.0;
            for i in (0..rank).rev() {
                let known: f64 = (i + 1..rank)
                    .map(|j| self.lu[i * n + j] * vector[self.columns[j]])
                    .sum::<f64>()
                    + self.lu[i * n + free];
                vector[self.columns[i]] = -known / self.lu[i * n + i];
            }
            for _ in 0..2 {
                for other in done.chunks_exact(n) {
                    let along: f64 = other.iter().zip(&*vector).map(|(a, b)| a * b).sum();
                    for (entry, direction) in vector.iter_mut().zip(other) {
                        *entry -= along * direction;
                    }
                }
                let length = vector.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
                for entry in vector.iter_mut() {
                    *entry /= length;
                }
            }
        }
    }
}

/// The largest magnitude, in lanes that do not wait for each other; NaN is passed over.
fn largest(entries: &[f64]) -> f64 {
    let mut lanes = [0.0_f64; 4];
    let chunks = entries.chunks_exact(4);
    let rest = chunks.remainder();
    let larger = |most: &mut f64, entry: &f64| {
        if entry.abs() > *most {
            *most = entry.abs();
        }
    };
    for chunk in chunks {
        lanes.iter_mut().zip(chunk).for_each(|(most, entry)| larger(most, entry));
    }
    lanes.iter_mut().zip(rest).for_each(|(most, entry)| larger(most, entry));
    lanes.iter().fold(0.0, |most, lane| if *lane > most { *lane } else { most })
}
