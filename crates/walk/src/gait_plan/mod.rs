//! Gaits planned by kinematics: places of feet and centre of mass first, joint positions from them.
//!
//! - [`plan_primitives`]: statically stable postures, joined (thesis 4.4.2)
//! - [`plan_inverted_pendulum`]: the linear inverted pendulum, from standing to standing
//! - [`plan_divergent_component`]: a walk in space on planned footsteps, by the divergent component
//!   of the pendulum
//! - [`GaitPlan`]: what all make; its files are [`GaitPlan::scenario_text`] and
//!   [`GaitPlan::trajectory_text`]
//! - [`PendulumPath`]: the centre of mass of the pendulum in closed form
//! - [`Walker`], [`Biped`]: joint positions for given places of the feet, in the plane and in space

mod biped;
mod curve;
mod divergent_component;
mod files;
mod footsteps;
mod inverted_pendulum;
mod pendulum;
mod plan;
mod posture;
mod primitives;
mod torque;
mod walker;

pub use crate::scenario_file::ContactFriction;
pub use biped::{AnkleRoll, Biped, BipedPose, RollCondition, Sole, SolePlace};
pub use curve::{Curve, JointPath, Piece};
pub use divergent_component::plan_divergent_component;
pub(crate) use divergent_component::{SpaceWalk, plan_space_walk, pose};
pub(crate) use footsteps::Phase;
pub use footsteps::{AnkleRolls, DivergentComponentProblem, Ending, Footstep, Side};
pub use inverted_pendulum::{InvertedPendulumProblem, plan_inverted_pendulum};
pub use pendulum::{PendulumPath, PendulumState, PressureSegment};
pub use plan::{GaitPlan, JointGains, Knot};
pub use posture::{Posture, Sought};
pub use primitives::{Join, Primitive, PrimitivesProblem, plan_primitives};
pub(crate) use torque::{Bearing, Moment, torques};
pub use walker::{Foot, Height, Pose, Walker};
