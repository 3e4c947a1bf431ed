//! Equations as LaTeX, the way a person would set them.
//!
//! - [`Notation`]: how symbols and angles are written (`\dot q_1`, `m_{2}`, `s_{12}`)
//! - [`write_expressions`]: formulas, with intermediates named where they are long or shared
//! - [`motion_document`]: the equations of motion of a robot as a complete document;
//!   [`document()`]: any of its functions
//! - [`base_document`]: its base parameters
//! - [`decomposition_document`], [`robot_decomposition`], [`equations_decomposition`]: f, B and
//!   theta as one

mod base_parameters;
mod decomposition;
mod document;
mod expression;
mod nomenclature;
mod notation;
mod term;
#[cfg(test)]
mod tests;

pub use base_parameters::{base_document, base_notation, base_sum};
pub use decomposition::{
    TooLongToSet, decomposition_document, equations_decomposition, robot_decomposition,
};
pub use document::{document, motion_document};
pub use expression::{Extent, Written, write_expression, write_expressions};
pub use notation::{Notation, escape, latex_of_name};
