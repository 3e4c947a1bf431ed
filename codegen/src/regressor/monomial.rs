//! Expressions as polynomials in the unknowns, with graph nodes as coefficients.
//!
//! What stands between the unknowns (lengths, sines of joint angles, rates) is never expanded: it
//! stays in the graph.

use crate::expr::{Dag, ExprId, Node};
use std::collections::{BTreeMap, BTreeSet};

/// A product of powers of unknowns; each unknown once, in the order of their making.
pub(super) type Unknown = Vec<(ExprId, u32)>;

/// A polynomial in the unknowns: coefficient by product; the coefficients are expressions.
pub(super) type InUnknowns = BTreeMap<Unknown, ExprId>;

/// Why an expression is no polynomial in the unknowns: this unknown stands below a function, or in
/// a denominator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct NotPolynomial(pub(super) ExprId);

/// `expr` as a polynomial in `unknowns`.
pub(super) fn in_unknowns(
    dag: &mut Dag,
    expr: ExprId,
    unknowns: &BTreeSet<ExprId>,
) -> Result<InUnknowns, NotPolynomial> {
    let mut known: BTreeMap<ExprId, InUnknowns> = BTreeMap::new();
    for node in dag.topological(&[expr]) {
        let value = match dag.node(node) {
            Node::Symbol(_) if unknowns.contains(&node) => {
                BTreeMap::from([(vec![(node, 1)], dag.one())])
            }
            Node::Neg(a) => scaled(&known[&a], |k| dag.neg(k)),
            Node::Add(a, b) => sum(dag, &known[&a], &known[&b], false),
            Node::Sub(a, b) => sum(dag, &known[&a], &known[&b], true),
            Node::Mul(a, b) => product(dag, &known[&a], &known[&b]),
            Node::Div(a, b) => match constant(dag, &known[&b]) {
                Some(divisor) => scaled(&known[&a], |k| dag.div(k, divisor)),
                None => return Err(NotPolynomial(first_unknown(&known[&b], node))),
            },
            Node::Pow(a, n) => {
                let one = BTreeMap::from([(Unknown::new(), dag.one())]);
                (0..n).fold(one, |power, _| product(dag, &power, &known[&a]))
            }
            other => {
                let mut inside = None;
                other.for_each_operand(|operand| {
                    inside = inside.or_else(|| {
                        let has = known[&operand].keys().any(|product| !product.is_empty());
                        has.then(|| first_unknown(&known[&operand], operand))
                    });
                });
                if let Some(unknown) = inside {
                    return Err(NotPolynomial(unknown));
                }
                if node == dag.zero() {
                    BTreeMap::new()
                } else {
                    BTreeMap::from([(Unknown::new(), node)])
                }
            }
        };
        known.insert(node, value);
    }
    Ok(known.remove(&expr).expect("the expression is its own last node"))
}

fn first_unknown(polynomial: &InUnknowns, otherwise: ExprId) -> ExprId {
    polynomial.keys().find_map(|product| product.first()).map_or(otherwise, |&(unknown, _)| unknown)
}

fn constant(dag: &Dag, polynomial: &InUnknowns) -> Option<ExprId> {
    let mut terms = polynomial.iter();
    match (terms.next(), terms.next()) {
        (Some((product, &value)), None) if product.is_empty() && value != dag.zero() => Some(value),
        _ => None,
    }
}

fn scaled(polynomial: &InUnknowns, mut by: impl FnMut(ExprId) -> ExprId) -> InUnknowns {
    polynomial.iter().map(|(product, &k)| (product.clone(), by(k))).collect()
}

fn sum(dag: &mut Dag, a: &InUnknowns, b: &InUnknowns, negative: bool) -> InUnknowns {
    let mut result = a.clone();
    for (product, &k) in b {
        let k = if negative { dag.neg(k) } else { k };
        add_to(dag, &mut result, product.clone(), k);
    }
    result
}

/// Adds one term; what cancels is dropped.
pub(super) fn add_to(dag: &mut Dag, sum: &mut InUnknowns, product: Unknown, k: ExprId) {
    let zero = dag.zero();
    let before = sum.get(&product).copied().unwrap_or(zero);
    let after = dag.add(before, k);
    if after == zero {
        sum.remove(&product);
    } else {
        sum.insert(product, after);
    }
}

fn product(dag: &mut Dag, a: &InUnknowns, b: &InUnknowns) -> InUnknowns {
    let mut result = InUnknowns::new();
    for (left, &x) in a {
        for (right, &y) in b {
            let k = dag.mul(x, y);
            add_to(dag, &mut result, times(left, right), k);
        }
    }
    result
}

fn times(a: &Unknown, b: &Unknown) -> Unknown {
    let mut powers: BTreeMap<ExprId, u32> = a.iter().copied().collect();
    for &(unknown, exponent) in b {
        *powers.entry(unknown).or_insert(0) += exponent;
    }
    powers.into_iter().collect()
}

/// The product as an expression.
pub(super) fn to_expr(dag: &mut Dag, product: &Unknown) -> ExprId {
    let mut result = dag.one();
    for &(unknown, exponent) in product {
        let power = dag.pow(unknown, i32::try_from(exponent).unwrap_or(i32::MAX));
        result = dag.mul(result, power);
    }
    result
}
