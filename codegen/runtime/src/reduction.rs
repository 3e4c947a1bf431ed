//! Reduction of an angle modulo a quarter turn.

use crate::Scalar;
use core::f64::consts::FRAC_2_PI;

/// An angle x = quarter_turns * pi/2 + head - excess, with |head| <= pi/4 (1 + 1e-9) and `excess`
/// at most half a unit in the last place of `head`; x = -0 becomes (-0) - (+0). Only the two low
/// bits of `quarter_turns` count.
#[derive(Clone, Copy)]
pub(crate) struct Reduced<R: Lanes> {
    pub(crate) head: R,
    pub(crate) excess: R,
    pub(crate) quarter_turns: R::Bits,
}

/// A number, or a pack of numbers that are computed alike: what the reduction and the polynomials
/// need of it. Every operation rounds in each lane as it does on one `f64`.
pub(crate) trait Lanes: Scalar {
    /// The bits, lane by lane.
    type Bits: Copy;

    /// The bits of the numbers.
    fn bits(self) -> Self::Bits;

    /// Turns the point (cosine, sine) by a number of quarter turns (modulo 4), without a branch.
    fn turned(sine: Self, cosine: Self, quarter_turns: Self::Bits) -> (Self, Self);
}

impl Lanes for f64 {
    type Bits = u64;

    #[inline]
    fn bits(self) -> u64 {
        self.to_bits()
    }

    /// An odd number of quarter turns swaps the two, and the signs follow from bit 1 of the number.
    #[inline]
    fn turned(sine: f64, cosine: f64, quarter_turns: u64) -> (f64, f64) {
        let (sine, cosine) = (sine.to_bits(), cosine.to_bits());
        let swapped = (sine ^ cosine) & 0_u64.wrapping_sub(quarter_turns & 1);
        let sine_sign = (quarter_turns & 2) << 62;
        let cosine_sign = (quarter_turns.wrapping_add(1) & 2) << 62;
        (f64::from_bits(sine ^ swapped ^ sine_sign), f64::from_bits(cosine ^ swapped ^ cosine_sign))
    }
}

/// Up to here the three parts of pi/2 suffice: the number of quarter turns stays below 2^16.
pub const ORDINARY_RANGE: f64 = 1e5;

/// pi/2 in three parts. The first two have at most 37 bits, so that their products with a number
/// of quarter turns below 2^16 are exact; together the three differ from pi/2 by 2^-130.
pub const HALF_PI: [f64; 3] = [
    f64::from_bits(0x3ff9_21fb_5444_0000),
    f64::from_bits(0x3d86_8c23_4c4c_0000),
    f64::from_bits(0x3b29_8a2e_0370_7345),
];

/// Adding and subtracting 1.5 * 2^52 rounds to the nearest integer, ties to even, and leaves that
/// integer, modulo 2^51, in the low bits in between.
pub const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// Reduces any `f64`; infinities and NaN give NaN.
#[inline]
pub(crate) fn reduce(x: f64) -> Reduced<f64> {
    if is_ordinary(x) { reduce_ordinary(x) } else { reduce_large(x) }
}

/// Whether |x| <= [`ORDINARY_RANGE`].
#[inline]
pub(crate) fn is_ordinary(x: f64) -> bool {
    x.abs() <= ORDINARY_RANGE
}

/// Cody and Waite's reduction, for |x| <= [`ORDINARY_RANGE`].
#[inline]
pub(crate) fn reduce_ordinary<R: Lanes>(x: R) -> Reduced<R> {
    let part = HALF_PI.map(R::from_f64);
    let biased = x.product_plus(R::from_f64(FRAC_2_PI), R::from_f64(ROUNDER));
    let turns = biased - R::from_f64(ROUNDER);
    // Exact: unless `turns` is zero, both terms are multiples of 2^-53, and so is their
    // difference, which is below 1.
    let first = x.minus_product(turns, part[0]);
    let second = first.minus_product(turns, part[1]);
    // What rounding `second` lost. If |first| is below the product nothing was lost: then `second`
    // is a multiple of 2^-73 below 2^-20.
    let lost = (first - second).minus_product(turns, part[1]);
    let correction = turns.product_minus(part[2], lost);
    let head = second - correction;
    let excess = correction - (second - head);
    Reduced { head, excess, quarter_turns: biased.bits() }
}

