//! What a derived function is: its name, its arguments, its outputs with their shapes.
//!
//! The stages that derive make these, the stages that lower, count and emit read them.

use crate::expr::ExprId;
use std::fmt;

/// The functions of a model, by the names used in JSON, flags and emitted code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FunctionName {
    /// tau = D(q) qdd + C(q, qd) qd + G(q) + drive torques.
    InverseDynamics,
    /// D(q).
    MassMatrix,
    /// C(q, qd), the Christoffel one: dD/dt - 2 C is skew.
    CoriolisMatrix,
    /// G(q).
    GravityVector,
    /// C qd + G + drive torques that do not depend on qdd.
    Bias,
    /// D, C and G at once.
    DynamicsTerms,
    /// qdd of given torques.
    ForwardDynamics,
    /// D^-1 b for a given right-hand side b.
    MassMatrixSolve,
    /// dtau/dq and dtau/dqd of inverse dynamics (dtau/dqdd is D).
    InverseDynamicsDerivatives,
    /// dqdd/dq, dqdd/dqd and dqdd/dtau of forward dynamics: A and B of the linearisation.
    ForwardDynamicsDerivatives,
    /// Homogeneous transforms of all link frames.
    LinkTransforms,
    /// Geometric Jacobian of one link's frame; one function for each link.
    LinkJacobian,
    /// World positions of the contact points.
    ContactPositions,
    /// W^T = dh/dq of the contact points.
    ContactJacobian,
    /// (d/dt W^T) qd.
    ContactBias,
    /// Derivatives of the contact points' velocities and accelerations, and of the torques W f.
    ContactDerivatives,
    /// (d/dt J) qd, J the Jacobian of the centre of mass.
    CenterOfMassBias,
    /// A of momentum = A qd: linear, then angular about the centre of mass.
    CentroidalMomentumMatrix,
    /// (d/dt A) qd.
    CentroidalMomentumBias,
    /// Angular momentum of the body on each joint about the centre of mass of all.
    AngularMomenta,
    /// The point of the ground plane about which gravity and inertia have no moment but along the
    /// plane's normal.
    ZeroMomentPoint,
    /// The same of all mass in the centre of mass, which keeps its height.
    CartTableZmp,
    /// The point of the ground plane where the ground would have to act to keep a foot still; one
    /// function for each link that carries contact points.
    FootRotationIndicator,
    /// The point of the ground plane above which the linear inverted pendulum comes to rest.
    CapturePoint,
    /// World position of the centre of mass of all that moves, without what is fixed to the base.
    CenterOfMass,
    /// d(centre of mass)/dq, of all that moves.
    CenterOfMassJacobian,
    /// Linear momentum, and angular momentum about the centre of mass of all that moves.
    Momentum,
    /// Kinetic energy.
    KineticEnergy,
    /// Potential energy.
    PotentialEnergy,
    /// Rates of the states of added effects.
    StateRates,
    /// R0 of zeta = R0 theta0: one column for each unknown parameter.
    Regressor,
    /// R of zeta = R theta: one column for each base parameter.
    BaseRegressor,
    /// theta, from the values of all parameters.
    BaseParameters,
}

impl FunctionName {
    /// Every function, in the order of listings.
    pub fn every() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().chain(Self::WALKING).chain(Self::REGRESSORS)
    }

    /// Every function of run-time use, in the order of listings.
    pub const ALL: [Self; 21] = [
        Self::InverseDynamics,
        Self::MassMatrix,
        Self::CoriolisMatrix,
        Self::GravityVector,
        Self::Bias,
        Self::DynamicsTerms,
        Self::ForwardDynamics,
        Self::MassMatrixSolve,
        Self::InverseDynamicsDerivatives,
        Self::ForwardDynamicsDerivatives,
        Self::LinkTransforms,
        Self::LinkJacobian,
        Self::ContactPositions,
        Self::ContactJacobian,
        Self::ContactBias,
        Self::CenterOfMass,
        Self::CenterOfMassJacobian,
        Self::Momentum,
        Self::KineticEnergy,
        Self::PotentialEnergy,
        Self::StateRates,
    ];

    /// The functions for walking, which are derived where they are asked for by name.
    pub const WALKING: [Self; 9] = [
        Self::ContactDerivatives,
        Self::CenterOfMassBias,
        Self::CentroidalMomentumMatrix,
        Self::CentroidalMomentumBias,
        Self::AngularMomenta,
        Self::ZeroMomentPoint,
        Self::CartTableZmp,
        Self::FootRotationIndicator,
        Self::CapturePoint,
    ];

    /// The functions for identification, which are derived where they are asked for by name.
    pub const REGRESSORS: [Self; 3] = [Self::Regressor, Self::BaseRegressor, Self::BaseParameters];

    /// The name in JSON, flags and emitted code.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::InverseDynamics => "inverse_dynamics",
            Self::MassMatrix => "mass_matrix",
            Self::CoriolisMatrix => "coriolis_matrix",
            Self::GravityVector => "gravity_vector",
            Self::Bias => "bias",
            Self::DynamicsTerms => "dynamics_terms",
            Self::ForwardDynamics => "forward_dynamics",
            Self::MassMatrixSolve => "mass_matrix_solve",
            Self::InverseDynamicsDerivatives => "inverse_dynamics_derivatives",
            Self::ForwardDynamicsDerivatives => "forward_dynamics_derivatives",
            Self::LinkTransforms => "link_transforms",
            Self::LinkJacobian => "link_jacobian",
            Self::ContactPositions => "contact_positions",
            Self::ContactJacobian => "contact_jacobian",
            Self::ContactBias => "contact_bias",
            Self::ContactDerivatives => "contact_derivatives",
            Self::CenterOfMassBias => "center_of_mass_bias",
            Self::CentroidalMomentumMatrix => "centroidal_momentum_matrix",
            Self::CentroidalMomentumBias => "centroidal_momentum_bias",
            Self::AngularMomenta => "angular_momenta",
            Self::ZeroMomentPoint => "zero_moment_point",
            Self::CartTableZmp => "cart_table_zmp",
            Self::FootRotationIndicator => "foot_rotation_indicator",
            Self::CapturePoint => "capture_point",
            Self::CenterOfMass => "center_of_mass",
            Self::CenterOfMassJacobian => "center_of_mass_jacobian",
            Self::Momentum => "momentum",
            Self::KineticEnergy => "kinetic_energy",
            Self::PotentialEnergy => "potential_energy",
            Self::StateRates => "state_rates",
            Self::Regressor => "regressor",
            Self::BaseRegressor => "base_regressor",
            Self::BaseParameters => "base_parameters",
        }
    }

    /// The function of a name.
    pub fn parse(name: &str) -> Option<Self> {
        let named = Self::WALKING.into_iter().chain(Self::REGRESSORS);
        Self::ALL.into_iter().chain(named).find(|function| function.as_str() == name)
    }
}

