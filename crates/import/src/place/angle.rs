//! Angles as sums of quarter turns, decimals and arc tangents, none of them computed.

use crate::exact::{decimal, exactly, pi, root, shortened, sine_and_cosine};
use denavit_codegen::model::meant_quarter_turns;
use denavit_codegen::number::{Rational, integer, ratio};
use num_traits::{One, Signed, ToPrimitive, Zero};

/// `factor sqrt(radicand)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Surd {
    factor: Rational,
    radicand: Rational,
}

/// A part of an angle that is no multiple of a quarter turn.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Term {
    Radians(Rational),
    Degrees(Rational),
    /// atan2(y, x); subtracted if the flag is set.
    Atan2 {
        y: Surd,
        x: Surd,
        minus: bool,
    },
}

/// An angle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Angle {
    /// Quarter turns, 0 to 3.
    quarters: u8,
    terms: Vec<Term>,
}

/// An angle, and whether it was within rounding of a quarter turn and became one.
pub(crate) struct Made {
    pub(crate) angle: Angle,
    pub(crate) is_snapped: bool,
}

/// No axis is aligned as well as this without being aligned \[rad\].
fn finest() -> Rational {
    ratio(2, 10_000_000)
}

impl Surd {
    /// A rational.
    pub(crate) fn rational(factor: Rational) -> Self {
        Self { factor, radicand: Rational::one() }
    }

    /// `factor sqrt(radicand)`.
    pub(crate) fn new(factor: Rational, radicand: Rational) -> Self {
        let whole = root(&radicand);
        if &whole * &whole == radicand {
            return Self::rational(factor * whole);
        }
        Self { factor, radicand }
    }

    fn square(&self) -> Rational {
        &self.factor * &self.factor * &self.radicand
    }

    fn is_zero(&self) -> bool {
        self.factor.is_zero() || self.radicand.is_zero()
    }

    fn value(&self) -> Rational {
        &self.factor * root(&self.radicand)
    }

    fn text(&self) -> String {
        let factor = number_text(&self.factor);
        if self.radicand.is_one() {
            return factor;
        }
        let root = format!("sqrt({})", number_text(&self.radicand));
        match factor.as_str() {
            "1" => root,
            "-1" => format!("-{root}"),
            _ => format!("{factor}*{root}"),
        }
    }
}

impl Angle {
    /// No turn.
    pub(crate) fn zero() -> Self {
        Self::quarter(0)
    }

    /// Some quarter turns.
    pub(crate) fn quarter(quarters: i64) -> Self {
        Self { quarters: quarters.rem_euclid(4) as u8, terms: Vec::new() }
    }

    /// A decimal \[rad\]; quarter turns that were rounded become quarter turns.
    pub(crate) fn radians(text: &str) -> Option<Made> {
        let value = decimal(text)?;
        if value.is_zero() {
            return Some(Made { angle: Self::zero(), is_snapped: false });
        }
        // many turns are what they are, but for whole quarters that nobody rounds
        Some(match meant_quarter_turns(text) {
            Some(quarters) => Made { angle: Self::quarter(quarters), is_snapped: true },
            None => Made { angle: Self::of(Term::Radians(value)), is_snapped: false },
        })
    }

    /// A decimal in degrees.
    pub(crate) fn degrees(value: Rational) -> Made {
        let quarters = (&value / integer(90)).round();
        let off = (&value - &quarters * integer(90)).abs();
        let is_snapped = !off.is_zero() && off <= finest() * integer(180) / pi();
        let angle = match quarters.to_i64() {
            Some(quarters) if is_snapped || off.is_zero() => Self::quarter(quarters),
            _ => Self::of(Term::Degrees(value)),
        };
        Made { angle, is_snapped }
    }

    /// atan2(y, x), 0 where both are 0.
    pub(crate) fn atan2(y: Surd, x: Surd) -> Made {
        let (up, along) = (y.square(), x.square());
        let square = finest() * finest();
        let quarters = if up <= &square * &along {
            Some(if x.factor.is_negative() { 2 } else { 0 })
        } else if along <= &square * &up {
            Some(if y.factor.is_negative() { 3 } else { 1 })
        } else {
            None
        };
        if let Some(quarters) = quarters {
            let is_snapped = !y.is_zero() && !x.is_zero();
            return Made { angle: Self::quarter(quarters), is_snapped };
        }
        let angle = if up == along {
            let eighth = if x.factor.is_negative() { 135 } else { 45 };
            let sign = if y.factor.is_negative() { -1 } else { 1 };
            Self::of(Term::Degrees(integer(sign * eighth)))
        } else {
            Self::of(Term::Atan2 { y, x, minus: false })
        };
        Made { angle, is_snapped: false }
    }

