//! Passive walkers whose legs have no mass at the feet, or knees that lock: plants written by hand,
//! with jumps of their own in place of contacts.

mod kneed;
mod simplest;

pub use kneed::KneedWalker;
pub use simplest::SimplestWalker;
