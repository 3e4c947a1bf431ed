//! From the basis cos(k.q), sin(k.q) to products of powers of single cosines and sines.
//!
//! Angle by angle: cos(k q + R) = cos(k q) cos R - sin(k q) sin R, and by Chebyshev's polynomials
//! cos(k q) = T_|k|(c), sin(k q) = +-s U_(|k|-1)(c). The coefficients are whole numbers, and c^a
//! and c^a s are linearly independent: the change of basis is exact, both ways.

use super::key::Key;
use super::layout::{Atom, Layout};
use super::series::{SeriesError, sum_equal_keys};
use super::whole::{Overflow, Whole};
use rustc_hash::FxHashMap;
use std::collections::hash_map::Entry;

/// A power of the cosine, times the sine or not, as it stands in the field of an angle: `c^a` as
/// a, `c^a s` as -(a + 1).
pub(super) fn product_powers(code: i32) -> (u32, bool) {
    if code < 0 { (code.unsigned_abs() - 1, true) } else { (code as u32, false) }
}

/// Terms in which some angles are replaced by their cumulated sums phi_i = q_1 + .. + q_i: the
/// multiple of phi_i is that of q_i minus that of q_(i+1). Known angles are in products already.
pub(super) fn cumulated<const N: usize, C: Whole>(
    layout: &Layout,
    chains: &[Vec<usize>],
    terms: &[(Key<N>, C)],
) -> Vec<(Key<N>, C)> {
    let cumulate = |(key, coefficient): &(Key<N>, C)| {
        let angle = key.with_flag(false).below(layout.function_angles_end);
        let mut exponents = vec![0; layout.angles.len()];
        for (index, exponent) in layout.exponents(&layout.angles, angle) {
            exponents[index] = i64::from(exponent);
        }
        let pairs = chains.iter().flat_map(|chain| chain.windows(2));
        let key = pairs.fold(*key, |key, pair| {
            key.minus(Layout::unit(&layout.angles[pair[0]], exponents[pair[1]]))
        });
        // The sign of an angle is that of its last multiple, which may have changed.
        with_normal_sign(layout, key, coefficient.clone())
    };
    terms.iter().filter_map(cumulate).collect()
}

/// Terms in the product basis of the known angles, or of the others: the fields of these hold codes
/// of [`product_powers`] instead of multiples.
///
/// The known angles come first; the rest of the angle is left as a cosine or sine. Without a rest
/// (`known` is false) the lowest bit is 0 everywhere. cos(k q1 + l q2) has some k l terms in this
/// basis: there may be `limit` of them on the way.
pub(super) fn products<const N: usize, C: Whole>(
    layout: &Layout,
    mut terms: Vec<(Key<N>, C)>,
    known: bool,
    limit: usize,
) -> Result<Vec<(Key<N>, C)>, SeriesError> {
    let angles: Vec<&Atom> = layout.angles.iter().filter(|atom| atom.is_known == known).collect();
    if angles.is_empty() {
        return Ok(terms);
    }
    // What differs in the factors alone is far apart in the order of keys, so that the terms of
    // one monomial stand together, and are few.
    sum_equal_keys(&mut terms)?;
    let bias = layout
        .angles
        .iter()
        .fold(Key::ZERO, |bias, atom| bias.plus(Key::shifted(1, atom.position + atom.width - 1)));
    let monomial = |key: &Key<N>| {
        let exponents = key.with_flag(false);
        exponents.minus(exponents.below(layout.angles_end))
    };
    let mut result = Vec::new();
    for group in terms.chunk_by(|(a, _), (b, _)| monomial(a) == monomial(b)) {
        // With a bias no field is negative, and fields can be read and written one by one.
        let mut group: Vec<_> = group.iter().map(|(key, c)| (key.plus(bias), c.clone())).collect();
        for atom in &angles {
            group = convert_angle(atom, &group, limit.saturating_sub(result.len()))?;
        }
        for (key, coefficient) in group {
            let key = key.minus(bias);
            if known {
                result.extend(with_normal_sign(layout, key, coefficient));
            } else if !key.flag() {
                // Nothing is left of the angle: cos 0 = 1, sin 0 = 0.
                result.push((key, coefficient));
            }
        }
    }
    sum_equal_keys(&mut result)?;
    Ok(result)
}

