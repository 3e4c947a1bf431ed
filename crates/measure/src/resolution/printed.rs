//! The distance of printed values: the coarsest of the formats that all values keep to.

use super::lattice::FEWEST_CHANGES;

/// Values that are looked at: one with all its digits is soon among them.
const SAMPLED: usize = 4096;

/// The distance of neighbouring values in the format of a column, root of mean square: so many
/// decimals, so many significant digits, or single precision. 0 of double precision, and where
/// values change too rarely to tell.
pub fn spacing(values: &[f64]) -> f64 {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let changes = finite().zip(finite().skip(1)).filter(|(one, other)| one != other).count();
    if changes < FEWEST_CHANGES {
        return 0.0;
    }
    let every = values.len().div_ceil(SAMPLED);
    let sampled: Vec<f64> = finite().step_by(every).collect();
    let of_single = || rms(&sampled, |value| f64::from(ulp(value as f32)));
    if finite().all(|value| f64::from(value as f32) == value) {
        // numbers of few digits, as quarters, are single too
        return of_single().max(of_decimals(&sampled));
    }
    let decimal = of_decimals(&sampled);
    let is_shortest = |value: &f64| format!("{}", *value as f32).parse() == Ok(*value);
    let is_single = decimal > 0.0 && sampled.iter().all(is_shortest);
    if is_single { of_single().max(decimal) } else { decimal }
}

/// Root of the mean square of the distances at values.
fn rms(values: &[f64], spacing: impl Fn(f64) -> f64) -> f64 {
    let squares: f64 = values.iter().map(|value| spacing(*value).powi(2)).sum();
    (squares / values.len().max(1) as f64).sqrt()
}

/// The distance of decimals, and of significant digits; 0 if some value has more digits than every
/// double holds.
fn of_decimals(sampled: &[f64]) -> f64 {
    let (mut most_decimals, mut most_digits) = (i32::MIN, 0);
    for &value in sampled.iter().filter(|value| **value != 0.0) {
        let (digits, exponent) = decimal(value);
        if digits > f64::DIGITS as i32 {
            return 0.0;
        }
        most_digits = most_digits.max(digits);
        most_decimals = most_decimals.max(digits - 1 - exponent);
    }
    let significant = rms(sampled, |value| match value {
        0.0 => 0.0,
        _ => 10.0_f64.powi(decimal(value).1 - most_digits + 1),
    });
    10.0_f64.powi(-most_decimals).max(significant)
}

/// Significant digits of the shortest decimal of a number, and its power of ten.
fn decimal(value: f64) -> (i32, i32) {
    let text = format!("{:e}", value.abs());
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let digits = mantissa.bytes().filter(u8::is_ascii_digit).count();
    (digits as i32, exponent.parse().unwrap_or(0))
}

/// The distance to the next number of single precision.
fn ulp(value: f32) -> f32 {
    value.abs().next_up() - value.abs()
}
