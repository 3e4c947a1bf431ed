//! Short expressions written out the way people do: one sum, angles cumulated where that is
//! shorter, terms of one mass together.

use super::canonical::canonical_within;
use super::polynomial::{Monomial, Polynomial};
use crate::expr::{Dag, ExprId, Node, SymbolClass, UnaryFunction};
use crate::number::{Rational, integer, ratio};
use num_traits::{One, Signed, Zero};
use std::collections::BTreeMap;

/// The expressions written out, if that takes at most `limit` terms for all of them together.
pub fn written_out(dag: &mut Dag, exprs: &[ExprId], limit: usize) -> Option<Vec<ExprId>> {
    let polynomials = canonical_within(dag, exprs, 64 * limit).ok()?;
    let mut shortest = Vec::new();
    for polynomial in polynomials {
        let combined = with_cumulated_angles(dag, &polynomial);
        shortest.push(match combined {
            Some(combined) if combined.len() < polynomial.len() => combined,
            _ => polynomial,
        });
    }
    let terms: usize = shortest.iter().map(Polynomial::len).sum();
    (terms <= limit).then(|| shortest.iter().map(|polynomial| collected(dag, polynomial)).collect())
}

/// An angle as a combination of atoms: whole multiples, the first one positive.
type Angle = BTreeMap<ExprId, i32>;

/// Every product of sines and cosines as a sum of sines and cosines of sums of angles. None if a
/// cosine divides.
fn with_cumulated_angles(dag: &mut Dag, polynomial: &Polynomial) -> Option<Polynomial> {
    let mut result = Polynomial::zero();
    for (monomial, coefficient) in polynomial.terms() {
        let mut rest = monomial.clone();
        let mut waves = BTreeMap::from([((UnaryFunction::Cos, Angle::new()), coefficient.clone())]);
        for &(atom, exponent) in monomial.powers() {
            if let Node::Unary(function @ (UnaryFunction::Sin | UnaryFunction::Cos), angle) =
                dag.node(atom)
            {
                rest = rest.without(atom);
                for _ in 0..u32::try_from(exponent).ok()? {
                    waves = product_of_waves(&waves, function, angle);
                }
            }
        }
        for ((function, angle), factor) in waves {
            let wave = wave_atom(dag, function, &angle);
            for (part, sign) in wave.terms() {
                result.add_term(rest.times(part)?, &factor * sign);
            }
        }
    }
    Some(result)
}

type Waves = BTreeMap<(UnaryFunction, Angle), Rational>;

/// `2 cos a cos b = cos(a - b) + cos(a + b)`, and so for the others.
fn product_of_waves(waves: &Waves, function: UnaryFunction, angle: ExprId) -> Waves {
    use UnaryFunction::{Cos, Sin};
    let mut product = Waves::new();
    for ((own, multiples), factor) in waves {
        let result = if *own == function { Cos } else { Sin };
        for plus in [true, false] {
            let mut sum = multiples.clone();
            *sum.entry(angle).or_default() += if plus { 1 } else { -1 };
            // sin a sin b: -cos(a + b); cos a sin b: -sin(a - b).
            let minus = match (*own, function) {
                (Sin, Sin) => plus,
                (Cos, Sin) => !plus,
                _ => false,
            };
            let half = factor * ratio(if minus { -1 } else { 1 }, 2);
            add_wave(&mut product, result, sum, half);
        }
    }
    product
}

fn add_wave(waves: &mut Waves, function: UnaryFunction, mut angle: Angle, mut factor: Rational) {
    angle.retain(|_, multiple| *multiple != 0);
    if angle.first_key_value().is_some_and(|(_, &multiple)| multiple < 0) {
        angle.values_mut().for_each(|multiple| *multiple = -*multiple);
        if function == UnaryFunction::Sin {
            factor = -factor;
        }
    }
    if angle.is_empty() && function == UnaryFunction::Sin {
        return;
    }
    let total = waves.entry((function, angle)).or_insert_with(Rational::zero);
    *total += factor;
}

/// The sine or cosine of an angle, as a polynomial: folding may take a sign out of it.
fn wave_atom(dag: &mut Dag, function: UnaryFunction, angle: &Angle) -> Polynomial {
    let mut sum = dag.zero();
    for (&atom, &multiple) in angle {
        let multiple = dag.integer(i64::from(multiple));
        let term = dag.mul(multiple, atom);
        sum = dag.add(sum, term);
    }
    let wave = dag.unary(function, sum);
    match dag.node(wave) {
        Node::Constant(id) => Polynomial::constant(dag.constant_value(id).clone()),
        Node::Neg(inner) => Polynomial::atom(inner).scaled(&integer(-1)),
        _ => Polynomial::atom(wave),
    }
}

/// The terms that share the same first inertial parameter, with what else they share in front.
fn collected(dag: &mut Dag, polynomial: &Polynomial) -> ExprId {
    let mut groups = BTreeMap::<Option<ExprId>, Vec<(Monomial, Rational)>>::new();
    for (monomial, coefficient) in polynomial.terms() {
        let is_inertia = |atom: ExprId| {
            dag.as_symbol(atom).is_some_and(|symbol| symbol.class == SymbolClass::Inertia)
        };
        let first = monomial.powers().iter().find(|&&(atom, n)| n > 0 && is_inertia(atom));
        let key = first.map(|&(atom, _)| atom);
        groups.entry(key).or_default().push((monomial.clone(), coefficient.clone()));
    }
    let mut sum = dag.zero();
    for (key, terms) in groups {
        let common = match key {
            Some(_) => common_monomial(&terms),
            None => Monomial::default(),
        };
        let content = content(&terms);
        let inverse = common.power(-1).expect("exponents were read from a monomial");
        let mut rest = Polynomial::zero();
        for (monomial, coefficient) in &terms {
            let monomial = monomial.times(&inverse).expect("the exponents shrink");
            rest.add_term(monomial, coefficient / &content);
        }
        let group = rest.to_expr(dag);
        let front = Polynomial::term(common, content).to_expr(dag);
        let product = dag.mul(front, group);
        sum = dag.add(sum, product);
    }
    sum
}

/// The product of the atoms that all terms share.
fn common_monomial(terms: &[(Monomial, Rational)]) -> Monomial {
    let mut common = Monomial::default();
    for &(atom, _) in terms[0].0.powers() {
        let least = terms.iter().map(|(monomial, _)| monomial.exponent(atom)).min();
        let power = Monomial::atom(atom).power(least.unwrap_or(0).max(0));
        common = power.and_then(|power| common.times(&power)).unwrap_or(common);
    }
    common
}

/// The rational number that divides all coefficients and leaves whole ones without common divisor,
/// negative if all coefficients are.
fn content(terms: &[(Monomial, Rational)]) -> Rational {
    let mut numerator = num_bigint::BigInt::zero();
    let mut denominator = num_bigint::BigInt::one();
    for (_, coefficient) in terms {
        numerator = gcd(numerator, coefficient.numer().abs());
        let divisor = gcd(denominator.clone(), coefficient.denom().clone());
        denominator *= coefficient.denom() / divisor;
    }
    let content = Rational::new(numerator, denominator);
    let all_negative = terms.iter().all(|(_, coefficient)| coefficient.is_negative());
    if all_negative { -content } else { content }
}

fn gcd(mut a: num_bigint::BigInt, mut b: num_bigint::BigInt) -> num_bigint::BigInt {
    while !b.is_zero() {
        (a, b) = (b.clone(), a % b);
    }
    a
}
