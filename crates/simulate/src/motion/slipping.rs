//! The direction of slipping: that of the velocity, but where that is no more than an error.
//!
//! In space v / |v| has no value where slipping begins and ends, and turns infinitely fast beside
//! that. Below a speed that the accuracy of the motion sets, the direction therefore is that of
//! v + v_s w d, where d is the direction remembered, of faster slipping or of that in which it
//! began, and the weight w(|v| / v_s) falls smoothly from 1 at rest to 0 at a few v_s. Faster
//! slipping has the direction of its velocity, exactly. In a plane the direction is d, and changes
//! by events alone.

use super::{Closed, Motion};
use crate::breakdown::Breakdown;
use crate::contact::{ContactProblem, Mode};
use crate::integrate::Method;

/// v_s in units of the absolute accuracy of rates, and within which limits [m/s].
const ERRORS: f64 = 1e4;
const SPEEDS: [f64; 2] = [1e-6, 1e-4];
/// Forces this much larger than those that would hold the contacts jam.
const JAMS: f64 = 1e3;
/// From this many v_s on nothing is remembered.
const FORGETS: f64 = 4.0;

/// How directions of slipping in space are remembered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SlipMemory {
    /// v_s [m/s].
    speed: f64,
}

impl SlipMemory {
    /// As the errors of a method ask for.
    pub(crate) fn of(method: Method) -> Self {
        let speed = match method {
            Method::DormandPrince(accuracy) | Method::Radau(accuracy) => ERRORS * accuracy.absolute,
            Method::RungeKutta { .. } => SPEEDS[1],
        };
        Self { speed: speed.clamp(SPEEDS[0], SPEEDS[1]) }
    }

    /// Whether slipping is so fast that its direction is that of its velocity.
    pub(crate) fn is_left_by(self, velocity: &[f64]) -> bool {
        size(velocity) >= FORGETS * self.speed
    }

    /// Slower contacts are at rest, once they have slipped faster than twice that [m/s].
    pub(crate) fn rests_below(self) -> f64 {
        0.5 * self.speed
    }

    /// How far slipping is from its end [m/s]: in a plane the speed along its direction. In space
    /// the speed down to which it is at rest, and once more what is left along the direction that
    /// is remembered, lest a stop be overlooked.
    pub(crate) fn slip_left(self, velocity: &[f64], closed: &Closed) -> f64 {
        let Mode::Slip(direction) = closed.mode else { return 0.0 };
        let along: f64 = velocity.iter().zip(direction).map(|(v, d)| v * d).sum();
        if velocity.len() < 2 {
            return along;
        }
        let back = along + self.rests_below();
        if closed.runs { back.min(size(velocity) - self.rests_below()) } else { back }
    }

    /// The direction of slipping at a velocity, after `last`.
    pub(crate) fn direction(self, velocity: &[f64], last: [f64; 2]) -> [f64; 2] {
        if velocity.len() < 2 || last == [0.0; 2] {
            return last;
        }
        let share = (size(velocity) / (FORGETS * self.speed)).min(1.0);
        let kept = self.speed * (1.0 - share * share).powi(3);
        let [x, y] = [0, 1].map(|axis| velocity[axis] + kept * last[axis]);
        let size = x.hypot(y);
        if size > 0.0 { [x / size, y / size] } else { last }
    }
}

fn size(velocity: &[f64]) -> f64 {
    velocity.iter().map(|v| v * v).sum::<f64>().sqrt()
}

impl Motion<'_> {
    /// Remembers the directions of what slips fast in space: rates do not change by it.
    pub(crate) fn remember_slips(&mut self, y: &[f64]) {
        let rows = self.ground.rows();
        if rows < 3 || self.closed.iter().all(|closed| closed.mode == Mode::Stick) {
            return;
        }
        let listed: Vec<usize> = self.closed.iter().map(|closed| closed.contact).collect();
        self.follow_points(y, &listed);
        for (index, closed) in self.closed.iter_mut().enumerate() {
            let velocity = &self.work.velocity[index * rows..index * rows + 2];
            closed.runs |= size(velocity) >= 2.0 * self.holding.slips.rests_below();
            match &mut closed.mode {
                Mode::Slip(direction)
                    if *direction != [0.0; 2] && self.holding.slips.is_left_by(velocity) =>
                {
                    *direction = [0, 1].map(|axis| velocity[axis] / size(velocity));
                }
                _ => {}
            }
        }
    }

    /// Whether what slips is loaded as equally compliant points are, and finds no such loads here
    /// though others push.
    pub(crate) fn loads_fail(&mut self, t_s: f64, y: &[f64]) -> Result<bool, Breakdown> {
        if self.takes_least() {
            return Ok(false);
        }
        self.pose(t_s, y)?;
        let problem = ContactProblem {
            space: self.ground.space,
            contacts: &self.work.contacts,
            delassus: self.delassus.matrix(),
            free: &self.work.free,
            tolerance: self.holding.tolerance,
        };
        Ok(self.solver.keeps_least_alone(&problem, &self.work.modes))
    }

    /// Whether the forces of what slips grow beyond all bounds here: its friction turns it into the
    /// ground as much as its normal force lifts it (Painleve).
    pub(crate) fn jams(&mut self, t_s: f64, y: &[f64]) -> bool {
        let slips = |closed: &Closed| closed.mode != Mode::Stick;
        if !self.closed.iter().any(slips) || self.constrained_motion(t_s, y).is_err() {
            return false;
        }
        let largest = |entries: &[f64]| entries.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
        let (total, matrix) = (self.delassus.rows(), self.delassus.matrix());
        let stiffest = (0..total).map(|row| matrix[row * (total + 1)]).fold(0.0, f64::max);
        stiffest * largest(&self.work.force) > JAMS * largest(&self.work.free)
    }

    /// Whether a closed contact slips on in space where its speed along the direction that is
    /// remembered ended: it has only turned away from that.
    pub(crate) fn slips_on(&mut self, index: usize, y: &[f64]) -> bool {
        let rows = self.ground.rows();
        let listed: Vec<usize> = self.closed.iter().map(|closed| closed.contact).collect();
        self.follow_points(y, &listed);
        let velocity = &self.work.velocity[index * rows..(index + 1) * rows - 1];
        rows == 3 && self.holding.slips.is_left_by(velocity)
    }
}
