//! The closed form of small robots: expanded, collected, factored again.
//!
//! For two or three joints the recursions carry more than the result needs. Here an expression is
//! expanded into terms (rational) x (parameters) x (rates) x (cos or sin of a sum of joint
//! angles), products of sines and cosines becoming sums, so that like terms meet and cancel. Then
//! the varying coefficient of each product of rates is made once and shared among all entries, and
//! what is left is factored greedily. Exact throughout; the portfolio decides whether it pays.

use crate::expr::{Dag, ExprId, Node, SymbolClass, UnaryFunction};
use crate::number::{Rational, integer, ratio};
use num_traits::{One, ToPrimitive, Zero};
use std::collections::BTreeMap;

/// Expansion is given up beyond this many terms in one node.
const MAX_TERMS: usize = 400;

/// A product of powers, sorted by handle.
type Product = Vec<(ExprId, u32)>;

/// The whole-number combination of joint variables inside a sine or cosine, its first nonzero
/// coefficient positive; empty for the constant 1.
type Angle = Vec<(ExprId, i32)>;

/// What a term is made of, besides its rational coefficient.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    /// Rates, accelerations and whatever else varies.
    varying: Product,
    /// The angle of the trigonometric factor.
    angle: Angle,
    /// Whether that factor is a sine.
    is_sine: bool,
    /// Expressions in parameters alone.
    parameters: Product,
}

type Terms = BTreeMap<Key, Rational>;

/// The entries in closed form; `None` if they hold anything but sums, products, sines and cosines,
/// or grow too long.
pub(crate) fn explicit(dag: &mut Dag, entries: &[ExprId]) -> Option<Vec<ExprId>> {
    let expanded = expand_all(dag, entries)?;
    Some(expanded.iter().map(|terms| rebuild(dag, terms)).collect())
}

fn expand_all(dag: &mut Dag, entries: &[ExprId]) -> Option<Vec<Terms>> {
    let mut expanded: BTreeMap<ExprId, Terms> = BTreeMap::new();
    for expr in dag.topological(entries) {
        let terms = expand(dag, expr, &expanded)?;
        if terms.len() > MAX_TERMS {
            return None;
        }
        expanded.insert(expr, terms);
    }
    Some(entries.iter().map(|entry| expanded[entry].clone()).collect())
}

fn expand(dag: &mut Dag, expr: ExprId, done: &BTreeMap<ExprId, Terms>) -> Option<Terms> {
    if let Some(value) = dag.as_constant(expr) {
        let value = value.clone();
        return Some(single(one_key(), value));
    }
    if !dag.is_run_time(expr) {
        let key = Key { parameters: vec![(expr, 1)], ..one_key() };
        return Some(single(key, Rational::one()));
    }
    Some(match dag.node(expr) {
        Node::Symbol(_) => {
            let key = Key { varying: vec![(expr, 1)], ..one_key() };
            single(key, Rational::one())
        }
        Node::Neg(a) => scaled(&done[&a], &integer(-1)),
        Node::Add(a, b) => sum(&done[&a], &done[&b], &integer(1)),
        Node::Sub(a, b) => sum(&done[&a], &done[&b], &integer(-1)),
        Node::Mul(a, b) => product(&done[&a], &done[&b])?,
        Node::Pow(a, n) => {
            let mut power = done[&a].clone();
            for _ in 1..n {
                power = product(&power, &done[&a])?;
            }
            power
        }
        Node::Unary(function @ (UnaryFunction::Sin | UnaryFunction::Cos), angle) => {
            wave(dag, function == UnaryFunction::Sin, angle)?
        }
        _ => return None,
    })
}

fn one_key() -> Key {
    Key { varying: Vec::new(), angle: Vec::new(), is_sine: false, parameters: Vec::new() }
}

fn single(key: Key, value: Rational) -> Terms {
    if value.is_zero() { Terms::new() } else { Terms::from([(key, value)]) }
}

fn scaled(terms: &Terms, factor: &Rational) -> Terms {
    terms.iter().map(|(key, value)| (key.clone(), value * factor)).collect()
}

fn sum(a: &Terms, b: &Terms, factor: &Rational) -> Terms {
    let mut result = a.clone();
    b.iter().for_each(|(key, value)| accumulate(&mut result, key.clone(), value * factor));
    result
}

fn accumulate(terms: &mut Terms, key: Key, value: Rational) {
    let entry = terms.entry(key);
    match entry {
        std::collections::btree_map::Entry::Vacant(entry) => {
            if !value.is_zero() {
                entry.insert(value);
            }
        }
        std::collections::btree_map::Entry::Occupied(mut entry) => {
            *entry.get_mut() += value;
            if entry.get().is_zero() {
                entry.remove();
            }
        }
    }
}

