//! From the rows of the table to moving bodies and their frames.
//!
//! - [`Mechanism`]: the rigid bodies that move, links on fixed rows merged into their carriers
//! - [`Frames`]: one frame for each body, in which the recursions run
//! - `world`: positions, rotations and Jacobians in frame 0
//! - `world_motion`: velocities and accelerations there

mod frames;
mod mechanism;
mod world;
mod world_motion;

pub use frames::{Frame, Frames, parallel_groups};
pub use mechanism::{Mechanism, MovingBody, Placement};
pub use world::{World, center_of_mass_column};
pub use world_motion::{Moving, WorldMotion};
