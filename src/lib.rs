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
//! - [`excite`]: motion that shows the parameters of a robot
//! - [`identify`]: parameters from measured motion
//! - [`import`]: URDF and MJCF as model files, and back
//! - [`logs`]: files of logs of any format as tables
//! - [`measure`]: logs: read, checked, filtered; noise of their positions
//! - [`trajectory`]: references for their joints
//! - [`walk`]: postures and gaits
//! - [`workflow`]: use cases as single calls: a robot and logs in, an answer out
//! - [`report`]: tables and pictures of robots
//! - [`demo`]: what the command shows of all that on shipped robots

// The command is part of the library, so that other programs have it in their own process; its
// files name the library as its users do.
extern crate self as denavit;

#[doc(hidden)]
pub mod cli;
pub mod demo;

pub use denavit_codegen::{
    arena, build_script, derive, dynamics, effect, emit, expr, function, fundamental, kinematics,
    model, number, program, regressor, regroup, spatial,
};
pub use denavit_diagnose as diagnose;
pub use denavit_excite as excite;
pub use denavit_identify as identify;
pub use denavit_import as import;
pub use denavit_logs as logs;
pub use denavit_measure as measure;
pub use denavit_numerics as numerics;
pub use denavit_plants as plants;
pub use denavit_plants::emitted::{planar_biped, puma560, tulip};
pub use denavit_plants::{batch, shipped, trajectory};
pub use denavit_report as report;
pub use denavit_simulate as simulate;
pub use denavit_walk as walk;
pub use denavit_workflow as workflow;

/// The examples of the guide, as tests.
#[cfg(doctest)]
#[doc = include_str!("../docs/guide/controller-code.md")]
pub struct GuideExamples;

/// The examples of the guide to the library, as tests.
#[cfg(doctest)]
#[doc = include_str!("../docs/guide/library.md")]
pub struct LibraryExamples;
