//! What was measured: one model of logs for everything that is concluded from them.
//!
//! - [`log`]: what was measured, read and checked
//! - [`condition`]: filtered, differentiated, decimated; its noise, rests and velocity reversals

pub mod condition;
pub mod log;
