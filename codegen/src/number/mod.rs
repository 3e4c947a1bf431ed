//! Exact numbers: rationals of any size, decimals read as text, residues modulo 2^61 - 1.

mod decimal;
mod residue;

pub use decimal::{DecimalError, MAX_DECIMAL_DIGITS, decimal_text, parse_decimal};
pub use residue::Residue;

/// An exact rational number (num-rational on num-bigint).
pub type Rational = num_rational::BigRational;

/// The rational `numerator / denominator`; the denominator must not be 0.
pub fn ratio(numerator: i64, denominator: i64) -> Rational {
    Rational::new(numerator.into(), denominator.into())
}

/// The rational number of an integer.
pub fn integer(value: i64) -> Rational {
    Rational::from_integer(value.into())
}

/// The nearest `f64` of a rational, correctly rounded also when numerator or denominator alone
/// overflow; infinite only if the number itself is beyond `f64`.
pub fn to_f64(value: &Rational) -> f64 {
    num_traits::ToPrimitive::to_f64(value).unwrap_or(f64::NAN)
}