impl fmt::Display for FunctionName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// A model has none of the functions that were asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoFunction {
    /// The model.
    pub model: String,
    /// The functions that it does not have.
    pub asked: Vec<FunctionName>,
}

impl NoFunction {
    /// Why a model has none of these functions.
    fn hint(&self) -> String {
        use FunctionName::{CapturePoint, CartTableZmp, FootRotationIndicator, ZeroMomentPoint};
        let why = |name: &FunctionName| match name.as_str() {
            text if text.contains("contact") => "contacts are declared under \"contacts\"",
            text if text.starts_with("base_") => {
                "`denavit base` says why its base parameters are not found"
            }
            "state_rates" => "it has no effects with states",
            _ => match name {
                ZeroMomentPoint | CartTableZmp | FootRotationIndicator | CapturePoint => {
                    "points of the ground are those of robots with a floating base and contact \
                     points"
                }
                _ => {
                    "its mass matrix has no inverse (a joint moves no mass, or none of its own), \
                     or an effect depends on what would have to be found"
                }
            },
        };
        let mut reasons: Vec<&str> = self.asked.iter().map(why).collect();
        reasons.dedup();
        reasons.join("; ")
    }
}

impl fmt::Display for NoFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let asked: Vec<&str> = self.asked.iter().map(|name| name.as_str()).collect();
        let (model, asked) = (&self.model, asked.join(", "));
        write!(f, "{model}: the model has no {asked}\n  hint: {}", self.hint())
    }
}

impl std::error::Error for NoFunction {}

/// Which formulation of the portfolio a function was derived by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Form {
    /// Recursions in frames on the joint axes.
    Plain,
    /// Recursions whose frames keep the orientation of a group of parallel axes.
    Grouped,
    /// Closed form, for robots of few joints.
    Explicit,
}

/// An argument: a vector with one symbol for each joint variable, for each state of added effects
/// (`states`), for each coordinate of the forces on the contact points (`f`), or with the time
/// alone (`t`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Argument {
    /// `q`, `qd`, `qdd`, `tau`, `b`, `f`, `t` or `states`.
    pub name: &'static str,
    /// The symbols, in the order of the joints.
    pub symbols: Vec<ExprId>,
}

/// The name of the symbol of one coordinate (`x`, `y`, `z`) of the force on a contact. No name
/// of a model has a full stop.
pub fn force_name(contact: &str, coordinate: &str) -> String {
    format!("f.{contact}.{coordinate}")
}

/// An output: an array of expressions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    /// The name of the array, as `mass_matrix` or `contact_positions`.
    pub name: &'static str,
    /// Its dimensions, outermost first: `[]` is a scalar, `[n]` a vector, `[r, c]` a matrix.
    pub shape: Vec<usize>,
    /// The entries, last index fastest (row-major).
    pub entries: Vec<ExprId>,
    /// One line that says what the entries are: frame, rows, columns, unit.
    pub doc: String,
    /// What each entry is, where that takes a line of its own.
    pub details: Vec<String>,
}

/// A derived function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Function {
    /// Which function.
    pub name: FunctionName,
    /// Of which link, where there is one function for each link.
    pub link: Option<String>,
    /// The arguments, in the order of the call.
    pub arguments: Vec<Argument>,
    /// The outputs, in the order of the result.
    pub outputs: Vec<Output>,
    /// The formulation it was derived by.
    pub form: Form,
}

impl Function {
    /// The entries of all outputs, in order.
    pub fn entries(&self) -> Vec<ExprId> {
        self.outputs.iter().flat_map(|output| output.entries.iter().copied()).collect()
    }

    /// The name, with the link where there is one: `link_jacobian_foot`.
    pub fn full_name(&self) -> String {
        match &self.link {
            Some(link) => format!("{}_{link}", self.name),
            None => self.name.to_string(),
        }
    }
}
