//! Programs and equations to text.
//!
//! - [`rust`]: a module of Rust source that depends on `denavit-runtime` alone
//! - [`c`]: C99 and C++17 that depend on nothing
//! - [`latex`]: equations as a person would set them
//! - [`layout`]: the filling of templates, which hold the frames of all text that is written
//!
//! Nothing is computed here but names and layout.

mod arrays;
mod body;
pub mod c;
mod context;
mod heading;
pub mod latex;
pub mod layout;
mod names;
mod routine;
pub mod rust;
mod selectors;
mod syntax;
mod wording;

pub use context::EmitError;
