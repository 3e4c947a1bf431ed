//! Angles of rows that were meant as multiples of a quarter turn, but are not.
//!
//! With `alpha = 1.5708` instead of `pi/2` a sum of parameters that should vanish is scaled by
//! 4e-6 instead, and exact algebra keeps what it finds: the base parameters of another robot.

use crate::model::fault::Cause;
use crate::number::{Rational, integer};
use num_traits::{Signed, ToPrimitive, Zero};

/// Multiples that nobody aims at by decimals, in quarter turns.
const MAX_QUARTER_TURNS: i64 = 8;
/// Digits after the point from which on a decimal near a quarter turn is one that was rounded.
const MIN_PLACES: u32 = 2;
/// No axis is aligned better than this \[rad\].
const FINEST_PLACES: u32 = 9;

/// The fault of an angle that is a number \[rad\], if it is one.
pub(super) fn rounded_quarter_turn(angle: &Rational, pi: &Rational) -> Option<Cause> {
    let quarter = pi / integer(2);
    let turns = (angle / &quarter).round().to_i64()?;
    if turns.abs() > MAX_QUARTER_TURNS || angle.is_zero() {
        return None;
    }
    let digit = |places| Rational::new(1.into(), num_traits::pow(10.into(), places as usize));
    let places = places(angle).min(FINEST_PLACES);
    if places < FINEST_PLACES && (places < MIN_PLACES || turns == 0) {
        return None;
    }
    let exact = quarter * integer(turns);
    let distance = (angle - &exact).abs();
    // Cut off is rounded too: 3.1415.
    let is_cut = angle.abs() < exact.abs() && distance < digit(places);
    let is_rounded = distance * integer(2) <= digit(places);
    (is_cut || is_rounded).then(|| Cause::RoundedAngle(turns_text(turns)))
}

/// Quarter turns as a multiple of pi.
fn turns_text(turns: i64) -> String {
    let sign = if turns < 0 { "-" } else { "" };
    match (turns.abs(), turns % 2 == 0) {
        (0, _) => "0".to_owned(),
        (1, _) => format!("{sign}pi/2"),
        (2, _) => format!("{sign}pi"),
        (quarters, true) => format!("{sign}{}*pi", quarters / 2),
        (quarters, false) => format!("{sign}{quarters}*pi/2"),
    }
}

/// Digits after the point that write the number, at most those of the finest angle.
fn places(value: &Rational) -> u32 {
    let ten = integer(10);
    let mut scaled = value.clone();
    let mut places = 0;
    while places < FINEST_PLACES && !scaled.is_integer() {
        scaled *= &ten;
        places += 1;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::super::measure::near_pi;
    use super::*;
    use crate::number::parse_decimal;

    fn meant(text: &str) -> Option<String> {
        match rounded_quarter_turn(&parse_decimal(text).expect("a decimal"), &near_pi())? {
            Cause::RoundedAngle(exact) => Some(exact),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn quarter_turns_are_known_by_their_digits() {
        for (text, exact) in [
            ("1.57", "pi/2"),
            ("1.5708", "pi/2"),
            ("1.5707", "pi/2"),
            ("-1.5707963267948966", "-pi/2"),
            ("3.14", "pi"),
            ("-3.141592653589793", "-pi"),
            ("4.71238898", "3*pi/2"),
            ("6.2832", "2*pi"),
            ("1.5707963270", "pi/2"),
            ("6.123e-17", "0"),
        ] {
            assert_eq!(meant(text).as_deref(), Some(exact), "{text}");
        }
    }

    #[test]
    fn other_angles_are_left_alone() {
        for text in ["0", "1.6", "3", "1.58", "1.5712", "0.7854", "1.571e-1", "0.001", "90"] {
            assert_eq!(meant(text), None, "{text}");
        }
    }
}
