//! Symbolic robot dynamics: from a Denavit-Hartenberg table to exact equations and optimised Rust.
//!
//! - everything of [`denavit_codegen`], the symbolic compiler
//! - [`shipped`]: robots whose model files are part of the library
//! - [`tulip`], [`puma560`], [`planar_biped`]: what the compiler made of three of them when this
//!   library was built
//! - [`batch`]: emitted functions on many samples, on all processors
//! - [`simulate`]: robots in motion, on the ground
//! - [`diagnose`]: what a model lacks, from measurements
//! - [`plants`]: robots as numbers, generated or interpreted
//! - [`identify`]: parameters from measured motion, and motion that shows them
//! - [`trajectory`]: references for their joints
//! - [`walk`]: postures and gaits
//! - [`report`]: tables and pictures of robots

pub mod batch;
pub mod diagnose;
mod generated;
pub mod identify;
pub mod plants;
pub mod report;
pub mod shipped;
pub mod simulate;
pub mod trajectory;
pub mod walk;

pub use denavit_codegen::*;
pub use generated::{planar_biped, puma560, tulip};

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExamples;
