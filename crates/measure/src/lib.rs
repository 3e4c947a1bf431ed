//! Logs of robots: what identification and diagnosis both know of them.
//!
//! - [`log`]: what was measured, read and checked
//! - [`condition`]: filtered, differentiated, decimated; noise of positions, rests, velocity
//!   reversals

pub mod condition;
pub mod log;
mod policy;
