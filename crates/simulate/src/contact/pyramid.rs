//! Coulomb friction with a pyramid instead of the cone: one linear complementarity problem.
//!
//! Stewart and Trinkle's form: tangential forces D beta with beta >= 0 along evenly spaced unit
//! directions, and per contact
//!
//! > 0 <= f_n  _|_ w_n >= 0,
//! > 0 <= beta _|_ D^T w_t + lambda >= 0,
//! > 0 <= lambda _|_ mu f_n - sum beta >= 0.
//!
//! Exact in a plane, where the directions are both; in space the pyramid lies within the cone. A
//! contact that slips already in a known direction has its friction in the column of f_n.

use super::lemke::{LcpReport, Lemke};
use super::{ContactProblem, Space};
use denavit_runtime::Scalar;

/// The problem's memory; grows to the largest problem and stays.
#[derive(Clone, Debug, Default)]
pub struct Pyramid {
    variables: Vec<Variable>,
    matrix: Vec<f64>,
    right: Vec<f64>,
    lemke: Lemke,
}

#[derive(Clone, Copy, Debug)]
enum Variable {
    /// f_n; with the tangential force that follows from it.
    Normal { contact: usize, friction: [f64; 2] },
    /// A component of beta and its direction.
    Edge { contact: usize, direction: [f64; 2] },
    /// lambda, the speed of slipping, and mu.
    Speed { contact: usize, mu: f64 },
}

impl Pyramid {
    /// No memory yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Solves with `facets` directions per contact in space (an even number, at least 4); writes
    /// the forces if solved. Contacts that never slip have no finite pyramid: the caller gives
    /// Coulomb contacts only.
    pub fn solve(
        &mut self,
        problem: &ContactProblem<'_>,
        facets: usize,
        force: &mut [f64],
    ) -> LcpReport {
        self.list_variables(problem, facets);
        let size = self.variables.len();
        self.matrix.clear();
        self.right.clear();
        for condition in &self.variables {
            for variable in &self.variables {
                self.matrix.push(entry(problem, condition, variable));
            }
            self.right.push(match condition {
                Variable::Normal { contact, .. } => problem.free[problem.normal(*contact)],
                Variable::Edge { contact, direction } => {
                    let first = problem.block(*contact).start;
                    tangential(problem, direction, |axis| problem.free[first + axis])
                }
                Variable::Speed { .. } => 0.0,
            });
        }
        let report = self.lemke.solve(&self.matrix, &self.right, 100 * (size + 1));
        force.fill(0.0);
        for (variable, value) in self.variables.iter().zip(self.lemke.solution()) {
            let (contact, direction) = match variable {
                Variable::Normal { contact, friction } => {
                    force[problem.normal(*contact)] = *value;
                    (*contact, friction)
                }
                Variable::Edge { contact, direction } => (*contact, direction),
                Variable::Speed { .. } => continue,
            };
            let first = problem.block(contact).start;
            for axis in 0..problem.space.tangents() {
                force[first + axis] += direction[axis] * value;
            }
        }
        report
    }

    fn list_variables(&mut self, problem: &ContactProblem<'_>, facets: usize) {
        self.variables.clear();
        for (index, contact) in problem.contacts.iter().enumerate().filter(|(_, c)| !c.released) {
            let mu = contact.coefficient().unwrap_or(0.0);
            let friction =
                contact.slipping.map_or([0.0; 2], |direction| direction.map(|d| -mu * d));
            self.variables.push(Variable::Normal { contact: index, friction });
            if contact.has_slip_law() {
                continue;
            }
            let count = if problem.space == Space::Planar { 2 } else { facets };
            for edge in 0..count {
                let angle = std::f64::consts::TAU * edge as f64 / count as f64;
                let (sine, cosine) = angle.sincos();
                let direction = match problem.space {
                    Space::Planar => [1.0 - 2.0 * edge as f64, 0.0],
                    Space::Spatial => [cosine, sine],
                };
                self.variables.push(Variable::Edge { contact: index, direction });
            }
            self.variables.push(Variable::Speed { contact: index, mu });
        }
    }
}

/// The sum of direction and entries over the tangential axes.
fn tangential(problem: &ContactProblem<'_>, d: &[f64; 2], entry: impl Fn(usize) -> f64) -> f64 {
    (0..problem.space.tangents()).map(|axis| d[axis] * entry(axis)).sum()
}

/// What the variable does to row `row` of w.
fn response(problem: &ContactProblem<'_>, row: usize, variable: &Variable) -> f64 {
    let line = &problem.delassus[row * problem.rows()..(row + 1) * problem.rows()];
    let (contact, direction, normal) = match variable {
        Variable::Normal { contact, friction } => (*contact, friction, true),
        Variable::Edge { contact, direction } => (*contact, direction, false),
        Variable::Speed { .. } => return 0.0,
    };
    let first = problem.block(contact).start;
    let along = tangential(problem, direction, |axis| line[first + axis]);
    along + if normal { line[problem.normal(contact)] } else { 0.0 }
}

/// One entry of the problem's matrix.
fn entry(problem: &ContactProblem<'_>, condition: &Variable, variable: &Variable) -> f64 {
    match (condition, variable) {
        (Variable::Normal { contact, .. }, _) => {
            response(problem, problem.normal(*contact), variable)
        }
        (Variable::Edge { contact, .. }, Variable::Speed { contact: other, .. }) => {
            f64::from(contact == other)
        }
        (Variable::Edge { contact, direction }, _) => {
            let first = problem.block(*contact).start;
            tangential(problem, direction, |axis| response(problem, first + axis, variable))
        }
        (Variable::Speed { contact, mu }, Variable::Normal { contact: other, .. }) => {
            if contact == other { *mu } else { 0.0 }
        }
        (Variable::Speed { contact, .. }, Variable::Edge { contact: other, .. }) => {
            -f64::from(contact == other)
        }
        (Variable::Speed { .. }, Variable::Speed { .. }) => 0.0,
    }
}
