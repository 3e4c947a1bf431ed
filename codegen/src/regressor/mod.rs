//! The regressor zeta = R0 theta0, and the base parameters: the least that the motion depends on.
//!
//! - `inertial`, `matter`: a body's ten numbers, and the torques per unit of each
//! - `pull`: the twists of the joints, carried outwards; `follow`: to axes and links, by any route
//! - `axis_frames`, `link_frames`: the torques per unit of matter there
//! - `axle`: what matter on a joint's axis spares of that
//! - [`Regressor`]: the columns of a model: ten a link, or every monomial of its unknowns
//! - `dependence`: the exact relations among columns, for any tree, without elimination
//! - `still`: points that never move; `coincidence`: relations of special geometries and terms
//! - [`Ranking`]: rank and pivots modulo 2^61 - 1 at random points
//! - `eliminate`: Gauss-Jordan over the rational functions of the known parameters
//! - [`BaseParameters`]: which combinations of parameters the torques depend on, as [`Part`]s
//! - [`joint_basis()`]: the same on the joint axes, as the emitted regressor has them
//! - [`Certificate`]: a proof of all that, and its verification by other means
//! - [`ProvenBase`], [`EquationsBase`]: base parameters with that proof, in one call
//! - [`functions`]: the regressor functions for emission
//! - [`equations`]: given equations, not of a model (`denavit-equations/1`)
//! - [`decompose_robot`]: f and B of a model's regressor
//! - [`Decomposed`]: the same of a model or of given equations, in one call
//! - [`Theta`]: theta from B_E, the thesis's way

mod about;
mod axis_frames;
mod axle;
pub mod base;
pub mod certificate;
mod coincidence;
mod column;
mod decompose;
mod decomposed;
mod dependence;
mod eliminate;
pub mod equations;
mod follow;
mod formula;
pub mod functions;
mod inertial;
mod inexact;
mod joint_basis;
mod link_frames;
mod matter;
mod monomial;
mod proven;
mod proven_equations;
mod pull;
mod rank;
mod settle;
mod still;
mod theta;
mod turning;

pub use about::ParameterGroup;
pub use base::{BaseError, BaseParameter, BaseParameters, Dependent, base_parameters};
pub use certificate::{Certificate, Verdict};
pub use column::{Column, Regressor, RegressorError, RegressorOptions, Unknowns};
pub use decompose::{DecomposeError, RobotDecomposition, decompose_robot};
pub use decomposed::{Decomposed, DecomposedError, DecomposedSubject};
pub use formula::{Part, signed};
pub use inexact::InexactEntry;
pub use joint_basis::{JointParameter, joint_basis};
pub use proven::{BaseOptions, ProvenBase, ProvenBaseError};
pub use proven_equations::EquationsBase;
pub use pull::{
    Equation, MatterRegressor, MotionTerms, TorsoMotion, fixed_base_regressor, torso_regressor,
};
pub use rank::{Ranking, rank};
pub use theta::Theta;
