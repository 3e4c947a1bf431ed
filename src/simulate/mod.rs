//! Simulation of robots on the ground.
//!
//! - [`contact`]: forces and impulses of contacts and their modes, decided by complementarity
//! - [`time_stepping`]: the schemes that take contacts into account over whole steps

pub mod contact;
pub mod time_stepping;
