//! Models of robots, as Python sees them.

use crate::arrays::Given;
use crate::failure::{Failure, Wrong};
use crate::formula::latex;
use crate::function::{RobotFunctions, call, function_name};
use crate::run::open_model;
use denavit::function::FunctionName;
use denavit::model::Robot;
use denavit::plants::RobotFunction;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

/// A robot: its model and its functions as numbers. `denavit.Model` adds what Python does better.
#[pyclass(subclass, frozen, module = "denavit._denavit")]
pub(crate) struct Model {
    robot: Robot,
    /// The text of the model file.
    source: String,
    notes: Vec<String>,
    effects: Option<PathBuf>,
    functions: RobotFunctions,
}

impl Model {
    /// Calls the one function of a name with its arguments.
    fn call<'py, const N: usize>(
        &self,
        py: Python<'py>,
        name: FunctionName,
        given: [(&'static str, &Bound<'py, PyAny>); N],
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call_function(py, self.functions.one(name)?, name, &given)
    }

    fn call_function<'py>(
        &self,
        py: Python<'py>,
        function: &RobotFunction,
        name: FunctionName,
        given: &[(&'static str, &Bound<'py, PyAny>)],
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut arguments = Vec::with_capacity(given.len());
        for wanted in function.arguments() {
            let Some((_, value)) = given.iter().find(|(name, _)| *name == wanted.name) else {
                let cause = format!("{name} of {} needs `{}`", self.robot.name, wanted.name);
                let hint = format!("evaluate(\"{name}\", ..) takes every argument by name");
                return Err(Failure::argument(Wrong::new(cause).hint(hint)).into());
            };
            arguments.push(Given::new(wanted.name, value)?);
        }
        call(py, function, name.as_str(), &arguments)
    }
}

#[pymethods]
impl Model {
    /// Reads a model: of a path or a shipped name, or of `text`, which is then that of the file
    /// `place`. `effects` is a folder of definitions.
    #[new]
    #[pyo3(signature = (place, text=None, effects=None))]
    fn new(
        py: Python<'_>,
        place: &str,
        text: Option<String>,
        effects: Option<PathBuf>,
    ) -> PyResult<Self> {
        let (robot, source, notes) = open_model(py, place, text, effects.clone())?;
        Ok(Self { source, notes, effects, functions: RobotFunctions::new(&robot), robot })
    }

    /// What was noted when the model was read.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// The folder of definitions of effects that was given.
    #[getter]
    fn _effects(&self) -> Option<&Path> {
        self.effects.as_deref()
    }

    /// A function as LaTeX, with the parameters of the model as symbols.
    #[pyo3(name = "_latex")]
    fn latex(&self, py: Python<'_>, name: &str) -> PyResult<String> {
        let name = function_name(name)?;
        py.detach(|| latex(&self.robot, name))
    }

    /// The name of the model.
    #[getter]
    fn name(&self) -> &str {
        &self.robot.name
    }

    /// What the robot is.
    #[getter]
    fn description(&self) -> &str {
        &self.robot.description
    }

    /// The text of the model file.
    #[getter]
    fn source(&self) -> &str {
        &self.source
    }

    /// Number of degrees of freedom n: entries of q, qd, qdd and tau.
    #[getter]
    fn dof(&self) -> usize {
        self.robot.degrees_of_freedom()
    }

    /// Names of the joints that move, in the order of q.
    #[getter]
    fn joints(&self) -> Vec<&str> {
        let links = &self.robot.links;
        self.robot.joints().map(|(link, _)| links[link].name.as_str()).collect()
    }

    /// Names of the links, in the order of the model file.
    #[getter]
    fn links(&self) -> Vec<&str> {
        self.robot.links.values().map(|link| link.name.as_str()).collect()
    }

    /// Names of the contact points, in the order of `contact_positions`.
    #[getter]
    fn contacts(&self) -> Vec<&str> {
        self.robot.contacts.values().map(|one| one.name.as_str()).collect()
    }

