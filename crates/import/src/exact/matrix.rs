//! Vectors and matrices of three rationals.

use denavit_codegen::number::{Rational, integer};

/// Three numbers.
pub(crate) type Vector = [Rational; 3];
/// Rows of three numbers.
pub(crate) type Matrix = [[Rational; 3]; 3];

/// The matrix 1.
pub(crate) fn identity() -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| integer(i64::from(row == column))))
}

/// `a b`.
pub(crate) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|row| {
        std::array::from_fn(|column| (0..3).map(|k| &a[row][k] * &b[k][column]).sum())
    })
}

/// The matrix with rows and columns exchanged.
pub(crate) fn transposed(a: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| a[column][row].clone()))
}

/// `a v`.
pub(crate) fn transformed(a: &Matrix, v: &Vector) -> Vector {
    std::array::from_fn(|row| (0..3).map(|k| &a[row][k] * &v[k]).sum())
}
