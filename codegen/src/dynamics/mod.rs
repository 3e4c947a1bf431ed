//! Equations of motion by recursion over the bodies.
//!
//! Every recursion runs in the [`Frames`](crate::kinematics::Frames) it is given, so that the plain
//! and the grouped formulation are the same code. Inertia is the pseudo-inertia throughout.
//!
//! - `motion`: velocities and accelerations, base to tip
//! - `inverse`: inverse dynamics, bias, gravity (recursive Newton-Euler in pseudo-inertia form)
//! - `composite`: composite inertias; D and G from them
//! - `coriolis`: C (Christoffel) and the derivatives of inverse dynamics from composites
//! - `contact_derivatives`: of the contact points' velocities, accelerations and torques
//! - `forward`: forward dynamics by factorising D, and by articulated bodies
//! - `explicit`: closed forms of small robots
//! - `energy`: kinetic and potential energy, momentum
//! - [`portfolio`]: every function of a model, the cheapest formulation of each
//! - [`methods`]: the thesis's four derivations, which share nothing with the recursions

mod articulated;
mod candidate;
mod composite;
mod contact_derivatives;
mod coriolis;
mod energy;
mod explicit;
mod forward;
mod inverse;
mod joint_torque;
pub mod methods;
mod motion;
mod outputs;
pub mod portfolio;

pub(crate) use explicit::explicit;
pub use joint_torque::implicit_effects;
pub(crate) use joint_torque::spring_torque;
