//! Symbolic robot dynamics: from a Denavit-Hartenberg table to exact equations and optimised Rust.
//!
//! # Use cases
//!
//! Files in, an answer out: [`workflow`] has each as one call, with options that have defaults, an
//! observer that hears of progress and may stop the work, and one error with kinds and hints.
//!
//! | to | call |
//! |---|---|
//! | read a robot (model file, URDF, MJCF) | [`workflow::RobotFile::open`], [`workflow::Files`] |
//! | identify parameters from logs | [`workflow::identify()`], [`workflow::Logs`] |
//! | name what a model lacks, from logs | [`workflow::diagnose()`] |
//! | find a motion that shows parameters | [`workflow::excite()`] |
//! | simulate a scenario | [`workflow::simulate()`] |
//! | design a gait, judge a walk | [`workflow::design_gait`], [`workflow::judge_run`] |
//! | follow progress, or stop after some time | [`workflow::Observer`], [`workflow::Progress`] |
//! | derive equations of motion | [`derive::MotionEquations`] |
//! | emit Rust, C, C++ | [`emit::Sources`]; in a build script [`build_script`] |
//! | find base parameters | [`regressor::ProvenBase`] |
//!
//! # The laboratory
//!
//! - [`identify`]: parameters from measured motion; [`elastic`]: springs and motors of series
//!   elastic drives first; [`statics`]: parameters from weighings and held postures
//! - [`diagnose`]: what a model lacks, from measurements
//! - [`excite`]: motion that shows the parameters of a robot
//! - [`simulate`]: robots in motion, on the ground
//! - [`walk`]: postures and gaits
//! - [`measure`]: logs: read, checked, filtered; noise of their positions
//! - [`logs`]: files of logs of any format as tables
//! - [`import`]: URDF and MJCF as model files, and back
//! - [`plants`]: robots as numbers, generated or interpreted; [`trajectory`]: references for their
//!   joints; [`batch`]: functions on many samples, on all processors
//! - [`report`]: answers as text, JSON, pictures and pages
//! - [`numerics`]: random numbers, systems of any rank
//! - [`shipped`]: robots whose model files are part of the library; [`tulip`], [`puma560`],
//!   [`planar_biped`]: what the compiler made of three of them when this library was built
//! - [`demo`]: what the command shows of all that on shipped robots
//!
//! # The compiler
//!
//! All of [`denavit_codegen`], in the order of its stages: [`arena`], [`expr`], [`number`],
//! [`fundamental`], [`model`], [`effect`], [`function`], [`spatial`], [`kinematics`], [`regroup`],
//! [`dynamics`], [`regressor`], [`mod@derive`], [`program`], [`emit`], [`build_script`].
//!
//! # Errors
//!
//! Each package has one: `Error`, with its `kind()`, its `source()`, and what helps as data.

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
pub use denavit_elastic as elastic;
pub use denavit_excite as excite;
pub use denavit_identify as identify;
pub use denavit_import as import;
pub use denavit_logs as logs;
pub use denavit_measure as measure;
pub use denavit_numerics as numerics;
pub use denavit_plants as plants;
pub use denavit_plants::emitted::{planar_biped, puma560, tulip};
pub use denavit_plants::{batch, shipped, trajectory};
pub use denavit_replay as replay;
pub use denavit_report as report;
pub use denavit_simulate as simulate;
pub use denavit_statics as statics;
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