    fn of(term: Term) -> Self {
        Self { quarters: 0, terms: vec![term] }
    }

    /// Whether it is a multiple of a quarter turn.
    pub(crate) fn is_quarter(&self) -> bool {
        self.terms.is_empty()
    }

    /// Its whole quarter turns.
    pub(crate) fn quarters(&self) -> u8 {
        self.quarters
    }

    /// What it has besides whole quarter turns.
    pub(crate) fn without_quarters(&self) -> Self {
        Self { quarters: 0, terms: self.terms.clone() }
    }

    /// The opposite.
    pub(crate) fn negated(&self) -> Self {
        let negated = |term: &Term| match term.clone() {
            Term::Radians(value) => Term::Radians(-value),
            Term::Degrees(value) => Term::Degrees(-value),
            Term::Atan2 { y, x, minus } => Term::Atan2 { y, x, minus: !minus },
        };
        let quarters = (4 - self.quarters) % 4;
        Self { quarters, terms: self.terms.iter().map(negated).collect() }
    }

    /// The sum.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        let mut sum = self.clone();
        sum.quarters = (sum.quarters + other.quarters) % 4;
        other.terms.iter().for_each(|term| sum.add(term.clone()));
        sum
    }

    /// Whether the sum with another one would not be taken for a rounded quarter turn: two turns
    /// that are almost opposite are two turns.
    pub(crate) fn may_join(&self, other: &Self) -> bool {
        self.plus(other).terms.iter().all(|term| match term {
            Term::Radians(value) => {
                let whole = (value * integer(2) / pi()).round();
                (value - whole * pi() / integer(2)).abs() > finest()
            }
            _ => true,
        })
    }

    fn add(&mut self, term: Term) {
        match &term {
            Term::Radians(value) => {
                for own in &mut self.terms {
                    if let Term::Radians(sum) = own {
                        *sum += value;
                    }
                }
                if !self.terms.iter().any(|own| matches!(own, Term::Radians(_))) {
                    self.terms.push(term);
                }
            }
            Term::Degrees(value) => {
                for own in &mut self.terms {
                    if let Term::Degrees(sum) = own {
                        *sum += value;
                    }
                }
                if !self.terms.iter().any(|own| matches!(own, Term::Degrees(_))) {
                    self.terms.push(term);
                }
            }
            Term::Atan2 { y, x, minus } => {
                let opposite = Term::Atan2 { y: y.clone(), x: x.clone(), minus: !minus };
                match self.terms.iter().position(|own| *own == opposite) {
                    Some(place) => drop(self.terms.remove(place)),
                    None => self.terms.push(term),
                }
            }
        }
        self.fold();
    }

    /// Sums that became quarter turns are quarter turns.
    fn fold(&mut self) {
        let mut quarters = 0;
        self.terms.retain(|term| {
            let whole = match term {
                Term::Radians(value) => value.is_zero().then(Rational::zero),
                Term::Degrees(value) => {
                    let whole = value / integer(90);
                    whole.is_integer().then_some(whole)
                }
                Term::Atan2 { .. } => None,
            };
            quarters += whole.as_ref().and_then(ToPrimitive::to_i64).unwrap_or(0);
            whole.is_none()
        });
        self.quarters = (i64::from(self.quarters) + quarters).rem_euclid(4) as u8;
    }

    /// The angle as the model file writes it: a number or an expression.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        let mut put = |minus: bool, part: String| {
            let sign = match (minus, text.is_empty()) {
                (true, true) => "-",
                (true, false) => " - ",
                (false, true) => "",
                (false, false) => " + ",
            };
            text.push_str(sign);
            text.push_str(&part);
        };
        let mut quarters = self.quarters;
        let mut degrees = None;
        if let Some(Term::Degrees(value)) =
            self.terms.iter().find(|term| matches!(term, Term::Degrees(_)))
        {
            let quarters_of =
                |n: u8| if n == 3 { integer(-90) } else { integer(90 * i64::from(n)) };
            degrees = Some(value + quarters_of(std::mem::take(&mut quarters)));
        }
        match quarters {
            0 => {}
            1 => put(false, "pi/2".into()),
            2 => put(false, "pi".into()),
            _ => put(true, "pi/2".into()),
        }
        if let Some(degrees) = degrees {
            let turns = degrees.abs() / integer(180);
            put(degrees.is_negative(), pi_text(&turns));
        }
        for term in &self.terms {
            match term {
                Term::Radians(value) => put(value.is_negative(), number_text(&value.abs())),
                Term::Degrees(_) => {}
                Term::Atan2 { y, x, minus } => {
                    put(*minus, format!("atan2({}, {})", y.text(), x.text()));
                }
            }
        }
        if text.is_empty() { "0".to_owned() } else { text }
    }

    /// Sine and cosine to fifty digits.
    pub(crate) fn sine_and_cosine(&self) -> (Rational, Rational) {
        let whole = i64::from(self.quarters);
        let mut found = (quarter_sine(whole), quarter_sine(whole + 1));
        for term in &self.terms {
            let (sine, cosine) = match term {
                Term::Radians(value) => sine_and_cosine(value),
                Term::Degrees(value) => sine_and_cosine(&(value * pi() / integer(180))),
                Term::Atan2 { y, x, minus } => {
                    let length = root(&(y.square() + x.square()));
                    let sine = shortened(y.value() / &length);
                    (if *minus { -sine } else { sine }, shortened(x.value() / length))
                }
            };
            found = (
                shortened(&found.0 * &cosine + &found.1 * &sine),
                shortened(&found.1 * &cosine - &found.0 * &sine),
            );
        }
        found
    }
}

