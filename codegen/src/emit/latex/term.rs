//! Sums of products as they stand on paper: signs pulled together, factors in the usual order,
//! brackets only where they are needed.

use crate::arena::Handle;
use crate::expr::ExprId;
use crate::number::Rational;
use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

/// Where a factor stands in a product: numbers come first of all, then these.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Place {
    Inertia,
    Drive,
    Geometry,
    Intermediate,
    Abbreviation,
    Configuration,
    Rate,
    Acceleration,
    Other,
    Sum,
    Function,
}

/// How a factor takes an exponent and an argument.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Body {
    /// `q_1`: an exponent is set behind it.
    Symbol(String),
    /// A sum, which stands in brackets; whether they must be tall.
    Sum { text: String, is_tall: bool },
    /// A function before its argument, `\cos` and `q_1`.
    Function { name: String, argument: String },
    /// Anything that is closed in itself but takes an exponent in brackets only.
    Closed { text: String, is_tall: bool },
}

/// A power of something.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Factor {
    /// What it is a power of.
    pub(super) base: ExprId,
    pub(super) place: Place,
    /// Decides among factors of one place.
    pub(super) rank: u32,
    pub(super) body: Body,
    pub(super) exponent: i32,
}

/// A number times powers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Term {
    pub(super) coefficient: Rational,
    /// Sorted by place and rank, each base once.
    pub(super) factors: Vec<Factor>,
}

/// A sum of terms; 0 has none.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub(super) struct Form {
    pub(super) terms: Vec<Term>,
}

impl Factor {
    fn is_tall(&self) -> bool {
        match &self.body {
            Body::Symbol(_) => false,
            Body::Sum { is_tall, .. } | Body::Closed { is_tall, .. } => *is_tall,
            Body::Function { argument, .. } => argument.contains(r"\frac"),
        }
    }

    /// The factor with a positive exponent.
    fn text(&self, exponent: i32) -> String {
        let power = match exponent {
            1 => String::new(),
            2..=9 => format!("^{exponent}"),
            _ => format!("^{{{exponent}}}"),
        };
        match &self.body {
            Body::Symbol(text) if text.contains('^') && exponent != 1 => {
                format!("{{{text}}}{power}")
            }
            Body::Symbol(text) => format!("{text}{power}"),
            Body::Sum { text, is_tall } => format!("{}{power}", bracketed(text, *is_tall)),
            Body::Function { name, argument } => {
                let is_bracketed = argument.starts_with('(') || argument.starts_with(r"\left");
                let space = if is_bracketed { "" } else { " " };
                format!("{name}{power}{space}{argument}")
            }
            Body::Closed { text, .. } if exponent == 1 => text.clone(),
            Body::Closed { text, is_tall } => format!("{}{power}", bracketed(text, *is_tall)),
        }
    }

    fn sort_key(&self) -> (Place, u32, ExprId) {
        (self.place, self.rank, self.base)
    }
}

/// The text in round brackets, as tall as they must be.
pub(super) fn bracketed(text: &str, is_tall: bool) -> String {
    if is_tall { format!(r"\left( {text} \right)") } else { format!("({text})") }
}

impl Term {
    fn times(mut self, other: &Self) -> Self {
        self.coefficient *= &other.coefficient;
        for factor in &other.factors {
            match self.factors.iter().position(|own| own.base == factor.base) {
                Some(index) => {
                    self.factors[index].exponent += factor.exponent;
                    if self.factors[index].exponent == 0 {
                        self.factors.remove(index);
                    }
                }
                None => self.factors.push(factor.clone()),
            }
        }
        self.factors.sort_by_key(Factor::sort_key);
        self
    }

    /// To the power n, negative ones too; a coefficient that is raised to it must not be 0.
    fn power(&self, n: i32) -> Self {
        let mut factors = self.factors.clone();
        factors.iter_mut().for_each(|factor| factor.exponent *= n);
        Self { coefficient: self.coefficient.pow(n), factors }
    }

    fn is_tall(&self) -> bool {
        self.factors.iter().any(|factor| factor.exponent < 0 || factor.is_tall())
    }

    /// The term without its sign.
    fn magnitude(&self) -> String {
        let coefficient = self.coefficient.abs();
        let over: Vec<&Factor> = self.factors.iter().filter(|factor| factor.exponent > 0).collect();
        let under: Vec<&Factor> =
            self.factors.iter().filter(|factor| factor.exponent < 0).collect();
        if under.is_empty() {
            let number = match coefficient.is_one() && !over.is_empty() {
                true => String::new(),
                false => number_text(&coefficient),
            };
            return product_text(number, &over, false);
        }
        let (p, q) = match short_decimal(&coefficient) {
            Some(decimal) => (decimal, String::new()),
            None => {
                let unless_one = |value: &BigInt| match value.is_one() {
                    true => String::new(),
                    false => value.to_string(),
                };
                (unless_one(coefficient.numer()), unless_one(coefficient.denom()))
            }
        };
        format!(r"\frac{{{}}}{{{}}}", product_text(p, &over, true), product_text(q, &under, true))
    }

    /// The terms of a sum stand in the order of their factors; those without any come last.
    fn sort_key(&self) -> Vec<(Place, u32, ExprId, i32)> {
        let mut key: Vec<_> = self
            .factors
            .iter()
            .map(|factor| (factor.place, factor.rank, factor.base, -factor.exponent))
            .collect();
        if key.is_empty() {
            key.push((Place::Function, u32::MAX, ExprId::from_index(0), 0));
        }
        key
    }
}

