//! Trigonometric polynomials: sums of cosines and sines of whole combinations of angles, times
//! monomials in other indeterminates, with rational coefficients.
//!
//! In the real basis `cos(k.q)`, `sin(k.q)` with the sign of k normalised, every function has one
//! form. Products follow from the addition theorems and are two additions of keys:
//!
//! ```text
//! 2 cos a cos b = cos(a+b) + cos(a-b)      2 sin a cos b = sin(a+b) + sin(a-b)
//! 2 sin a sin b = cos(a-b) - cos(a+b)      2 cos a sin b = sin(a+b) - sin(a-b)
//! ```

use super::key::Key;
use super::whole::{Overflow, Whole};
use crate::number::Rational;
use num_traits::Zero;
use rustc_hash::FxHashMap;
use std::cmp::Ordering;

/// A trigonometric polynomial in normal form: equal functions have equal series.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Series<const N: usize, C> {
    /// Common denominator, positive; no number divides it and all coefficients.
    pub(super) denominator: C,
    /// Keys, increasing, with numerators that are not 0. The lowest bit of a key tells a sine.
    pub(super) terms: Vec<(Key<N>, C)>,
}

/// Why a series was not made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SeriesError {
    /// A coefficient does not fit its integers.
    Overflow,
    /// There are more terms than allowed.
    TooManyTerms,
}

impl From<Overflow> for SeriesError {
    fn from(_: Overflow) -> Self {
        Self::Overflow
    }
}

/// Products of at least this many terms by as many are summed in a hash table, shorter ones by
/// sorting.
const HASHED: usize = 3;

impl<const N: usize, C: Whole> Series<N, C> {
    /// The number 0.
    pub(super) fn zero() -> Self {
        Self { denominator: C::from(1), terms: Vec::new() }
    }

    /// A number.
    pub(super) fn constant(value: &Rational) -> Result<Self, Overflow> {
        if value.is_zero() {
            return Ok(Self::zero());
        }
        let terms = vec![(Key::ZERO, C::from_big(value.numer())?)];
        Ok(Self { denominator: C::from_big(value.denom())?, terms })
    }

    /// One key, with the coefficient 1.
    pub(super) fn key(key: Key<N>) -> Self {
        Self { denominator: C::from(1), terms: vec![(key, C::from(1))] }
    }

    /// cos or sin of an angle with the sign of its key normalised.
    pub(super) fn wave(angle: Key<N>, is_sine: bool) -> Self {
        if angle == Key::ZERO {
            return if is_sine { Self::zero() } else { Self::key(angle) };
        }
        if angle.is_negative() {
            let wave = Self::key(Key::ZERO.minus(angle).with_flag(is_sine));
            return if is_sine { wave.negated() } else { wave };
        }
        Self::key(angle.with_flag(is_sine))
    }

    pub(super) fn negated(mut self) -> Self {
        self.terms.iter_mut().for_each(|(_, c)| *c = c.negated());
        self
    }

    /// `self + other`, or `self - other`.
    pub(super) fn plus(&self, other: &Self, subtract: bool) -> Result<Self, Overflow> {
        let denominator = self.denominator.lcm(&other.denominator)?;
        let left = denominator.over(&self.denominator);
        let right = denominator.over(&other.denominator);
        let right = if subtract { right.negated() } else { right };
        let mut terms = Vec::with_capacity(self.terms.len() + other.terms.len());
        let (mut i, mut j) = (0, 0);
        while i < self.terms.len() || j < other.terms.len() {
            let order = match (self.terms.get(i), other.terms.get(j)) {
                (Some((a, _)), Some((b, _))) => a.cmp(b),
                (Some(_), None) => Ordering::Less,
                _ => Ordering::Greater,
            };
            let mut sum = C::from(0);
            let key = if order.is_le() { self.terms[i].0 } else { other.terms[j].0 };
            if order.is_le() {
                sum = self.terms[i].1.times(&left)?;
                i += 1;
            }
            if order.is_ge() {
                sum = sum.plus(&other.terms[j].1.times(&right)?)?;
                j += 1;
            }
            if !sum.is_zero() {
                terms.push((key, sum));
            }
        }
        Ok(Self { denominator, terms }.reduced())
    }

    /// The product, if it has at most `limit` terms on the way. Angles end at bit `angles_end`.
    pub(super) fn times(
        &self,
        other: &Self,
        angles_end: usize,
        limit: usize,
    ) -> Result<Self, SeriesError> {
        let (few, many) =
            if self.terms.len() < other.terms.len() { (self, other) } else { (other, self) };
        let denominator = self.denominator.times(&other.denominator)?;
        let denominator = denominator.times(&C::from(2))?;
        let few = few.split(angles_end);
        let many = many.split(angles_end);
        let mut terms = Vec::new();
        if few.len() < HASHED {
            let pairs = few.len() * many.len();
            if pairs > limit {
                return Err(SeriesError::TooManyTerms);
            }
            terms.reserve(2 * pairs);
            for (a, b) in few.iter().flat_map(|a| many.iter().map(move |b| (a, b))) {
                a.times(b, &mut |key, c| {
                    terms.push((key, c));
                    Ok(())
                })?;
            }
            sum_equal_keys(&mut terms)?;
        } else {
            let mut sums: FxHashMap<Key<N>, C> = FxHashMap::default();
            for a in &few {
                for b in &many {
                    a.times(b, &mut |key, c| {
                        let sum = sums.entry(key).or_insert_with(|| C::from(0));
                        *sum = sum.plus(&c)?;
                        Ok(())
                    })?;
                }
                if sums.len() > limit {
                    return Err(SeriesError::TooManyTerms);
                }
            }
            terms.reserve_exact(sums.len());
            terms.extend(sums.drain().filter(|(_, c)| !c.is_zero()));
            terms.sort_unstable_by_key(|(a, _)| *a);
        }
        terms.shrink_to_fit();
        Ok(Self { denominator, terms }.reduced())
    }

