//! What was measured: one model of logs for everything that is concluded from them.
//!
//! - [`log`]: what was measured, read and checked
//! - [`resolution`]: what its channels tell apart: printing, steps of encoders, white noise
//! - [`condition`]: filtered, differentiated, decimated; its noise, rests and velocity reversals

pub mod condition;
pub mod log;
pub mod resolution;
