//! Sparse polynomials in many atoms.

use crate::expr::{Dag, ExprId};
use crate::number::Rational;
use num_traits::{One, Signed, Zero};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// A product of powers of atoms. Exponents may be negative, and are never 0.
///
/// An atom is an expression that is taken as an indeterminate. Monomials are ordered as their
/// atoms were made, so that the same graph gives the same order.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Monomial(Box<[(ExprId, i32)]>);

impl Monomial {
    /// The monomial of an atom alone.
    pub fn atom(atom: ExprId) -> Self {
        Self(Box::new([(atom, 1)]))
    }

    /// Whether it is 1.
    pub fn is_one(&self) -> bool {
        self.0.is_empty()
    }

    /// The atoms with their exponents, each atom once.
    pub fn powers(&self) -> &[(ExprId, i32)] {
        &self.0
    }

    /// The exponent of an atom.
    pub fn exponent(&self, atom: ExprId) -> i32 {
        self.0.binary_search_by_key(&atom, |&(atom, _)| atom).map_or(0, |index| self.0[index].1)
    }

    /// The product; `None` if an exponent leaves `i32`.
    pub fn times(&self, other: &Self) -> Option<Self> {
        let mut powers = Vec::with_capacity(self.0.len() + other.0.len());
        let (mut left, mut right) = (self.0.iter().peekable(), other.0.iter().peekable());
        loop {
            match (left.peek(), right.peek()) {
                (Some(&&(a, n)), Some(&&(b, m))) if a == b => {
                    let exponent = n.checked_add(m)?;
                    if exponent != 0 {
                        powers.push((a, exponent));
                    }
                    left.next();
                    right.next();
                }
                (Some(&&(a, n)), Some(&&(b, _))) if a < b => {
                    powers.push((a, n));
                    left.next();
                }
                (Some(&&power), None) => {
                    powers.push(power);
                    left.next();
                }
                (_, Some(&&power)) => {
                    powers.push(power);
                    right.next();
                }
                (None, None) => return Some(Self(powers.into())),
            }
        }
    }

    /// The n-th power, for any n; `None` if an exponent leaves `i32`.
    pub fn power(&self, n: i32) -> Option<Self> {
        if n == 0 {
            return Some(Self::default());
        }
        let powers = self.0.iter().map(|&(atom, m)| Some((atom, m.checked_mul(n)?)));
        powers.collect::<Option<Box<[_]>>>().map(Self)
    }

    /// The same monomial without one atom.
    pub fn without(&self, atom: ExprId) -> Self {
        Self(self.0.iter().copied().filter(|&(other, _)| other != atom).collect())
    }
}

/// A product would have had more terms than allowed, or would have taken too long to find out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooManyTerms;

/// A sum of monomials with coefficients that are not 0.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Polynomial {
    terms: BTreeMap<Monomial, Rational>,
}

impl Polynomial {
    /// The number 0.
    pub fn zero() -> Self {
        Self::default()
    }

    /// A number.
    pub fn constant(value: Rational) -> Self {
        Self::term(Monomial::default(), value)
    }

    /// An atom.
    pub fn atom(atom: ExprId) -> Self {
        Self::term(Monomial::atom(atom), Rational::one())
    }

    /// One term.
    pub fn term(monomial: Monomial, coefficient: Rational) -> Self {
        let mut sum = Self::zero();
        sum.add_term(monomial, coefficient);
        sum
    }