    /// Names of arguments and results of a function, each with its shape; results with a line on
    /// what their entries are.
    #[allow(clippy::type_complexity)] // a table
    #[pyo3(name = "_signature")]
    fn signature(
        &self,
        name: &str,
    ) -> PyResult<(Vec<(&'static str, usize)>, Vec<(&'static str, Vec<usize>, String)>)> {
        let function = self.functions.one(function_name(name)?)?;
        let arguments = function.arguments().iter().map(|one| (one.name, one.len)).collect();
        let outputs = function.outputs().iter();
        let outputs = outputs.map(|one| (one.name, one.shape.clone(), one.doc.clone())).collect();
        Ok((arguments, outputs))
    }

    /// Calls a function by name, with arguments by name.
    #[pyo3(name = "_evaluate", signature = (name, link, arguments))]
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        link: Option<&str>,
        arguments: Vec<(String, Bound<'py, PyAny>)>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let name = function_name(name)?;
        let function = match link {
            Some(link) => self.functions.of_link(name, link)?,
            None => self.functions.one(name)?,
        };
        let known = function.arguments();
        let mut given = Vec::with_capacity(arguments.len());
        for (argument, value) in &arguments {
            let Some(known) = known.iter().find(|one| one.name == argument) else {
                let names: Vec<&str> = known.iter().map(|one| one.name).collect();
                let cause = format!("{name} has no argument `{argument}`");
                let hint = format!("its arguments are {}", names.join(", "));
                return Err(Failure::argument(Wrong::new(cause).hint(hint)).into());
            };
            given.push((known.name, value));
        }
        self.call_function(py, function, name, &given)
    }

