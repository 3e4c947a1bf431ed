//! What emitted code relies on, checked against big integers, closed forms and known values.

mod reference;
mod scalar;
mod sincos;
#[cfg(feature = "libm")]
mod transcendental;
