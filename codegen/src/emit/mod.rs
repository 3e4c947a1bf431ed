//! Programs and equations to text.
//!
//! - [`rust`]: a module of Rust source that depends on `denavit-runtime` alone
//! - [`c`]: C99 and C++17 that depend on nothing
//! - [`Sources`]: the files of a robot in a [`Language`], in one call
//! - [`latex`]: equations as a person would set them
//! - [`layout`]: the filling of templates, which hold the frames of all text that is written
//!
//! Nothing is computed here but names and layout.

mod arrays;
mod body;
pub mod c;
mod context;
mod heading;
mod language;
pub mod latex;
pub mod layout;
mod names;
mod routine;
pub mod rust;
mod selectors;
mod syntax;
mod wording;

pub use context::EmitError;
pub use language::{FileNameError, Language, SourceError, SourceOptions, Sources};
