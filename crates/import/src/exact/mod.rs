//! Numbers: decimals as the rationals that they say, and functions of them to more digits than any
//! file has.

mod matrix;
mod series;

pub(crate) use matrix::{Matrix, Vector, identity, product, transformed, transposed};
pub(crate) use series::{pi, root, sine_and_cosine};

use denavit_codegen::number::{Rational, parse_decimal};
use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

/// Significant digits of numbers that cannot be written exactly: one more than a double has.
const DIGITS: i64 = 17;
/// Zeros after the point, or digits before it, from which on an exponent is written.
const PLAIN: i64 = 7;

/// A decimal of a file. Files have `+1`, `5.` and `.5`, which are read alike.
pub(crate) fn decimal(text: &str) -> Option<Rational> {
    parse_decimal(text).ok()
}

/// Ten to a power.
pub(crate) fn power_of_ten(exponent: i64) -> Rational {
    let power = num_traits::pow(BigInt::from(10), exponent.unsigned_abs() as usize);
    let power = Rational::from_integer(power);
    if exponent < 0 { power.recip() } else { power }
}

/// The number as an exact decimal, or, where no decimal says it, rounded to 17 digits.
pub(crate) fn written(value: &Rational) -> String {
    exactly(value).unwrap_or_else(|| rounded_text(value))
}

/// The number as a decimal, if a decimal says it.
pub(crate) fn exactly(value: &Rational) -> Option<String> {
    let mut rest = value.denom().clone();
    let mut places = [0_i64; 2];
    for (prime, count) in [2, 5].into_iter().zip(&mut places) {
        let prime = BigInt::from(prime);
        while (&rest % &prime).is_zero() {
            rest /= &prime;
            *count += 1;
        }
    }
    if !rest.is_one() {
        return None;
    }
    let places = places[0].max(places[1]);
    let scaled = value * power_of_ten(places);
    Some(digits_text(scaled.numer(), places))
}

/// The number, rounded to 17 significant digits.
pub(crate) fn rounded(value: &Rational) -> Rational {
    if value.is_zero() {
        return value.clone();
    }
    let unit = power_of_ten(leading_place(value) + 1 - DIGITS);
    (value / &unit).round() * unit
}

/// The number with at most fifty digits after the point: products of roundings need no more.
pub(crate) fn shortened(value: Rational) -> Rational {
    const LONG: u64 = 240;
    if value.denom().bits() < LONG {
        return value;
    }
    let unit = power_of_ten(50);
    let whole = (value * &unit).round().to_integer();
    Rational::new(whole, unit.to_integer())
}

fn rounded_text(value: &Rational) -> String {
    exactly(&rounded(value)).unwrap_or_else(|| value.to_string())
}

/// The place of the first digit: 0 for 1 to 9, -1 for 0.1 to 0.9.
fn leading_place(value: &Rational) -> i64 {
    let size = value.abs();
    let digits = |number: &BigInt| number.to_string().len() as i64;
    let guess = digits(size.numer()) - digits(size.denom());
    if size >= power_of_ten(guess) { guess } else { guess - 1 }
}

/// `digits / 10^places` as text.
fn digits_text(digits: &BigInt, places: i64) -> String {
    if digits.is_zero() {
        return "0".to_owned();
    }
    let sign = if digits.is_negative() { "-" } else { "" };
    let mut text = digits.magnitude().to_string();
    let mut places = places;
    while places > 0 && text.ends_with('0') {
        text.pop();
        places -= 1;
    }
    let length = text.len() as i64;
    if places == 0 {
        return format!("{sign}{text}");
    }
    if places - length >= PLAIN {
        let (first, rest) = text.split_at(1);
        let point = if rest.is_empty() { "" } else { "." };
        return format!("{sign}{first}{point}{rest}e{}", length - 1 - places);
    }
    let padded = format!("{text:0>width$}", width = places as usize + 1);
    let (whole, fraction) = padded.split_at(padded.len() - places as usize);
    format!("{sign}{whole}.{fraction}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use denavit_codegen::number::ratio;

    #[test]
    fn decimals_come_back_as_they_are() {
        for text in ["0", "-1.25", "0.000123", "1e-9", "-2.5e-12", "1200", "3.141592653589793"] {
            let value = decimal(text).expect("a decimal");
            assert_eq!(written(&value), text);
        }
        for (text, plain) in [("5.", "5"), ("+.5", "0.5"), ("1.0e+00", "1"), ("-0.0", "0")] {
            assert_eq!(written(&decimal(text).expect("a decimal")), plain);
        }
        assert_eq!(decimal("0x10"), None);
    }

    #[test]
    fn what_no_decimal_says_is_rounded_to_seventeen_digits() {
        assert_eq!(written(&ratio(2, 3)), "0.66666666666666667");
        assert_eq!(written(&ratio(-1, 30_000_000)), "-3.3333333333333333e-8");
        assert_eq!(written(&ratio(1000, 3)), "333.33333333333333");
        assert_eq!(rounded(&ratio(1, 8)), ratio(1, 8));
    }
}
