//! f and B of a model or of given equations, whichever it is, with theta where B is eliminated.

use super::column::RegressorOptions;
use super::decompose::{DecomposeError, RobotDecomposition, decompose_robot};
use super::equations::{EquationsError, EquationsRegressor, equations_regressor};
use super::theta::Theta;
use crate::fundamental::{Basis, Decomposition, Expansion, smallest};
use crate::model::Robot;
use crate::model::equations::Equations;
use std::fmt;

/// f and B, and theta once B is eliminated.
#[derive(Clone, Debug)]
pub struct Decomposed {
    /// What was decomposed.
    pub subject: DecomposedSubject,
    /// f and B.
    pub decomposition: Decomposition,
    /// theta, if B was eliminated.
    pub theta: Option<Theta>,
}

/// What was decomposed.
#[derive(Clone, Debug)]
pub enum DecomposedSubject {
    /// A model.
    Model(Box<Robot>, Box<RobotDecomposition>),
    /// Given equations.
    Equations(Box<Equations>, Box<EquationsRegressor>),
}

/// Why there are no f and B.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DecomposedError {
    /// A model is not decomposed.
    Model(DecomposeError),
    /// Equations have no regressor.
    Equations(EquationsError),
    /// There are no angles to cumulate; holds the name.
    NoParallelAxes(String),
}

impl fmt::Display for DecomposedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Model(error) => write!(f, "{error}"),
            Self::Equations(error) => write!(f, "{error}"),
            Self::NoParallelAxes(name) => write!(
                f,
                "{name}: there are no parallel axes whose angles could be cumulated\n  hint: \
                 choose the basis fourier or product"
            ),
        }
    }
}

impl std::error::Error for DecomposedError {}

impl Decomposed {
    /// Of a model; in the basis that makes the fewest functions if none is named.
    pub fn of_model(
        robot: Robot,
        options: RegressorOptions,
        basis: Option<Basis>,
        expansion: &mut Expansion<'_>,
    ) -> Result<Self, DecomposedError> {
        let bases = basis.map_or(Basis::ALL.to_vec(), |basis| vec![basis]);
        let mut found =
            decompose_robot(&robot, options, &bases, expansion).map_err(DecomposedError::Model)?;
        let decomposition = smallest(std::mem::take(&mut found.decompositions))
            .ok_or_else(|| DecomposedError::NoParallelAxes(robot.name.clone()))?;
        let subject = DecomposedSubject::Model(Box::new(robot), Box::new(found));
        Ok(Self { subject, decomposition, theta: None })
    }

    /// Of equations, likewise.
    pub fn of_equations(
        equations: Equations,
        basis: Option<Basis>,
        expansion: &mut Expansion<'_>,
    ) -> Result<Self, DecomposedError> {
        let bases = match basis {
            Some(Basis::Cumulated) => {
                return Err(DecomposedError::NoParallelAxes(equations.name));
            }
            Some(basis) => vec![basis],
            None => vec![Basis::Fourier, Basis::Product],
        };
        let mut least: Option<EquationsRegressor> = None;
        for basis in bases {
            let found = equations_regressor(&equations, basis, expansion)
                .map_err(DecomposedError::Equations)?;
            let functions = found.decomposition.functions.len();
            if least.as_ref().is_none_or(|known| functions < known.decomposition.functions.len()) {
                least = Some(found);
            }
        }
        let found = least.expect("there is a basis");
        let decomposition = found.decomposition.clone();
        let subject = DecomposedSubject::Equations(Box::new(equations), Box::new(found));
        Ok(Self { subject, decomposition, theta: None })
    }

    /// Eliminates B, the columns of `keep` being kept before others.
    pub fn eliminate(&mut self, keep: &[String]) -> Result<(), DecomposedError> {
        self.theta = Some(match &mut self.subject {
            DecomposedSubject::Model(_, found) => {
                found.theta(&self.decomposition, keep).map_err(DecomposedError::Model)?
            }
            DecomposedSubject::Equations(_, found) => {
                found.theta(keep).map_err(DecomposedError::Equations)?
            }
        });
        Ok(())
    }

    /// The name of the model or of the equations.
    pub fn name(&self) -> &str {
        match &self.subject {
            DecomposedSubject::Model(robot, _) => &robot.name,
            DecomposedSubject::Equations(equations, _) => &equations.name,
        }
    }
}
