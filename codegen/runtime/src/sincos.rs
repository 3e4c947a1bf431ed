//! Sine and cosine of an `f64` from one reduced argument.

use crate::reduction::{self, Reduced};

/// Coefficients of r^3, r^5, .. r^13 in r - sin r. Minimax on |r| <= pi/4, weighted for relative
/// error of the sine, and refitted after each coefficient was rounded to `f64`: error 2^-57.9.
const SINE: [f64; 6] = [
    0.1666666666666663,
    -0.00833333333332184,
    0.00019841269829358528,
    -2.755731353851416e-6,
    2.505073438922155e-8,
    -1.589543328509913e-10,
];

/// Coefficients of r^4, r^6, .. r^14 in cos r, found in the same way: error 2^-63.9.
const COSINE: [f64; 6] = [
    0.041666666666666595,
    -0.0013888888888873342,
    2.480158728900208e-5,
    -2.755731421703885e-7,
    2.0875705396025724e-9,
    -1.1358749239790839e-11,
];

/// `(sin x, cos x)`.
#[inline]
pub(crate) fn sincos(x: f64) -> (f64, f64) {
    let Reduced { head, excess, quarter_turns } = reduction::reduce(x);
    let square = head * head;
    let fourth = square * square;
    let half = 0.5 * square;
    let leading = 1.0 - half;

    // sin(h - e) = h - [e cos h + h^3 S(h^2)]: the bracket is small, so h comes last; and -0 - 0
    // is -0, whereas a sum would lose the sign of zero.
    let bracket = excess * leading + square * head * polynomial(SINE, square, fourth);
    let sine = head - bracket;

    // cos(h - e) = 1 - h^2/2 + [h^4 C(h^2) + e sin h]; since 1 - `leading` is exact, `lost` is
    // what rounding `leading` lost.
    let lost = (1.0 - leading) - half;
    let bracket = fourth * polynomial(COSINE, square, fourth) + head * excess;
    let cosine = leading + (lost + bracket);

    turn(sine, cosine, quarter_turns)
}

/// a0 + a1 z + .. + a5 z^5 from z and z^2, in pairs: a shorter chain of waiting than Horner's.
#[inline]
fn polynomial(a: [f64; 6], z: f64, z_squared: f64) -> f64 {
    let high = (a[2] + a[3] * z) + z_squared * (a[4] + a[5] * z);
    (a[0] + a[1] * z) + z_squared * high
}

/// Turns the point (cosine, sine) by a number of quarter turns (modulo 4), without a branch:
/// an odd number swaps the two, and the signs follow from bit 1 of the number.
#[inline]
fn turn(sine: f64, cosine: f64, quarter_turns: u64) -> (f64, f64) {
    let (sine, cosine) = (sine.to_bits(), cosine.to_bits());
    let swapped = (sine ^ cosine) & 0_u64.wrapping_sub(quarter_turns & 1);
    let sine_sign = (quarter_turns & 2) << 62;
    let cosine_sign = (quarter_turns.wrapping_add(1) & 2) << 62;
    (f64::from_bits(sine ^ swapped ^ sine_sign), f64::from_bits(cosine ^ swapped ^ cosine_sign))
}
