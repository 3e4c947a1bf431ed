//! Logs of robots: what identification and diagnosis both know of them.
//!
//! - [`log`]: what was measured, read and checked
//! - [`condition`]: filtered, differentiated, decimated; noise of positions, rests, velocity
//!   reversals
//! - [`LogIndex`], [`PartIndex`], [`SampleIndex`], [`JointIndex`]: their numbers
//! - [`Split`]: those that an answer is from, and those that judge it
//! - [`Error`]: why a log is not read, or cannot be conditioned

pub mod condition;
mod error;
mod index;
pub mod log;
mod policy;
mod split;

pub use error::{Error, ErrorKind};
pub use index::{JointIndex, LogIndex, PartIndex, SampleIndex};
pub use split::Split;
