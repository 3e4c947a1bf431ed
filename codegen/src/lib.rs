//! The symbolic compiler: from a robot's Denavit-Hartenberg table to exact dynamics to optimised
//! Rust.

pub mod arena;
pub mod expr;
pub mod function;
pub mod model;
pub mod number;
pub mod program;
