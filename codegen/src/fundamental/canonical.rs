//! The canonical polynomial of an expression.
//!
//! Atoms are symbols, pi, and the sine and cosine of *single* angles: an angle is first made
//! canonical itself, a sum of monomials with whole coefficients, and then taken apart by the
//! addition theorems. With s^2 = 1 - c^2 each sine is left at most once in a monomial, and the
//! monomials c^k s^e (e = 0 or 1) of different angles are linearly independent: two expressions
//! are the same function exactly if their polynomials are equal. Angles a quarter turn apart are
//! known to be; other fractions of pi are refused, because their sines are algebraic numbers
//! ([`canonical_generic`] takes them for variables).
//!
//! Functions without such a theory (`sqrt`, `sign`, `select`, ...) are atoms too, told apart by
//! their canonical arguments: of these equal polynomials still mean equal expressions, but
//! `sqrt(x)^2` is not seen to be `x`.

use super::number_angle::{NumberAngles, beyond_quarter_turns};
use super::polynomial::{Monomial, Polynomial, TooManyTerms};
use crate::expr::{Dag, ExprId, Node, UnaryFunction};
use crate::number::{Rational, integer};
use num_bigint::BigInt;
use num_traits::{One, ToPrimitive, Zero};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::fmt;

/// The most terms that a polynomial may have on the way.
pub const MAX_TERMS: usize = 50_000;

/// An angle may be at most so many times another one.
const MAX_MULTIPLE: i32 = 64;

/// Why an expression has no canonical polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CanonicalError {
    /// The polynomial has more than [`MAX_TERMS`] terms, or exponents beyond 32 bits.
    TooManyTerms,
    /// Division by zero.
    DivisionByZero,
    /// Division by a sum, or by a sine: the quotient is no polynomial.
    DivisionBySum,
    /// An angle that is no whole multiple (up to 64) of its atoms and of a quarter turn.
    Angle,
}

impl fmt::Display for CanonicalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooManyTerms => {
                write!(f, "written out, the expression has more than {MAX_TERMS} terms")
            }
            Self::DivisionByZero => write!(f, "division by zero"),
            Self::DivisionBySum => {
                write!(f, "division by a sum or a sine: only products of symbols divide here")
            }
            Self::Angle => write!(
                f,
                "an angle is no whole multiple of its symbols and of a quarter turn, so its sine \
                 has no canonical form"
            ),
        }
    }
}

impl std::error::Error for CanonicalError {}

impl From<TooManyTerms> for CanonicalError {
    fn from(_: TooManyTerms) -> Self {
        Self::TooManyTerms
    }
}

/// The canonical polynomial of an expression. The graph grows by atoms.
pub fn canonical(dag: &mut Dag, expr: ExprId) -> Result<Polynomial, CanonicalError> {
    let mut polynomials = canonical_all(dag, &[expr])?;
    Ok(polynomials.remove(0))
}

/// The canonical polynomials of several expressions, in order; what they share is done once.
pub fn canonical_all(dag: &mut Dag, exprs: &[ExprId]) -> Result<Vec<Polynomial>, CanonicalError> {
    canonical_within(dag, exprs, MAX_TERMS)
}

/// [`canonical_all`] that gives up beyond `limit` terms instead of [`MAX_TERMS`].
pub(super) fn canonical_within(
    dag: &mut Dag,
    exprs: &[ExprId],
    limit: usize,
) -> Result<Vec<Polynomial>, CanonicalError> {
    expand(dag, exprs, limit, None)
}

/// [`canonical_all`] in which an angle that is a number (0.3, pi/6) is a variable: its cosine and
/// sine obey cos^2 + sin^2 = 1 and nothing else. What vanishes then vanishes for every such angle;
/// what does not may still vanish for this one. Small multiples of one angle share its variable.
pub fn canonical_generic(
    dag: &mut Dag,
    exprs: &[ExprId],
) -> Result<Vec<Polynomial>, CanonicalError> {
    let nodes = dag.topological(exprs);
    let angles = nodes.into_iter().filter_map(|expr| match dag.node(expr) {
        Node::Unary(UnaryFunction::Sin | UnaryFunction::Cos | UnaryFunction::Tan, a) => Some(a),
        _ => None,
    });
    let numbers = NumberAngles::among(dag, angles);
    expand(dag, exprs, MAX_TERMS, Some(numbers))
}

