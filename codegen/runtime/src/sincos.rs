//! Sine and cosine of an `f64` from one reduced argument.

use crate::reduction::{self, Reduced};

/// Coefficients of r^3, r^5, .. r^13 in sin r. Minimax on |r| <= pi/4, weighted for relative
/// error and refitted after each coefficient was rounded to `f64`: error 2^-57.9.
const SINE: [f64; 6] = [
    -0.1666666666666663,
    0.00833333333332184,
    -0.00019841269829358528,
    2.755731353851416e-6,
    -2.505073438922155e-8,
    1.589543328509913e-10,
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
    let Reduced { head, tail, quarter_turns } = reduction::reduce(x);
    turn(sine(head, tail), cosine(head, tail), quarter_turns)
}

/// sin(head + tail) for |head| <= pi/4, with `tail` below half a unit in the last place of `head`.
#[inline]
fn sine(head: f64, tail: f64) -> f64 {
    let square = head * head;
    let cube = square * head;
    let rest = horner_pair(square, [SINE[1], SINE[2], SINE[3], SINE[4], SINE[5]]);
    // sin(h + t) = h + [t + S1 h^3 - t h^2/2 + rest h^5]: the bracket is small, h is added last.
    head - ((square * (0.5 * tail - cube * rest) - tail) - cube * SINE[0])
}

/// cos(head + tail), under the same conditions.
#[inline]
fn cosine(head: f64, tail: f64) -> f64 {
    let square = head * head;
    let half = 0.5 * square;
    let leading = 1.0 - half;
    // 1 - leading is exact, so this is what rounding `leading` lost.
    let lost = (1.0 - leading) - half;
    let [first, others @ ..] = COSINE;
    let rest = square * square * (first + square * horner_pair(square, others));
    leading + (lost + (rest - head * tail))
}

/// a0 + a1 z + .. + a4 z^4 in two interleaved halves, which shortens the chain of waiting.
#[inline]
fn horner_pair(z: f64, a: [f64; 5]) -> f64 {
    let low = a[0] + z * (a[1] + z * a[2]);
    let high = a[3] + z * a[4];
    low + z * (z * z) * high
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
