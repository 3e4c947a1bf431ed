//! The numbers of [`Scalar::sincos`](crate::Scalar::sincos), for compilers that write its steps
//! themselves and promise its bits.

pub use crate::reduction::{HALF_PI, ORDINARY_RANGE, ROUNDER};
pub use crate::sincos::{COSINE, SINE};
