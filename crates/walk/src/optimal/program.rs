//! What a nonlinear program is: a cost, constraints within ranges, bounds, and their derivatives.

use super::sparse::Triplets;

/// minimise f(x) subject to l <= c(x) <= u and bounds of x.
pub trait Program {
    /// The size of a change of each variable that linearisations are trusted for.
    fn scales(&self) -> &[f64];

    /// Lowest and highest value of each variable; steps stay within.
    fn bounds(&self) -> &[[f64; 2]];

    /// Lowest and highest value of each constraint, equal for an equation; constraints should be
    /// without dimension and of the order of 1.
    fn ranges(&self) -> &[[f64; 2]];

    /// Cost and constraints at a point.
    fn evaluate(&mut self, x: &[f64], constraints: &mut Vec<f64>) -> f64;

    /// Derivatives at a point; the Hessian is that of the Lagrangian with these multipliers of the
    /// constraints, or a positive semidefinite approximation.
    fn linearise(&mut self, x: &[f64], multipliers: &[f64], linear: &mut Linearisation);
}

/// Derivatives of a program at a point.
#[derive(Clone, Debug, Default)]
pub struct Linearisation {
    /// Of the cost.
    pub gradient: Vec<f64>,
    /// Of the constraints.
    pub jacobian: Triplets,
    /// Upper triangle of a positive semidefinite matrix.
    pub hessian: Triplets,
}

impl Linearisation {
    /// Forgets everything, for a program of so many variables.
    pub fn clear(&mut self, variables: usize) {
        self.gradient.clear();
        self.gradient.resize(variables, 0.0);
        self.jacobian.entries.clear();
        self.hessian.entries.clear();
    }
}

/// By how much a value is outside its range.
pub(super) fn violation(value: f64, [low, high]: [f64; 2]) -> f64 {
    (low - value).max(value - high).max(0.0)
}
