//! Forces for given modes, and how far they are from violating a law.
//!
//! Unknown are all components of a contact that sticks and the normal force of one that slips; the
//! conditions are w = 0 in the rows of the first and w_n = 0 for the second. Redundant contacts
//! leave forces undetermined: among those that obey the inequalities f_n >= 0 and |f_t| <= mu f_n
//! the least ones are taken, min |f|^2, a complementarity problem in as many unknowns as there are
//! inequalities. A flat foot is so judged by whether *some* distribution of forces exists, never by
//! the signs of an arbitrary one. Friction cones in space enter as tangent planes, added where the
//! last distribution leaves the cone.

use super::lemke::{LcpOutcome, Lemke};
use super::minimum_norm::MinimumNorm;
use super::{ContactFailure, ContactProblem, Friction, Mode, length};

/// Pivots below this, relative to the largest, are redundancies of contacts.
const RANK: f64 = 1e-10;
/// Rounds of tangent planes: each at least halves the angle by which a cone is left.
const ROUNDS: usize = 40;

/// Memory of the solution for given modes; grows to the largest problem and stays.
#[derive(Clone, Debug, Default)]
pub struct ModeSolver {
    unknowns: Vec<Unknown>,
    matrix: Vec<f64>,
    right: Vec<f64>,
    values: Vec<f64>,
    system: MinimumNorm,
    planes: Vec<Plane>,
    /// The planes' values at the forces of least norm.
    slack: Vec<f64>,
    /// Row-major: how each plane changes along each null vector.
    slope: Vec<f64>,
    /// Forces of least norm, to which `slack` belongs.
    least: Vec<f64>,
    lcp: Vec<f64>,
    lcp_right: Vec<f64>,
    lemke: Lemke,
}

/// One unknown force component and the condition w = 0 of its row.
#[derive(Clone, Copy, Debug)]
struct Unknown {
    row: usize,
    /// Tangential rows, just before the row, whose forces follow this one: none if it sticks.
    tangents: usize,
    /// Those tangential forces per normal force.
    friction: [f64; 2],
}

/// The inequality friction . x_t + normal * x_n >= 0 for the unknowns of one contact.
#[derive(Clone, Copy, Debug)]
struct Plane {
    /// The unknown x_n.
    at: usize,
    normal: f64,
    /// For the unknowns just before x_n.
    friction: [f64; 2],
    tangents: usize,
}

impl ModeSolver {
    /// No memory yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Forces that keep every contact in its mode, written into `force`.
    ///
    /// Undetermined forces are the least that obey the inequalities, or the least of all where no
    /// forces obey them. Returns the number of undetermined directions; fails where no force
    /// whatever keeps the modes.
    pub fn forces(
        &mut self,
        problem: &ContactProblem<'_>,
        modes: &[Mode],
        force: &mut [f64],
    ) -> Result<usize, ContactFailure> {
        self.solve(problem, modes)?;
        let redundancy = self.system.nullity();
        if redundancy > 0 {
            self.with_planes(problem, modes, Self::least_admissible);
        }
        self.expand(force);
        Ok(redundancy)
    }

    /// The largest t such that forces exist that keep the modes, with f_n >= t for every closed
    /// contact and mu f_n - |f_t| >= t for every one that sticks \[N\].
    ///
    /// Continuous in time while the modes stay and the forces are determined; the first sign
    /// change from positive to negative is when a contact has to open or to slip. Infinite if no
    /// contact is closed, or if contacts press against each other without bound.
    pub fn margin(
        &mut self,
        problem: &ContactProblem<'_>,
        modes: &[Mode],
    ) -> Result<f64, ContactFailure> {
        self.solve(problem, modes)?;
        let mut margin = f64::INFINITY;
        self.with_planes(problem, modes, |solver| {
            margin = solver.largest_slack();
            margin.is_finite().then_some(margin)
        });
        Ok(margin)
    }

