//! Angles that were meant as multiples of a quarter turn, but are not.
//!
//! With `alpha = 1.5708` instead of `pi/2` a sum of parameters that should vanish is scaled by
//! 4e-6 instead, and exact algebra keeps what it finds: the base parameters of another robot.

use super::measure::near_pi;
use crate::model::fault::Cause;
use crate::number::{Rational, integer, parse_decimal, ratio};
use num_traits::{Signed, ToPrimitive, Zero};

/// Multiples that somebody may mean, in quarter turns.
const MAX_QUARTER_TURNS: i64 = 8;
/// Digits after the point from which on a decimal near a quarter turn is one that was rounded.
const MIN_PLACES: i64 = 2;

/// No axis is aligned as well as this without being aligned \[rad\]; single precision is not.
fn finest() -> Rational {
    ratio(2, 10_000_000)
}

/// The fault of an angle by its value \[rad\].
pub(super) fn nearly_aligned(text: &str, angle: &Rational, pi: &Rational) -> Option<Cause> {
    let (turns, distance) = nearest(angle, pi)?;
    (distance <= finest() && !angle.is_zero()).then(|| fault(text, turns))
}

/// The fault of an angle by the first decimal in its text that is a rounded multiple.
pub(super) fn rounded_decimal(text: &str, pi: &Rational) -> Option<Cause> {
    decimals(text).into_iter().find_map(|decimal| {
        let value = parse_decimal(decimal).ok()?;
        let (turns, distance) = nearest(&value, pi)?;
        let places = places(decimal);
        if turns == 0 || places < MIN_PLACES {
            return None;
        }
        let digit = Rational::new(1.into(), num_traits::pow(10.into(), places as usize));
        // Cut off is rounded too: 3.1415.
        let is_cut = value < pi * ratio(turns, 2) && distance < digit;
        let is_rounded = distance * integer(2) <= digit;
        (is_cut || is_rounded).then(|| fault(decimal, turns))
    })
}

/// The quarter turns that a decimal \[rad\] means, if it is a rounded multiple of them: what this
/// reader refuses, and a reader of other formats takes for what was meant.
pub fn meant_quarter_turns(decimal: &str) -> Option<i64> {
    let pi = near_pi();
    let value = parse_decimal(decimal).ok()?;
    let (turns, _) = nearest(&value, &pi)?;
    let found = rounded_decimal(decimal, &pi).or_else(|| nearly_aligned(decimal, &value, &pi));
    found.map(|_| turns)
}

/// The nearest multiple in quarter turns, and how far it is.
fn nearest(angle: &Rational, pi: &Rational) -> Option<(i64, Rational)> {
    let quarter = pi / integer(2);
    let turns = (angle / &quarter).round().to_i64()?;
    let distance = (angle - quarter * integer(turns)).abs();
    (turns.abs() <= MAX_QUARTER_TURNS).then_some((turns, distance))
}

fn fault(found: &str, turns: i64) -> Cause {
    let sign = if turns < 0 { "-" } else { "" };
    let exact = match (turns.abs(), turns % 2 == 0) {
        (0, _) => "0".to_owned(),
        (1, _) => format!("{sign}pi/2"),
        (2, _) => format!("{sign}pi"),
        (quarters, true) => format!("{sign}{}*pi", quarters / 2),
        (quarters, false) => format!("{sign}{quarters}*pi/2"),
    };
    Cause::RoundedAngle { found: found.trim().to_owned(), exact }
}

/// The decimals in an expression, without their signs.
fn decimals(text: &str) -> Vec<&str> {
    let bytes = text.as_bytes();
    let is_part = |byte: u8| byte.is_ascii_digit() || byte == b'.';
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let start = at;
        if bytes[at].is_ascii_alphabetic() || bytes[at] == b'_' {
            // a name may end in digits
            while at < bytes.len() && (bytes[at].is_ascii_alphanumeric() || bytes[at] == b'_') {
                at += 1;
            }
        } else if is_part(bytes[at]) {
            while at < bytes.len() && is_part(bytes[at]) {
                at += 1;
            }
            if at < bytes.len() && bytes[at].eq_ignore_ascii_case(&b'e') {
                let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
                let digits = bytes[at + 1 + sign..].iter().take_while(|b| b.is_ascii_digit());
                at += 1 + sign + digits.count();
            }
            found.push(&text[start..at]);
        } else {
            at += 1;
        }
    }
    found
}

/// Digits after the point, as they are written.
fn places(decimal: &str) -> i64 {
    let (mantissa, exponent) = match decimal.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse().unwrap_or(0)),
        None => (decimal, 0),
    };
    let fraction = mantissa.split_once('.').map_or("", |(_, fraction)| fraction);
    (fraction.len() as i64 - exponent).min(40)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meant(text: &str) -> Option<String> {
        let pi = near_pi();
        let by_value = || nearly_aligned(text, &parse_decimal(text).ok()?, &pi);
        match rounded_decimal(text, &pi).or_else(by_value)? {
            Cause::RoundedAngle { exact, .. } => Some(exact),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn quarter_turns_are_known_by_their_digits() {
        for (text, exact) in [
            ("1.57", "pi/2"),
            ("1.5708", "pi/2"),
            ("1.5707", "pi/2"),
            ("-1.5707963267948966", "pi/2"),
            ("3.14", "pi"),
            ("4.71238898", "3*pi/2"),
            ("6.2832", "2*pi"),
            ("15707.963e-4", "pi/2"),
            ("3.14159/2", "pi"),
            ("90*3.1416/180", "pi"),
            // of single precision
            ("1.5707964", "pi/2"),
            ("-1.5707963705062866", "-pi/2"),
            ("3.1415927410125732", "pi"),
            ("-4.371139e-8", "0"),
            ("6.123e-17", "0"),
        ] {
            assert_eq!(meant(text).as_deref(), Some(exact), "{text}");
        }
    }

    #[test]
    fn other_angles_are_left_alone() {
        for text in [
            "0",
            "1.6",
            "3",
            "1.58",
            "1.5710",
            "1.5712",
            "3.1400",
            "0.7854",
            "0.001",
            "90",
            "2e",
            "pi/2 + 0.0002",
            "l1.57",
            "1.5e5000",
            "..",
            "1.571e-1",
        ] {
            assert_eq!(meant(text), None, "{text}");
        }
    }
}
