//! Symbolic robot dynamics: from a Denavit-Hartenberg table to exact equations and optimised Rust.
//!
//! - everything of [`denavit_codegen`], the symbolic compiler
//! - [`shipped`]: robots whose model files are part of the library
//! - [`report`]: tables and pictures of robots

pub mod report;
pub mod shipped;

pub use denavit_codegen::*;
