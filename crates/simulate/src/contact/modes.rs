//! Forces for given modes, and how far they are from violating a law.
//!
//! Unknown are all components of a contact that sticks and the normal force of one that slips; the
//! conditions are w = 0 in the rows of the first and w_n = 0 for the second. Redundant contacts
//! leave forces undetermined: of those that obey the inequalities f_n >= 0 and |f_t| <= mu f_n
//! those are taken that equally compliant points have in the limit of no compliance. Where all
//! stick these are the least, min |f|^2; where some slip, the distribution of normal forces then
//! does not depend on the directions. It is a complementarity problem in as many unknowns as there
//! are inequalities. A flat foot is so judged by whether *some* distribution of forces exists,
//! never by the signs of an arbitrary one. Friction cones in space enter as tangent planes, added
//! where the last distribution leaves the cone.

mod margin;

use super::cholesky::dot;
use super::interior;
use super::lemke::{LcpOutcome, Lemke};
use super::sharing::{Limit, Sharing};
use super::{ContactFailure, ContactProblem, Mode, length};
use denavit_numerics::MinimumNorm;

/// Pivots below this, relative to the largest, are redundancies of contacts.
const RANK: f64 = 1e-10;
/// Smaller entries of a unit null vector are no direction: points of a foot that is flat up to a
/// drift would pull at each other with 10^12 N to lift one of them.
const DIRECTION: f64 = 1e-5;
/// Rounds of tangent planes: each at least halves the angle by which a cone is left.
const ROUNDS: usize = 40;

