//! A walk in space whose feet are placed as the robot is pushed (thesis 4.4.3, active lateral foot
//! placement).
//!
//! The walk is planned from standing to standing on footsteps ([`crate::gait_plan`]). During the
//! run a planner looks at the state at a fixed period. As long as the divergent component of
//! motion, centre of mass plus velocity over w, is where it was planned, nothing happens. Where it
//! is not, the centre of pressure goes beyond it, inside the soles that stand, so that it returns.
//! What the soles are too small for is foretold for the landing of the foot that swings; this one
//! lands elsewhere, and all further footsteps with it, so that the walk goes on beside the planned
//! one.
//!
//! References start with what is measured, which fades into the plan; inverse dynamics with ground
//! forces gives the torques that are fed forward.
//!
//! - [`FootPlacement`]: the numbers of the law

mod course;
mod file;
mod law;
mod measured;
mod motion;
mod pendulum;
mod stepper;

pub(crate) use file::read;
pub use law::FootPlacement;
