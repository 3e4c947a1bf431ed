//! Angles that are numbers (0.3, pi/6) beyond quarter turns: the cosine and sine of each are taken
//! for variables.

use crate::expr::{Dag, ExprId, angle_atoms, is_pi};
use crate::number::{Rational, integer, ratio};
use num_bigint::BigInt;
use num_traits::{Signed, Zero};
use std::collections::BTreeMap;

/// Up to this multiple of a common angle, angles are written by the variables of that angle.
const MAX_TIED_MULTIPLE: i64 = 8;

/// Which angles that are numbers have a variable in common.
#[derive(Clone, Debug, Default)]
pub(super) struct NumberAngles {
    /// By (whether of pi, denominator): the greatest common divisor of the numerators, or nothing
    /// if some of them is too large a multiple of it.
    divisors: BTreeMap<(bool, BigInt), Option<BigInt>>,
}

impl NumberAngles {
    /// Those among `angles`.
    pub(super) fn among(dag: &Dag, angles: impl Iterator<Item = ExprId>) -> Self {
        let mut numerators: BTreeMap<(bool, BigInt), Vec<BigInt>> = BTreeMap::new();
        for angle in angles {
            for (atom, coefficient) in angle_atoms(dag, angle) {
                let is_pi = is_pi(dag, &atom);
                if is_pi || atom.is_empty() {
                    let rest =
                        if is_pi { beyond_quarter_turns(&coefficient).1 } else { coefficient };
                    let of_kind = numerators.entry((is_pi, rest.denom().clone())).or_default();
                    of_kind.push(rest.numer().abs());
                }
            }
        }
        let divisors = numerators.into_iter().map(|(kind, numerators)| {
            let divisor = numerators.iter().fold(BigInt::ZERO, |a, b| common_divisor(a, b.clone()));
            let limit = &divisor * BigInt::from(MAX_TIED_MULTIPLE);
            let are_tied = numerators.iter().all(|numerator| *numerator <= limit);
            (kind, are_tied.then_some(divisor))
        });
        Self { divisors: divisors.collect() }
    }

    /// The angle, in units of pi or of 1 rad, of which `rest` (not 0) is a whole multiple and that
    /// has variables of its own. It is positive.
    pub(super) fn unit(&self, rest: &Rational, is_pi: bool) -> Rational {
        match self.divisors.get(&(is_pi, rest.denom().clone())) {
            Some(Some(divisor)) => Rational::new(divisor.clone(), rest.denom().clone()),
            _ => rest.abs(),
        }
    }
}

fn common_divisor(mut a: BigInt, mut b: BigInt) -> BigInt {
    while !b.is_zero() {
        (a, b) = (b.clone(), a % b);
    }
    a
}

/// A multiple of pi as quarter turns and the rest, which is at most half of one. Opposite angles
/// are taken apart into opposites, and an angle of at most half a quarter is its own rest.
pub(super) fn beyond_quarter_turns(multiple: &Rational) -> (BigInt, Rational) {
    let size = (multiple.abs() * integer(2) - ratio(1, 2)).ceil();
    let quarters = if multiple.is_negative() { -size } else { size };
    (quarters.to_integer(), multiple - quarters / integer(2))
}
