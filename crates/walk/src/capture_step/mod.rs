//! A controller of planar robots with two legs that steps onto the capture point.
//!
//! It looks at the state at a fixed period. While the capture point is inside the sole by a margin,
//! the robot stands: the centre of mass follows a linear inverted pendulum whose centre of
//! pressure, inside the sole by the margin, takes the capture point back to the middle. Where it is
//! outside, the foot that is behind (of a fall backward: ahead) swings for the step time. Meanwhile
//! the centre of pressure is at the edge of the sole that stands, where it slows the fall most; the
//! foot lands with its middle under the capture point of that time, or as near as the longest step
//! allows. After the landing it looks again: stand, or step on.
//!
//! Planned paths of centre of mass, trunk and feet start with the measured places and velocities.
//! Inverse kinematics makes joint references of them, inverse dynamics torques that are fed forward
//! ([`denavit_simulate::Planning`]).
//!
//! - [`CaptureStep`]: the numbers of the law
//! - [`capture_step`]: the law for a robot, with the posture in which it starts
//! - [`step_limits`]: what the robot of a scenario can do, for [`crate::capturability`]

mod file;
mod law;
mod limits;
mod measured;
mod motion;
mod pendulum;
mod planner;
mod reach;
mod torques;

pub(crate) use file::read;
pub use law::{CaptureStep, CaptureStepLaw, Prepared, capture_step};
pub use limits::{law_of, step_limits};
