//! Vectors and matrices of three rationals.

use super::shortened;
use denavit_codegen::number::{Rational, integer};
use num_traits::{One, Zero};

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
        std::array::from_fn(|column| dot((0..3).map(|k| (&a[row][k], &b[k][column]))))
    })
}

/// The sum of products, to fifty digits where it has more.
fn dot<'r>(pairs: impl Iterator<Item = (&'r Rational, &'r Rational)>) -> Rational {
    let mut sum = Rational::zero();
    for (a, b) in pairs.filter(|(a, b)| !a.is_zero() && !b.is_zero()) {
        sum += if a.is_one() { b.clone() } else { a * b };
    }
    shortened(sum)
}

/// The matrix with rows and columns exchanged.
pub(crate) fn transposed(a: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| a[column][row].clone()))
}

/// `a v`.
pub(crate) fn transformed(a: &Matrix, v: &Vector) -> Vector {
    std::array::from_fn(|row| dot((0..3).map(|k| (&a[row][k], &v[k]))))
}
