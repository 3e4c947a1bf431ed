//! Residues modulo the Mersenne prime p = 2^61 - 1, where an exact zero test costs nanoseconds.
//!
//! Two different polynomials of degree d agree at a random point with a chance of at most d/p
//! (Schwartz-Zippel), below 1e-15 for everything here.

use super::Rational;
use num_bigint::{BigInt, Sign};
use std::ops::{Add, Mul, Neg, Sub};

const P: u64 = (1 << 61) - 1;

/// A residue modulo p = 2^61 - 1, always reduced to `0..p`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Residue(u64);

impl Residue {
    /// The prime p = 2^61 - 1.
    pub const MODULUS: u64 = P;
    /// The residue 0.
    pub const ZERO: Self = Self(0);
    /// The residue 1.
    pub const ONE: Self = Self(1);

    /// The residue of an unsigned integer.
    pub const fn new(value: u64) -> Self {
        Self(value % P)
    }

    /// The representative in `0..p`.
    pub const fn value(self) -> u64 {
        self.0
    }

    /// The residue of a rational; `None` if p divides its denominator.
    pub fn from_rational(value: &Rational) -> Option<Self> {
        let denominator = Self::from_integer(value.denom());
        denominator.inverse().map(|inverse| Self::from_integer(value.numer()) * inverse)
    }

    fn from_integer(value: &BigInt) -> Self {
        // Digits of base 2^32, most significant first: Horner's scheme.
        let (sign, digits) = value.to_u32_digits();
        let base = Self(1 << 32);
        let magnitude = digits
            .iter()
            .rev()
            .fold(Self::ZERO, |sum, &digit| sum * base + Self::new(u64::from(digit)));
        if sign == Sign::Minus { -magnitude } else { magnitude }
    }

    /// `self` to a power.
    pub fn power(self, exponent: u64) -> Self {
        let (mut result, mut base, mut rest) = (Self::ONE, self, exponent);
        while rest > 0 {
            if rest & 1 == 1 {
                result = result * base;
            }
            base = base * base;
            rest >>= 1;
        }
        result
    }

    /// The inverse, by Fermat's little theorem; `None` for 0.
    pub fn inverse(self) -> Option<Self> {
        (self != Self::ZERO).then(|| self.power(P - 2))
    }

    /// A residue that depends on `seed` and `key` alone and looks random (splitmix64 finaliser).
    pub const fn scrambled(seed: u64, key: u64) -> Self {
        let mut z = seed ^ key.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut round = 0;
        while round < 2 {
            z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^= z >> 31;
            round += 1;
        }
        Self::new(z)
    }
}

impl Add for Residue {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let sum = self.0 + other.0;
        Self(if sum >= P { sum - P } else { sum })
    }
}

impl Sub for Residue {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(if self.0 >= other.0 { self.0 - other.0 } else { self.0 + P - other.0 })
    }
}

impl Neg for Residue {
    type Output = Self;
    fn neg(self) -> Self {
        Self::ZERO - self
    }
}

impl Mul for Residue {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        // x = high 2^61 + low = high + low (mod p), because 2^61 = 1 (mod p).
        let product = u128::from(self.0) * u128::from(other.0);
        let sum = (product as u64 & P) + (product >> 61) as u64;
        Self(if sum >= P { sum - P } else { sum })
    }
}

#[cfg(test)]
mod tests {
    use super::super::ratio;
    use super::*;

    #[test]
    fn the_field_laws_hold() {
        for key in 0..200 {
            let [a, b, c] = [1, 2, 3].map(|seed| Residue::scrambled(seed, key));
            assert_eq!((a + b) * c, a * c + b * c);
            assert_eq!(a - b + b, a);
            assert_eq!(a * a.inverse().unwrap(), Residue::ONE);
        }
        assert_eq!(Residue::ZERO.inverse(), None);
    }

    #[test]
    fn products_agree_with_wide_arithmetic() {
        let big = BigInt::from(P);
        for key in 0..50 {
            let (a, b) = (Residue::scrambled(5, key), Residue::scrambled(6, key));
            let wide = BigInt::from(a.value()) * BigInt::from(b.value()) % &big;
            assert_eq!(BigInt::from((a * b).value()), wide);
        }
    }

    #[test]
    fn rationals_keep_their_equations() {
        let third = Residue::from_rational(&ratio(-1, 3)).unwrap();
        assert_eq!(third * Residue::new(3), -Residue::ONE);
        let p = Rational::from_integer(BigInt::from(P));
        assert_eq!(Residue::from_rational(&p), Some(Residue::ZERO));
        assert_eq!(Residue::from_rational(&p.recip()), None);
    }
}
