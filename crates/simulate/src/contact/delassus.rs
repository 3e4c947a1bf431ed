//! The Delassus matrix G = J M^-1 J^T: how contact forces accelerate contact points.

use super::cholesky::{backward, dot, factorise, forward, subtract};

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

/// M = U^T U, the columns U^-T J^T and their products; memory that grows to the largest and stays.
///
/// Coordinates are taken in reverse order, leaves of the tree before their parents: then U is as
/// sparse as M, and what is zero costs nothing.
#[derive(Clone, Debug, Default)]
pub struct Delassus {
    dof: usize,
    rows: usize,
    /// Row-major upper factor of M with its coordinates reversed.
    factor: Vec<f64>,
    /// Row-major, `dof` x `rows`: U^-T J^T.
    half: Vec<f64>,
    /// Row-major, `rows` x `rows`.
    matrix: Vec<f64>,
    /// Number of factorisations and projections so far.
    changes: u64,
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

    /// A number that another factorisation or projection changes.
    pub(crate) fn changes(&self) -> u64 {
        self.changes
    }

    /// G, row-major, `rows` x `rows` [1/kg for rows of a point's velocity].
    pub fn matrix(&self) -> &[f64] {
        &self.matrix
    }

    /// Factors the mass matrix (symmetric, `dof` x `dof`).
    pub fn factor(&mut self, mass: &[f64], dof: usize) -> Result<(), NotPositiveDefinite> {
        assert_eq!(mass.len(), dof * dof, "a square matrix");
        self.dof = dof;
        self.rows = 0;
        self.changes += 1;
        self.factor.clear();
        // Rows and columns backwards: all entries backwards.
        self.factor.extend(mass.iter().rev());
        factorise(&mut self.factor, dof)
            .map_err(|row| NotPositiveDefinite { coordinate: dof - 1 - row })
    }

    /// Forms G for the rows of `jacobian` (row-major, `dof` columns); the mass matrix has been
    /// factored.
    pub fn project(&mut self, jacobian: &[f64]) {
        let dof = self.dof;
        let rows = jacobian.len().checked_div(dof).unwrap_or(0);
        assert_eq!(jacobian.len(), rows * dof, "whole rows");
        self.rows = rows;
        self.changes += 1;
        self.half.clear();
        self.half.resize(rows * dof, 0.0);
        self.matrix.clear();
        self.matrix.resize(rows * rows, 0.0);
        if rows == 0 {
            return;
        }
        for (r, row) in jacobian.chunks_exact(dof).enumerate() {
            for (i, entry) in row.iter().rev().enumerate() {
                self.half[i * rows + r] = *entry;
            }
        }
        for i in 0..dof {
            let (upper, below) = self.half.split_at_mut((i + 1) * rows);
            let line = &mut upper[i * rows..];
            let factors = &self.factor[i * dof..(i + 1) * dof];
            for entry in line.iter_mut() {
                *entry *= factors[i];
            }
            for (other, factor) in below.chunks_exact_mut(rows).zip(&factors[i + 1..]) {
                subtract(other, *factor, line);
            }
            for (r, target) in self.matrix.chunks_exact_mut(rows).enumerate() {
                subtract(&mut target[..=r], -line[r], line);
            }
        }
        for i in 0..rows {
            for j in 0..i {
                self.matrix[j * rows + i] = self.matrix[i * rows + j];
            }
        }
    }

    /// x := M^-1 x.
    pub fn solve_mass(&self, x: &mut [f64]) {
        x.reverse();
        forward(&self.factor, x);
        backward(&self.factor, x);
        x.reverse();
    }

    /// v := v + M^-1 J^T f: what forces (or impulses) of the rows do to the acceleration (or
    /// velocity). `scratch` has `dof` entries.
    pub fn respond(&self, force: &[f64], v: &mut [f64], scratch: &mut [f64]) {
        let rows = self.rows;
        if rows == 0 {
            return;
        }
        for (sum, line) in scratch.iter_mut().zip(self.half.chunks_exact(rows)) {
            *sum = dot(line, force);
        }
        backward(&self.factor, scratch);
        for (entry, change) in v.iter_mut().zip(scratch.iter().rev()) {
            *entry += change;
        }
    }
}
