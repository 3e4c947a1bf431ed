//! Values of attributes: names, numbers, poses, with their faults.

use crate::exact::{Vector, decimal};
use crate::fault::{Cause, Faults, clip};
use crate::place::{Angle, Pose, Turn};
use crate::xml::{Element, Text};
use denavit_codegen::number::{Rational, integer};
use num_traits::{Signed, Zero};

/// Larger angles are no angles of frames \[rad\].
const MAX_ANGLE: i64 = 10_000;

/// The fault of a value that is not what should stand there.
pub(crate) fn wrong(value: Text<'_>, what: &str, expected: &str, faults: &mut Faults) {
    let text = value.text;
    let cause = if text.contains("${") || text.contains("$(") {
        let said = format!("{what} is \"{}\", which xacro would replace", clip(text));
        Cause::with_hint(said, "run `xacro ROBOT.urdf.xacro -o ROBOT.urdf` first")
    } else {
        Cause::new(format!("{what} is {expected}, not \"{}\"", clip(text)))
    };
    faults.push(value.at, cause);
}

/// The fault of an attribute that is not there.
pub(crate) fn missing(element: Element<'_>, name: &str, faults: &mut Faults) {
    let said = format!("<{}> has no `{name}`", clip(element.name()));
    faults.push(element.at(), Cause::new(said));
}

/// A name, which must be there.
pub(crate) fn name<'s>(element: Element<'s>, key: &str, faults: &mut Faults) -> Option<Text<'s>> {
    let Some(found) = element.get(key) else {
        missing(element, key, faults);
        return None;
    };
    if found.text.trim().is_empty() || found.text.contains("${") {
        wrong(found, "a name", "a word", faults);
        return None;
    }
    Some(found)
}

/// A number.
pub(crate) fn number(value: Text<'_>, what: &str, faults: &mut Faults) -> Option<Rational> {
    let found = decimal(value.text.trim());
    if found.is_none() {
        wrong(value, what, "a number", faults);
    }
    found
}

/// A number that may be absent, and then is 0.
pub(crate) fn number_or_zero(
    element: Element<'_>,
    key: &str,
    faults: &mut Faults,
) -> Option<Rational> {
    match element.get(key) {
        None => Some(Rational::zero()),
        Some(value) => number(value, &format!("`{key}`"), faults),
    }
}

/// A number that is not negative; nothing if it is absent, 0, or no finite number.
pub(crate) fn positive(element: Element<'_>, key: &str, faults: &mut Faults) -> Option<Rational> {
    let value = element.get(key)?;
    if is_endless(value.text) {
        return None;
    }
    let found = number(value, &format!("`{key}`"), faults)?;
    if found.is_negative() {
        wrong(value, &format!("`{key}`"), "0 or more", faults);
        return None;
    }
    (!found.is_zero()).then_some(found)
}

/// Whether a text is an infinity, or no number by name.
pub(crate) fn is_endless(text: &str) -> bool {
    let word = text.trim().trim_start_matches(['-', '+']).to_ascii_lowercase();
    ["inf", "infinity", "nan", ".inf", ".nan"].contains(&word.as_str())
}

/// Numbers of a list.
pub(crate) fn numbers<const N: usize>(
    value: Text<'_>,
    what: &str,
    faults: &mut Faults,
) -> Option<[Rational; N]> {
    let found: Option<Vec<Rational>> = value.text.split_whitespace().map(decimal).collect();
    let found = found.and_then(|numbers| numbers.try_into().ok());
    if found.is_none() {
        wrong(value, what, &format!("{N} numbers"), faults);
    }
    found
}

/// The vector of an attribute; nothing but faults if it is wrong.
pub(crate) fn vector(element: Element<'_>, key: &str, faults: &mut Faults) -> Option<Vector> {
    match element.get(key) {
        None => Some(std::array::from_fn(|_| Rational::zero())),
        Some(value) => numbers(value, &format!("`{key}`"), faults),
    }
}

/// Turns that were within rounding of quarter turns, for a note about all of them.
#[derive(Debug, Default)]
pub(crate) struct Snapped {
    /// Those that a reader may not have meant as such, each with whose it is.
    pub(crate) named: Vec<String>,
    /// How many agree to ten digits.
    pub(crate) fine: usize,
}

impl Snapped {
    fn push(&mut self, text: &str, owner: &str) {
        let digits = text.bytes().filter(u8::is_ascii_digit).count();
        match digits {
            0..10 => self.named.push(format!("{text} of {owner}")),
            _ => self.fine += 1,
        }
    }
}

/// The pose of an `origin`, at identity without one. `owner` is whose it is, for notes.
pub(crate) fn pose(
    origin: Option<Element<'_>>,
    owner: &str,
    snapped: &mut Snapped,
    faults: &mut Faults,
) -> Option<Pose> {
    let Some(origin) = origin else { return Some(Pose::identity()) };
    let at = vector(origin, "xyz", faults)?;
    let mut pose = Pose::moved(at);
    let Some(rpy) = origin.get("rpy") else { return Some(pose) };
    let texts: Vec<&str> = rpy.text.split_whitespace().collect();
    let made: Option<Vec<_>> = texts.iter().map(|text| Angle::radians(text)).collect();
    let small = |text: &&str| decimal(text).is_some_and(|value| value.abs() < integer(MAX_ANGLE));
    let made = made.filter(|made| made.len() == 3 && texts.iter().all(small));
    let Some(made) = made else {
        wrong(rpy, "`rpy`", "three angles", faults);
        return None;
    };
    for (axis, made) in made.into_iter().enumerate().rev() {
        if made.is_snapped {
            snapped.push(texts[axis], owner);
        }
        if made.angle != Angle::zero() {
            pose.turns.push(Turn::new(axis, made.angle));
        }
    }
    Some(pose)
}