fn quarter_sine(quarters: i64) -> Rational {
    integer([0, 1, 0, -1][quarters.rem_euclid(4) as usize])
}

/// `n pi/d`
fn pi_text(turns: &Rational) -> String {
    let (numerator, denominator) = (turns.numer(), turns.denom());
    let head = if numerator.is_one() { "pi".to_owned() } else { format!("{numerator}*pi") };
    if denominator.is_one() { head } else { format!("{head}/{denominator}") }
}

/// A number in an expression: a fraction where its decimal would be taken for a rounded quarter
/// turn.
fn number_text(value: &Rational) -> String {
    let size = value.abs();
    match exactly(&size) {
        Some(text) if size.is_integer() || meant_quarter_turns(&text).is_none() => {
            format!("{}{text}", if value.is_negative() { "-" } else { "" })
        }
        _ => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use denavit_codegen::number::to_f64;

    fn radians(text: &str) -> Made {
        Angle::radians(text).expect("a decimal")
    }

    #[test]
    fn rounded_quarter_turns_are_quarter_turns() {
        for (text, written) in [("1.57", "pi/2"), ("-1.5707963", "-pi/2"), ("3.14159", "pi")] {
            let made = radians(text);
            assert!(made.is_snapped && made.angle.text() == written, "{text}");
        }
        let slant = radians("0.7854");
        assert!(!slant.is_snapped);
        assert_eq!(slant.angle.text(), "0.7854");
        let sum = Angle::quarter(1).plus(&slant.angle.negated());
        assert_eq!(sum.text(), "pi/2 - 0.7854");
    }

    #[test]
    fn opposite_terms_cancel() {
        let made = Angle::atan2(Surd::rational(ratio(3, 10)), Surd::rational(ratio(-2, 5)));
        assert_eq!(made.angle.text(), "atan2(0.3, -0.4)");
        assert!(made.angle.plus(&made.angle.negated()).is_quarter());
        let degrees = Angle::degrees(integer(30)).angle;
        assert_eq!(degrees.plus(&Angle::quarter(3)).text(), "-pi/3");
        assert!(degrees.plus(&Angle::degrees(integer(60)).angle).is_quarter());
        let back = radians("-0.39999999").angle;
        assert!(!radians("0.4").angle.may_join(&back), "they are no whole turn together");
        let slip = radians("0.785").angle.plus(&radians("0.785").angle);
        assert_eq!(slip.text(), "157/100", "no rounded quarter turn: nobody wrote 1.57");
    }

    #[test]
    fn sines_are_those_of_the_text() {
        let made = Angle::atan2(Surd::rational(ratio(-1, 3)), Surd::new(integer(1), ratio(2, 9)));
        let angle = made.angle.plus(&radians("0.3").angle).plus(&Angle::quarter(2));
        let value = (-1.0_f64 / 3.0).atan2((2.0_f64 / 9.0).sqrt()) + 0.3 + std::f64::consts::PI;
        let (sine, cosine) = angle.sine_and_cosine();
        assert!((to_f64(&sine) - value.sin()).abs() < 1e-15);
        assert!((to_f64(&cosine) - value.cos()).abs() < 1e-15);
    }
}
