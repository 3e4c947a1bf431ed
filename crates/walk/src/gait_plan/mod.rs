//! Gaits planned by kinematics: places of feet and centre of mass first, joint positions from them.
//!
//! - [`plan_primitives`]: statically stable postures, joined (thesis 4.4.2)
//! - [`plan_inverted_pendulum`]: the linear inverted pendulum, from standing to standing
//! - [`GaitPlan`]: what both make; its files are [`GaitPlan::scenario_text`] and
//!   [`GaitPlan::trajectory_text`]
//! - [`PendulumPath`]: the centre of mass of the pendulum in closed form
//! - [`Walker`]: joint positions for given places of the feet

mod curve;
mod fault;
mod files;
mod inverted_pendulum;
mod pendulum;
mod plan;
mod primitives;
mod walker;

pub use curve::{Curve, JointPath, Piece};
pub use fault::PlanError;
pub use inverted_pendulum::{InvertedPendulumProblem, plan_inverted_pendulum};
pub use pendulum::{PendulumPath, PendulumState, PressureSegment};
pub use plan::{GaitPlan, JointGains, Knot};
pub use primitives::{Join, Primitive, PrimitivesProblem, plan_primitives};
pub use walker::{Foot, Height, Pose, Posture, Walker};
