//! Functions of the normal distribution.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// log of the probability that a normal variable is below `x`. Where that has no digits left it is
/// Mills' ratio, to a part in a million.
pub(crate) fn log_below(x: f64) -> f64 {
    if x > -37.0 {
        return (0.5 * libm::erfc(-x * FRAC_1_SQRT_2)).ln();
    }
    -0.5 * (x * x + TAU.ln()) - (-x - 1.0 / x).ln()
}

#[cfg(test)]
#[path = "../tests/unit/gaussian.rs"]
mod tests;
