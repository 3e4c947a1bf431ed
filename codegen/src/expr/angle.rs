//! Angles taken apart: what a sine or cosine is a function of, whatever way it was written.

use super::dag::{Dag, ExprId, Node};
use crate::number::{Rational, integer};
use num_traits::Zero;
use std::collections::{BTreeMap, BTreeSet};

/// A product of powers, as (factor, exponent) in order of handle; the empty product is the number
/// 1.
pub(crate) type AngleAtom = Vec<(ExprId, i64)>;

/// A sum of multiples of atoms, none of them 0.
type Sum = BTreeMap<AngleAtom, Rational>;

/// Largest exponent of a factor, most atoms of a sum, and largest coefficient of an atom; beyond
/// them an expression is an atom as it stands.
const MAX_EXPONENT: i64 = 1 << 12;
const MAX_ATOMS: usize = 64;
const MAX_BITS: u64 = 1 << 12;

/// An angle as a combination of atoms with rational coefficients.
///
/// The graph may write 2 (u s) as u (2 s) and u v - v as v (u - 1): products are multiplied out, so
/// that one angle has one form.
pub(crate) fn angle_atoms(dag: &Dag, argument: ExprId) -> BTreeMap<AngleAtom, Rational> {
    let mut sums = BTreeMap::<ExprId, Sum>::new();
    for expr in ring_nodes(dag, argument) {
        let sum = match dag.node(expr) {
            Node::Constant(id) => Some(number(dag.constant_value(id).clone())),
            Node::Neg(a) => Some(times_number(&sums[&a], &integer(-1))),
            Node::Add(a, b) => Some(plus(&sums[&a], &sums[&b], &integer(1))),
            Node::Sub(a, b) => Some(plus(&sums[&a], &sums[&b], &integer(-1))),
            Node::Mul(a, b) => times(&sums[&a], &sums[&b]),
            Node::Div(a, b) => reciprocal(&sums[&b]).and_then(|inverse| times(&sums[&a], &inverse)),
            Node::Pow(a, n) => power(&sums[&a], n),
            _ => None,
        };
        let sum = sum.filter(|sum| sum.len() <= MAX_ATOMS);
        sums.insert(expr, sum.unwrap_or_else(|| Sum::from([(vec![(expr, 1)], integer(1))])));
    }
    sums.remove(&argument).expect("the argument is one of its nodes")
}

/// The nodes that sums and products reach from an expression, operands first.
fn ring_nodes(dag: &Dag, expr: ExprId) -> Vec<ExprId> {
    let mut seen = BTreeSet::from([expr]);
    let mut pending = vec![expr];
    while let Some(expr) = pending.pop() {
        let node = dag.node(expr);
        if matches!(
            node,
            Node::Neg(_)
                | Node::Add(..)
                | Node::Sub(..)
                | Node::Mul(..)
                | Node::Div(..)
                | Node::Pow(..)
        ) {
            node.for_each_operand(|operand| {
                if seen.insert(operand) {
                    pending.push(operand);
                }
            });
        }
    }
    seen.into_iter().collect()
}

fn number(value: Rational) -> Sum {
    if value.is_zero() { Sum::new() } else { Sum::from([(Vec::new(), value)]) }
}

fn times_number(sum: &Sum, number: &Rational) -> Sum {
    sum.iter().map(|(atom, coefficient)| (atom.clone(), coefficient * number)).collect()
}

/// `a + sign b`
fn plus(a: &Sum, b: &Sum, sign: &Rational) -> Sum {
    let mut sum = a.clone();
    for (atom, coefficient) in b {
        *sum.entry(atom.clone()).or_insert_with(Rational::zero) += coefficient * sign;
    }
    sum.retain(|_, coefficient| !coefficient.is_zero());
    sum
}

/// The product, unless it is too large.
fn times(a: &Sum, b: &Sum) -> Option<Sum> {
    let mut product = Sum::new();
    for (left, p) in a {
        for (right, q) in b {
            let atom = atom_times(left, right)?;
            *product.entry(atom).or_insert_with(Rational::zero) += p * q;
        }
    }
    product.retain(|_, coefficient| !coefficient.is_zero());
    let bits = product.values().map(|c| c.numer().bits().max(c.denom().bits())).max();
    (product.len() <= MAX_ATOMS && bits.unwrap_or(0) <= MAX_BITS).then_some(product)
}

fn atom_times(a: &[(ExprId, i64)], b: &[(ExprId, i64)]) -> Option<AngleAtom> {
    let mut powers: BTreeMap<ExprId, i64> = a.iter().copied().collect();
    for &(factor, exponent) in b {
        let sum = powers.entry(factor).or_insert(0);
        *sum += exponent;
        if sum.abs() > MAX_EXPONENT {
            return None;
        }
    }
    Some(powers.into_iter().filter(|&(_, exponent)| exponent != 0).collect())
}

/// One divided by a single term; a sum has no reciprocal here.
fn reciprocal(sum: &Sum) -> Option<Sum> {
    let mut terms = sum.iter();
    let ((atom, coefficient), None) = (terms.next()?, terms.next()) else { return None };
    let inverse = atom.iter().map(|&(factor, exponent)| (factor, -exponent)).collect();
    Some(Sum::from([(inverse, coefficient.recip())]))
}

fn power(base: &Sum, n: u32) -> Option<Sum> {
    let mut power = number(integer(1));
    for bit in (0..u32::BITS - n.leading_zeros()).rev() {
        power = times(&power, &power)?;
        if n >> bit & 1 == 1 {
            power = times(&power, base)?;
        }
    }
    Some(power)
}

/// Whether an atom is the number pi.
pub(crate) fn is_pi(dag: &Dag, atom: &[(ExprId, i64)]) -> bool {
    matches!(*atom, [(expr, 1)] if matches!(dag.node(expr), Node::Pi))
}

/// The expression that an atom stands for.
pub(crate) fn atom_to_expr(dag: &mut Dag, atom: &[(ExprId, i64)]) -> ExprId {
    let mut product = dag.one();
    for &(expr, exponent) in atom {
        let power = dag.pow(expr, i32::try_from(exponent).expect("exponents are bounded"));
        product = dag.mul(product, power);
    }
    product
}
