//! The base parameters of given equations, compared with the equations, in one call.

use super::equations::{EquationsError, EquationsRegressor, equations_regressor};
use super::theta::Theta;
use crate::fundamental::{Basis, Expansion};
use crate::model::equations::Equations;

/// The base parameters of given equations.
#[derive(Clone, Debug)]
pub struct EquationsBase {
    /// Their regressor.
    pub regressor: EquationsRegressor,
    /// What elimination of B leaves.
    pub theta: Theta,
    /// Whether they are the equations at random points modulo a prime.
    pub verified: bool,
}

impl EquationsBase {
    /// Eliminates B of the equations, the columns of `keep` being kept before others, and compares
    /// what comes out with the equations.
    pub fn find(
        equations: &Equations,
        keep: &[String],
        expansion: &mut Expansion<'_>,
    ) -> Result<Self, EquationsError> {
        let mut regressor = equations_regressor(equations, Basis::Product, expansion)?;
        let theta = regressor.theta(keep)?;
        let verified = regressor.holds(&theta)?;
        Ok(Self { regressor, theta, verified })
    }
}
