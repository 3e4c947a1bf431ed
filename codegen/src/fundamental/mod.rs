//! Canonical forms: what two expressions have in common is decided exactly, without floats and
//! without random points.
//!
//! - [`Polynomial`]: sparse, over any atoms, with rational coefficients and signed exponents
//! - [`canonical`]: an expression as a polynomial in symbols, sines and cosines of single angles
//! - [`equal`]: whether two expressions are the same function

mod canonical;
mod polynomial;
#[cfg(test)]
mod tests;

pub use canonical::{CanonicalError, MAX_TERMS, canonical, canonical_all, equal};
pub use polynomial::{Monomial, Polynomial, TooManyTerms};
