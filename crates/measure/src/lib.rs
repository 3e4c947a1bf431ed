//! Logs of robots: what identification and diagnosis both know of them.
//!
//! - [`log`]: what was measured, read and checked
//! - [`condition`]: filtered, differentiated, decimated; noise of positions, rests, velocity
//!   reversals
//! - [`LogIndex`], [`PartIndex`], [`SampleIndex`], [`JointIndex`]: their numbers
//! - [`Split`]: those that an answer is from, and those that judge it

pub mod condition;
mod index;
pub mod log;
mod policy;
mod split;

pub use index::{JointIndex, LogIndex, PartIndex, SampleIndex};
pub use split::Split;
