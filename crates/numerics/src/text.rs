//! Numbers as a person writes them.

/// A number with at most six significant digits, as a person writes it.
pub fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    let magnitude = rounded.abs();
    if rounded != 0.0 && !(1e-4..1e6).contains(&magnitude) {
        return format!("{rounded:e}");
    }
    // -0 is no number that a person writes
    format!("{}", rounded + 0.0)
}

/// A share as percents, in few digits; a dash where it means nothing.
pub fn percent(share: f64) -> String {
    let percents = 100.0 * share;
    if !percents.is_finite() || percents.abs() >= 1e5 {
        return "-".to_owned();
    }
    format!("{:.2} %", percents + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_never_minus_zero() {
        let texts = [25.290000000000003, -0.0, 3.35e-6, 51394.0, 1.0 / 3.0, -2e9].map(short);
        assert_eq!(texts, ["25.29", "0", "3.35e-6", "51394", "0.333333", "-2e9"]);
    }

    #[test]
    fn shares_without_meaning_are_dashes() {
        let texts = [0.12345, 1e300, f64::NAN, f64::INFINITY, -0.5].map(percent);
        assert_eq!(texts, ["12.35 %", "-", "-", "-", "-50.00 %"]);
    }
}
