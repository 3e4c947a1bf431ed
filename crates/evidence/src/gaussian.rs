//! Functions of the normal distribution.

/// log of the probability that a normal variable is below `x`.
pub(crate) fn log_below(x: f64) -> f64 {
    if x > 6.0 {
        return 0.0;
    }
    if x < -6.0 {
        // Mills' ratio by its continued fraction, three terms of it.
        let y = -x;
        let ratio = y + 1.0 / (y + 2.0 / (y + 3.0 / (y + 4.0 / y)));
        return -0.5 * x * x - 0.5 * std::f64::consts::TAU.ln() - ratio.ln();
    }
    // The series of Marsaglia 2004, exact to rounding in this range.
    let (mut term, mut sum, mut k) = (x, x, 1.0);
    while f64::abs(term) > 1e-17 * f64::abs(sum) && k < 200.0 {
        k += 2.0;
        term *= x * x / k;
        sum += term;
    }
    let density = (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
    (0.5 + density * sum).max(f64::MIN_POSITIVE).ln()
}

#[cfg(test)]
mod tests {
    use super::log_below;

    /// Abramowitz and Stegun, tables 26.1 and 26.2.
    #[test]
    fn probabilities_are_those_of_the_tables() {
        for (x, p) in [(0.0, 0.5), (1.0, 0.841_344_746_068_5), (-2.0, 0.022_750_131_948_18)] {
            assert!((log_below(x).exp() - p).abs() < 1e-12, "{x}");
        }
        // Q(7) = 1.279812543886e-12
        assert!((log_below(-7.0) - 1.279_812_543_886e-12_f64.ln()).abs() < 1e-4);
        assert!(log_below(-40.0).is_finite());
        let (a, b) = (log_below(-5.999_999), log_below(-6.000_001));
        assert!((a - b).abs() < 2e-3, "{a} {b}");
    }
}
