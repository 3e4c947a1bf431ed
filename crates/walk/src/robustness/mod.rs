//! How much a gait endures: which starts off its cycle return to it, and which push fells it.
//!
//! - [`basin`]: starts around the fixed point
//! - [`least_pushes`]: the least push that fells, over the time in the step and the direction

mod basin;
mod outcome;
mod parallel;
mod push_map;

pub use basin::{BasinOptions, BasinStart, Deviation, basin, grid, noise};
pub use outcome::Outcome;
pub use parallel::Observer;
pub use parallel::Opener;
pub use push_map::{LeastPush, PushOptions, least_pushes};