    /// Whether it is 0.
    pub fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }

    /// The number of terms.
    pub fn len(&self) -> usize {
        self.terms.len()
    }

    /// Whether there is no term: it is 0.
    pub fn is_empty(&self) -> bool {
        self.terms.is_empty()
    }

    /// The terms, in the order of their monomials.
    pub fn terms(&self) -> impl ExactSizeIterator<Item = (&Monomial, &Rational)> {
        self.terms.iter()
    }

    /// The coefficient of a monomial.
    pub fn coefficient(&self, monomial: &Monomial) -> Rational {
        self.terms.get(monomial).cloned().unwrap_or_else(Rational::zero)
    }

    /// The only term, if there is one alone.
    pub fn as_term(&self) -> Option<(&Monomial, &Rational)> {
        self.terms.first_key_value().filter(|_| self.terms.len() == 1)
    }

    /// Adds one term.
    pub fn add_term(&mut self, monomial: Monomial, coefficient: Rational) {
        if coefficient.is_zero() {
            return;
        }
        match self.terms.entry(monomial) {
            Entry::Vacant(entry) => {
                entry.insert(coefficient);
            }
            Entry::Occupied(mut entry) => {
                let sum = sum(entry.get(), &coefficient);
                *entry.get_mut() = sum;
                if entry.get().is_zero() {
                    entry.remove();
                }
            }
        }
    }

    /// `self + factor other`.
    pub fn plus(mut self, other: &Self, factor: &Rational) -> Self {
        for (monomial, coefficient) in &other.terms {
            self.add_term(monomial.clone(), product_of(coefficient, factor));
        }
        self
    }

    /// `factor self`.
    pub fn scaled(&self, factor: &Rational) -> Self {
        Self::zero().plus(self, factor)
    }

    /// The same with s^2 = 1 - c^2, until no sine has an exponent but 1. `cosine_of` gives the
    /// cosine of each atom that is a sine; more terms than `limit` are an error.
    pub fn without_squared_sines(
        mut self,
        cosine_of: &dyn Fn(ExprId) -> Option<ExprId>,
        limit: usize,
    ) -> Result<Self, TooManyTerms> {
        loop {
            let mut reduced = Self::zero();
            let mut is_done = true;
            for (monomial, coefficient) in self.terms() {
                let squared = monomial.powers().iter().find_map(|&(atom, exponent)| {
                    let cosine = cosine_of(atom)?;
                    (exponent > 1).then_some((atom, cosine, exponent))
                });
                let Some((sine, cosine, exponent)) = squared else {
                    reduced.add_term(monomial.clone(), coefficient.clone());
                    continue;
                };
                is_done = false;
                let times = |base: &Monomial, atom: ExprId, exponent: i32| {
                    let power = Monomial::atom(atom).power(exponent);
                    power.and_then(|power| base.times(&power)).ok_or(TooManyTerms)
                };
                let base = times(&monomial.without(sine), sine, exponent - 2)?;
                reduced.add_term(times(&base, cosine, 2)?, -coefficient.clone());
                reduced.add_term(base, coefficient.clone());
            }
            if reduced.len() > limit {
                return Err(TooManyTerms);
            }
            self = reduced;
            if is_done {
                return Ok(self);
            }
        }
    }

    /// The product, if it has at most `limit` terms on the way, and at most 16 times as many pairs
    /// of terms need be looked at.
    pub fn times(&self, other: &Self, limit: usize) -> Result<Self, TooManyTerms> {
        if self.len().saturating_mul(other.len()) > limit.saturating_mul(16) {
            return Err(TooManyTerms);
        }
        let mut product = Self::zero();
        for (a, x) in &self.terms {
            for (b, y) in &other.terms {
                product.add_term(a.times(b).ok_or(TooManyTerms)?, product_of(x, y));
            }
            if product.len() > limit {
                return Err(TooManyTerms);
            }
        }
        Ok(product)
    }

    /// The polynomial as an expression, its terms in order, what divides a term below it.
    pub fn to_expr(&self, dag: &mut Dag) -> ExprId {
        let one = dag.one();
        self.times_expr(dag, one)
    }

    /// The product with an expression, which stands above what divides a term.
    pub(super) fn times_expr(&self, dag: &mut Dag, expr: ExprId) -> ExprId {
        let mut sum = dag.zero();
        for (monomial, coefficient) in &self.terms {
            let mut above = dag.constant(coefficient.abs());
            let mut below = dag.one();
            for &(atom, exponent) in monomial.powers() {
                let power = dag.pow(atom, exponent.saturating_abs());
                let side = if exponent > 0 { &mut above } else { &mut below };
                *side = dag.mul(*side, power);
            }
            above = dag.mul(above, expr);
            let term = dag.div(above, below);
            sum = match coefficient.is_negative() {
                true => dag.sub(sum, term),
                false => dag.add(sum, term),
            };
        }
        sum
    }
}

/// `a b`, without looking for the common divisors of whole numbers: most coefficients are whole.
fn product_of(a: &Rational, b: &Rational) -> Rational {
    match a.is_integer() && b.is_integer() {
        true => Rational::from_integer(a.numer() * b.numer()),
        false => a * b,
    }
}

/// `a + b`, likewise.
fn sum(a: &Rational, b: &Rational) -> Rational {
    match a.is_integer() && b.is_integer() {
        true => Rational::from_integer(a.numer() + b.numer()),
        false => a + b,
    }
}
