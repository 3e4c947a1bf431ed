//! The symbolic compiler: from a robot's Denavit-Hartenberg table to exact dynamics to optimised
//! Rust.

pub mod alias;
pub mod arena;
pub mod build_script;
pub mod derive;
pub mod dynamics;
pub mod effect;
pub mod emit;
pub mod expr;
pub mod function;
pub mod fundamental;
pub mod kinematics;
pub mod model;
pub mod number;
pub mod program;
pub mod regressor;
pub mod regroup;
pub mod spatial;
