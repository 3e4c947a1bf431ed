//! Packs of four and eight `f64` as scalars.
//!
//! With `-C target-cpu=native`, or the target features avx2 and avx512f, a pack is one register.

use crate::Scalar;
use crate::pack::Packed;
use crate::reduction::{Lanes, ORDINARY_RANGE, reduce_ordinary};
use crate::scalar::fused_operations;
use crate::sincos::{of_reduced, sincos};
use wide::{f64x4, f64x8, u64x4, u64x8};

/// The last samples, the last one repeated. Apart from the loop over full packs: where the two meet
/// the compiler stores lanes one by one, and the processor waits until it can read them as one.
#[cold]
#[inline(never)]
fn read_last<const N: usize>(lanes: &mut [f64; N], there: &[f64]) {
    *lanes = core::array::from_fn(|lane| there[lane.min(there.len() - 1)]);
}

/// Implements the traits for a pack; the lanes are computed as the runtime's `f64` is.
macro_rules! pack {
    ($pack:ident, $bits:ident, $lanes:literal) => {
        impl Lanes for $pack {
            type Bits = $bits;

            #[inline]
            fn bits(self) -> $bits {
                bytemuck::cast(self)
            }

            #[inline]
            fn turned(sine: Self, cosine: Self, quarter_turns: $bits) -> (Self, Self) {
                let (sine, cosine) = (sine.bits(), cosine.bits());
                let [one, two] = [1, 2].map($bits::splat);
                let swapped = (sine ^ cosine) & ($bits::splat(0) - (quarter_turns & one));
                let sine_sign = (quarter_turns & two) << 62;
                let cosine_sign = ((quarter_turns + one) & two) << 62;
                let turned = |bits: $bits| -> Self { bytemuck::cast(bits) };
                (turned(sine ^ swapped ^ sine_sign), turned(cosine ^ swapped ^ cosine_sign))
            }
        }

        impl Scalar for $pack {
            const ZERO: Self = Self::ZERO;
            const ONE: Self = Self::ONE;

            #[inline]
            fn from_f64(value: f64) -> Self {
                Self::splat(value)
            }

            #[inline]
            fn sincos(self) -> (Self, Self) {
                if self.abs().simd_le(Self::splat(ORDINARY_RANGE)).all() {
                    return of_reduced(reduce_ordinary(self));
                }
                let pairs = self.to_array().map(sincos);
                (Self::new(pairs.map(|pair| pair.0)), Self::new(pairs.map(|pair| pair.1)))
            }

            fused_operations!();

            #[inline]
            fn abs(self) -> Self {
                self.abs()
            }

            #[inline]
            fn select_less(left: Self, right: Self, then: Self, otherwise: Self) -> Self {
                left.simd_lt(right).select(then, otherwise)
            }

            #[inline]
            fn select_less_equal(left: Self, right: Self, then: Self, otherwise: Self) -> Self {
                left.simd_le(right).select(then, otherwise)
            }

            #[inline]
            fn select_equal(left: Self, right: Self, then: Self, otherwise: Self) -> Self {
                left.simd_eq(right).select(then, otherwise)
            }
        }

        impl Packed for $pack {
            const LANES: usize = $lanes;
            const ENTRIES: usize = 1;
            const ZEROS: Self = Self::ZERO;

            #[inline]
            fn read(&mut self, columns: &[&[f64]], first: usize) {
                let there = &columns[0][first..];
                match there.first_chunk::<$lanes>() {
                    // Read as one: an array would go through memory in parts.
                    Some(lanes) => *self = bytemuck::pod_read_unaligned(bytemuck::bytes_of(lanes)),
                    None => read_last(bytemuck::cast_mut::<Self, [f64; $lanes]>(self), there),
                }
            }

            #[inline]
            fn write(&self, columns: &mut [&mut [f64]], first: usize) {
                let there = &mut columns[0][first..];
                match there.first_chunk_mut::<$lanes>() {
                    Some(lanes) => *lanes = self.to_array(),
                    None => there.copy_from_slice(&self.as_array()[..there.len()]),
                }
            }
        }
    };
}

// Where the target has no register of this size a pack is several smaller ones, and fusing is left
// to those targets on which single numbers fuse too.
pack!(f64x4, u64x4, 4);
pack!(f64x8, u64x8, 8);

#[cfg(feature = "libm")]
mod transcendental {
    use crate::Transcendental;
    use wide::{f64x4, f64x8};

    /// Lane by lane, with the bits of the single number.
    macro_rules! by_lanes {
        ($pack:ident) => {
            impl Transcendental for $pack {
                #[inline]
                fn sqrt(self) -> Self {
                    Self::new(self.to_array().map(Transcendental::sqrt))
                }

                #[inline]
                fn tangent(self) -> Self {
                    Self::new(self.to_array().map(Transcendental::tangent))
                }

                #[inline]
                fn arctangent2(self, abscissa: Self) -> Self {
                    let abscissae = abscissa.to_array();
                    let ordinates = self.to_array();
                    Self::new(core::array::from_fn(|lane| {
                        ordinates[lane].arctangent2(abscissae[lane])
                    }))
                }

                #[inline]
                fn exponential(self) -> Self {
                    Self::new(self.to_array().map(Transcendental::exponential))
                }

                #[inline]
                fn logarithm(self) -> Self {
                    Self::new(self.to_array().map(Transcendental::logarithm))
                }

                #[inline]
                fn hyperbolic_tangent(self) -> Self {
                    Self::new(self.to_array().map(Transcendental::hyperbolic_tangent))
                }
            }
        };
    }

    by_lanes!(f64x4);
    by_lanes!(f64x8);
}