/// Memory of the solution for given modes; grows to the largest problem and stays.
#[derive(Clone, Debug, Default)]
pub struct ModeSolver {
    unknowns: Vec<Unknown>,
    matrix: Vec<f64>,
    right: Vec<f64>,
    values: Vec<f64>,
    sharing: Sharing,
    limits: Vec<Limit>,
    normals: Vec<Limit>,
    /// The system with its null vectors, where sharing finds nothing.
    system: MinimumNorm,
    /// The transpose, and the products of its null vectors with those of the system: needed where
    /// friction makes the matrix unsymmetric.
    transpose: MinimumNorm,
    products: MinimumNorm,
    /// Row-major: where along the null vectors a unit force of each plane leads.
    push: Vec<f64>,
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
        let redundancy = self.sharing.nullity();
        let keeps = || least_slack(&self.limits, &self.values) >= 0.0;
        if redundancy > 0 && !(self.sharing.is_free() && keeps()) {
            if self.sharing.share(&self.limits, 0.0).is_some() {
                self.values.copy_from_slice(self.sharing.forces());
            } else {
                self.share_by_planes(problem, modes);
            }
        }
        self.expand(force);
        Ok(redundancy)
    }

    /// Shares forces of redundant contacts.
    pub(crate) fn sharing(&mut self) -> &mut Sharing {
        &mut self.sharing
    }

    /// Forces where sharing finds none: there may be none.
    fn share_by_planes(&mut self, problem: &ContactProblem<'_>, modes: &[Mode]) {
        self.find_null_vectors();
        if !self.has_cones_in_space() {
            self.with_planes(problem, modes, Self::least_admissible);
            return;
        }
        // forces far inside the cones, or near to them, are as good
        let (_, along) =
            interior::largest_margin(&self.values, &self.system, &self.limits, f64::INFINITY);
        for (direction, along) in along.into_iter().enumerate() {
            self.move_along(direction, along);
        }
    }

    /// What each closed contact must keep.
    fn list_limits(&mut self, problem: &ContactProblem<'_>, modes: &[Mode]) {
        self.limits.clear();
        self.limits.extend(closed(problem, modes).map(|Held { at, tangents, friction }| Limit {
            at,
            cone: friction.filter(|_| tangents > 0).map(|mu| (tangents, mu)),
        }));
    }

    fn has_cones_in_space(&self) -> bool {
        self.limits.iter().any(|limit| limit.cone.is_some_and(|(tangents, _)| tangents == 2))
    }

    /// The forces as equally compliant points share them, whatever their signs.
    fn solve(
        &mut self,
        problem: &ContactProblem<'_>,
        modes: &[Mode],
    ) -> Result<(), ContactFailure> {
        self.list_unknowns(problem, modes);
        self.list_limits(problem, modes);
        self.write_system(problem);
        let missed = self.sharing.pose(&self.matrix, &self.right);
        self.values.clear();
        self.values.extend_from_slice(self.sharing.forces());
        // Constraints that are met only up to a drift contradict each other a little.
        let allowed = 1e5 * problem.response_zero();
        if missed > allowed { Err(ContactFailure::Inconsistent) } else { Ok(()) }
    }

    /// Null vectors of the system and, where friction makes it unsymmetric, of its transpose.
    fn find_null_vectors(&mut self) {
        self.system.clone_from(self.sharing.system());
        self.system.find_null_space();
        if self.is_unsymmetric() {
            self.transpose_system();
        }
    }

    /// Redundant, and with friction that follows normal forces.
    fn is_unsymmetric(&self) -> bool {
        self.system.nullity() > 0 && self.unknowns.iter().any(|unknown| unknown.tangents > 0)
    }

    /// Null vectors L of the transpose, and their products with N, those of the system: a force x
    /// that gives way moves the values along N by (L^T N)^-1 L^T x.
    fn transpose_system(&mut self) {
        let (size, free) = (self.unknowns.len(), self.system.nullity());
        self.lcp.clear();
        for row in 0..size {
            self.lcp.extend((0..size).map(|column| self.matrix[column * size + row]));
        }
        self.transpose.factor(&self.lcp, size, RANK);
        if self.transpose.nullity() != free {
            // at the edge of the rank: the least forces are as good
            self.transpose.clone_from(&self.system);
        }
        self.lcp.clear();
        for i in 0..free {
            let left = self.transpose.null_vector(i);
            self.lcp.extend((0..free).map(|j| dot(left, self.system.null_vector(j))));
        }
        self.products.factor(&self.lcp, free, RANK);
    }

    /// (L^T N)^-1 L^T x.
    fn along(&mut self, x: &[f64]) -> Vec<f64> {
        let free = self.system.nullity();
        let right: Vec<f64> = (0..free).map(|i| dot(self.transpose.null_vector(i), x)).collect();
        let mut along = vec![0.0; free];
        self.products.solve(&right, &mut along);
        along
    }

    /// The conditions w = 0 of the unknowns' rows.
    fn write_system(&mut self, problem: &ContactProblem<'_>) {
        let rows = problem.rows();
        self.matrix.clear();
        self.right.clear();
        for condition in &self.unknowns {
            let line = &problem.delassus[condition.row * rows..(condition.row + 1) * rows];
            self.matrix.extend(self.unknowns.iter().map(|unknown| unknown.column(line)));
            self.right.push(-problem.free[condition.row]);
        }
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
        for Held { at, tangents, friction } in closed(problem, modes) {
            self.planes.push(Plane { at, normal: 1.0, friction: [0.0; 2], tangents: 0 });
            if let (1, Some(mu)) = (tangents, friction) {
                for side in [1.0, -1.0] {
                    self.planes.push(Plane { at, normal: mu, friction: [side, 0.0], tangents });
                }
            }
        }
    }

    /// Adds a tangent plane for every cone in space where mu f_n - |f_t| is below the threshold;
    /// says if there is one.
    fn cut(&mut self, problem: &ContactProblem<'_>, modes: &[Mode], threshold: f64) -> bool {
        let largest = self.values.iter().fold(0.0_f64, |sum, x| sum.max(x.abs()));
        let count = self.planes.len();
        for Held { at, tangents, friction } in closed(problem, modes) {
            let (2, Some(mu)) = (tangents, friction) else { continue };
            let tangential = &self.values[at - 2..at];
            let size = length(tangential);
            let slack = mu * self.values[at] - size;
            if size > 0.0 && slack < threshold - 1e-11 * largest {
                let friction = [-tangential[0] / size, -tangential[1] / size];
                self.planes.push(Plane { at, normal: mu, friction, tangents });
            }
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
                self.slope.push(if slope.abs() > DIRECTION { slope } else { 0.0 });
            }
        }
        self.push.clear();
        if !self.is_unsymmetric() {
            self.push.extend_from_slice(&self.slope);
            return;
        }
        let mut row = vec![0.0; self.unknowns.len()];
        for index in 0..self.planes.len() {
            row.fill(0.0);
            self.planes[index].write(&mut row);
            let along = self.along(&row);
            self.push.extend(along);
        }
    }

    /// min |x|^2 subject to the planes: x = x0 + N z, z = P^T y, 0 <= y _|_ A P^T y + c >= 0, with
    /// P = A where all stick.
    fn least_admissible(&mut self) -> Option<f64> {
        let (count, free) = (self.slack.len(), self.system.nullity());
        self.values.copy_from_slice(&self.least);
        if self.slack.iter().all(|slack| *slack >= 0.0) {
            return Some(0.0);
        }
        self.lcp.clear();
        for i in 0..count {
            for j in 0..count {
                let (a, b) = (&self.slope[i * free..(i + 1) * free], &self.push[j * free..]);
                self.lcp.push(a.iter().zip(b).map(|(a, b)| a * b).sum());
            }
        }
        let report = self.lemke.solve(&self.lcp, &self.slack, 50 * (count + 1));
        let solved = report.outcome == LcpOutcome::Solved;
        for direction in 0..if solved { free } else { 0 } {
            let multipliers = self.lemke.solution();
            let along = (0..count).map(|i| multipliers[i] * self.push[i * free + direction]).sum();
            self.move_along(direction, along);
        }
        solved.then_some(0.0)
    }

    fn move_along(&mut self, direction: usize, along: f64) {
        for (value, entry) in self.values.iter_mut().zip(self.system.null_vector(direction)) {
            *value += along * entry;
        }
    }
}

