//! The blind battery: data in which an effect is hidden, made by code that shares nothing with the
//! symbolic engine, the catalogue of effects or the simulator. docs/evidence/battery.md describes
//! it.

pub mod battery;
pub mod case;
pub mod conditions;
pub mod design;
pub mod experiment;
pub mod filter;
pub mod generate;
pub mod hidden;
pub mod laws;
pub mod nominal;
pub mod plant;
pub mod random;
pub mod reference;
pub mod rigid;
pub mod robots;
pub mod score;
pub mod strength;
