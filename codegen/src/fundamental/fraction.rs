//! The field of rational functions of the known parameters, with sines and cosines of its angles.
//!
//! A member is a numerator over a denominator without sines (they are multiplied away by
//! conjugates, with s^2 = 1 - c^2), both without a common divisor, the denominator without units.
//! That is a canonical form: equal members are written equally.

use super::gcd::{divide, gcd, without_unit};
use super::{Monomial, Polynomial, TooManyTerms, Work};
use crate::expr::{Dag, ExprId};
use crate::number::{Rational, integer};
use num_traits::One;
use std::collections::BTreeMap;

/// Products on the way may have this many terms.
const MAX_PRODUCT: usize = 20_000;

/// A rational function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fraction {
    numerator: Polynomial,
    denominator: Polynomial,
}

impl Fraction {
    /// A Laurent polynomial; its sines must be reduced (no power above 1).
    pub fn polynomial(numerator: Polynomial) -> Self {
        Self { numerator, denominator: Polynomial::constant(Rational::one()) }
    }

    /// A number.
    pub fn number(value: Rational) -> Self {
        Self::polynomial(Polynomial::constant(value))
    }

    /// Whether it is 0.
    pub fn is_zero(&self) -> bool {
        self.numerator.is_zero()
    }

    /// Whether it is 1.
    pub fn is_one(&self) -> bool {
        self.as_number().is_some_and(|value| value.is_one())
    }

    /// Its value, if it is a number.
    pub fn as_number(&self) -> Option<Rational> {
        let one = self.has_unit_denominator();
        match self.numerator.as_term() {
            Some((monomial, value)) if one && monomial.is_one() => Some(value.clone()),
            None if self.is_zero() => Some(integer(0)),
            _ => None,
        }
    }

    /// The numerator: a Laurent polynomial.
    pub fn numerator(&self) -> &Polynomial {
        &self.numerator
    }

    /// The denominator: 1, or a polynomial of several terms.
    pub fn denominator(&self) -> &Polynomial {
        &self.denominator
    }

    fn has_unit_denominator(&self) -> bool {
        self.denominator.len() == 1
    }

    /// The number of terms of both sides, which says how large it is.
    pub fn size(&self) -> usize {
        self.numerator.len() + self.denominator.len()
    }

    /// `-a`.
    pub fn negated(&self) -> Self {
        let numerator = self.numerator.scaled(&integer(-1));
        Self { numerator, denominator: self.denominator.clone() }
    }

    /// The same member as an expression.
    pub fn to_expr(&self, dag: &mut Dag) -> ExprId {
        let one = dag.one();
        self.times_expr(dag, one)
    }

    /// The product with an expression, which stands above the divisor: (I1 + c1^2 m1)/l1^2.
    pub fn times_expr(&self, dag: &mut Dag, expr: ExprId) -> ExprId {
        if self.numerator.len() > 1 && dag.as_constant(expr).is_none() {
            let factor = self.to_expr(dag);
            return dag.mul(factor, expr);
        }
        let numerator = self.numerator.times_expr(dag, expr);
        if self.has_unit_denominator() {
            return numerator;
        }
        let denominator = self.denominator.to_expr(dag);
        dag.div(numerator, denominator)
    }
}

/// The field: which atoms are sines, and the cosines that belong to them.
#[derive(Clone, Debug, Default)]
pub struct Field {
    cosine_of: BTreeMap<ExprId, ExprId>,
    work: Work,
}

impl Field {
    /// The field in which the given atoms are sines, each with its cosine.
    pub fn new(cosine_of: BTreeMap<ExprId, ExprId>) -> Self {
        Self { cosine_of, work: Work::default() }
    }

    /// `a + b`.
    pub fn add(&self, a: &Fraction, b: &Fraction) -> Result<Fraction, TooManyTerms> {
        if a.denominator == b.denominator {
            let sum = a.numerator.clone().plus(&b.numerator, &Rational::one());
            return self.reduced(sum, a.denominator.clone());
        }
        let left = self.product(&a.numerator, &b.denominator)?;
        let right = self.product(&b.numerator, &a.denominator)?;
        let denominator = self.work.times(&a.denominator, &b.denominator, MAX_PRODUCT)?;
        self.reduced(left.plus(&right, &Rational::one()), denominator)
    }