/// The unknowns of one closed contact.
struct Held {
    /// That of its normal force; tangential ones stand just before it.
    at: usize,
    /// How many: none if it slips.
    tangents: usize,
    /// Its coefficient of friction, if it has one.
    friction: Option<f64>,
}

/// The closed contacts in turn.
fn closed<'p>(
    problem: &'p ContactProblem<'_>,
    modes: &'p [Mode],
) -> impl Iterator<Item = Held> + 'p {
    let mut next = 0;
    modes.iter().zip(problem.contacts).filter_map(move |(mode, contact)| {
        let tangents = match mode {
            Mode::Open => return None,
            Mode::Stick => problem.space.tangents(),
            Mode::Slip(_) => 0,
        };
        let at = next + tangents;
        next = at + 1;
        Some(Held { at, tangents, friction: contact.coefficient() })
    })
}

/// The least of f_n and of mu f_n - |f_t|; infinite if nothing is closed.
fn least_slack(limits: &[Limit], x: &[f64]) -> f64 {
    let slack = |limit: &Limit| {
        let normal = x[limit.at];
        let cone =
            limit.cone.map(|(count, mu)| mu * normal - length(&x[limit.at - count..limit.at]));
        cone.map_or(normal, |cone| cone.min(normal))
    };
    limits.iter().map(slack).fold(f64::INFINITY, f64::min)
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
    /// The plane's coefficients of all unknowns.
    fn write(&self, row: &mut [f64]) {
        row[self.at] = self.normal;
        for axis in 0..self.tangents {
            row[self.at - self.tangents + axis] = self.friction[axis];
        }
    }

    fn value(&self, x: &[f64]) -> f64 {
        let first = self.at - self.tangents;
        (0..self.tangents)
            .fold(self.normal * x[self.at], |sum, axis| sum + self.friction[axis] * x[first + axis])
    }
}
