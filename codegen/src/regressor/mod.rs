//! The regressor zeta = R0 theta0, and the base parameters: the least that the motion depends on.
//!
//! - `matter`: torques per unit of each entry of each body's pseudo-inertia, by twist pull
//! - [`Regressor`]: the columns of a model: ten a link, or every monomial of its unknowns
//! - `dependence`: the exact relations among columns, for any tree, without elimination
//! - [`Ranking`]: rank and pivots modulo 2^61 - 1 at random points
//! - `eliminate`: Gauss-Jordan over the rational functions of the known parameters
//! - [`BaseParameters`]: which combinations of parameters the torques depend on
//! - [`Certificate`]: a proof of all that, and its verification by other means
//! - [`functions`]: the regressor functions for emission
//! - [`equations`]: given equations, not of a model (`denavit-equations/1`)
//! - [`decompose_robot`]: f and B of a model's regressor
//! - [`Theta`]: theta from B_E, the thesis's way
//! - `pull`: the equations for decomposition, of arms and of robots on a moving torso

pub mod base;
pub mod certificate;
mod column;
mod decompose;
mod dependence;
mod eliminate;
pub mod equations;
pub mod functions;
mod matter;
mod monomial;
mod pull;
mod rank;
mod settle;
mod theta;
mod turning;

pub use base::{BaseError, BaseParameter, BaseParameters, Dependent, base_parameters};
pub use certificate::{Certificate, Verdict};
pub use column::{Column, Regressor, RegressorError, RegressorOptions, Unknowns};
pub use decompose::{DecomposeError, RobotDecomposition, decompose_robot};
pub use pull::{
    Equation, MatterEntry, MatterRegressor, MotionTerms, TorsoMotion, fixed_base_regressor,
    torso_regressor,
};
pub use rank::{Ranking, rank};
pub use theta::Theta;
