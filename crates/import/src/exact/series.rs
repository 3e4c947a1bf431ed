//! Sine, cosine, root and pi to fifty digits, in whole numbers.

use denavit_codegen::number::Rational;
use num_bigint::BigInt;
use num_traits::{Signed, Zero};

/// Digits after the point.
const PLACES: usize = 60;
/// Digits that a result keeps: the last ones carry the roundings.
const KEPT: usize = 50;
/// pi to 65 digits after the point.
const PI: &str = "314159265358979323846264338327950288419716939937510582097494459230";
/// Digits of it after the point.
const PI_PLACES: usize = 65;

fn scale(places: usize) -> BigInt {
    num_traits::pow(BigInt::from(10), places)
}

/// The number in units of 10^-60.
fn fixed(value: &Rational) -> BigInt {
    (value * Rational::from_integer(scale(PLACES))).round().to_integer()
}

/// Back, without the digits that carry roundings.
fn kept(value: BigInt) -> Rational {
    let unit = scale(PLACES - KEPT);
    let whole = Rational::new(value, unit).round().to_integer();
    Rational::new(whole, scale(KEPT))
}

/// pi.
pub(crate) fn pi() -> Rational {
    let digits: BigInt = PI.parse().unwrap_or_default();
    Rational::new(digits, scale(PI_PLACES))
}

/// Sine and cosine of an angle [rad].
pub(crate) fn sine_and_cosine(angle: &Rational) -> (Rational, Rational) {
    let quarter = pi() / Rational::from_integer(2.into());
    let turns = (angle / &quarter).round().to_integer();
    let rest = fixed(&(angle - quarter * Rational::from_integer(turns.clone())));
    let unit = scale(PLACES);
    let (mut sums, mut term) = ([BigInt::zero(), BigInt::zero()], unit.clone());
    let mut order = 0_u32;
    while !term.is_zero() {
        // 1, x, -x^2/2, -x^3/6, ..: even ones are those of the cosine
        let sum = &mut sums[order as usize % 2];
        if order % 4 < 2 {
            *sum += &term
        } else {
            *sum -= &term
        }
        order += 1;
        term = &term * &rest / (&unit * order);
    }
    let [cosine, sine] = sums.map(kept);
    let four = BigInt::from(4);
    let place = ((turns % &four) + &four) % &four;
    match u8::try_from(place).unwrap_or_default() {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// The square root of a number that is not negative: exact where it is a rational.
pub(crate) fn root(value: &Rational) -> Rational {
    if !value.is_positive() {
        return Rational::zero();
    }
    // sqrt(n/d) = sqrt(n d)/d
    let inside = value.numer() * value.denom();
    let whole = inside.sqrt();
    if &whole * &whole == inside {
        return Rational::new(whole, value.denom().clone());
    }
    let shift = scale(PLACES);
    let scaled = (inside * &shift * &shift).sqrt();
    Rational::new(scaled, value.denom() * shift)
}

#[cfg(test)]
mod tests {
    use super::*;
    use denavit_codegen::number::{integer, ratio, to_f64};
    use num_traits::One;

    #[test]
    fn sines_are_those_of_the_library_and_squares_add_up() {
        for eighths in -60..60 {
            let angle = ratio(eighths, 8);
            let (sine, cosine) = sine_and_cosine(&angle);
            assert!((to_f64(&sine) - to_f64(&angle).sin()).abs() < 1e-15);
            assert!((to_f64(&cosine) - to_f64(&angle).cos()).abs() < 1e-15);
            let off = &sine * &sine + &cosine * &cosine - Rational::one();
            assert!(off.abs() < Rational::new(1.into(), scale(48)));
        }
    }

    #[test]
    fn roots_are_exact_where_they_can_be() {
        assert_eq!(root(&ratio(25, 16)), ratio(5, 4));
        assert_eq!(root(&integer(0)), integer(0));
        let two = root(&integer(2));
        assert!((&two * &two - integer(2)).abs() < Rational::new(1.into(), scale(55)));
    }
}
