//! The scalar that emitted code is generic over.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::sincos;

/// Whether [`Scalar::product_plus`] and its kin round once: the feature `fma` is on and the target
/// has the instruction (`-C target-cpu=native`, or `-C target-feature=+fma`).
pub const FUSES: bool =
    cfg!(all(feature = "fma", any(target_feature = "fma", target_arch = "aarch64")));

/// A real number, or a pack of them, that emitted dynamics can be evaluated on.
///
/// An implementation keeps to three rules: the operators round like IEEE arithmetic, no method
/// panics, and a pack does in each lane exactly what the single number does. Angles are in
/// radians. `Default` is [`ZERO`](Scalar::ZERO).
pub trait Scalar:
    Copy
    + Debug
    + Default
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// The number 0 (positive zero).
    const ZERO: Self;
    /// The number 1.
    const ONE: Self;

    /// The nearest `Self` to a constant of emitted code.
    #[must_use]
    fn from_f64(value: f64) -> Self;

    /// `(sin self, cos self)`, for an angle in radians.
    ///
    /// Exactly odd and even: `sincos(-x) = (-sin x, cos x)`, and `sincos(-0.0) = (-0.0, 1.0)`.
    /// Infinities and NaN give `(NaN, NaN)`.
    ///
    /// Both results are within 1 ulp (unit in the last place) for every finite `f64`, however
    /// large and however close to a multiple of a quarter turn; the largest error measured on
    /// 5e7 arguments is 0.82 ulp. For `f32` the `f64` result is rounded once more, which is
    /// within 0.500001 ulp, but costs `f64` arithmetic also where that is done in software.
    #[must_use]
    fn sincos(self) -> (Self, Self);

    /// The sines and the cosines of several angles, with the bits that [`sincos`](Self::sincos)
    /// gives; `f64` computes up to four of them in the time of one.
    #[must_use]
    fn sincos_all<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
        let pairs = angles.map(Self::sincos);
        (pairs.map(|(sine, _)| sine), pairs.map(|(_, cosine)| cosine))
    }

    /// `self factor + addend`, rounded once where [`FUSES`], else after the product too.
    #[must_use]
    fn product_plus(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }

    /// `self factor - subtrahend`, rounded as [`product_plus`](Self::product_plus).
    #[must_use]
    fn product_minus(self, factor: Self, subtrahend: Self) -> Self {
        self * factor - subtrahend
    }

    /// `self - left right`, rounded as [`product_plus`](Self::product_plus).
    #[must_use]
    fn minus_product(self, left: Self, right: Self) -> Self {
        self - left * right
    }

    /// The absolute value; clears the sign of zero.
    #[must_use]
    fn abs(self) -> Self;

    /// -1, 0 or +1 as `self` is negative, zero or positive; a zero keeps its sign, NaN stays NaN.
    #[inline]
    #[must_use]
    fn sign(self) -> Self {
        let not_positive = Self::select_less(self, Self::ZERO, -Self::ONE, self);
        Self::select_less(Self::ZERO, self, Self::ONE, not_positive)
    }

    /// The lesser of the two; `self` if they are equal (so of two zeros the left one), NaN if
    /// either is NaN: a fault is not clipped away.
    #[inline]
    #[must_use]
    fn lesser(self, other: Self) -> Self {
        // A NaN on the right fails the first comparison and is chosen by it.
        let chosen = Self::select_less_equal(self, other, self, other);
        Self::select_equal(self, self, chosen, self)
    }

    /// The greater of the two; `self` if they are equal (so of two zeros the left one), NaN if
    /// either is NaN: a fault is not clipped away.
    #[inline]
    #[must_use]
    fn greater(self, other: Self) -> Self {
        let chosen = Self::select_less_equal(other, self, self, other);
        Self::select_equal(self, self, chosen, self)
    }

    /// `then` if `left < right`, else `otherwise`; a comparison with NaN does not hold.
    #[must_use]
    fn select_less(left: Self, right: Self, then: Self, otherwise: Self) -> Self;

    /// `then` if `left <= right`, else `otherwise`; a comparison with NaN does not hold.
    #[must_use]
    fn select_less_equal(left: Self, right: Self, then: Self, otherwise: Self) -> Self;

    /// `then` if `left = right`, else `otherwise`; a comparison with NaN does not hold.
    #[must_use]
    fn select_equal(left: Self, right: Self, then: Self, otherwise: Self) -> Self;
}

/// The fused operations, where the target has them. A product that is negated is exact, so a fused
/// difference is a fused sum of it.
macro_rules! fused_operations {
    () => {
        #[cfg(all(feature = "fma", any(target_feature = "fma", target_arch = "aarch64")))]
        #[inline]
        fn product_plus(self, factor: Self, addend: Self) -> Self {
            self.mul_add(factor, addend)
        }

        #[cfg(all(feature = "fma", any(target_feature = "fma", target_arch = "aarch64")))]
        #[inline]
        fn product_minus(self, factor: Self, subtrahend: Self) -> Self {
            self.mul_add(factor, -subtrahend)
        }

        #[cfg(all(feature = "fma", any(target_feature = "fma", target_arch = "aarch64")))]
        #[inline]
        fn minus_product(self, left: Self, right: Self) -> Self {
            (-left).mul_add(right, self)
        }
    };
}
#[cfg(feature = "wide")]
pub(crate) use fused_operations;

/// What `f64` and `f32` do alike: everything but constants and the sine and cosine.
macro_rules! comparisons_and_signs {
    () => {
        fused_operations!();

        #[inline]
        fn abs(self) -> Self {
            // The inherent method, which the compiler prefers here.
            self.abs()
        }

        #[inline]
        fn select_less(left: Self, right: Self, then: Self, otherwise: Self) -> Self {
            if left < right { then } else { otherwise }
        }

        #[inline]
        fn select_less_equal(left: Self, right: Self, then: Self, otherwise: Self) -> Self {
            if left <= right { then } else { otherwise }
        }

        #[inline]
        fn select_equal(left: Self, right: Self, then: Self, otherwise: Self) -> Self {
            if left == right { then } else { otherwise }
        }
    };
}

impl Scalar for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    #[inline]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline]
    fn sincos(self) -> (Self, Self) {
        sincos::sincos(self)
    }

    #[inline]
    fn sincos_all<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
        sincos::sincos_all(angles)
    }

    comparisons_and_signs!();
}

impl Scalar for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    #[inline]
    fn from_f64(value: f64) -> Self {
        value as f32
    }

    #[inline]
    fn sincos(self) -> (Self, Self) {
        let (sine, cosine) = sincos::sincos(f64::from(self));
        (sine as f32, cosine as f32)
    }

    comparisons_and_signs!();
}
