//! Units that depend on the joint: words that say a torque or a force, an angle or a length.

use crate::model::{JointKind, Unit, UnitError};

/// A word with what it stands for: factors with exponents, of a joint that turns and of one that
/// slides.
type JointWord = (&'static str, [&'static [(&'static str, i32)]; 2]);

const WORDS: [JointWord; 5] = [
    ("torque", [&[("N", 1), ("m", 1)], &[("N", 1)]]),
    ("position", [&[("rad", 1)], &[("m", 1)]]),
    ("rate", [&[("rad", 1), ("s", -1)], &[("m", 1), ("s", -1)]]),
    ("acceleration", [&[("rad", 1), ("s", -2)], &[("m", 1), ("s", -2)]]),
    ("inertia", [&[("kg", 1), ("m", 2)], &[("kg", 1)]]),
];

/// A unit of a joint that turns and of one that slides; the same unless the file used one of the
/// words `torque`, `position`, `rate`, `acceleration`, `inertia`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointUnit {
    text: String,
    units: [Unit; 2],
}

impl JointUnit {
    /// Reads a product of SI units and words: `torque/rate`, `1/s`.
    pub fn parse(text: &str) -> Result<Self, UnitError> {
        let [turning, sliding] = [0, 1].map(|kind| {
            let spelled = spell(text, kind);
            Unit::parse(spelled.as_deref().unwrap_or(text))
        });
        Ok(Self { text: text.trim().to_owned(), units: [turning?, sliding?] })
    }

    /// As it is written in the file.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The unit of a joint of this kind; a fixed joint has those of one that turns.
    pub fn of(&self, kind: JointKind) -> &Unit {
        &self.units[usize::from(kind == JointKind::Prismatic)]
    }
}

/// The text with words replaced and factors collected: `torque/rate` is `N m s/rad`. None if there
/// is no word in it, or it is no product.
fn spell(text: &str, kind: usize) -> Option<String> {
    let mut factors: Vec<(String, i32)> = Vec::new();
    let (mut sign, mut bracket, mut any) = (1, 1, false);
    let mut rest = text.trim();
    while let Some(first) = rest.chars().next() {
        let end = rest.find(|c: char| c.is_whitespace() || "*/^()".contains(c));
        let (name, after) = rest.split_at(end.unwrap_or(rest.len()));
        if name.is_empty() {
            match first {
                '/' => sign = -1,
                '(' => (bracket, sign) = (sign, 1),
                ')' => bracket = 1,
                '^' => return None,
                _ => {}
            }
            rest = &rest[first.len_utf8()..];
            continue;
        }
        let (power, after) = power(after)?;
        let exponent = sign * bracket * power;
        sign = 1;
        let word = WORDS.iter().find(|(word, _)| *word == name);
        any |= word.is_some();
        let parts = match word {
            Some((_, parts)) => parts[kind].to_vec(),
            None => vec![(name, 1)],
        };
        for (part, power) in parts {
            match factors.iter_mut().find(|(known, _)| known == part) {
                Some((_, sum)) => *sum += power * exponent,
                None => factors.push((part.to_owned(), power * exponent)),
            }
        }
        rest = after;
    }
    any.then(|| written(&factors))
}

/// The exponent that a text begins with, 1 if there is none, and what follows.
fn power(text: &str) -> Option<(i32, &str)> {
    let Some(digits) = text.strip_prefix('^') else { return Some((1, text)) };
    let end = digits.find(|c: char| !c.is_ascii_digit() && c != '-').unwrap_or(digits.len());
    let power: i32 = digits[..end].parse().ok()?;
    (power.abs() < 100).then_some((power, &digits[end..]))
}

fn written(factors: &[(String, i32)]) -> String {
    let side = |sign: i32| -> Vec<String> {
        let on_side = factors.iter().filter(|(_, power)| power * sign > 0);
        on_side
            .map(|(name, power)| match power.abs() {
                1 => name.clone(),
                power => format!("{name}^{power}"),
            })
            .collect()
    };
    let (above, below) = (side(1), side(-1));
    let above = if above.is_empty() { "1".to_owned() } else { above.join(" ") };
    match below.as_slice() {
        [] => above,
        [one] => format!("{above}/{one}"),
        _ => format!("{above}/({})", below.join(" ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_spelled_for_the_joint() {
        let both = |text: &str| {
            let unit = JointUnit::parse(text).expect("a unit");
            [JointKind::Revolute, JointKind::Prismatic].map(|kind| unit.of(kind).text().to_owned())
        };
        assert_eq!(both("torque/rate"), ["N m s/rad", "N s/m"]);
        assert_eq!(both("torque/rate^2"), ["N m s^2/rad^2", "N s^2/m^2"]);
        assert_eq!(both("position/(torque s)"), ["rad/(N m s)", "m/(N s)"]);
        assert_eq!(both("rate"), ["rad/s", "m/s"]);
        assert_eq!(both("rate/rate"), ["1", "1"]);
        assert_eq!(both("kg m^2"), ["kg m^2", "kg m^2"]);
        assert!(JointUnit::parse("torqe").is_err() && JointUnit::parse("rate^x").is_err());
    }
}