/// Products of waves become sums: cos a cos b = (cos(a-b) + cos(a+b)) / 2, and so on.
fn product(a: &Terms, b: &Terms) -> Option<Terms> {
    if a.len() * b.len() > 16 * MAX_TERMS {
        return None;
    }
    let mut result = Terms::new();
    for (left, x) in a {
        for (right, y) in b {
            let varying = merged(&left.varying, &right.varying);
            let parameters = merged(&left.parameters, &right.parameters);
            let mut add = |angle: Angle, is_sine: bool, value: Rational| {
                let (angle, sign) = oriented(angle, is_sine);
                if angle.is_empty() && is_sine {
                    return;
                }
                let (varying, parameters) = (varying.clone(), parameters.clone());
                accumulate(&mut result, Key { varying, angle, is_sine, parameters }, value * sign);
            };
            let value = x * y;
            if left.angle.is_empty() || right.angle.is_empty() {
                let wave = if left.angle.is_empty() { right } else { left };
                add(wave.angle.clone(), wave.is_sine, value);
                continue;
            }
            let half = value * ratio(1, 2);
            let plus = combined(&left.angle, &right.angle, 1);
            let minus = combined(&left.angle, &right.angle, -1);
            match (left.is_sine, right.is_sine) {
                (false, false) => {
                    add(minus, false, half.clone());
                    add(plus, false, half);
                }
                (true, true) => {
                    add(minus, false, half.clone());
                    add(plus, false, -half);
                }
                // sin a cos b = (sin(a-b) + sin(a+b)) / 2
                (true, false) => {
                    add(minus, true, half.clone());
                    add(plus, true, half);
                }
                // cos a sin b = (sin(a+b) - sin(a-b)) / 2
                (false, true) => {
                    add(minus, true, -half.clone());
                    add(plus, true, half);
                }
            }
        }
    }
    Some(result)
}

fn merged(a: &Product, b: &Product) -> Product {
    let mut powers: BTreeMap<ExprId, u32> = a.iter().copied().collect();
    b.iter().for_each(|&(base, n)| *powers.entry(base).or_insert(0) += n);
    powers.into_iter().collect()
}

fn combined(a: &Angle, b: &Angle, sign: i32) -> Angle {
    let mut sum: BTreeMap<ExprId, i32> = a.iter().copied().collect();
    b.iter().for_each(|&(variable, n)| *sum.entry(variable).or_insert(0) += sign * n);
    sum.into_iter().filter(|&(_, n)| n != 0).collect()
}

/// The angle with a positive first coefficient, and the sign that this takes out of the wave.
fn oriented(angle: Angle, is_sine: bool) -> (Angle, Rational) {
    if angle.first().is_some_and(|&(_, n)| n < 0) {
        let angle = angle.into_iter().map(|(variable, n)| (variable, -n)).collect();
        return (angle, integer(if is_sine { -1 } else { 1 }));
    }
    (angle, integer(1))
}

/// The sine or cosine of a whole-number combination of joint variables plus a constant.
fn wave(dag: &mut Dag, is_sine: bool, angle: ExprId) -> Option<Terms> {
    let (variables, constant) = linear(dag, angle)?;
    let (oriented_angle, sign) = oriented(variables.clone(), is_sine);
    if constant == dag.zero() {
        let key = Key { angle: oriented_angle, is_sine, ..one_key() };
        return Some(single(key, sign));
    }
    // sin(a + k) = sin a cos k + cos a sin k, cos(a + k) = cos a cos k - sin a sin k
    let (cos, sin) = (dag.cos(constant), dag.sin(constant));
    let mut result = Terms::new();
    for (same, factor) in [(true, cos), (false, sin)] {
        let wave_is_sine = is_sine == same;
        let (angle, mut sign) = oriented(variables.clone(), wave_is_sine);
        if !same && !is_sine {
            sign = -sign;
        }
        let parameters = vec![(factor, 1)];
        let key = Key { angle, is_sine: wave_is_sine, parameters, ..one_key() };
        accumulate(&mut result, key, sign);
    }
    Some(result)
}

/// An angle as a combination of joint variables and the rest, which is constant.
fn linear(dag: &mut Dag, angle: ExprId) -> Option<(Angle, ExprId)> {
    let (mut variables, mut constant) = (BTreeMap::<ExprId, i32>::new(), dag.zero());
    let mut pending = vec![(angle, 1)];
    while let Some((expr, sign)) = pending.pop() {
        if !dag.is_run_time(expr) {
            constant = if sign > 0 { dag.add(constant, expr) } else { dag.sub(constant, expr) };
            continue;
        }
        match dag.node(expr) {
            Node::Symbol(_) if dag.classes(expr).contains(SymbolClass::Configuration) => {
                *variables.entry(expr).or_insert(0) += sign;
            }
            Node::Neg(a) => pending.push((a, -sign)),
            Node::Add(a, b) => pending.extend([(a, sign), (b, sign)]),
            Node::Sub(a, b) => pending.extend([(a, sign), (b, -sign)]),
            _ => return None,
        }
    }
    let variables = variables.into_iter().filter(|&(_, n)| n != 0).collect();
    Some((variables, constant))
}

