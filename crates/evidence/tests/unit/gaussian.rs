//! Tests of what is private in `gaussian.rs`.

use super::log_below;

/// Abramowitz and Stegun, tables 26.1 and 26.2.
#[test]
fn probabilities_are_those_of_the_tables() {
    let table = [(0.0, 0.5), (1.0, 0.841_344_746_068_5), (-7.0, 1.279_812_543_886e-12)];
    for (x, p) in table {
        assert!((log_below(x) - f64::ln(p)).abs() < 1e-12, "{x}");
    }
    let [above, below] = [-36.999_999, -37.000_001].map(log_below);
    assert!((above - below - 37.027e-6 * 2.0).abs() < 2e-6, "{above} {below}");
}