/// The bits of 2/pi with weights 2^63 down to 2^-1216, so the first word is zero. The table is
/// filled up to a power of two, so that masked indices need no check and nothing here can panic.
const TWO_OVER_PI: [u64; 32] = filled([
    0x0000_0000_0000_0000,
    0xA2F9_836E_4E44_1529,
    0xFC27_57D1_F534_DDC0,
    0xDB62_9599_3C43_9041,
    0xFE51_63AB_DEBB_C561,
    0xB724_6E3A_424D_D2E0,
    0x0649_2EEA_09D1_921C,
    0xFE1D_EB1C_B129_A73E,
    0xE882_35F5_2EBB_4484,
    0xE99C_7026_B45F_7E41,
    0x3991_D639_8353_39F4,
    0x9C84_5F8B_BDF9_283B,
    0x1FF8_97FF_DE05_980F,
    0xEF2F_118B_5A0A_6D1F,
    0x6D36_7ECF_27CB_09B7,
    0x4F46_3F66_9E5F_EA2D,
    0x7527_BAC7_EBE5_F17B,
    0x3D07_39F7_8A52_92EA,
    0x6BFB_5FB1_1F8D_5D08,
    0x5603_3046_FC7B_6BAB,
]);

const fn filled(words: [u64; 20]) -> [u64; 32] {
    let mut table = [0; 32];
    let mut row = 0;
    while row < words.len() {
        table[row] = words[row];
        row += 1;
    }
    table
}

/// pi/2, scaled by 2^63.
const HALF_PI_SCALED: u64 = 0xC90F_DAA2_2168_C235;

/// Payne and Hanek's reduction, for |x| > [`ORDINARY_RANGE`]: of the product x * 2/pi only those
/// bits are formed that matter modulo 4, and enough below them that cancellation costs nothing.
#[cold]
#[inline(never)]
fn reduce_large(x: f64) -> Reduced<f64> {
    if !x.is_finite() {
        return Reduced { head: f64::NAN, excess: 0.0, quarter_turns: 0 };
    }
    // |x| = significand * 2^exponent, with -36 <= exponent <= 971.
    let bits = x.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i32 - 1075;
    let significand = (bits & ((1 << 52) - 1)) | (1 << 52);

    // |x| * 2/pi modulo 4, its 192 bits weighing 2^1 down to 2^-190; error below 2^-137.
    let [high, middle, low] = multiply(significand, two_over_pi_from((62 + exponent) as usize));
    let whole = high >> 62;
    // The fraction in 192 bits of two's complement, hence in [-1/2, 1/2).
    let fraction = [high << 2 | middle >> 62, middle << 2 | low >> 62, low << 2];
    let round_up = fraction[0] >> 63;
    // The complement is the negative but for one unit in 192 bits, which is far below the error.
    let magnitude = if round_up == 1 { fraction.map(|word| !word) } else { fraction };

    // The magnitude as 64 leading bits, then the reduced angle as an integer below 2^128.
    let (leading, zeros) = leading_bits(magnitude);
    let angle = u128::from(leading) * u128::from(HALF_PI_SCALED);
    let scale = power_of_two(-127 - zeros);
    let above = (angle >> 75) as f64 * power_of_two(75) * scale;
    let below = (angle & ((1 << 75) - 1)) as f64 * scale;
    let head = above + below;
    let excess = (head - above) - below;

    let quarter_turns = whole + round_up;
    let negative = x.is_sign_negative();
    let flip = if negative != (round_up == 1) { -1.0 } else { 1.0 };
    let quarter_turns = if negative { quarter_turns.wrapping_neg() } else { quarter_turns };
    Reduced { head: flip * head, excess: flip * excess, quarter_turns }
}

/// Three words of 2/pi, from the bit `offset` of the table on.
fn two_over_pi_from(offset: usize) -> [u64; 3] {
    let (word, shift) = (offset / 64, offset % 64);
    core::array::from_fn(|i| {
        let pair = join(TWO_OVER_PI[(word + i) & 31], TWO_OVER_PI[(word + i + 1) & 31]);
        ((pair << shift) >> 64) as u64
    })
}

/// The product modulo 2^192, most significant word first.
fn multiply(factor: u64, [high, middle, low]: [u64; 3]) -> [u64; 3] {
    let factor = u128::from(factor);
    let p0 = factor * u128::from(low);
    let p1 = factor * u128::from(middle) + (p0 >> 64);
    let p2 = factor * u128::from(high) + (p1 >> 64);
    [p2 as u64, p1 as u64, p0 as u64]
}

/// The 64 bits from the first nonzero one on, and how many zeros stand before it (at most 127: a
/// finite `f64` comes no closer to a multiple of pi/2).
fn leading_bits([high, middle, low]: [u64; 3]) -> (u64, i32) {
    let (value, skipped) =
        if high == 0 { (join(middle, low), 64) } else { (join(high, middle), 0) };
    let zeros = value.leading_zeros() as i32;
    (((value << zeros) >> 64) as u64, skipped + zeros)
}

fn join(high: u64, low: u64) -> u128 {
    u128::from(high) << 64 | u128::from(low)
}

/// 2^exponent, for exponents of normal numbers.
fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((exponent + 1023) as u64) << 52)
}