/// A term on its way back: a coefficient of parameters and the factors that vary.
type Factored = (ExprId, Product);

/// One entry: for each product of rates, its constant coefficient apart from its varying one,
/// which is normalised so that entries share it.
fn rebuild(dag: &mut Dag, terms: &Terms) -> ExprId {
    let mut by_rates: BTreeMap<&Product, Vec<(&Key, &Rational)>> = BTreeMap::new();
    for (key, value) in terms {
        by_rates.entry(&key.varying).or_default().push((key, value));
    }
    let mut factored: Vec<Factored> = Vec::new();
    for (rates, terms) in by_rates {
        let (constant, waves): (Vec<_>, Vec<_>) =
            terms.into_iter().partition(|(key, _)| key.angle.is_empty());
        if !constant.is_empty() {
            let coefficient = coefficient(dag, &constant, &Rational::one());
            factored.push((coefficient, rates.clone()));
        }
        let Some((_, lead)) = waves.first() else { continue };
        let shared = varying_coefficient(dag, &waves, lead);
        let scale = dag.constant((*lead).clone());
        factored.push((scale, merged(rates, &vec![(shared, 1)])));
    }
    factor(dag, factored)
}

/// The sum of waves, divided by `lead`.
fn varying_coefficient(dag: &mut Dag, waves: &[(&Key, &Rational)], lead: &Rational) -> ExprId {
    let mut by_wave: BTreeMap<(&Angle, bool), Vec<(&Key, &Rational)>> = BTreeMap::new();
    for &(key, value) in waves {
        by_wave.entry((&key.angle, key.is_sine)).or_default().push((key, value));
    }
    let inverse = lead.recip();
    let mut total = dag.zero();
    for ((angle, is_sine), terms) in by_wave {
        let coefficient = coefficient(dag, &terms, &inverse);
        let mut argument = dag.zero();
        for &(variable, n) in angle {
            let factor = dag.integer(i64::from(n));
            let part = dag.mul(factor, variable);
            argument = dag.add(argument, part);
        }
        let wave = if is_sine { dag.sin(argument) } else { dag.cos(argument) };
        let part = dag.mul(coefficient, wave);
        total = dag.add(total, part);
    }
    total
}

/// The sum of rational multiples of products of parameters.
fn coefficient(dag: &mut Dag, terms: &[(&Key, &Rational)], factor: &Rational) -> ExprId {
    terms.iter().fold(dag.zero(), |sum, (key, value)| {
        let mut part = dag.constant(*value * factor);
        for &(base, n) in &key.parameters {
            let power = dag.pow(base, n.to_i32().unwrap_or(i32::MAX));
            part = dag.mul(part, power);
        }
        dag.add(sum, part)
    })
}

/// The sum of terms, with the factor that most of them share taken out, and so on.
fn factor(dag: &mut Dag, mut terms: Vec<Factored>) -> ExprId {
    let mut total = dag.zero();
    while !terms.is_empty() {
        let mut uses: BTreeMap<ExprId, usize> = BTreeMap::new();
        for (base, _) in terms.iter().flat_map(|(_, factors)| factors) {
            *uses.entry(*base).or_insert(0) += 1;
        }
        let most = uses.iter().max_by_key(|&(base, count)| (*count, *base));
        let shared = most.filter(|&(_, count)| *count > 1).map(|(&base, _)| base);
        let Some(shared) = shared else { break };
        let (inside, outside): (Vec<_>, Vec<_>) = terms
            .into_iter()
            .partition(|(_, factors)| factors.iter().any(|&(base, _)| base == shared));
        let inside = inside.into_iter().map(|(coefficient, factors)| {
            let lowered = factors.into_iter().filter_map(|(base, n)| match base == shared {
                true if n == 1 => None,
                true => Some((base, n - 1)),
                false => Some((base, n)),
            });
            (coefficient, lowered.collect())
        });
        let inner = factor(dag, inside.collect());
        let part = dag.mul(shared, inner);
        total = dag.add(total, part);
        terms = outside;
    }
    for (coefficient, factors) in terms {
        let mut part = coefficient;
        for (base, n) in factors {
            let power = dag.pow(base, n.to_i32().unwrap_or(i32::MAX));
            part = dag.mul(part, power);
        }
        total = dag.add(total, part);
    }
    total
}
