//! The blind battery: data in which an effect is hidden, made by code that shares nothing with the
//! symbolic engine, the catalogue of effects or the simulator. docs/blind-battery.md describes it.

// The two test programs and the example each use a part of it, so that each warns of the rest.
#![allow(dead_code)]

pub(crate) mod battery;
pub(crate) mod case;
pub(crate) mod design;
pub(crate) mod experiment;
pub(crate) mod filter;
pub(crate) mod generate;
pub(crate) mod hidden;
pub(crate) mod laws;
pub(crate) mod nominal;
pub(crate) mod plant;
pub(crate) mod random;
pub(crate) mod reference;
pub(crate) mod rigid;
pub(crate) mod robots;
pub(crate) mod score;
pub(crate) mod strength;