fn expand(
    dag: &mut Dag,
    exprs: &[ExprId],
    limit: usize,
    numbers: Option<NumberAngles>,
) -> Result<Vec<Polynomial>, CanonicalError> {
    let mut uses: FxHashMap<ExprId, usize> = FxHashMap::default();
    let nodes = dag.topological(exprs);
    for &expr in &nodes {
        dag.node(expr).for_each_operand(|operand| *uses.entry(operand).or_default() += 1);
    }
    exprs.iter().for_each(|&expr| *uses.entry(expr).or_default() += 1);
    let mut expansion = Expansion { dag, limit, cosine_of: FxHashMap::default(), numbers };
    let mut known: FxHashMap<ExprId, Polynomial> = FxHashMap::default();
    for expr in nodes {
        let polynomial = expansion.node(expr, &known)?;
        // A polynomial is kept only as long as something below the outputs still needs it.
        expansion.dag.node(expr).for_each_operand(|operand| {
            let left = uses.get_mut(&operand).expect("operands were counted");
            *left -= 1;
            if *left == 0 {
                known.remove(&operand);
            }
        });
        known.insert(expr, polynomial);
    }
    Ok(exprs.iter().map(|expr| known[expr].clone()).collect())
}

/// Whether two expressions are the same function.
pub fn equal(dag: &mut Dag, a: ExprId, b: ExprId) -> Result<bool, CanonicalError> {
    let polynomials = canonical_all(dag, &[a, b])?;
    Ok(polynomials[0] == polynomials[1])
}

struct Expansion<'a> {
    dag: &'a mut Dag,
    limit: usize,
    /// The cosine atom of each sine atom.
    cosine_of: FxHashMap<ExprId, ExprId>,
    /// Angles that are numbers, if they are taken for variables.
    numbers: Option<NumberAngles>,
}

