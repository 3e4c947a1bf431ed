//! What numbers need that belong to no robot.
//!
//! - [`Random`]: numbers from a seed, the same on every machine
//! - [`MinimumNorm`]: square systems of any rank
//! - [`Butterworth`], [`Decimator`]: filters that delay nothing
//! - [`extremes`]: the rows of long columns that a picture needs
//! - [`envelope`]: what is between the ends of a signal that chatters
//! - [`short`], [`percent`]: numbers as a person writes them

mod butterworth;
mod decimate;
mod envelope;
mod extremes;
mod minimum_norm;
mod random;
mod text;

pub use butterworth::Butterworth;
pub use decimate::Decimator;
pub use envelope::{Span, envelope};
pub use extremes::extremes;
pub use minimum_norm::MinimumNorm;
pub use random::Random;
pub use text::{percent, short};