    fn split(&self, angles_end: usize) -> Vec<Factor<'_, N, C>> {
        self.terms
            .iter()
            .map(|(key, coefficient)| {
                let exponents = key.with_flag(false);
                let angle = exponents.below(angles_end);
                Factor { exponents, angle, is_sine: key.flag(), coefficient }
            })
            .collect()
    }

    /// The inverse of a single term without angle; `None` for any other series.
    pub(super) fn inverse(&self, angles_end: usize) -> Option<Self> {
        let [(key, coefficient)] = self.terms.as_slice() else { return None };
        if key.flag() || key.below(angles_end) != Key::ZERO {
            return None;
        }
        let is_negative = coefficient.to_big() < num_bigint::BigInt::from(0);
        let denominator = if is_negative { coefficient.negated() } else { coefficient.clone() };
        let numerator =
            if is_negative { self.denominator.negated() } else { self.denominator.clone() };
        Some(Self { denominator, terms: vec![(Key::ZERO.minus(*key), numerator)] })
    }

    /// Divides denominator and coefficients by their largest common divisor.
    fn reduced(mut self) -> Self {
        let one = C::from(1);
        let mut divisor = self.denominator.clone();
        for (_, coefficient) in &self.terms {
            if divisor == one {
                return self;
            }
            divisor = divisor.gcd(coefficient);
        }
        self.denominator = self.denominator.over(&divisor);
        self.terms.iter_mut().for_each(|(_, c)| *c = c.over(&divisor));
        self
    }
}

/// Adds up the terms of equal keys, in the order of the keys, and drops zeros.
pub(super) fn sum_equal_keys<const N: usize, C: Whole>(
    terms: &mut Vec<(Key<N>, C)>,
) -> Result<(), Overflow> {
    terms.sort_unstable_by_key(|(a, _)| *a);
    let mut kept = 0;
    let mut at = 0;
    while at < terms.len() {
        let (key, mut sum) = terms[at].clone();
        at += 1;
        while at < terms.len() && terms[at].0 == key {
            sum = sum.plus(&terms[at].1)?;
            at += 1;
        }
        if !sum.is_zero() {
            terms[kept] = (key, sum);
            kept += 1;
        }
    }
    terms.truncate(kept);
    Ok(())
}

/// A term taken apart for products.
struct Factor<'a, const N: usize, C> {
    /// The key without the bit of the sine.
    exponents: Key<N>,
    /// The exponents of the angles alone.
    angle: Key<N>,
    is_sine: bool,
    coefficient: &'a C,
}

impl<const N: usize, C: Whole> Factor<'_, N, C> {
    /// Gives twice the product, term by term.
    #[inline]
    fn times(
        &self,
        other: &Self,
        give: &mut impl FnMut(Key<N>, C) -> Result<(), Overflow>,
    ) -> Result<(), Overflow> {
        let product = self.coefficient.times(other.coefficient)?;
        let exponents = self.exponents.plus(other.exponents);
        if self.angle == Key::ZERO || other.angle == Key::ZERO {
            let is_sine = self.is_sine | other.is_sine;
            return give(exponents.with_flag(is_sine), product.plus(&product)?);
        }
        let is_sine = self.is_sine ^ other.is_sine;
        let negated = product.negated();
        let (at_sum, at_difference) = match (self.is_sine, other.is_sine) {
            (true, true) => (negated, product),
            (false, true) => (product, negated),
            _ => (product.clone(), product),
        };
        let sum = self.angle.plus(other.angle);
        give_normalised(exponents, sum, is_sine, at_sum, give)?;
        let difference = self.angle.minus(other.angle);
        let exponents = exponents.minus(other.angle).minus(other.angle);
        give_normalised(exponents, difference, is_sine, at_difference, give)
    }
}

/// Gives a term whose angle may have the wrong sign.
#[inline]
fn give_normalised<const N: usize, C: Whole>(
    exponents: Key<N>,
    angle: Key<N>,
    is_sine: bool,
    coefficient: C,
    give: &mut impl FnMut(Key<N>, C) -> Result<(), Overflow>,
) -> Result<(), Overflow> {
    if angle.is_negative() {
        let exponents = exponents.minus(angle).minus(angle);
        let coefficient = if is_sine { coefficient.negated() } else { coefficient };
        return give(exponents.with_flag(is_sine), coefficient);
    }
    if is_sine && angle == Key::ZERO {
        return Ok(());
    }
    give(exponents.with_flag(is_sine), coefficient)
}
