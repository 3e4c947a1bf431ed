//! Symmetric positive definite systems: A = U^T U in place.
//!
//! Row operations whose entries do not wait for each other, and none for entries that are zero: the
//! branches of a robot are independent of each other, and in the right order stay so.

/// Replaces the upper triangle of `a` (row-major, n x n) by U, the diagonal by its inverses.
/// Returns the row of a pivot that is not positive.
pub(crate) fn factorise(a: &mut [f64], n: usize) -> Result<(), usize> {
    for i in 0..n {
        let (upper, lower) = a.split_at_mut((i + 1) * n);
        let row = &mut upper[i * n..];
        // Written so that NaN fails as well.
        if !(row[i] > 0.0 && row[i].is_finite()) {
            return Err(i);
        }
        let inverse = 1.0 / row[i].sqrt();
        row[i] = inverse;
        for entry in &mut row[i + 1..] {
            *entry *= inverse;
        }
        for (line, j) in lower.chunks_exact_mut(n).zip(i + 1..) {
            subtract(&mut line[j..], row[j], &row[j..]);
        }
    }
    Ok(())
}

/// x := U^-T x.
pub(crate) fn forward(u: &[f64], x: &mut [f64]) {
    let n = x.len();
    for i in 0..n {
        let row = &u[i * n..(i + 1) * n];
        let value = x[i] * row[i];
        x[i] = value;
        subtract(&mut x[i + 1..], value, &row[i + 1..]);
    }
}

/// x := U^-1 x.
pub(crate) fn backward(u: &[f64], x: &mut [f64]) {
    let n = x.len();
    for i in (0..n).rev() {
        let row = &u[i * n..(i + 1) * n];
        x[i] = (x[i] - dot(&row[i + 1..], &x[i + 1..])) * row[i];
    }
}

/// x := x - factor y.
pub(crate) fn subtract(x: &mut [f64], factor: f64, y: &[f64]) {
    if factor != 0.0 {
        for (entry, other) in x.iter_mut().zip(y) {
            *entry -= factor * other;
        }
    }
}

/// The scalar product, in four sums that do not wait for each other.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (mut left, mut right) = (a.chunks_exact(4), b.chunks_exact(4));
    for (x, y) in (&mut left).zip(&mut right) {
        for lane in 0..4 {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let rest: f64 = left.remainder().iter().zip(right.remainder()).map(|(x, y)| x * y).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}
