//! What compiled code calls: the runtime's functions, by C's calling convention.
// Compiled code hands over plain addresses.
#![allow(unsafe_code)]

use denavit_runtime::{Scalar, Transcendental};

/// Angles that one call of [`sincos`] takes.
pub(crate) const ANGLES: usize = 4;

/// Sines, then cosines, of [`ANGLES`] angles.
///
/// # Safety
/// `angles` points to [`ANGLES`] numbers, `results` to room for twice as many.
unsafe extern "C" fn sincos(angles: *const [f64; ANGLES], results: *mut [[f64; ANGLES]; 2]) {
    // SAFETY: compiled code passes two stack slots of these sizes.
    let (angles, results) = unsafe { (&*angles, &mut *results) };
    let (sines, cosines) = f64::sincos_all(*angles);
    *results = [sines, cosines];
}

extern "C" fn tangent(a: f64) -> f64 {
    a.tangent()
}

extern "C" fn exponential(a: f64) -> f64 {
    a.exponential()
}

extern "C" fn logarithm(a: f64) -> f64 {
    a.logarithm()
}

extern "C" fn hyperbolic_tangent(a: f64) -> f64 {
    a.hyperbolic_tangent()
}

extern "C" fn arctangent2(a: f64, b: f64) -> f64 {
    a.arctangent2(b)
}

/// Gives the address of a function.
type Address = fn() -> *const u8;

/// The addresses by the names that compiled code knows.
pub(crate) const ADDRESSES: [(&str, Address); 6] = [
    ("sincos", || sincos as *const u8),
    ("tangent", || tangent as *const u8),
    ("exponential", || exponential as *const u8),
    ("logarithm", || logarithm as *const u8),
    ("hyperbolic_tangent", || hyperbolic_tangent as *const u8),
    ("arctangent2", || arctangent2 as *const u8),
];
