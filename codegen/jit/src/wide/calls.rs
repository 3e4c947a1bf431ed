//! What wide code calls: the runtime's functions, sample by sample.
//!
//! The calling convention is that of System V on every system, so that wide code is the same.
// Compiled code hands over plain addresses.
#![allow(unsafe_code)]

use crate::lanes::Lanes;
use denavit_runtime::{Scalar, Transcendental};

/// A function of the runtime.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Callee {
    SinCos,
    Tan,
    Exp,
    Log,
    Tanh,
    Atan2,
}

/// Operands and room for results, each of the samples of a register. What a function does not have
/// is not touched.
type Function<const N: usize> =
    unsafe extern "sysv64" fn(*const [f64; N], *const [f64; N], *mut [f64; N], *mut [f64; N]);

/// # Safety
/// `a` points to numbers, `sines` and `cosines` to room for as many.
unsafe extern "sysv64" fn sincos<const N: usize>(
    a: *const [f64; N],
    _: *const [f64; N],
    sines: *mut [f64; N],
    cosines: *mut [f64; N],
) {
    // SAFETY: compiled code passes rows of its scratch memory.
    unsafe { (*sines, *cosines) = f64::sincos_all(*a) };
}

/// Functions of one number.
macro_rules! unary {
    ($($name:ident $method:ident),+) => {$(
        /// # Safety
        /// `a` points to numbers, `result` to room for as many.
        unsafe extern "sysv64" fn $name<const N: usize>(
            a: *const [f64; N],
            _: *const [f64; N],
            result: *mut [f64; N],
            _: *mut [f64; N],
        ) {
            // SAFETY: compiled code passes rows of its scratch memory.
            unsafe { *result = (*a).map(f64::$method) };
        }
    )+};
}

unary!(tan tangent, exp exponential, log logarithm, tanh hyperbolic_tangent);

/// # Safety
/// `a` and `b` point to numbers, `result` to room for as many.
unsafe extern "sysv64" fn atan2<const N: usize>(
    a: *const [f64; N],
    b: *const [f64; N],
    result: *mut [f64; N],
    _: *mut [f64; N],
) {
    // SAFETY: compiled code passes rows of its scratch memory.
    unsafe { *result = std::array::from_fn(|lane| (*a)[lane].arctangent2((*b)[lane])) };
}

impl Callee {
    fn function<const N: usize>(self) -> Function<N> {
        match self {
            Self::SinCos => sincos,
            Self::Tan => tan,
            Self::Exp => exp,
            Self::Log => log,
            Self::Tanh => tanh,
            Self::Atan2 => atan2,
        }
    }

    /// The address, for registers of four or eight.
    pub(super) fn address(self, lanes: Lanes) -> u64 {
        match lanes {
            Lanes::Eight => self.function::<8>() as usize as u64,
            _ => self.function::<4>() as usize as u64,
        }
    }
}