/// A term whose function angle has the normal sign; none if it is the sine of 0.
fn with_normal_sign<const N: usize, C: Whole>(
    layout: &Layout,
    key: Key<N>,
    coefficient: C,
) -> Option<(Key<N>, C)> {
    let is_sine = key.flag();
    let exponents = key.with_flag(false);
    let angle = exponents.below(layout.function_angles_end);
    if !is_sine && !angle.is_negative() {
        return Some((key, coefficient));
    }
    if angle.is_negative() {
        let key = exponents.minus(angle).minus(angle).with_flag(is_sine);
        return Some((key, if is_sine { coefficient.negated() } else { coefficient }));
    }
    (angle != Key::ZERO).then_some((key, coefficient))
}

/// One angle of biased keys.
fn convert_angle<const N: usize, C: Whole>(
    atom: &Atom,
    terms: &[(Key<N>, C)],
    limit: usize,
) -> Result<Vec<(Key<N>, C)>, SeriesError> {
    let mut converted = Vec::with_capacity(2 * terms.len());
    let mut polynomials: FxHashMap<usize, [Vec<C>; 2]> = FxHashMap::default();
    for (key, coefficient) in terms {
        let digit = key.bits(atom.position, atom.width) as i64 - (1 << (atom.width - 1));
        if digit == 0 {
            converted.push((*key, coefficient.clone()));
            continue;
        }
        let size = digit.unsigned_abs() as usize;
        let is_sine = key.flag();
        let mut give = |code: i64, is_sine: bool, factor: &C| -> Result<(), Overflow> {
            let key = key.plus(Key::shifted(code - digit, atom.position)).with_flag(is_sine);
            converted.push((key, coefficient.times(factor)?));
            Ok(())
        };
        let [first, second] = match polynomials.entry(size) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(free) => {
                free.insert([chebyshev(size, false)?, chebyshev(size - 1, true)?])
            }
        };
        for (power, factor) in first.iter().enumerate() {
            if !factor.is_zero() {
                give(power as i64, is_sine, factor)?;
            }
        }
        // sin(k q) cos R in a sine, -sin(k q) sin R in a cosine
        let is_negative = is_sine == (digit < 0);
        for (power, factor) in second.iter().enumerate() {
            if !factor.is_zero() {
                let factor = if is_negative { factor.negated() } else { factor.clone() };
                give(-(power as i64 + 1), !is_sine, &factor)?;
            }
        }
        if converted.len() > limit {
            return Err(SeriesError::TooManyTerms);
        }
    }
    sum_equal_keys(&mut converted)?;
    Ok(converted)
}

/// The coefficients of Chebyshev's polynomial T_n, or of U_n (`second`), by powers of c.
fn chebyshev<C: Whole>(n: usize, second: bool) -> Result<Vec<C>, Overflow> {
    let [zero, one, two] = [0, 1, 2].map(C::from);
    let first = if second { two.clone() } else { one.clone() };
    let (mut before, mut last) = (vec![one], vec![zero.clone(), first]);
    if n == 0 {
        return Ok(before);
    }
    for _ in 1..n {
        let mut next = vec![zero.clone(); last.len() + 1];
        for (power, factor) in last.iter().enumerate() {
            next[power + 1] = factor.times(&two)?;
        }
        for (power, factor) in before.iter().enumerate() {
            next[power] = next[power].plus(&factor.negated())?;
        }
        (before, last) = (last, next);
    }
    Ok(last)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chebyshev_polynomials_are_those_of_the_tables() {
        assert_eq!(chebyshev(4, false), Ok(vec![1_i64, 0, -8, 0, 8]));
        assert_eq!(chebyshev(3, true), Ok(vec![0_i64, -4, 0, 8]));
        assert_eq!([chebyshev(0, true), chebyshev(1, true)], [Ok(vec![1_i64]), Ok(vec![0, 2])]);
    }
}