    /// `a b`.
    pub fn multiply(&self, a: &Fraction, b: &Fraction) -> Result<Fraction, TooManyTerms> {
        let numerator = self.product(&a.numerator, &b.numerator)?;
        if a.has_unit_denominator() && b.has_unit_denominator() {
            return Ok(Fraction::polynomial(numerator));
        }
        let denominator = self.work.times(&a.denominator, &b.denominator, MAX_PRODUCT)?;
        self.reduced(numerator, denominator)
    }

    /// `1 / a`, for a that is not 0.
    pub fn inverse(&self, a: &Fraction) -> Result<Fraction, TooManyTerms> {
        let (mut top, mut bottom) = (a.denominator.clone(), a.numerator.clone());
        for &sine in self.cosine_of.keys() {
            if bottom.terms().all(|(monomial, _)| monomial.exponent(sine) == 0) {
                continue;
            }
            let mut conjugate = Polynomial::zero();
            for (monomial, coefficient) in bottom.terms() {
                let sign = integer(if monomial.exponent(sine) == 0 { 1 } else { -1 });
                conjugate.add_term(monomial.clone(), coefficient * sign);
            }
            top = self.product(&top, &conjugate)?;
            bottom = self.product(&bottom, &conjugate)?;
        }
        self.reduced(top, bottom)
    }

    /// The product of two polynomials, with s^2 = 1 - c^2.
    fn product(&self, a: &Polynomial, b: &Polynomial) -> Result<Polynomial, TooManyTerms> {
        let cosine_of = |atom: ExprId| self.cosine_of.get(&atom).copied();
        self.work.times(a, b, MAX_PRODUCT)?.without_squared_sines(&cosine_of, usize::MAX)
    }

    /// Takes `place` out of a sparse row with a row that has 1 there.
    pub fn subtract_row<K: Ord + Copy>(
        &self,
        row: &mut BTreeMap<K, Fraction>,
        pivot: &BTreeMap<K, Fraction>,
        place: K,
    ) -> Result<(), TooManyTerms> {
        let Some(factor) = row.get(&place).map(Fraction::negated) else { return Ok(()) };
        for (&other, value) in pivot {
            let change = self.multiply(&factor, value)?;
            let sum = match row.get(&other) {
                Some(before) => self.add(before, &change)?,
                None => change,
            };
            if sum.is_zero() {
                row.remove(&other);
            } else {
                row.insert(other, sum);
            }
        }
        Ok(())
    }

    /// The canonical form of a quotient whose denominator has no sines.
    fn reduced(&self, top: Polynomial, bottom: Polynomial) -> Result<Fraction, TooManyTerms> {
        if top.is_zero() {
            return Ok(Fraction::polynomial(top));
        }
        if bottom.len() == 1 {
            let quotient = divide(&self.work, &top, &bottom)?.expect("units divide");
            return Ok(Fraction::polynomial(quotient));
        }
        // The powers of the sines are independent over the rest: the divisor divides each part.
        let mut divisor = bottom.clone();
        for part in self.parts(&top).values() {
            divisor = gcd(&self.work, &divisor, part)?;
            if divisor.len() == 1 {
                break;
            }
        }
        let (mut top, mut bottom) = (top, bottom);
        if divisor.len() > 1 {
            let mut quotient = Polynomial::zero();
            for (sines, part) in self.parts(&top) {
                let part = divide(&self.work, &part, &divisor)?.expect("the gcd divides");
                let part = super::gcd::times_monomial(&part, &sines)?;
                quotient = quotient.plus(&part, &Rational::one());
            }
            top = quotient;
            bottom = divide(&self.work, &bottom, &divisor)?.expect("the gcd divides");
        }
        let (unit, denominator) = without_unit(&bottom)?;
        let numerator = divide(&self.work, &top, &unit)?.expect("units divide");
        Ok(Fraction { numerator, denominator })
    }

    /// The polynomial by its powers of sines.
    fn parts(&self, polynomial: &Polynomial) -> BTreeMap<Monomial, Polynomial> {
        let mut parts = BTreeMap::<Monomial, Polynomial>::new();
        for (monomial, coefficient) in polynomial.terms() {
            let (mut sines, mut rest) = (Monomial::default(), monomial.clone());
            for &(atom, _) in monomial.powers() {
                if self.cosine_of.contains_key(&atom) {
                    sines = sines.times(&Monomial::atom(atom)).expect("exponents are 0 or 1");
                    rest = rest.without(atom);
                }
            }
            parts.entry(sines).or_default().add_term(rest, coefficient.clone());
        }
        parts
    }
}