/// Factors side by side. A sum that is alone in a fraction bar needs no brackets.
fn product_text(number: String, factors: &[&Factor], in_bar: bool) -> String {
    if let ([factor], true, true) = (factors, in_bar, number.is_empty())
        && let (Body::Sum { text, .. }, 1) = (&factor.body, factor.exponent.abs())
    {
        return text.clone();
    }
    let mut texts: Vec<String> = Vec::new();
    if !number.is_empty() {
        texts.push(number);
    }
    texts.extend(factors.iter().map(|factor| factor.text(factor.exponent.abs())));
    if texts.is_empty() { "1".to_owned() } else { texts.join(" ") }
}

/// A number > 0: whole, a short fraction, a short decimal, or a fraction after all.
fn number_text(value: &Rational) -> String {
    short_decimal(value).unwrap_or_else(|| match value.is_integer() {
        true => value.numer().to_string(),
        false => format!(r"\tfrac{{{}}}{{{}}}", value.numer(), value.denom()),
    })
}

/// The decimal of a number >= 0 that is no short fraction.
fn short_decimal(value: &Rational) -> Option<String> {
    let is_fraction = *value.denom() > BigInt::from(12);
    if is_fraction { decimal_text(value) } else { None }
}

/// A number as a decimal, if eight decimals are enough.
pub(super) fn decimal_text(value: &Rational) -> Option<String> {
    const DECIMALS: u32 = 8;
    let scaled = value * Rational::from_integer(BigInt::from(10).pow(DECIMALS));
    if !scaled.is_integer() {
        return None;
    }
    let digits = format!("{:0>width$}", scaled.numer().abs(), width = DECIMALS as usize + 1);
    let (whole, fraction) = digits.split_at(digits.len() - DECIMALS as usize);
    let sign = if value.is_negative() { "-" } else { "" };
    let text = format!("{sign}{whole}.{}", fraction.trim_end_matches('0'));
    Some(text.trim_end_matches('.').to_owned())
}

impl Form {
    pub(super) fn number(value: Rational) -> Self {
        if value.is_zero() {
            return Self::default();
        }
        Self { terms: vec![Term { coefficient: value, factors: Vec::new() }] }
    }

    pub(super) fn factor(factor: Factor) -> Self {
        Self { terms: vec![Term { coefficient: Rational::one(), factors: vec![factor] }] }
    }

    pub(super) fn negated(mut self) -> Self {
        self.terms.iter_mut().for_each(|term| term.coefficient = -term.coefficient.clone());
        self
    }

    pub(super) fn plus(mut self, mut other: Self) -> Self {
        self.terms.append(&mut other.terms);
        self
    }

    /// The product; `bases` are the expressions that the two forms stand for.
    pub(super) fn times(self, other: Self, bases: [ExprId; 2]) -> Self {
        if self.terms.is_empty() || other.terms.is_empty() {
            return Self::default();
        }
        let [left, right] = [(self, bases[0]), (other, bases[1])];
        let (left, right) = (left.0.into_term(left.1), right.0.into_term(right.1));
        Self { terms: vec![left.times(&right)] }
    }

    /// The power; `base` is the expression that the form stands for, and is not 0 if n < 0.
    pub(super) fn power(self, n: i32, base: ExprId) -> Self {
        if self.terms.is_empty() {
            return self;
        }
        Self { terms: vec![self.into_term(base).power(n)] }
    }

    /// The form as one term: a sum becomes a factor in brackets, its sign and its number outside.
    fn into_term(mut self, base: ExprId) -> Term {
        if self.terms.len() == 1 {
            return self.terms.remove(0);
        }
        self.sort();
        let mut coefficient = Rational::one();
        if self.terms[0].coefficient.is_negative() {
            self = self.negated();
            coefficient = -coefficient;
        }
        let body = Body::Sum { text: self.sorted_text(), is_tall: self.is_tall() };
        let factor = Factor { base, place: Place::Sum, rank: 0, body, exponent: 1 };
        Term { coefficient, factors: vec![factor] }
    }

    pub(super) fn is_tall(&self) -> bool {
        self.terms.iter().any(Term::is_tall)
    }

    /// Sorts the terms, and lets a positive one lead if there is any.
    fn sort(&mut self) {
        self.terms.sort_by_cached_key(Term::sort_key);
        let positive = self.terms.iter().position(|term| term.coefficient.is_positive());
        if let Some(index) = positive {
            self.terms[..=index].rotate_right(1);
        }
    }

    /// The texts of the terms, each with its sign but a leading plus.
    pub(super) fn term_texts(mut self) -> Vec<String> {
        self.sort();
        self.signed_texts()
    }

    pub(super) fn text(mut self) -> String {
        self.sort();
        self.sorted_text()
    }

    fn sorted_text(&self) -> String {
        match self.terms.is_empty() {
            true => "0".to_owned(),
            false => self.signed_texts().join(" "),
        }
    }

    fn signed_texts(&self) -> Vec<String> {
        let terms = self.terms.iter().enumerate();
        terms
            .map(|(index, term)| match (index, term.coefficient.is_negative()) {
                (0, false) => term.magnitude(),
                (0, true) => format!("-{}", term.magnitude()),
                (_, false) => format!("+ {}", term.magnitude()),
                (_, true) => format!("- {}", term.magnitude()),
            })
            .collect()
    }
}