    /// The forces of least norm, whatever their signs.
    fn solve(
        &mut self,
        problem: &ContactProblem<'_>,
        modes: &[Mode],
    ) -> Result<(), ContactFailure> {
        self.list_unknowns(problem, modes);
        let (rows, size) = (problem.rows(), self.unknowns.len());
        self.matrix.clear();
        self.right.clear();
        for condition in &self.unknowns {
            let line = &problem.delassus[condition.row * rows..(condition.row + 1) * rows];
            self.matrix.extend(self.unknowns.iter().map(|unknown| unknown.column(line)));
            self.right.push(-problem.free[condition.row]);
        }
        self.system.factor(&self.matrix, size, RANK);
        self.values.clear();
        self.values.resize(size, 0.0);
        let missed = self.system.solve(&self.right, &mut self.values);
        // Constraints that are met only up to a drift contradict each other a little.
        let allowed = 1e3 * problem.response_zero();
        if missed > allowed { Err(ContactFailure::Inconsistent) } else { Ok(()) }
    }

    fn list_unknowns(&mut self, problem: &ContactProblem<'_>, modes: &[Mode]) {
        assert_eq!(modes.len(), problem.contacts.len(), "a mode for every contact");
        self.unknowns.clear();
        for (index, (mode, contact)) in modes.iter().zip(problem.contacts).enumerate() {
            match mode {
                Mode::Open => {}
                Mode::Stick => self.unknowns.extend(problem.block(index).map(|row| Unknown {
                    row,
                    tangents: 0,
                    friction: [0.0; 2],
                })),
                Mode::Slip(direction) => {
                    let mu = contact.coefficient().unwrap_or(0.0);
                    self.unknowns.push(Unknown {
                        row: problem.normal(index),
                        tangents: problem.space.tangents(),
                        friction: direction.map(|entry| -mu * entry),
                    });
                }
            }
        }
    }

    fn expand(&self, force: &mut [f64]) {
        force.fill(0.0);
        for (unknown, value) in self.unknowns.iter().zip(&self.values) {
            force[unknown.row] = *value;
            for axis in 0..unknown.tangents {
                force[unknown.row - unknown.tangents + axis] = unknown.friction[axis] * value;
            }
        }
    }

    /// Calls `distribute`, which moves `values` within the null space and returns the value that it
    /// gave all planes at least, until no cone is left further; or until it says that it cannot.
    fn with_planes(
        &mut self,
        problem: &ContactProblem<'_>,
        modes: &[Mode],
        mut distribute: impl FnMut(&mut Self) -> Option<f64>,
    ) {
        self.least.clear();
        self.least.extend_from_slice(&self.values);
        self.list_planes(problem, modes);
        for _ in 0..ROUNDS {
            self.measure_planes();
            match distribute(self) {
                Some(threshold) if self.cut(problem, modes, threshold) => {}
                _ => return,
            }
        }
    }

    fn list_planes(&mut self, problem: &ContactProblem<'_>, modes: &[Mode]) {
        self.planes.clear();
        let mut at = 0;
        for (mode, contact) in modes.iter().zip(problem.contacts) {
            let tangents = match mode {
                Mode::Open => continue,
                Mode::Stick => problem.space.tangents(),
                Mode::Slip(_) => 0,
            };
            at += tangents;
            self.planes.push(Plane { at, normal: 1.0, friction: [0.0; 2], tangents: 0 });
            if let (1, Friction::Coulomb(mu)) = (tangents, contact.friction) {
                for side in [1.0, -1.0] {
                    self.planes.push(Plane { at, normal: mu, friction: [side, 0.0], tangents });
                }
            }
            at += 1;
        }
    }

    /// Adds a tangent plane for every cone in space where mu f_n - |f_t| is below the threshold;
    /// says if there is one.
    fn cut(&mut self, problem: &ContactProblem<'_>, modes: &[Mode], threshold: f64) -> bool {
        let largest = self.values.iter().fold(0.0_f64, |sum, x| sum.max(x.abs()));
        let (mut at, count) = (0, self.planes.len());
        for (mode, contact) in modes.iter().zip(problem.contacts) {
            let tangents = match mode {
                Mode::Open => continue,
                Mode::Stick => problem.space.tangents(),
                Mode::Slip(_) => 0,
            };
            at += tangents;
            if let (2, Friction::Coulomb(mu)) = (tangents, contact.friction) {
                let tangential = &self.values[at - 2..at];
                let size = length(tangential);
                let slack = mu * self.values[at] - size;
                if size > 0.0 && slack < threshold - 1e-11 * largest {
                    let friction = [-tangential[0] / size, -tangential[1] / size];
                    self.planes.push(Plane { at, normal: mu, friction, tangents });
                }
            }
            at += 1;
        }
        self.planes.len() > count
    }

