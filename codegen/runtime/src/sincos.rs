//! Sine and cosine of an `f64` from one reduced argument.

use crate::reduction::{self, Lanes, Reduced};

/// Coefficients of r^3, r^5, .. r^13 in r - sin r. Minimax on |r| <= pi/4, weighted for relative
/// error of the sine, and refitted after each coefficient was rounded to `f64`: error 2^-57.9.
pub const SINE: [f64; 6] = [
    0.1666666666666663,
    -0.00833333333332184,
    0.00019841269829358528,
    -2.755731353851416e-6,
    2.505073438922155e-8,
    -1.589543328509913e-10,
];

/// Coefficients of r^4, r^6, .. r^14 in cos r, found in the same way: error 2^-63.9.
pub const COSINE: [f64; 6] = [
    0.041666666666666595,
    -0.0013888888888873342,
    2.480158728900208e-5,
    -2.755731421703885e-7,
    2.0875705396025724e-9,
    -1.1358749239790839e-11,
];

/// Angles that are computed side by side: as many as the widest common registers hold.
const PACK: usize = 4;

/// `(sin x, cos x)`.
#[inline]
pub(crate) fn sincos(x: f64) -> (f64, f64) {
    of_reduced(reduction::reduce(x))
}

/// The sines and the cosines of several angles, each with the bits that [`sincos`] gives.
#[inline]
pub(crate) fn sincos_all<const N: usize>(angles: [f64; N]) -> ([f64; N], [f64; N]) {
    let (mut sines, mut cosines) = ([0.0; N], [0.0; N]);
    let mut first = 0;
    while first < N {
        if N - first == 1 {
            (sines[first], cosines[first]) = sincos(angles[first]);
            break;
        }
        // A pack that is not full ends with its last angle once more.
        let at = |place: usize| angles[if first + place < N { first + place } else { N - 1 }];
        let (s, c) = sincos_pack(at(0), at(1), at(2), at(3));
        for place in 0..PACK {
            if first + place < N {
                (sines[first + place], cosines[first + place]) = (s[place], c[place]);
            }
        }
        first += PACK;
    }
    (sines, cosines)
}

/// A pack of angles. Compiled once: in here the compiler finds the same steps for all angles and
/// takes one instruction for them. The angles come one by one because four numbers that were just
/// stored cannot be read as one before they have left the processor's store buffer.
#[inline(never)]
fn sincos_pack(a: f64, b: f64, c: f64, d: f64) -> ([f64; PACK], [f64; PACK]) {
    let angles = [a, b, c, d];
    let (mut sines, mut cosines) = ([0.0; PACK], [0.0; PACK]);
    let are_ordinary = angles.map(reduction::is_ordinary);
    if are_ordinary[0] & are_ordinary[1] & are_ordinary[2] & are_ordinary[3] {
        for i in 0..PACK {
            (sines[i], cosines[i]) = of_reduced(reduction::reduce_ordinary(angles[i]));
        }
    } else {
        for i in 0..PACK {
            (sines[i], cosines[i]) = sincos(angles[i]);
        }
    }
    (sines, cosines)
}

/// Sines and cosines of reduced angles.
#[inline]
pub(crate) fn of_reduced<R: Lanes>(reduced: Reduced<R>) -> (R, R) {
    let Reduced { head, excess, quarter_turns } = reduced;
    let square = head * head;
    let fourth = square * square;
    let half = R::from_f64(0.5);
    let leading = R::ONE.minus_product(half, square);

    // sin(h - e) = h - [e cos h + h^3 S(h^2)]: the bracket is small, so h comes last; and -0 - 0
    // is -0, whereas a sum would lose the sign of zero.
    let bracket = (square * head).product_plus(polynomial(SINE, square, fourth), excess * leading);
    let sine = head - bracket;

    // cos(h - e) = 1 - h^2/2 + [h^4 C(h^2) + e sin h]; since 1 - `leading` is exact, `lost` is
    // what rounding `leading` lost.
    let lost = (R::ONE - leading).minus_product(half, square);
    let bracket = fourth.product_plus(polynomial(COSINE, square, fourth), head * excess);
    let cosine = leading + (lost + bracket);

    R::turned(sine, cosine, quarter_turns)
}

/// a0 + a1 z + .. + a5 z^5 from z and z^2, in pairs: a shorter chain of waiting than Horner's.
#[inline]
fn polynomial<R: Lanes>(coefficients: [f64; 6], z: R, z_squared: R) -> R {
    let a = coefficients.map(R::from_f64);
    let pair = |low: usize| a[low + 1].product_plus(z, a[low]);
    let high = z_squared.product_plus(pair(4), pair(2));
    z_squared.product_plus(high, pair(0))
}
