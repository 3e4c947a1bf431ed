//! The right-hand side: accelerations with any of the contact forces that move the plant alike.

use super::{Closed, Motion, Work};
use crate::breakdown::Breakdown;
use crate::contact::cholesky::dot;
use crate::contact::independent::IndependentRows;
use crate::contact::sharing::{Limit, Loads, Sharing};
use crate::contact::{ContactFailure, Mode};

/// Memory of the right-hand side.
#[derive(Clone, Debug, Default)]
pub(super) struct MovedMemory {
    /// Rows that are independent of each other, where all stick, and the contacts of which they
    /// are.
    independent: IndependentRows,
    chosen_for: Vec<usize>,
    /// The state of the Delassus matrix in which it is that of these rows, factored.
    factored_at: u64,
    /// Rows of the problem: of its conditions, then of forces that slip.
    lines: Vec<f64>,
    matrix: Vec<f64>,
    right: Vec<f64>,
    limits: Vec<Limit>,
    sharing: Sharing,
    force: Vec<f64>,
}

impl Motion<'_> {
    /// As `constrained_motion`, with any of the forces that move the plant alike.
    pub(super) fn moved(&mut self, t_s: f64, y: &[f64]) -> Result<(), Breakdown> {
        self.free_motion(t_s, y)?;
        self.work.force.clear();
        if self.closed.is_empty() {
            return Ok(());
        }
        let listed: Vec<usize> = self.closed.iter().map(|closed| closed.contact).collect();
        self.follow_points(y, &listed);
        self.append_bias(y);
        self.hold();
        let all_stick = self.closed.iter().all(|closed| closed.mode == Mode::Stick);
        if all_stick && self.held_by_few(listed) { Ok(()) } else { self.held_and_sliding() }
    }

    /// Which loads redundant contacts that slip have from now on.
    pub(crate) fn want(&mut self, loads: Loads) {
        self.moved.sharing.want(loads);
        self.solver.sharing().want(loads);
    }

    /// Whether loads are the least.
    pub(crate) fn takes_least(&self) -> bool {
        self.moved.sharing.wanted_loads() == Loads::Least
    }

    /// Remembers which redundant contacts that slip are loaded.
    pub(crate) fn remember_loads(&mut self, t_s: f64, y: &[f64]) -> Result<(), Breakdown> {
        if self.moved.sharing.nullity() == 0 || !self.closed.iter().any(slips) {
            return Ok(());
        }
        self.moved(t_s, y)?;
        let moved = &mut self.moved;
        let forces = moved.sharing.forces();
        let loaded: Vec<bool> = moved.limits.iter().map(|limit| forces[limit.at] > 0.0).collect();
        moved.sharing.remember(&loaded);
        self.solver.sharing().remember(&loaded);
        Ok(())
    }

    /// Smooth motion begins, with the contacts as they are from now on.
    pub(crate) fn begin_smooth(&mut self) {
        self.moved.chosen_for.clear();
    }

    /// Forces in rows that say all that the rows of the listed contacts say, of which all stick.
    /// False if these are not independent here, far from where they were chosen.
    fn held_by_few(&mut self, listed: Vec<usize>) -> bool {
        let n = self.layout.joints;
        let Self { work, moved, delassus, .. } = self;
        if moved.chosen_for != listed {
            delassus.project(&work.rows);
            moved.independent.choose(delassus.matrix(), delassus.rows());
            moved.chosen_for = listed;
        }
        moved.force.clear();
        let line = |row: &usize| &work.rows[row * n..(row + 1) * n];
        let chosen = &moved.independent.chosen;
        let missed = chosen.iter().map(|row| work.free[*row] + dot(line(row), &work.acceleration));
        moved.force.extend(missed);
        if moved.factored_at != delassus.changes() {
            moved.lines.clear();
            chosen.iter().for_each(|row| moved.lines.extend_from_slice(line(row)));
            delassus.project(&moved.lines);
            if !moved.independent.factor(delassus.matrix()) {
                return false;
            }
            moved.factored_at = delassus.changes();
        }
        moved.independent.cancel(&mut moved.force);
        delassus.respond(&moved.force, &mut work.acceleration, &mut work.scratch);
        true
    }

    /// Forces of contacts of which some slip. Redundant ones are shared so that none pulls; cones
    /// of what sticks are not looked at: they say when the motion ends, not what it is.
    fn held_and_sliding(&mut self) -> Result<(), Breakdown> {
        self.list_lines();
        let tolerance = self.holding.tolerance;
        let largest = self.moved.right.iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
        let zero = tolerance.response + tolerance.relative * largest;
        let MovedMemory { lines, matrix, right, limits, sharing, force, .. } = &mut self.moved;
        self.delassus.project(lines);
        let (size, total) = (right.len(), self.delassus.rows());
        // the column of a force: its own row, or that of the force that slips
        let mut columns: Vec<usize> = (0..size).collect();
        let mut next = size;
        for (limit, closed) in limits.iter().zip(&self.closed) {
            if slips(closed) {
                columns[limit.at] = next;
                next += 1;
            }
        }
        matrix.clear();
        for line in self.delassus.matrix().chunks_exact(total).take(size) {
            matrix.extend(columns.iter().map(|column| line[*column]));
        }
        let missed = sharing.pose(matrix, right);
        // Constraints that are met only up to a drift contradict each other a little.
        if missed.is_nan() || missed > 1e5 * zero {
            return Err(Breakdown::Contact(ContactFailure::Inconsistent));
        }
        let pulls = limits.iter().any(|limit| sharing.forces()[limit.at] < 0.0);
        if (pulls || !sharing.is_free()) && sharing.nullity() > 0 {
            // if nothing keeps them from pulling, an event is near
            sharing.share_or_pull(limits);
        }
        force.clear();
        force.resize(total, 0.0);
        for (column, value) in columns.iter().zip(sharing.forces()) {
            force[*column] = *value;
        }
        let work = &mut self.work;
        self.delassus.respond(force, &mut work.acceleration, &mut work.scratch);
        self.expand();
        Ok(())
    }

    /// Rows of the conditions and of the forces that slip, limits of the forces, and what the
    /// conditions lack without forces.
    fn list_lines(&mut self) {
        let (n, rows) = (self.layout.joints, self.ground.rows());
        let Self { work, moved, closed, .. } = self;
        let MovedMemory { lines, right, limits, .. } = moved;
        lines.clear();
        right.clear();
        limits.clear();
        let line = |row: usize| &work.rows[row * n..(row + 1) * n];
        for (index, closed) in closed.iter().enumerate() {
            let normal = index * rows + rows - 1;
            let first = if slips(closed) { normal } else { index * rows };
            for row in first..=normal {
                lines.extend_from_slice(line(row));
                right.push(-work.free[row] - dot(line(row), &work.acceleration));
            }
            limits.push(Limit { at: right.len() - 1, cone: None });
        }
        for (index, mode) in work.modes.iter().enumerate() {
            let Mode::Slip(direction) = mode else { continue };
            let friction = work.contacts[index].coefficient().unwrap_or(0.0);
            let (first, normal) = (index * rows, index * rows + rows - 1);
            let start = lines.len();
            lines.extend_from_slice(line(normal));
            for (axis, along) in direction.iter().enumerate().take(rows - 1) {
                for (entry, tangent) in lines[start..].iter_mut().zip(line(first + axis)) {
                    *entry -= friction * along * tangent;
                }
            }
        }
    }

    /// Forces of all rows, of those that were shared.
    fn expand(&mut self) {
        let (rows, work) = (self.ground.rows(), &mut self.work);
        work.force.resize(self.closed.len() * rows, 0.0);
        for (index, limit) in self.moved.limits.iter().enumerate() {
            let block = &mut work.force[index * rows..(index + 1) * rows];
            let shared = self.moved.sharing.forces();
            block[rows - 1] = shared[limit.at];
            match work.modes[index] {
                Mode::Slip(direction) => {
                    let friction = work.contacts[index].coefficient().unwrap_or(0.0);
                    for axis in 0..rows - 1 {
                        block[axis] = -friction * direction[axis] * shared[limit.at];
                    }
                }
                _ => block[..rows - 1].copy_from_slice(&shared[limit.at + 1 - rows..limit.at]),
            }
        }
    }

    /// What accelerations of the closed contact points have from rates alone, into `work.free`.
    fn append_bias(&mut self, y: &[f64]) {
        let parts = self.layout.parts(y);
        let Work { contact_bias, free, .. } = &mut self.work;
        self.plant.contact_bias(parts.q, parts.qd, contact_bias);
        free.clear();
        for closed in &self.closed {
            let at = 3 * closed.contact;
            self.ground.append(&contact_bias[at..at + 3], free);
        }
    }
}

fn slips(closed: &Closed) -> bool {
    closed.mode != Mode::Stick
}
