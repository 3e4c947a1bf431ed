//! The Delassus matrix G = J M^-1 J^T: how contact forces accelerate contact points.

/// The mass matrix is not positive definite (or not finite).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotPositiveDefinite {
    /// The coordinate at which the factorisation failed.
    pub coordinate: usize,
}

impl std::fmt::Display for NotPositiveDefinite {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the mass matrix is not positive definite at coordinate {}", self.coordinate)
    }
}

impl std::error::Error for NotPositiveDefinite {}

/// M = L L^T, the rows J L^-T and their products; memory that grows to the largest and stays.
#[derive(Clone, Debug, Default)]
pub struct Delassus {
    dof: usize,
    rows: usize,
    /// Row-major lower factor; the diagonal holds inverses.
    factor: Vec<f64>,
    /// Row-major, `rows` x `dof`: row i is L^-1 J_i^T.
    half: Vec<f64>,
    /// Row-major, `rows` x `rows`.
    matrix: Vec<f64>,
}

impl Delassus {
    /// No memory yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of contact rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// G, row-major, `rows` x `rows` [1/kg for rows of a point's velocity].
    pub fn matrix(&self) -> &[f64] {
        &self.matrix
    }

    /// Factors the mass matrix (symmetric, `dof` x `dof`; its lower triangle is read).
    pub fn factor(&mut self, mass: &[f64], dof: usize) -> Result<(), NotPositiveDefinite> {
        assert_eq!(mass.len(), dof * dof, "a square matrix");
        self.dof = dof;
        self.rows = 0;
        self.factor.clear();
        self.factor.extend_from_slice(mass);
        let l = &mut self.factor;
        for i in 0..dof {
            let (above, rest) = l.split_at_mut(i * dof);
            let row = &mut rest[..dof];
            for j in 0..i {
                let other = &above[j * dof..(j + 1) * dof];
                let sum: f64 = row[..j].iter().zip(&other[..j]).map(|(a, b)| a * b).sum();
                row[j] = (row[j] - sum) * other[j];
            }
            let pivot = row[i] - row[..i].iter().map(|entry| entry * entry).sum::<f64>();
            // Written so that NaN fails as well.
            if !(pivot > 0.0 && pivot.is_finite()) {
                return Err(NotPositiveDefinite { coordinate: i });
            }
            row[i] = 1.0 / pivot.sqrt();
        }
        Ok(())
    }

    /// Forms G for the rows of `jacobian` (row-major, `dof` columns); the mass matrix has been
    /// factored.
    pub fn project(&mut self, jacobian: &[f64]) {
        let dof = self.dof;
        let rows = jacobian.len().checked_div(dof).unwrap_or(0);
        assert_eq!(jacobian.len(), rows * dof, "whole rows");
        self.rows = rows;
        self.half.clear();
        self.half.extend_from_slice(jacobian);
        for row in self.half.chunks_exact_mut(dof) {
            forward(&self.factor, dof, row);
        }
        self.matrix.clear();
        self.matrix.resize(rows * rows, 0.0);
        for i in 0..rows {
            for j in 0..=i {
                let (a, b) = (&self.half[i * dof..(i + 1) * dof], &self.half[j * dof..]);
                let sum: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
                self.matrix[i * rows + j] = sum;
                self.matrix[j * rows + i] = sum;
            }
        }
    }

    /// x := M^-1 x.
    pub fn solve_mass(&self, x: &mut [f64]) {
        forward(&self.factor, self.dof, x);
        backward(&self.factor, self.dof, x);
    }

    /// v := v + M^-1 J^T f: what forces (or impulses) of the rows do to the acceleration (or
    /// velocity). `scratch` has `dof` entries.
    pub fn respond(&self, force: &[f64], v: &mut [f64], scratch: &mut [f64]) {
        let dof = self.dof;
        scratch.fill(0.0);
        for (row, f) in self.half.chunks_exact(dof).zip(force) {
            if *f != 0.0 {
                for (sum, entry) in scratch.iter_mut().zip(row) {
                    *sum += f * entry;
                }
            }
        }
        backward(&self.factor, dof, scratch);
        for (entry, change) in v.iter_mut().zip(&*scratch) {
            *entry += change;
        }
    }
}

/// x := L^-1 x.
fn forward(l: &[f64], n: usize, x: &mut [f64]) {
    for i in 0..n {
        let row = &l[i * n..(i + 1) * n];
        let sum: f64 = row[..i].iter().zip(&x[..i]).map(|(a, b)| a * b).sum();
        x[i] = (x[i] - sum) * row[i];
    }
}

/// x := L^-T x.
fn backward(l: &[f64], n: usize, x: &mut [f64]) {
    for i in (0..n).rev() {
        let row = &l[i * n..(i + 1) * n];
        let value = x[i] * row[i];
        x[i] = value;
        for (entry, factor) in x[..i].iter_mut().zip(row) {
            *entry -= factor * value;
        }
    }
}
