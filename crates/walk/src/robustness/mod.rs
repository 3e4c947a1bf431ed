//! How much a gait endures: which starts off its cycle return to it, and which push fells it.
//!
//! - [`basin`]: starts around the fixed point
//! - [`capture_pushes`]: pushes of a standing robot, its steps, and the steps predicted
//! - [`least_pushes`]: the least push that fells, over the time in the step and the direction

mod basin;
mod capture_pushes;
mod outcome;
mod parallel;
mod push_map;

pub use basin::{BasinOptions, BasinStart, Deviation, basin, grid, noise};
pub use capture_pushes::{CapturePush, CapturePushOptions, capture_pushes, steps_taken};
pub use outcome::Outcome;
pub use parallel::Observer;
pub use parallel::Opener;
pub use push_map::{LeastPush, PushOptions, least_pushes};

/// Friction that stands in where the no-slip law has no answer to an impact: disturbed robots
/// scuff, and runs would end there.
pub const FALLBACK_FRICTION: f64 = 0.8;
