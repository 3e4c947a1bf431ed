//! What emitted code relies on, checked against big integers, closed forms and known values.

#[cfg(feature = "wide")]
mod packs;
mod reference;
mod scalar;
mod sincos;
#[cfg(feature = "libm")]
mod transcendental;
