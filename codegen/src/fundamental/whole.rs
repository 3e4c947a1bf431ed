//! Whole numbers of two sizes: machine integers that notice when they do not suffice, and integers
//! without bounds.

use crate::number::Rational;
use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive, Zero};
use std::hash::Hash;

/// A result did not fit: the calculation must be done again with larger integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Overflow;

/// What sums and products of terms need of their numbers.
pub(super) trait Whole: Clone + Eq + Hash + From<i32> {
    fn from_big(value: &BigInt) -> Result<Self, Overflow>;
    fn to_big(&self) -> BigInt;
    fn is_zero(&self) -> bool;
    fn plus(&self, other: &Self) -> Result<Self, Overflow>;
    fn times(&self, other: &Self) -> Result<Self, Overflow>;
    fn negated(&self) -> Self;
    /// The largest common divisor, not negative.
    fn gcd(&self, other: &Self) -> Self;
    /// `self / divisor`, which leaves no rest.
    fn over(&self, divisor: &Self) -> Self;

    /// The smallest common multiple of two positive numbers.
    fn lcm(&self, other: &Self) -> Result<Self, Overflow> {
        self.times(&other.over(&self.gcd(other)))
    }
}

impl Whole for i64 {
    fn from_big(value: &BigInt) -> Result<Self, Overflow> {
        value.to_i64().filter(|&value| value != Self::MIN).ok_or(Overflow)
    }
    fn to_big(&self) -> BigInt {
        BigInt::from(*self)
    }
    #[inline]
    fn is_zero(&self) -> bool {
        *self == 0
    }
    #[inline]
    fn plus(&self, other: &Self) -> Result<Self, Overflow> {
        // i64::MIN has no opposite, so it counts as an overflow.
        self.checked_add(*other).filter(|&sum| sum != Self::MIN).ok_or(Overflow)
    }
    #[inline]
    fn times(&self, other: &Self) -> Result<Self, Overflow> {
        self.checked_mul(*other).filter(|&product| product != Self::MIN).ok_or(Overflow)
    }
    #[inline]
    fn negated(&self) -> Self {
        -*self
    }
    fn gcd(&self, other: &Self) -> Self {
        let (mut a, mut b) = (self.abs(), other.abs());
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    }
    fn over(&self, divisor: &Self) -> Self {
        self / divisor
    }
}

impl Whole for BigInt {
    fn from_big(value: &BigInt) -> Result<Self, Overflow> {
        Ok(value.clone())
    }
    fn to_big(&self) -> BigInt {
        self.clone()
    }
    fn is_zero(&self) -> bool {
        Zero::is_zero(self)
    }
    fn plus(&self, other: &Self) -> Result<Self, Overflow> {
        Ok(self + other)
    }
    fn times(&self, other: &Self) -> Result<Self, Overflow> {
        Ok(self * other)
    }
    fn negated(&self) -> Self {
        -self
    }
    fn gcd(&self, other: &Self) -> Self {
        if Zero::is_zero(other) {
            return self.abs();
        }
        // a / gcd(a, b) is the numerator of a/b.
        let reduced = Rational::new(self.clone(), other.clone());
        if Zero::is_zero(self) { other.abs() } else { (self / reduced.numer()).abs() }
    }
    fn over(&self, divisor: &Self) -> Self {
        self / divisor
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sizes_agree_on_divisors() {
        let numbers = [0i64, 1, -1, 6, -4, 10, 1 << 40, -(3 << 38)];
        for (a, b) in numbers.into_iter().flat_map(|a| numbers.map(|b| (a, b))) {
            let big = Whole::gcd(&BigInt::from(a), &BigInt::from(b));
            assert_eq!(BigInt::from(Whole::gcd(&a, &b)), big, "{a} {b}");
        }
        assert_eq!(Whole::gcd(&12i64, &-18), 6);
        assert_eq!(Whole::lcm(&4i64, &6), Ok(12));
    }

    #[test]
    fn machine_integers_notice_overflow() {
        assert_eq!(i64::MAX.plus(&1), Err(Overflow));
        assert_eq!((1i64 << 32).times(&(1 << 31)), Err(Overflow));
        assert_eq!((-i64::MAX).plus(&-1), Err(Overflow));
        assert_eq!(i64::from_big(&(BigInt::from(1) << 63)), Err(Overflow));
    }
}
