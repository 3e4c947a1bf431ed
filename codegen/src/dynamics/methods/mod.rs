//! The thesis's four derivations of the equations of motion (section 2.2, appendix A), straight
//! from a robot's table, bodies and drives.
//!
//! They share nothing with the recursions in joint frames, and as little as is sensible with each
//! other, so that agreement says something:
//!
//! - [`newton_euler`]: bodies, constraint wrenches, constraints at acceleration level (2.3, 2.5)
//! - [`lagrange`]: energies and their derivatives (2.6-2.11)
//! - [`tmt`]: a transformation to independent coordinates (2.12-2.17), here in three dimensions
//! - [`dh_lagrange`]: homogeneous transforms, Jacobians of chains, Christoffel (2.18-2.43)
//!
//! Everything is in world coordinates (frame 0), SI units, one row for each moving joint.

pub mod dh_lagrange;
mod extract;
mod frames;
mod joint_terms;
pub mod lagrange;
mod linear;
pub mod newton_euler;
#[cfg(test)]
mod tests;
pub mod tmt;

use crate::expr::{Dag, ExprId};
use crate::model::Robot;
use std::fmt;

/// A derivation of the thesis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// Newton-Euler with explicit joint constraints (2.2.1).
    NewtonEuler,
    /// Lagrange-Euler from energies (2.2.2).
    Lagrange,
    /// TMT with the geometric Jacobian (2.2.3, 5.2.1).
    Tmt,
    /// Lagrange-Euler on Denavit-Hartenberg frames (2.2.4).
    DhLagrange,
}

impl Method {
    /// Every method, in the order of the thesis.
    pub const ALL: [Self; 4] = [Self::NewtonEuler, Self::Lagrange, Self::Tmt, Self::DhLagrange];

    /// The name in flags and JSON.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::NewtonEuler => "newton-euler",
            Self::Lagrange => "lagrange",
            Self::Tmt => "tmt",
            Self::DhLagrange => "dh-lagrange",
        }
    }

    /// The method of a name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.as_str() == name)
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// The equations of motion `tau = D qdd + C qd + G + drive torques`, as one method found them.
///
/// A term that the model does not have ([`Terms`](crate::model::Terms)) is zero. The motor side of
/// a series elastic joint does not enter: its spring separates it from the link (thesis 3.25).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MethodResult {
    /// How it was derived.
    pub method: Method,
    /// D, by rows, with the reflected rotor inertia on its diagonal [kg m^2, kg m, kg].
    pub mass_matrix: Vec<Vec<ExprId>>,
    /// C, by rows: the Christoffel matrix, for which dD/dt - 2 C is skew.
    pub coriolis_matrix: Vec<Vec<ExprId>>,
    /// G, the gradient of the potential of gravity [N m, N].
    pub gravity: Vec<ExprId>,
    /// Torque that friction, damping, springs and a drive's offset ask for [N m, N].
    pub drive_torque: Vec<ExprId>,
    /// tau [N m, N]: all of the above in one, as the method itself arrives at it.
    pub inverse_dynamics: Vec<ExprId>,
}

/// Derives the equations of motion of `robot`. The expressions go to `dag`, which must know the
/// robot's symbols (a copy of `robot.dag`).
pub fn derive(dag: &mut Dag, robot: &Robot, method: Method) -> MethodResult {
    match method {
        Method::NewtonEuler => newton_euler::derive(dag, robot),
        Method::Lagrange => lagrange::derive(dag, robot),
        Method::Tmt => tmt::derive(dag, robot),
        Method::DhLagrange => dh_lagrange::derive(dag, robot),
    }
}
