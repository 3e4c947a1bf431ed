//! Sums of parameters as people write them: `m2 + (m1*c1^2 + I1)/l1^2` by parts, each a factor and
//! the parameters that it stands before.

use super::column::Regressor;
use crate::expr::{Dag, ExprId, Node, text};
use crate::fundamental::{Polynomial, canonical_generic};
use num_traits::{One, Signed};

/// A factor before a sum of parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Whether it is subtracted.
    pub is_negative: bool,
    /// The factor as expression and as text; none if it is 1.
    pub factor: Option<(ExprId, String)>,
    /// Whether the factor is a sum, and needs brackets.
    pub is_sum: bool,
    /// The columns, each with whether it is subtracted within.
    pub members: Vec<(usize, bool)>,
}

/// A combination by parts; members of the same factor, up to sign, stand together.
pub(super) fn parts(regressor: &mut Regressor, members: &[(usize, ExprId)]) -> Vec<Part> {
    let mut parts: Vec<(ExprId, Part)> = Vec::new();
    for &(column, factor) in members {
        let (size, is_negative) = magnitude(regressor, factor);
        if let Some((_, part)) = parts.iter_mut().find(|(other, _)| *other == size) {
            part.members.push((column, part.is_negative != is_negative));
            continue;
        }
        let is_one = size == regressor.dag.one();
        let factor = (!is_one).then(|| (size, factor_text(regressor, size)));
        let is_sum = matches!(regressor.dag.node(size), Node::Add(..) | Node::Sub(..));
        parts.push((size, Part { is_negative, factor, is_sum, members: vec![(column, false)] }));
    }
    parts.into_iter().map(|(_, part)| part).collect()
}

/// The sum of parts, with an expression for each column.
pub(super) fn sum_of(dag: &mut Dag, parts: &[Part], columns: &[ExprId]) -> ExprId {
    let mut total = dag.zero();
    for part in parts {
        let mut sum = dag.zero();
        for &(column, is_negative) in &part.members {
            let own = columns[column];
            sum = if is_negative { dag.sub(sum, own) } else { dag.add(sum, own) };
        }
        let product = match part.factor {
            Some((factor, _)) => dag.mul(factor, sum),
            None => sum,
        };
        total = if part.is_negative { dag.sub(total, product) } else { dag.add(total, product) };
    }
    total
}

/// A factor without its sign.
fn magnitude(regressor: &mut Regressor, factor: ExprId) -> (ExprId, bool) {
    let dag = &mut regressor.dag;
    let is_negative = match dag.node(factor) {
        Node::Neg(_) => true,
        Node::Constant(_) => dag.as_constant(factor).is_some_and(Signed::is_negative),
        Node::Mul(a, b) => {
            let is_negative =
                |operand| dag.as_constant(operand).is_some_and(|value| value.is_negative());
            is_negative(a) != is_negative(b)
        }
        _ => false,
    };
    if is_negative { (dag.neg(factor), true) } else { (factor, false) }
}

fn factor_text(regressor: &mut Regressor, factor: ExprId) -> String {
    match canonical_generic(&mut regressor.dag, &[factor]) {
        Ok(polynomials) => polynomial_text(regressor, &polynomials[0]),
        // A quotient of sums.
        Err(_) => text::print(&regressor.dag, factor),
    }
}

/// A Laurent polynomial, each term as one fraction.
fn polynomial_text(regressor: &Regressor, polynomial: &Polynomial) -> String {
    let mut result = String::new();
    for (monomial, coefficient) in polynomial.terms() {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        let (numerator, denominator) = (coefficient.numer().abs(), coefficient.denom());
        if !numerator.is_one() {
            above.push(numerator.to_string());
        }
        if !denominator.is_one() {
            below.push(denominator.to_string());
        }
        for &(atom, exponent) in monomial.powers() {
            let name = text::print(&regressor.dag, atom);
            let power = match exponent.unsigned_abs() {
                1 => name,
                size => format!("{name}^{size}"),
            };
            if exponent > 0 { above.push(power) } else { below.push(power) }
        }
        let above = if above.is_empty() { "1".to_owned() } else { above.join("*") };
        let term = match below.len() {
            0 => above,
            1 => format!("{above}/{}", below[0]),
            _ => format!("{above}/({})", below.join("*")),
        };
        result.push_str(match (result.is_empty(), coefficient.is_negative()) {
            (true, true) => "-",
            (true, false) => "",
            (false, true) => " - ",
            (false, false) => " + ",
        });
        result.push_str(&term);
    }
    result
}

/// Terms with their signs.
pub fn signed(terms: impl Iterator<Item = (bool, String)>) -> String {
    let mut result = String::new();
    for (is_negative, term) in terms {
        result.push_str(match (result.is_empty(), is_negative) {
            (true, true) => "-",
            (true, false) => "",
            (false, true) => " - ",
            (false, false) => " + ",
        });
        result.push_str(&term);
    }
    if result.is_empty() { "0".to_owned() } else { result }
}

/// The sum as text, in the language of model files.
pub(super) fn sum_text(regressor: &Regressor, parts: &[Part]) -> String {
    let name = |column: usize| regressor.columns[column].name.clone();
    let terms = parts.iter().flat_map(|part| {
        let members = part.members.iter().map(|&(column, is_negative)| (is_negative, name(column)));
        let Some((_, factor)) = &part.factor else {
            let own = part.is_negative;
            return members.map(|(sign, name)| (sign != own, name)).collect::<Vec<_>>();
        };
        let factor = if part.is_sum { format!("({factor})") } else { factor.clone() };
        let sum = match part.members.len() {
            1 => signed(members),
            _ => format!("({})", signed(members)),
        };
        // (a + b)/c rather than 1/c*(a + b)
        let term = match factor.strip_prefix("1/") {
            Some(divisor) => format!("{sum}/{divisor}"),
            None => format!("{factor}*{sum}"),
        };
        vec![(part.is_negative, term)]
    });
    signed(terms)
}
