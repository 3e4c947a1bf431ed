//! Monomials as integers: all exponents packed into one wide integer, so that the product of two
//! monomials is the sum of two integers.

use std::cmp::Ordering;
use std::hash::{Hash, Hasher};

/// A packed exponent vector: the integer sum of `exponent * 2^position` over all fields, modulo
/// 2^(64 N). Exponents may be negative; a field borrows from the one above it, which the sum of
/// two keys undoes again, so that packing is linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Key<const N: usize>([u64; N]);

impl<const N: usize> Hash for Key<N> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.iter().for_each(|&limb| state.write_u64(limb));
    }
}

/// The order of the unsigned integers: what stands in higher fields counts first.
impl<const N: usize> Ord for Key<N> {
    #[inline]
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.iter().rev().cmp(other.0.iter().rev())
    }
}

impl<const N: usize> PartialOrd for Key<N> {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<const N: usize> Key<N> {
    /// All exponents 0.
    pub(super) const ZERO: Self = Self([0; N]);

    /// `value * 2^position`.
    pub(super) fn shifted(value: i64, position: usize) -> Self {
        let (limb, bit) = (position / 64, position % 64);
        let wide = (i128::from(value) << bit) as u128;
        let fill = if value < 0 { u64::MAX } else { 0 };
        let mut limbs = [0; N];
        for (index, place) in limbs.iter_mut().enumerate().skip(limb) {
            *place = match index - limb {
                0 => wide as u64,
                1 => (wide >> 64) as u64,
                _ => fill,
            };
        }
        Self(limbs)
    }

    #[inline]
    pub(super) fn plus(mut self, other: Self) -> Self {
        let mut carry = false;
        for (a, b) in self.0.iter_mut().zip(other.0) {
            let (sum, first) = a.overflowing_add(b);
            let (sum, second) = sum.overflowing_add(u64::from(carry));
            (*a, carry) = (sum, first | second);
        }
        self
    }

    #[inline]
    pub(super) fn minus(mut self, other: Self) -> Self {
        let mut borrow = false;
        for (a, b) in self.0.iter_mut().zip(other.0) {
            let (difference, first) = a.overflowing_sub(b);
            let (difference, second) = difference.overflowing_sub(u64::from(borrow));
            (*a, borrow) = (difference, first | second);
        }
        self
    }

    /// The part below `position` of a key whose field just below it is not filled: the exponents
    /// there, with their signs.
    #[inline]
    pub(super) fn below(mut self, position: usize) -> Self {
        let (limb, bit) = ((position - 1) / 64, (position - 1) % 64);
        // The sign of what is below stands in the bit before `position`.
        let fill = if self.0[limb] >> bit & 1 == 1 { u64::MAX } else { 0 };
        let keep = (1 << bit) - 1;
        self.0[limb] = self.0[limb] & keep | fill & !keep;
        self.0[limb + 1..].fill(fill);
        self
    }

    /// Whether the integer is negative.
    #[inline]
    pub(super) fn is_negative(&self) -> bool {
        self.0[N - 1] >> 63 == 1
    }

    /// The bits of a field, as they stand.
    pub(super) fn bits(&self, position: usize, width: usize) -> u64 {
        let (limb, bit) = (position / 64, position % 64);
        let low = self.0[limb] >> bit;
        let high = match self.0.get(limb + 1) {
            Some(next) if bit > 0 => next << (64 - bit),
            _ => 0,
        };
        (low | high) & ((1 << width) - 1)
    }

    /// The lowest bit, which no exponent uses.
    #[inline]
    pub(super) fn flag(&self) -> bool {
        self.0[0] & 1 == 1
    }

    /// The key with the lowest bit set so.
    #[inline]
    pub(super) fn with_flag(mut self, flag: bool) -> Self {
        self.0[0] = self.0[0] & !1 | u64::from(flag);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The signed integer of a two-limb key.
    fn value(key: Key<2>) -> i128 {
        (u128::from(key.0[1]) << 64 | u128::from(key.0[0])) as i128
    }

    #[test]
    fn arithmetic_is_that_of_wide_integers() {
        let numbers = [0, 1, -1, 3, -3, 0x7fff_ffff];
        for (a, b) in numbers.into_iter().flat_map(|a| numbers.map(|b| (a, b))) {
            for (i, j) in [(0, 1), (60, 62), (63, 64), (70, 3)] {
                let (x, y) = (Key::<2>::shifted(a, i), Key::<2>::shifted(b, j));
                let (u, v) = (i128::from(a) << i, i128::from(b) << j);
                assert_eq!(value(x), u);
                assert_eq!(value(x.plus(y)), u + v);
                assert_eq!(value(x.minus(y)), u - v);
                assert_eq!(x.is_negative(), u < 0);
            }
        }
    }

    #[test]
    fn a_key_comes_apart_at_a_boundary() {
        for (low, high) in [(5, 9), (-5, 9), (5, -9), (-5, -9), (0, -1), (-7, 0)] {
            for position in [5, 60, 63, 64, 65, 100] {
                let (x, y) = (Key::<2>::shifted(low, 1), Key::<2>::shifted(high, position));
                assert_eq!(x.plus(y).below(position), x, "{low} {high} {position}");
            }
        }
    }

    #[test]
    fn fields_are_read_across_limbs() {
        let key = Key::<2>::shifted(0b1011, 62).plus(Key::shifted(1, 0));
        assert_eq!([key.bits(62, 4), key.bits(61, 5), key.bits(0, 3)], [0b1011, 0b10110, 1]);
    }
}
