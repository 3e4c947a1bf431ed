//! R0_ij = f^T b_ij of a robot, in the columns of its regressor; a floating base in torso
//! coordinates.

use super::column::{Column, Feature, Regressor, RegressorError, RegressorOptions, row_scales};
use super::pull::{
    Equation, MatterRegressor, MotionTerms, TorsoMotion, fixed_base_regressor, torso_regressor,
};
use super::theta::{Theta, column_symbol, order_of};
use crate::arena::Handle;
use crate::dynamics::spring_torque;
use crate::expr::{ClassSet, Dag, ExprId, Symbol, SymbolId};
use crate::fundamental::{
    Basis, Decomposition, EchelonError, Expansion, FourierError, Matrix, decompose,
};
use crate::kinematics::{Frames, parallel_groups};
use crate::model::{Base, Robot};
use std::fmt;

/// Why a model is not decomposed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DecomposeError {
    /// There is no regressor.
    Regressor(RegressorError),
    /// A floating base without the terms of inertia; holds the model.
    TorsoTerms(String),
    /// It is not written out; holds the model and the cause.
    Fourier(String, FourierError),
    /// A column to keep that there is not; holds the model and what was asked for.
    NoColumn(String, String),
    /// B is not eliminated; holds the model and the cause.
    Echelon(String, EchelonError),
}

impl fmt::Display for DecomposeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Regressor(error) => write!(f, "{error}"),
            Self::TorsoTerms(model) => write!(
                f,
                "{model}: a floating base is written in the motion of its torso, which takes the \
                 terms of inertia\n  hint: `robot.terms=inertia,gravity` has the relations of \
                 all terms"
            ),
            Self::Fourier(model, error) => write!(f, "{model}: {error}"),
            Self::NoColumn(model, name) => write!(
                f,
                "{model}: there is no parameter {name} to keep\n  hint: \
                 `denavit decompose {model} --json` lists the columns"
            ),
            Self::Echelon(model, error) => write!(f, "{model}: {error}"),
        }
    }
}

impl std::error::Error for DecomposeError {}

/// f and B of a robot.
#[derive(Clone, Debug)]
pub struct RobotDecomposition {
    /// The model's name.
    pub model: String,
    /// Holds all expressions.
    pub dag: Dag,
    /// The columns: those of [`Regressor`], in its order.
    pub columns: Vec<Column>,
    /// What each equation balances.
    pub equations: Vec<String>,
    /// zeta: the torque of each joint less what is known; of the equations of a torso, on which
    /// nothing acts, what is known with the opposite sign.
    pub left: Vec<ExprId>,
    /// R0, by equations.
    pub rows: Vec<Vec<ExprId>>,
    /// f and B, in each of the bases that the robot has.
    pub decompositions: Vec<Decomposition>,
}

/// Decomposes the regressor of `robot` with the terms of the motion that it has. A drive's rows
/// are on the side that the model says.
pub fn decompose_robot(
    robot: &Robot,
    options: RegressorOptions,
    bases: &[Basis],
    expansion: &mut Expansion<'_>,
) -> Result<RobotDecomposition, DecomposeError> {
    if robot.base != Base::Fixed && !robot.terms.inertia {
        return Err(DecomposeError::TorsoTerms(robot.name.clone()));
    }
    let regressor =
        Regressor::new(robot, options, robot.torque_side).map_err(DecomposeError::Regressor)?;
    let Regressor { model, mut dag, columns, mechanism, known_features, .. } = regressor;
    let frames = Frames::plain(&mut dag, &mechanism);
    let terms = MotionTerms {
        rates: robot.terms.coriolis,
        accelerations: robot.terms.inertia,
        gravity: robot.terms.gravity,
    };
    let matter = match robot.base {
        Base::Fixed => fixed_base_regressor(&mut dag, &frames, terms),
        Base::Floating => torso_regressor(&mut dag, &frames, 5, TorsoMotion::Spatial, terms),
        Base::PlanarFloating => torso_regressor(&mut dag, &frames, 2, TorsoMotion::Planar, terms),
    };
    let mut balance = Balance { robot, scales: Vec::new(), matter };
    balance.scales = row_scales(&mut dag, robot, robot.torque_side);
    let count = balance.matter.equations.len();
    let mut rows = vec![Vec::new(); count];
    for column in &columns {
        for (row, entry) in rows.iter_mut().zip(balance.column(&mut dag, &column.definition)) {
            row.push(entry);
        }
    }
    let known = balance.column(&mut dag, &known_features);
    let mut left = Vec::new();
    for (&equation, known) in balance.matter.equations.iter().zip(known) {
        let acting = match equation {
            Equation::Joint(joint) => balance.acting(&mut dag, joint),
            _ => dag.zero(),
        };
        left.push(dag.sub(acting, known));
    }
    let equations = balance.names();
    let chains: Vec<Vec<ExprId>> = parallel_groups(&mechanism)
        .into_iter()
        .map(|group| group.into_iter().map(|i| mechanism.bodies[i].variables.q).collect())
        .collect();
    let run_time = |symbol: &Symbol| ClassSet::of(symbol.class).is_run_time();
    let known: Vec<bool> = dag.symbols().values().map(|symbol| !run_time(symbol)).collect();
    let is_known = |id: SymbolId| known[id.index()];
    let matrix = Matrix { rows: &rows, is_known: &is_known, chains: &chains };
    let decompositions = decompose(&mut dag, &matrix, bases, expansion)
        .map_err(|error| DecomposeError::Fourier(model.clone(), error))?;
    Ok(RobotDecomposition { model, dag, columns, equations, left, rows, decompositions })
}