impl Expansion<'_> {
    fn node(
        &mut self,
        expr: ExprId,
        known: &FxHashMap<ExprId, Polynomial>,
    ) -> Result<Polynomial, CanonicalError> {
        let one = Rational::one();
        Ok(match self.dag.node(expr) {
            Node::Constant(id) => Polynomial::constant(self.dag.constant_value(id).clone()),
            Node::Pi | Node::Symbol(_) => Polynomial::atom(expr),
            Node::Neg(a) => known[&a].scaled(&-one),
            Node::Add(a, b) => self.bounded(known[&a].clone().plus(&known[&b], &one))?,
            Node::Sub(a, b) => self.bounded(known[&a].clone().plus(&known[&b], &-one))?,
            Node::Mul(a, b) => self.product(&known[&a], &known[&b])?,
            Node::Div(a, b) => {
                let inverse = self.inverse(&known[&b])?;
                self.product(&known[&a], &inverse)?
            }
            Node::Pow(a, n) => self.power(&known[&a], n)?,
            Node::Unary(UnaryFunction::Cos, a) => self.unit_point(&known[&a])?.0,
            Node::Unary(UnaryFunction::Sin, a) => self.unit_point(&known[&a])?.1,
            Node::Unary(UnaryFunction::Tan, a) => {
                let (cosine, sine) = self.unit_point(&known[&a])?;
                let inverse = self.inverse(&cosine)?;
                self.product(&sine, &inverse)?
            }
            node @ (Node::Unary(..) | Node::Binary(..) | Node::Select { .. }) => {
                let mut images = BTreeMap::<ExprId, ExprId>::new();
                let dag = &mut *self.dag;
                node.for_each_operand(|operand| {
                    images.insert(operand, known[&operand].to_expr(dag));
                });
                let folded = crate::expr::rebuild(self.dag, expr, |operand| images[&operand]);
                let operand = images.iter().find(|(_, image)| **image == folded);
                match operand {
                    Some((operand, _)) => known[operand].clone(),
                    None => signed_atom(self.dag, folded),
                }
            }
        })
    }

    fn bounded(&self, polynomial: Polynomial) -> Result<Polynomial, CanonicalError> {
        if polynomial.len() > self.limit {
            return Err(CanonicalError::TooManyTerms);
        }
        Ok(polynomial)
    }

    fn product(&self, a: &Polynomial, b: &Polynomial) -> Result<Polynomial, CanonicalError> {
        let product = a.times(b, self.limit)?;
        let cosine_of = |atom: ExprId| self.cosine_of.get(&atom).copied();
        Ok(product.without_squared_sines(&cosine_of, self.limit)?)
    }

    fn inverse(&self, polynomial: &Polynomial) -> Result<Polynomial, CanonicalError> {
        if polynomial.is_zero() {
            return Err(CanonicalError::DivisionByZero);
        }
        let (monomial, coefficient) = polynomial.as_term().ok_or(CanonicalError::DivisionBySum)?;
        if monomial.powers().iter().any(|(atom, _)| self.cosine_of.contains_key(atom)) {
            return Err(CanonicalError::DivisionBySum);
        }
        let inverse = monomial.power(-1).ok_or(TooManyTerms)?;
        Ok(Polynomial::term(inverse, coefficient.recip()))
    }

    fn power(&self, base: &Polynomial, n: u32) -> Result<Polynomial, CanonicalError> {
        let mut result = Polynomial::constant(Rational::one());
        for bit in (0..32 - n.leading_zeros()).rev() {
            result = self.product(&result, &result)?;
            if n >> bit & 1 == 1 {
                result = self.product(&result, base)?;
            }
        }
        Ok(result)
    }

    /// (cos, sin) of an angle.
    fn unit_point(
        &mut self,
        angle: &Polynomial,
    ) -> Result<(Polynomial, Polynomial), CanonicalError> {
        let one = Polynomial::constant(Rational::one());
        let mut point = (one, Polynomial::zero());
        let pi = self.dag.pi();
        for (monomial, coefficient) in angle.terms() {
            let is_pi = monomial.powers() == [(pi, 1)];
            let mut rest = coefficient.clone();
            if is_pi {
                let quarters;
                (quarters, rest) = beyond_quarter_turns(coefficient);
                let quarters: BigInt = ((quarters % 4) + 4) % 4;
                for _ in 0..quarters.to_u8().unwrap_or(0) {
                    point = (point.1.scaled(&integer(-1)), point.0);
                }
            }
            if rest.is_zero() {
                continue;
            }
            let unit = self.unit_of(&rest, monomial, is_pi)?;
            let times = (&rest / &unit).to_integer().to_i32();
            let times = times.filter(|times| times.abs() <= MAX_MULTIPLE);
            let times = times.ok_or(CanonicalError::Angle)?;
            let (cosine, mut sine) = self.atom_point(monomial, unit);
            if times < 0 {
                sine = sine.scaled(&integer(-1));
            }
            for _ in 0..times.abs() {
                point = self.turned(&point, &(cosine.clone(), sine.clone()))?;
            }
        }
        Ok(point)
    }

    /// The angle of which `rest` times a monomial is a whole multiple.
    fn unit_of(
        &self,
        rest: &Rational,
        monomial: &Monomial,
        is_pi: bool,
    ) -> Result<Rational, CanonicalError> {
        if is_pi || monomial.is_one() {
            // An angle of 1 rad has no canonical sine: neither has a third of pi.
            let numbers = self.numbers.as_ref().ok_or(CanonicalError::Angle)?;
            return Ok(numbers.unit(rest, is_pi));
        }
        match rest.is_integer() {
            true => Ok(Rational::one()),
            false => Err(CanonicalError::Angle),
        }
    }

    /// (cos, sin) of an angle that is one monomial.
    fn atom_point(&mut self, monomial: &Monomial, unit: Rational) -> (Polynomial, Polynomial) {
        let angle = Polynomial::term(monomial.clone(), unit).to_expr(self.dag);
        let (cosine, sine) = (self.dag.cos(angle), self.dag.sin(angle));
        self.cosine_of.insert(sine, cosine);
        (Polynomial::atom(cosine), Polynomial::atom(sine))
    }

    /// The sum of two angles, as points (cos, sin).
    fn turned(
        &self,
        (c, s): &(Polynomial, Polynomial),
        (d, t): &(Polynomial, Polynomial),
    ) -> Result<(Polynomial, Polynomial), CanonicalError> {
        let (cc, ss) = (self.product(c, d)?, self.product(s, t)?);
        let (sc, cs) = (self.product(s, d)?, self.product(c, t)?);
        Ok((cc.plus(&ss, &integer(-1)), sc.plus(&cs, &Rational::one())))
    }
}

/// A function as an atom; folding may have made it a number, or taken a sign out of it.
fn signed_atom(dag: &Dag, expr: ExprId) -> Polynomial {
    match dag.node(expr) {
        Node::Constant(id) => Polynomial::constant(dag.constant_value(id).clone()),
        Node::Neg(a) => Polynomial::atom(a).scaled(&integer(-1)),
        _ => Polynomial::atom(expr),
    }
}
