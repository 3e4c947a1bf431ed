//! Sine and cosine in fixed point on big integers: Machin's pi and Taylor's series. It shares
//! neither tables nor polynomials with the crate.

use num_bigint::BigInt;
use num_traits::{Euclid, Signed, ToPrimitive, Zero};

/// Fractional bits of pi and of the argument: 1024 for the largest `f64`, and 350 to spare.
const REDUCTION_BITS: u32 = 1374;
/// Fractional bits of the results. Even where a result is as small as 2^-62, 220 are significant.
const RESULT_BITS: u32 = 282;

/// A sine or cosine, scaled by 2^RESULT_BITS.
pub(crate) struct Exact(BigInt);

impl Exact {
    /// The distance of `computed` from the exact value, in units of the last place that a
    /// significand of `significand_bits` bits has at the exact value.
    pub(crate) fn error_ulp(&self, computed: f64, significand_bits: u32) -> f64 {
        let difference = scaled(computed, RESULT_BITS) - &self.0;
        let last_place = self.0.magnitude().bits() as i32 - significand_bits as i32;
        difference.abs().to_f64().unwrap() * 2_f64.powi(-last_place)
    }
}

pub(crate) struct Reference {
    half_pi: BigInt,
}

impl Reference {
    pub(crate) fn new() -> Self {
        let pi_quarter = 4 * arctangent_of_inverse(5) - arctangent_of_inverse(239);
        Self { half_pi: 2 * pi_quarter }
    }

    /// `(sin x, cos x)` for 2^-100 < |x| < infinity.
    pub(crate) fn sincos(&self, x: f64) -> (Exact, Exact) {
        let x = scaled(x, REDUCTION_BITS);
        // Rounded to the nearest: floor((2x + pi/2) / pi).
        let turns = Euclid::div_euclid(&(&x * 2 + &self.half_pi), &(&self.half_pi * 2));
        let rest = (x - &turns * &self.half_pi) >> (REDUCTION_BITS - RESULT_BITS);
        let (sine, cosine) = taylor(&rest);
        let (sine, cosine) = match Euclid::rem_euclid(&turns, &BigInt::from(4)).to_u32().unwrap() {
            0 => (sine, cosine),
            1 => (cosine, -sine),
            2 => (-sine, -cosine),
            _ => (-cosine, sine),
        };
        (Exact(sine), Exact(cosine))
    }

    /// The `f64` nearest to `turns * pi/2`, give or take one unit in the last place.
    pub(crate) fn quarter_turns(&self, turns: u32) -> f64 {
        let product = turns * &self.half_pi;
        (product >> (REDUCTION_BITS - 80)).to_f64().unwrap() * 2_f64.powi(-80)
    }

    /// Those `f64` of the form integer * 2^exponent that come closest to a multiple of pi/2: the
    /// integers are the denominators below 2^53 of the last convergents of 2^exponent * 2/pi.
    pub(crate) fn hardest(&self, exponent: i32) -> Vec<f64> {
        let mut dividend = BigInt::from(1) << (REDUCTION_BITS as i32 + exponent);
        let mut divisor = self.half_pi.clone();
        let (mut previous, mut current) = (0_u128, 1_u128);
        let mut found = Vec::new();
        while current < 1 << 53 {
            found.push(current as f64 * 2_f64.powi(exponent));
            let rest = dividend % &divisor;
            (dividend, divisor) = (divisor, rest);
            let quotient = (&dividend / &divisor).to_u128().unwrap_or(1 << 53).min(1 << 53);
            (previous, current) = (current, quotient * current + previous);
        }
        found.split_off(found.len().saturating_sub(4))
    }
}

/// `value * 2^bits`, exact if no bit of `value` weighs less than 2^-bits.
fn scaled(value: f64, bits: u32) -> BigInt {
    if value.is_zero() {
        return BigInt::zero();
    }
    let exponent = (value.to_bits() >> 52 & 0x7ff) as i32 - 1075;
    let significand = (value.to_bits() & ((1 << 52) - 1)) | 1 << 52;
    let shift = exponent + bits as i32;
    assert!(shift >= 0, "{value:e} is too small for this reference");
    let magnitude = BigInt::from(significand) << shift;
    if value.is_sign_negative() { -magnitude } else { magnitude }
}

/// arctan(1/n) = sum (-1)^k / ((2k + 1) n^(2k+1)), scaled by 2^REDUCTION_BITS.
fn arctangent_of_inverse(n: u32) -> BigInt {
    let mut power = (BigInt::from(1) << REDUCTION_BITS) / n;
    let mut sum = BigInt::zero();
    let mut k = 0_i32;
    while !power.is_zero() {
        let term = &power / (2 * k + 1);
        sum += if k % 2 == 0 { term } else { -term };
        power /= n * n;
        k += 1;
    }
    sum
}

/// `(sin r, cos r)` by r^k / k!, everything scaled by 2^RESULT_BITS.
fn taylor(r: &BigInt) -> (BigInt, BigInt) {
    let mut term = BigInt::from(1) << RESULT_BITS;
    let (mut sine, mut cosine) = (BigInt::zero(), BigInt::zero());
    let mut k = 0_u32;
    while !term.is_zero() && term != BigInt::from(-1) {
        let sum = if k.is_multiple_of(2) { &mut cosine } else { &mut sine };
        if k % 4 < 2 {
            *sum += &term
        } else {
            *sum -= &term
        }
        k += 1;
        term = ((term * r) >> RESULT_BITS) / k;
    }
    (sine, cosine)
}
