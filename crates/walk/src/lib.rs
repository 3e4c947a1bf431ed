//! Walking: how a robot is to move so that it makes steps.
//!
//! - [`inverse_kinematics`]: joint positions for given places of feet and centre of mass
//! - [`optimal`]: limit cycles by periodic optimal control
//! - [`gait_plan`]: walking primitives, and walks by the linear inverted pendulum
//! - [`gait_file`]: files that say what a gait is to be
//! - [`balance`]: zero moment point, foot rotation, capture point, momentum along a run
//! - [`capturability`]: in how many steps the linear inverted pendulum comes to rest
//! - [`capture_step`]: a controller that steps onto the capture point
//! - [`foot_placement`]: a walk in space whose feet are placed as the robot is pushed
//! - [`comparison`]: what each criterion of stability says of runs, and what comes out
//! - [`poincare`]: cycles, and whether they are stable
//! - [`robustness`]: basins of attraction, and the least push that fells
//! - [`ScenarioHead`]: what the scenario file of a designed gait says besides it
//! - [`read_scenario`]: scenarios whose gait is planned
//! - [`Error`]: why there is no answer, of all of these

pub mod balance;
pub mod capturability;
pub mod capture_step;
pub mod comparison;
mod error;
mod fading;
pub mod foot_placement;
pub mod gait_file;
pub mod gait_plan;
pub mod inverse_kinematics;
mod leg_exchange;
pub mod optimal;
pub mod poincare;
pub mod robustness;
mod scenario;
mod scenario_file;

pub use error::{Error, ErrorKind, Violated};
pub use leg_exchange::LegExchange;
pub use scenario::read_scenario;
pub use scenario_file::ScenarioHead;
