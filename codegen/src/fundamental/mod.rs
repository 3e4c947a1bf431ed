//! Canonical forms: what two expressions have in common is decided exactly, without floats and
//! without random points.
//!
//! - [`Polynomial`]: sparse, over any atoms, with rational coefficients and signed exponents
//! - [`canonical`]: an expression as a polynomial in symbols, sines and cosines of single angles
//! - [`decompose`]: a matrix as f^T B, over trigonometric polynomials in packed keys
//! - [`separate`]: products of unknowns as columns; [`echelon`]: Gauss-Jordan on B
//! - [`gcd`], [`divide`]: divisors of polynomials; [`Fraction`], [`Field`]: rational functions
//! - [`equal`]: whether two expressions are the same function
//! - [`written_out`]: short expressions the way people write them

mod basis;
mod canonical;
mod decompose;
#[cfg(test)]
mod decompose_tests;
mod echelon;
mod expand;
mod fraction;
mod gcd;
mod key;
mod layout;
mod number_angle;
mod polynomial;
mod readable;
mod separate;
mod series;
#[cfg(test)]
mod tests;
mod whole;
mod work;

pub use canonical::{
    CanonicalError, MAX_TERMS, canonical, canonical_all, canonical_generic, equal,
};
pub use decompose::{
    Basis, Decomposition, Entry, FundamentalFunction, Matrix, Wave, decompose, smallest,
};
pub use echelon::{Echelon, EchelonError, echelon};
pub use expand::{DEFAULT_MEMORY_BYTES, Expansion, FourierError, Progress};
pub use fraction::{Field, Fraction};
pub use gcd::{divide, gcd};
pub use polynomial::{Monomial, Polynomial, TooManyTerms};
pub use readable::written_out;
pub use separate::{Separated, equal_columns, separate};
pub use work::Work;