    /// tau = D(q) qdd + C(q, qd) qd + G(q) + drives: (n,) [N m, N].
    fn inverse_dynamics<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::InverseDynamics, [("q", q), ("qd", qd), ("qdd", qdd)])
    }

    /// D(q): (n, n), symmetric [kg m^2, kg m, kg].
    fn mass_matrix<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::MassMatrix, [("q", q)])
    }

    /// C(q, qd) of the Christoffel symbols: (n, n); dD/dt - 2 C is skew.
    fn coriolis_matrix<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::CoriolisMatrix, [("q", q), ("qd", qd)])
    }

    /// G(q): (n,) [N m, N].
    fn gravity_vector<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::GravityVector, [("q", q)])
    }

    /// C qd + G + drives, the torque at qdd = 0: (n,) [N m, N].
    fn bias<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::Bias, [("q", q), ("qd", qd)])
    }

    /// D (n, n), C (n, n) and G (n,) at once.
    #[pyo3(name = "_dynamics_terms")]
    fn dynamics_terms<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::DynamicsTerms, [("q", q), ("qd", qd)])
    }

    /// qdd of given torques: (n,) [rad/s^2, m/s^2].
    fn forward_dynamics<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::ForwardDynamics, [("q", q), ("qd", qd), ("tau", tau)])
    }

    /// D^-1 b: (n,).
    fn mass_matrix_solve<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        b: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::MassMatrixSolve, [("q", q), ("b", b)])
    }

    /// dtau/dq and dtau/dqd: (n, n) each, row: torque.
    #[pyo3(name = "_inverse_dynamics_derivatives")]
    fn inverse_dynamics_derivatives<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(
            py,
            FunctionName::InverseDynamicsDerivatives,
            [("q", q), ("qd", qd), ("qdd", qdd)],
        )
    }

    /// dqdd/dq, dqdd/dqd and dqdd/dtau: (n, n) each, row: acceleration.
    #[pyo3(name = "_forward_dynamics_derivatives")]
    fn forward_dynamics_derivatives<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(
            py,
            FunctionName::ForwardDynamicsDerivatives,
            [("q", q), ("qd", qd), ("tau", tau)],
        )
    }

    /// The upper three rows of the homogeneous transforms of all links: (links, 3, 4) [m].
    fn link_transforms<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::LinkTransforms, [("q", q)])
    }

    /// World positions of the contact points: (contacts, 3) [m].
    fn contact_positions<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::ContactPositions, [("q", q)])
    }

    /// W^T, the derivatives of the contact points by q: (3 contacts, n).
    fn contact_jacobian<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::ContactJacobian, [("q", q)])
    }

    /// (d/dt W^T) qd of the contact points [m/s^2].
    fn contact_bias<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::ContactBias, [("q", q), ("qd", qd)])
    }

    /// World position of the centre of mass: (3,) [m].
    fn center_of_mass<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::CenterOfMass, [("q", q)])
    }

    /// Derivatives of the centre of mass by q: (3, n).
    fn center_of_mass_jacobian<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::CenterOfMassJacobian, [("q", q)])
    }

    /// Linear momentum [kg m/s] and angular momentum about the centre of mass [kg m^2/s]: (3,)
    /// each.
    #[pyo3(name = "_momentum")]
    fn momentum<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::Momentum, [("q", q), ("qd", qd)])
    }

    /// Kinetic energy [J].
    fn kinetic_energy<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::KineticEnergy, [("q", q), ("qd", qd)])
    }

    /// Potential energy of gravity and springs [J].
    fn potential_energy<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::PotentialEnergy, [("q", q)])
    }

    /// (d/dt J) qd, J the Jacobian of the centre of mass: (3,) [m/s^2].
    fn center_of_mass_bias<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::CenterOfMassBias, [("q", q), ("qd", qd)])
    }

    /// A of momentum = A qd: (6, n), linear rows first.
    fn centroidal_momentum_matrix<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::CentroidalMomentumMatrix, [("q", q)])
    }

    /// (d/dt A) qd: (6,) [N, N m].
    fn centroidal_momentum_bias<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::CentroidalMomentumBias, [("q", q), ("qd", qd)])
    }

    /// Angular momentum of the body on each joint about the common centre of mass: (n, 3).
    fn angular_momenta<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::AngularMomenta, [("q", q), ("qd", qd)])
    }

    /// The zero-moment point: (3,) [m].
    fn zero_moment_point<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::ZeroMomentPoint, [("q", q), ("qd", qd), ("qdd", qdd)])
    }

    /// The zero-moment point of the cart-table model: (3,) [m].
    fn cart_table_zmp<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::CartTableZmp, [("q", q), ("qd", qd), ("qdd", qdd)])
    }

    /// The capture point of the linear inverted pendulum: (3,) [m].
    fn capture_point<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::CapturePoint, [("q", q), ("qd", qd)])
    }

    /// R0 of tau = R0 theta0 + known: (n, unknown parameters), and what is known if there is any.
    #[pyo3(name = "_regressor")]
    fn regressor<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::Regressor, [("q", q), ("qd", qd), ("qdd", qdd)])
    }

    /// R of tau = R theta + known: (n, base parameters), and what is known if there is any.
    #[pyo3(name = "_base_regressor")]
    fn base_regressor<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.call(py, FunctionName::BaseRegressor, [("q", q), ("qd", qd), ("qdd", qdd)])
    }

    /// Geometric Jacobian of the frame of a link: (6, n), linear rows first.
    fn link_jacobian<'py>(
        &self,
        py: Python<'py>,
        link: &str,
        q: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let name = FunctionName::LinkJacobian;
        self.call_function(py, self.functions.of_link(name, link)?, name, &[("q", q)])
    }

    /// The foot rotation indicator of a link that carries contact points: (3,) [m].
    fn foot_rotation_indicator<'py>(
        &self,
        py: Python<'py>,
        link: &str,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let name = FunctionName::FootRotationIndicator;
        self.call_function(
            py,
            self.functions.of_link(name, link)?,
            name,
            &[("q", q), ("qd", qd), ("qdd", qdd)],
        )
    }
}