impl RobotDecomposition {
    /// theta0: the parameter of each column, by its name.
    pub fn parameters(&mut self) -> Vec<ExprId> {
        self.columns.iter().map(|column| column_symbol(&mut self.dag, column)).collect()
    }

    /// theta = B_Eu theta0 by elimination of B (thesis 3.3-3.5), in the names of the columns, of
    /// which those of `keep` are kept before others.
    pub fn theta(
        &mut self,
        decomposition: &Decomposition,
        keep: &[String],
    ) -> Result<Theta, DecomposeError> {
        let find = |name: &String| self.columns.iter().position(|column| column.name == *name);
        let order = order_of(keep, self.columns.len(), find)
            .map_err(|name| DecomposeError::NoColumn(self.model.clone(), name))?;
        let parameters = self.parameters();
        Theta::new(&mut self.dag, decomposition, &order, parameters)
            .map_err(|error| DecomposeError::Echelon(self.model.clone(), error))
    }
}

/// The equations that a column has entries in.
struct Balance<'a> {
    robot: &'a Robot,
    /// What the row of each joint is multiplied with.
    scales: Vec<ExprId>,
    matter: MatterRegressor,
}

impl Balance<'_> {
    /// The torque of a joint less that of its springs, which is known.
    fn acting(&self, dag: &mut Dag, joint: usize) -> ExprId {
        let (link, variables) = self.robot.joints().nth(joint).expect("the joint is there");
        let tau = variables.tau;
        let (spring, _) = spring_torque(dag, self.robot, link);
        let spring = dag.mul(self.scales[joint], spring);
        dag.sub(tau, spring)
    }

    /// The entries of a combination of features, equation by equation.
    fn column(&self, dag: &mut Dag, definition: &[(Feature, ExprId)]) -> Vec<ExprId> {
        let mut entries = vec![dag.zero(); self.matter.equations.len()];
        for &(feature, factor) in definition {
            for (row, entry) in entries.iter_mut().enumerate() {
                let value = match (feature, self.matter.equations[row]) {
                    (Feature::Matter { body, entry }, _) => self.matter.rows[row][body][entry],
                    (Feature::Joint { joint, function }, Equation::Joint(own)) if own == joint => {
                        function.of(dag, self.robot, joint)
                    }
                    (Feature::Joint { .. }, _) => continue,
                };
                let product = dag.mul(factor, value);
                *entry = dag.add(*entry, product);
            }
        }
        for (entry, &equation) in entries.iter_mut().zip(&self.matter.equations) {
            if let Equation::Joint(joint) = equation {
                *entry = dag.mul(self.scales[joint], *entry);
            }
        }
        entries
    }

    fn names(&self) -> Vec<String> {
        let joints: Vec<&str> =
            self.robot.joints().map(|(link, _)| self.robot.links[link].name.as_str()).collect();
        let name = |equation: &Equation| match *equation {
            Equation::TorsoMoment(axis) => format!("torso moment {}", ["x", "y", "z"][axis]),
            Equation::TorsoForce(axis) => format!("torso force {}", ["x", "y", "z"][axis]),
            Equation::Joint(joint) => joints[joint].to_owned(),
        };
        self.matter.equations.iter().map(name).collect()
    }
}
