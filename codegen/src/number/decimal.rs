//! Decimals read exactly from their text: `0.15005` is 15005/100000, never the nearest `f64`.

use super::Rational;
use num_bigint::BigInt;
use num_traits::{Signed, Zero};
use std::fmt;

/// Digits and decimal exponent together may not describe a number longer than this: a file of ten
/// bytes (`1e999999999`) must not fill the memory.
pub const MAX_DECIMAL_DIGITS: usize = 400;

/// Why a text is not a decimal that is read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DecimalError {
    /// The text is not `[-+] digits [. digits] [e [+-] digits]`.
    Malformed,
    /// The number has more digits than [`MAX_DECIMAL_DIGITS`], written out.
    TooLong,
}

impl fmt::Display for DecimalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Malformed => write!(f, "not a decimal number"),
            Self::TooLong => {
                write!(f, "the number is longer than {MAX_DECIMAL_DIGITS} digits when written out")
            }
        }
    }
}

impl std::error::Error for DecimalError {}

/// Reads `-12.5e-3` as the rational it says.
pub fn parse_decimal(text: &str) -> Result<Rational, DecimalError> {
    let (negative, rest) = match text.as_bytes().first() {
        Some(b'-') => (true, &text[1..]),
        Some(b'+') => (false, &text[1..]),
        _ => (false, text),
    };
    let (mantissa, exponent) = match rest.find(['e', 'E']) {
        Some(at) => (&rest[..at], parse_exponent(&rest[at + 1..])?),
        None => (rest, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let all_digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    if (whole.is_empty() && fraction.is_empty()) || !all_digits(whole) || !all_digits(fraction) {
        return Err(DecimalError::Malformed);
    }
    let digits = format!("{whole}{fraction}");
    let shift = exponent - i64::try_from(fraction.len()).map_err(|_| DecimalError::TooLong)?;
    let length = digits.len() as u64 + shift.unsigned_abs();
    if length > MAX_DECIMAL_DIGITS as u64 {
        return Err(DecimalError::TooLong);
    }
    let value: BigInt = digits.parse().map_err(|_| DecimalError::Malformed)?;
    let value = if negative { -value } else { value };
    if value.is_zero() {
        return Ok(Rational::zero());
    }
    let scale = num_traits::pow(BigInt::from(10), shift.unsigned_abs() as usize);
    Ok(if shift < 0 { Rational::new(value, scale) } else { Rational::from_integer(value * scale) })
}

fn parse_exponent(text: &str) -> Result<i64, DecimalError> {
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return Err(DecimalError::Malformed);
    }
    text.parse::<i32>().map(i64::from).map_err(|_| DecimalError::TooLong)
}

/// A rational as a person reads it: an exact decimal where it is a short one, else a fraction.
pub fn decimal_text(value: &Rational) -> String {
    let mut scaled = value.clone();
    for places in 0..=12 {
        if scaled.is_integer() {
            let digits = scaled.numer().magnitude().to_string();
            let padded = format!("{digits:0>width$}", width = places + 1);
            let (whole, fraction) = padded.split_at(padded.len() - places);
            let sign = if value.is_negative() { "-" } else { "" };
            let point = if places == 0 { "" } else { "." };
            return format!("{sign}{whole}{point}{fraction}");
        }
        scaled *= Rational::from_integer(10.into());
    }
    value.to_string()
}

#[cfg(test)]
mod tests {
    use super::super::{integer, ratio};
    use super::*;

    #[test]
    fn decimals_are_read_exactly() {
        assert_eq!(parse_decimal("0.15005"), Ok(ratio(3001, 20000)));
        assert_eq!(parse_decimal("-12.5e-3"), Ok(ratio(-1, 80)));
        assert_eq!(parse_decimal("2E3"), Ok(integer(2000)));
        assert_eq!(parse_decimal(".5"), Ok(ratio(1, 2)));
        assert_eq!(parse_decimal("0e300"), Ok(integer(0)));
    }

    #[test]
    fn short_decimals_are_written_as_such() {
        let texts = [ratio(3001, 20000), ratio(-1, 80), integer(-20), ratio(1, 3), integer(0)]
            .map(|value| decimal_text(&value));
        assert_eq!(texts, ["0.15005", "-0.0125", "-20", "1/3", "0"]);
    }

    #[test]
    fn what_is_no_decimal_is_refused() {
        for text in ["", ".", "-", "1e", "1e+", "0x10", "1_000", "NaN", "inf", "1.2.3", "１"] {
            assert_eq!(parse_decimal(text), Err(DecimalError::Malformed), "{text}");
        }
        for text in ["1e999999999", "1e-401", "1e99999999999999999999"] {
            assert_eq!(parse_decimal(text), Err(DecimalError::TooLong), "{text}");
        }
    }
}
