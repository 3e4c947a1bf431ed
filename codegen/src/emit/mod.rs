//! Programs to text.
//!
//! - [`rust`]: a module of Rust source that depends on `denavit-runtime` alone
//! - [`layout`]: the filling of templates, which hold the frames of all text that is written
//!
//! Nothing is computed here but names and layout.

mod arrays;
mod body;
pub mod layout;
mod names;
pub mod rust;
mod wording;
