//! Vectors, elementary rotations and pseudo-inertias as expressions.

mod inertia;
mod turn;
mod vector;

pub use inertia::PseudoInertia;
pub use turn::{Axis, Turn};
pub use vector::{
    Matrix, Vector, add, add_matrix, cross, dot, entrywise, negate, scale, subtract, transpose,
    vee, zero, zero_matrix,
};
