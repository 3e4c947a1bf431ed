//! The unit circle over the residues modulo p = 2^61 - 1: pairs (cos, sin) with cos^2 + sin^2 = 1.
//!
//! It is a cyclic group of p + 1 = 2^61 points, so that every half, quarter, eighth .. of a turn
//! is one of them: angles may be written in any way, as multiples of pi with any power of two.

use crate::number::{Rational, Residue, integer};
use num_bigint::BigInt;
use num_traits::{One, ToPrimitive, Zero};
use std::sync::OnceLock;

/// The sum of two angles.
pub(super) fn turned(a: [Residue; 2], b: [Residue; 2]) -> [Residue; 2] {
    [a[0] * b[0] - a[1] * b[1], a[1] * b[0] + a[0] * b[1]]
}

/// A multiple of an angle.
pub(super) fn multiple(mut angle: [Residue; 2], mut times: u64) -> [Residue; 2] {
    let mut sum = [Residue::ONE, Residue::ZERO];
    while times > 0 {
        if times & 1 == 1 {
            sum = turned(sum, angle);
        }
        angle = turned(angle, angle);
        times >>= 1;
    }
    sum
}

/// The angle with tan(angle / 2) = t.
pub(super) fn half_tangent(t: Residue) -> [Residue; 2] {
    let square = t * t;
    // 1 + t^2 has no root: -1 is no square modulo 2^61 - 1, which is 3 modulo 4.
    let inverse = (Residue::ONE + square).inverse().expect("-1 is not a square");
    [(Residue::ONE - square) * inverse, (t + t) * inverse]
}

/// A multiple of pi as the exact point of a/2^j, and the rest b/d with d odd and |b| < d/2, which
/// the circle has no point for.
///
/// a and b are the same however whole turns are counted, and opposite angles have opposite ones.
pub(super) fn fraction_of_pi(coefficient: &Rational) -> ([Residue; 2], Rational) {
    let (numerator, denominator) = (coefficient.numer(), coefficient.denom());
    let twos = denominator.trailing_zeros().unwrap_or(0);
    if twos > 60 {
        return ([Residue::ONE, Residue::ZERO], coefficient.clone());
    }
    let odd = denominator >> twos;
    let power = BigInt::one() << twos;
    // n / (2^j d) = a / 2^j + b / d: b is n divided by 2^j modulo d, and (d + 1)/2 is the inverse
    // of 2.
    let half: BigInt = (&odd + 1_u32) >> 1;
    let mut b = numerator * half.modpow(&BigInt::from(twos), &odd) % &odd;
    if b.clone() + &b > odd {
        b -= &odd;
    } else if -(b.clone() + &b) > odd {
        b += &odd;
    }
    let a = (numerator - &b * &power) / &odd;
    let turn = BigInt::one() << 61;
    let exponent: BigInt = ((a << (60 - twos)) % &turn + &turn) % &turn;
    let exponent = exponent.to_u64().expect("less than 2^61");
    let rest = if b.is_zero() { integer(0) } else { Rational::new(b, odd) };
    (multiple(generator(), exponent), rest)
}

/// The point of pi / 2^60, from which all others come.
fn generator() -> [Residue; 2] {
    static GENERATOR: OnceLock<[Residue; 2]> = OnceLock::new();
    *GENERATOR.get_or_init(|| {
        let mut t = Residue::ONE;
        loop {
            t = t + Residue::ONE;
            let [cos, sin] = half_tangent(t);
            // The 2^59-th multiple of a generator is a quarter turn, one way or the other.
            let quarter = multiple([cos, sin], 1 << 59);
            if quarter[0] == Residue::ZERO {
                return [cos, if quarter[1] == Residue::ONE { sin } else { -sin }];
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::ratio;

    #[test]
    fn quarters_and_halves_are_exact() {
        let point = |p, q| fraction_of_pi(&ratio(p, q)).0;
        let [zero, one] = [Residue::ZERO, Residue::ONE];
        assert_eq!(
            [point(1, 2), point(1, 1), point(-1, 2)],
            [[zero, one], [-one, zero], [zero, -one]]
        );
        assert_eq!(point(7, 1), point(-1, 1));
        let eighth = point(1, 4);
        assert_eq!(eighth[0], eighth[1], "cos 45 deg = sin 45 deg");
        assert_eq!(eighth[0] * eighth[0] * (one + one), one);
        assert_eq!(point(-3, 4), [-eighth[0], -eighth[1]]);
    }

    #[test]
    fn odd_parts_do_not_depend_on_whole_turns() {
        assert_eq!(fraction_of_pi(&ratio(2, 3)), ([-Residue::ONE, Residue::ZERO], ratio(-1, 3)));
        for (p, q) in [(1, 6), (5, 12), (7, 9), (-2, 15), (1, 1000)] {
            let (point, rest) = fraction_of_pi(&ratio(p, q));
            assert_eq!(fraction_of_pi(&ratio(p + 2 * q, q)), (point, rest.clone()));
            assert_eq!(fraction_of_pi(&ratio(-p, q)), ([point[0], -point[1]], -rest));
        }
    }
}
