//! Programs and equations to text.
//!
//! - [`rust`]: a module of Rust source that depends on `denavit-runtime` alone
//! - [`latex`]: equations as a person would set them
//! - [`layout`]: the filling of templates, which hold the frames of all text that is written
//!
//! Nothing is computed here but names and layout.

mod arrays;
mod body;
pub mod latex;
pub mod layout;
mod names;
pub mod rust;
mod wording;