    fn measure_planes(&mut self) {
        self.slack.clear();
        self.slope.clear();
        for plane in &self.planes {
            self.slack.push(plane.value(&self.least));
            for direction in 0..self.system.nullity() {
                let slope = plane.value(self.system.null_vector(direction));
                // Rounding of a unit vector is no direction.
                self.slope.push(if slope.abs() > 1e-12 { slope } else { 0.0 });
            }
        }
    }

    /// min |x|^2 subject to the planes: x = x0 + N z, z = A^T y, 0 <= y _|_ A A^T y + c >= 0.
    fn least_admissible(&mut self) -> Option<f64> {
        let (count, free) = (self.slack.len(), self.system.nullity());
        self.lcp.clear();
        for i in 0..count {
            for j in 0..count {
                let (a, b) = (&self.slope[i * free..(i + 1) * free], &self.slope[j * free..]);
                self.lcp.push(a.iter().zip(b).map(|(a, b)| a * b).sum());
            }
        }
        let report = self.lemke.solve(&self.lcp, &self.slack, 50 * (count + 1));
        let solved = report.outcome == LcpOutcome::Solved;
        self.values.copy_from_slice(&self.least);
        for direction in 0..if solved { free } else { 0 } {
            let multipliers = self.lemke.solution();
            let along = (0..count).map(|i| multipliers[i] * self.slope[i * free + direction]).sum();
            self.move_along(direction, along);
        }
        solved.then_some(0.0)
    }

    fn move_along(&mut self, direction: usize, along: f64) {
        for (value, entry) in self.values.iter_mut().zip(self.system.null_vector(direction)) {
            *value += along * entry;
        }
    }

    /// max t subject to A z + c >= t, as a complementarity problem of the multipliers y and of
    /// (z, t) = x+ - x-; moves the values to z.
    fn largest_slack(&mut self) -> f64 {
        let (count, free) = (self.slack.len(), self.system.nullity());
        let smallest = self.slack.iter().copied().fold(f64::INFINITY, f64::min);
        self.values.copy_from_slice(&self.least);
        let largest = self.slack.iter().fold(0.0_f64, |sum, slack| sum.max(slack.abs()));
        if free == 0 || largest == 0.0 || !smallest.is_finite() {
            return smallest;
        }
        let (columns, size) = (free + 1, count + 2 * free + 2);
        self.lcp.clear();
        self.lcp.resize(size * size, 0.0);
        for row in 0..count {
            for column in 0..columns {
                let last = column == free;
                let entry = if last { -1.0 } else { self.slope[row * free + column] };
                let (plus, minus) = (count + column, count + columns + column);
                self.lcp[row * size + plus] = entry;
                self.lcp[row * size + minus] = -entry;
                self.lcp[plus * size + row] = -entry;
                self.lcp[minus * size + row] = entry;
            }
        }
        self.lcp_right.clear();
        self.lcp_right.extend(self.slack.iter().map(|slack| slack / largest));
        self.lcp_right.resize(size, 0.0);
        self.lcp_right[count + free] = -1.0;
        self.lcp_right[count + columns + free] = 1.0;
        let report = self.lemke.solve(&self.lcp, &self.lcp_right, 50 * size);
        match report.outcome {
            LcpOutcome::Solved => {}
            LcpOutcome::Ray => return f64::INFINITY,
            // A lower bound that is certain.
            LcpOutcome::Limit | LcpOutcome::Inaccurate => return smallest,
        }
        let x = |solution: &[f64], column: usize| {
            largest * (solution[count + column] - solution[count + columns + column])
        };
        for direction in 0..free {
            self.move_along(direction, x(self.lemke.solution(), direction));
        }
        x(self.lemke.solution(), free)
    }
}

impl Unknown {
    /// What the unknown does to the row of G given as `line`.
    fn column(&self, line: &[f64]) -> f64 {
        let first = self.row - self.tangents;
        (0..self.tangents)
            .fold(line[self.row], |sum, axis| sum + self.friction[axis] * line[first + axis])
    }
}

impl Plane {
    fn value(&self, x: &[f64]) -> f64 {
        let first = self.at - self.tangents;
        (0..self.tangents)
            .fold(self.normal * x[self.at], |sum, axis| sum + self.friction[axis] * x[first + axis])
    }
}
