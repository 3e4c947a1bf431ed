//! Impacts: all closed contacts at once, as one complementarity problem of impulses.
//!
//! Newton's law with momentum (thesis 2.51-2.53, the right side of whose last line should read
//! -e W^T qdot-): M (v+ - v-) = J^T P, and per contact
//!
//! > 0 <= P_n _|_ u_n+ + e min(u_n-, 0) >= 0,
//!
//! with no-slip or Coulomb friction between P_t and u_t+. A contact that the impact pulls off the
//! ground carries no impulse and opens; a rocking block rocks because of it.
//!
//! Newton's restitution together with friction can make energy. Where it would, all coefficients
//! are reduced by one factor until it does not; with e = 0 every solution loses energy.

use super::solver::{ContactSolver, Search};
use super::{Contact, ContactFailure, ContactProblem, ContactSolution, Space, Tolerance};

/// What collides.
#[derive(Clone, Copy, Debug)]
pub struct Impact<'a> {
    /// Planar or spatial.
    pub space: Space,
    /// The closed contacts; none of them `slipping`.
    pub contacts: &'a [Contact],
    /// e of each, 0 to 1.
    pub restitution: &'a [f64],
    /// G, row-major.
    pub delassus: &'a [f64],
    /// Velocities of the contact points before, contact-major [m/s].
    pub before: &'a [f64],
    /// What counts as zero.
    pub tolerance: Tolerance,
}

/// What an impact did, beside its impulses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactReport {
    /// Change of kinetic energy, never positive beyond rounding \[J\].
    pub energy_j: f64,
    /// The factor that was applied to all coefficients of restitution: 1 unless they would have
    /// made energy.
    pub restitution_factor: f64,
}

/// Solves impacts; memory that grows to the largest and stays.
#[derive(Clone, Debug, Default)]
pub struct ImpactSolver {
    solver: ContactSolver,
    free: Vec<f64>,
}

impl ImpactSolver {
    /// No memory yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Finds the impulses P and the velocities u+ after them (the solution's `force` and
    /// `response`). Fails with [`ContactFailure::NoSolution`] where no-slip laws allow none.
    pub fn solve(
        &mut self,
        impact: &Impact<'_>,
        search: Search,
        solution: &mut ContactSolution,
    ) -> Result<ImpactReport, ContactFailure> {
        let energy = self.attempt(impact, search, 1.0, solution)?;
        let allowed = 1e-12 * work_scale(impact, solution);
        if energy <= allowed {
            return Ok(ImpactReport { energy_j: energy, restitution_factor: 1.0 });
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            match self.attempt(impact, search, middle, solution) {
                Ok(energy) if energy <= allowed => low = middle,
                _ => high = middle,
            }
        }
        let energy = self.attempt(impact, search, low, solution)?;
        Ok(ImpactReport { energy_j: energy, restitution_factor: low })
    }

    /// Solves with the coefficients times `factor`; returns the change of energy.
    fn attempt(
        &mut self,
        impact: &Impact<'_>,
        search: Search,
        factor: f64,
        solution: &mut ContactSolution,
    ) -> Result<f64, ContactFailure> {
        let rows = impact.space.rows();
        assert_eq!(impact.restitution.len(), impact.contacts.len(), "a coefficient each");
        assert_eq!(impact.before.len(), impact.contacts.len() * rows, "rows of all contacts");
        let bounce = |index: usize| {
            let approach = impact.before[index * rows + rows - 1].min(0.0);
            factor * impact.restitution[index] * approach
        };
        self.free.clear();
        self.free.extend_from_slice(impact.before);
        for index in 0..impact.contacts.len() {
            self.free[index * rows + rows - 1] += bounce(index);
        }
        let problem = ContactProblem {
            space: impact.space,
            contacts: impact.contacts,
            delassus: impact.delassus,
            free: &self.free,
            tolerance: impact.tolerance,
        };
        self.solver.decide(&problem, search, solution)?;
        for index in 0..impact.contacts.len() {
            solution.response[index * rows + rows - 1] -= bounce(index);
        }
        // P . (u+ + u-) / 2
        let mean =
            solution.response.iter().zip(impact.before).map(|(after, before)| after + before);
        Ok(0.5 * solution.force.iter().zip(mean).map(|(p, u)| p * u).sum::<f64>())
    }
}

/// The size of the terms whose sum is the change of energy.
fn work_scale(impact: &Impact<'_>, solution: &ContactSolution) -> f64 {
    let speeds = solution.response.iter().zip(impact.before).map(|(a, b)| a.abs() + b.abs());
    solution.force.iter().zip(speeds).map(|(p, u)| p.abs() * u).sum()
}
