//! Exact expressions: a hash-consed graph that folds as it is built.
//!
//! Equal expressions are one node, so sharing is found while an algorithm runs and never searched
//! for afterwards. Constants are exact rationals; nothing here knows a robot or a float.
//!
//! - [`Dag`]: the graph; its constructors (`add`, `mul`, `sin`, ...) apply the laws of `fold.rs`
//! - [`Symbol`], [`SymbolClass`]: what an expression may depend on
//! - [`derivative`], [`substitute`], [`free_symbols`]: passes over the graph, without recursion
//! - [`evaluate`]: the value over any [`Ring`]: `f64`, rationals, residues modulo 2^61 - 1
//! - [`Order`]: one order of expressions, whatever order they were made in
//! - [`text`]: expressions as text, read and written

mod angle;
mod circle;
mod dag;
mod diff;
mod evaluate;
mod fold;
mod fold_functions;
#[cfg(test)]
mod fold_tests;
mod operations;
mod order;
#[cfg(test)]
mod pass_tests;
#[cfg(test)]
pub(crate) mod random;
mod rings;
mod row_table;
mod substitute;
mod symbol;
pub mod text;

pub(crate) use angle::{AngleAtom, angle_atoms, atom_to_expr, is_pi};
pub use dag::{BinaryFunction, Dag, ExprId, Node, Relation, SymbolId, UnaryFunction};
pub use diff::derivative;
pub use evaluate::{EvaluateError, Ring, evaluate};
pub(crate) use fold_functions::quarter_turns;
pub use operations::Operations;
pub use order::Order;
pub use rings::{Floats, Rationals, Residues};
pub(crate) use substitute::rebuild;
pub use substitute::{free_symbols, import, substitute};
pub use symbol::{ClassSet, Symbol, SymbolClass};
