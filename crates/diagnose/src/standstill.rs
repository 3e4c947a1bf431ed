//! Where a drive rests between two motions.
//!
//! A drive that sticks is seen by its encoder as it is, and by a filter of positions as if it never
//! stopped. While it rests its friction is whatever balances the other torques, up to where it
//! leaves: no motion tells that, but the measured torque does. Rates of a rest therefore change
//! their sign all the time, so that a law of the sign has in the mean a torque that balances, and
//! no more than it has while the drive slides. What is needed beyond that is for laws of sticking:
//! as long as it is, and the drive has not left, they are told that it creeps by a step of its
//! encoder, below which nobody sees it, as friction before sliding has it (Canudas de Wit, Olsson,
//! Åström, Lischinsky 1995).

use super::law::Response;
use super::signals::Signals;
use crate::policy::standstill::{ANOTHER, CREEPS, LEAVES, POWER, SAME, SLIDES, UNSEEN};
use denavit_measure::JointIndex;
use std::ops::Range;

/// Samples of the shortest rest.
const LEAST: usize = 6;

/// A rest of a drive.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Rest {
    /// When it began and ended \[s\].
    pub(super) time_s: Range<f64>,
    /// The directions in which the drive came and leaves, 1 or -1.
    directions: [f64; 2],
    /// On which side its friction is, from -1 to 1, at equal distances.
    sides: Vec<f64>,
    /// What balances the other torques over what it slides with, at its samples, and that [N m, N].
    needs: Vec<[f64; 2]>,
    /// From when on it is on the side of sliding \[s\].
    leaves_s: f64,
    /// How fast it would cover a step of its encoder meanwhile [rad/s, m/s].
    pub(super) creep: f64,
}

impl Rest {
    /// A rest in readings of an encoder's step, the first at a time, and the others at equal
    /// distances \[s\]. It begins and ends where the drive, as it moves beside, was last seen to.
    fn new(still: Still, step: f64, [start_s, step_s]: [f64; 2]) -> Self {
        let Still { samples, moves, off } = still;
        let count = samples.len() as f64;
        let [came, left] = off.map(|off| off.abs() + UNSEEN);
        let edge = |off: f64, moved: Option<f64>, power: f64| {
            moved.map_or(0.0, |moved| count * (off / moved.abs()).powf(1.0 / power))
        };
        let start = samples.start as f64 + edge(came, moves[0], 2.0);
        let end = (samples.end - 1) as f64 - edge(left, moves[1], POWER);
        let time_s = start_s + step_s * start..start_s + step_s * end.max(start + 1.0);
        let creep = step / (time_s.end - time_s.start);
        let beside = moves[0].or(moves[1]).unwrap_or(1.0);
        let directions = moves.map(|moved| moved.unwrap_or(beside).signum());
        let (leaves_s, sides, needs) = (time_s.start, directions.to_vec(), Vec::new());
        Self { time_s, directions, sides, needs, leaves_s, creep }
    }

    /// What of it is within times \[s\]; none if that is nothing.
    pub(super) fn within(mut self, times_s: &Range<f64>) -> Option<Self> {
        let Range { start, end } = self.time_s;
        self.time_s = start.max(times_s.start)..end.min(times_s.end);
        self.leaves_s = self.time_s.start;
        (self.time_s.start < self.time_s.end).then_some(self)
    }

    /// Tells which friction is needed, over what the drive slides with, and that [N m, N], at equal
    /// distances from when it begins to when it ends.
    pub(super) fn settle(&mut self, needs: &[[f64; 2]]) {
        self.needs = needs.to_vec();
        self.sides = needs.iter().map(|[side, _]| side.clamp(-1.0, 1.0)).collect();
        let holds = |side: &f64| side * self.directions[1] < SLIDES;
        let held = self.sides.iter().rposition(holds).map_or(0, |last| last + 1);
        let share = held.min(self.sides.len() - 1) as f64 / self.sides.len() as f64;
        let Range { start, end } = self.time_s;
        self.leaves_s = start + share * (end - start);
        self.creep *= (end - start) / (end - self.leaves_s);
    }

    /// Its samples among so many times.
    pub(super) fn samples(&self, t: &[f64]) -> Range<usize> {
        within(t, &self.time_s)
    }

    /// Those among so many times at which it needs less than it slides with.
    pub(super) fn held(&self, t: &[f64]) -> Range<usize> {
        within(t, &(self.time_s.start..self.leaves_s))
    }

    /// On which side friction is at a time \[s\] of the rest.
    fn side(&self, t: f64) -> f64 {
        let [came, leaves] = self.directions;
        if t < self.time_s.start {
            return came;
        } else if t >= self.time_s.end {
            return leaves;
        }
        let part = (t - self.time_s.start) / (self.time_s.end - self.time_s.start);
        let count = self.sides.len();
        self.sides[((part * count as f64) as usize).min(count - 1)]
    }
}

/// Readings that stay where they are.
struct Still {
    samples: Range<usize>,
    /// The steps by which the drive moves as long before and after it; none where the log ends.
    moves: [Option<f64>; 2],
    /// How far its first and its last reading are from its middle, in steps.
    off: [f64; 2],
}

impl Still {
    /// Readings from one on that are within so many steps of it.
    fn new(positions: &[f64], first: usize, step: f64, within: f64) -> Self {
        let is_near = |q: &&f64| (**q - positions[first]).abs() <= SAME * within * step;
        let count = positions[first..].iter().take_while(is_near).count();
        let (last, end) = (first + count - 1, positions.len() - 1);
        let before = (first > 0).then(|| positions[first.saturating_sub(count)]);
        let after = (last < end).then(|| positions[(last + count).min(end)]);
        let by = |from: f64, to: f64| (to - from) / step;
        let middle = positions[first + count / 2];
        Self {
            samples: first..last + 1,
            moves: [
                before.map(|before| by(before, positions[first])),
                after.map(|after| by(positions[last], after)),
            ],
            off: [positions[first], positions[last]].map(|q| by(middle, q)),
        }
    }

    fn overlaps(&self, other: &Self) -> bool {
        self.samples.start < other.samples.end && other.samples.start < self.samples.end
    }

    /// Whether the drive stops and leaves rather than turns around.
    fn is_rest(&self, within: f64) -> bool {
        let leaves = |by: &Option<f64>| by.is_none_or(|by| by.abs() > LEAVES * within);
        let has_moved = self.moves.iter().any(Option::is_some);
        self.samples.len() >= LEAST && has_moved && self.moves.iter().all(leaves)
    }
}

/// The rests in positions as an encoder of a step gives them, the first at a time, and the others
/// at equal distances \[s\].
pub(super) fn rests(positions: &[f64], step: f64, times: [f64; 2]) -> Vec<Rest> {
    let mut found: Vec<Still> = Vec::new();
    for within in CREEPS {
        let mut first = 0;
        while first < positions.len() {
            let still = Still::new(positions, first, step, within);
            let is_new = found.iter().all(|other| !still.overlaps(other));
            if is_new && still.is_rest(within) {
                first = still.samples.end;
                found.push(still);
            } else {
                // A drive that comes slowly may rest from its next reading on.
                let is_same = |q: &&f64| (**q - positions[first]).abs() < ANOTHER * step;
                first += positions[first..].iter().take_while(is_same).count();
            }
        }
    }
    found.sort_by_key(|still| still.samples.start);
    found.into_iter().map(|still| Rest::new(still, step, times)).collect()
}

impl Signals {
    /// Has the drive of a joint rest where it does.
    pub(super) fn rest(&mut self, joint: JointIndex) {
        let (t, rests) = (self.t.clone(), self.rests[joint.0].clone());
        alternate(self.drive_mut(joint)[0], &t, &rests);
    }

    /// Takes from a change of a measured torque what friction of the drive balances at rest.
    pub(super) fn unbalanced(&self, joint: JointIndex, change: &mut Response) {
        let Response { torque, gradient, .. } = change;
        let beyond = |side: f64| side - side.clamp(-1.0, 1.0);
        for rest in &self.rests[joint.0] {
            for (k, [side, friction]) in rest.samples(&self.t).zip(&rest.needs) {
                let left = side - torque[0][k] / friction;
                if *friction > 0.0 {
                    torque[0][k] = friction * (beyond(*side) - beyond(left));
                    let is_held = left.abs() <= 1.0;
                    gradient.iter_mut().filter(|_| is_held).for_each(|by| by[0][k] = 0.0);
                }
            }
        }
    }

    /// Rates of a joint's drive that creeps where it rests, for laws of sticking [rad/s, m/s].
    pub(super) fn creeping(&self, joint: JointIndex) -> Vec<f64> {
        let mut rates = self.of_drive(joint)[0].clone();
        for rest in &self.rests[joint.0] {
            rates[rest.samples(&self.t)].fill(0.0);
            let leaves = within(&self.t, &(rest.leaves_s..rest.time_s.end));
            rates[leaves].fill(rest.directions[1] * rest.creep);
        }
        rates
    }
}

/// Gives rates at times \[s\] of a drive that rests another sign at each sample, so that their mean
/// is the side of its friction. As long before and after it the drive moves as it is seen to, which
/// a filter blurs; but not where it goes the other way by more than a step of its encoder in the
/// time of the shortest rest.
fn alternate(rates: &mut [f64], t: &[f64], rests: &[Rest]) {
    for rest in rests {
        let Rest { time_s: Range { start, end }, directions, creep, leaves_s, .. } = rest;
        let [came, leaves] = directions;
        let long = end - start;
        let step_s = t.get(1).map_or(1.0, |second| second - t[0]);
        let other_way = -creep * (end - leaves_s) / (LEAST as f64 * step_s);
        let before = rates[within(t, &(start - long..*start))].iter_mut().rev();
        let blurred = before.take_while(|rate| came * **rate >= other_way);
        blurred.for_each(|rate| *rate = came * (came * *rate).max(*creep));
        let after = rates[within(t, &(*end..end + long))].iter_mut();
        let blurred = after.take_while(|rate| leaves * **rate >= other_way);
        blurred.for_each(|rate| *rate = leaves * (leaves * *rate).max(*creep));
        let samples = rest.samples(t);
        let mut sum = 0.0;
        for (rate, t) in rates[samples.clone()].iter_mut().zip(&t[samples]) {
            sum += rest.side(*t);
            let sign = if sum < 0.0 { -1.0 } else { 1.0 };
            sum -= sign;
            *rate = sign * creep;
        }
    }
}

fn within(t: &[f64], time_s: &Range<f64>) -> Range<usize> {
    let at = |time_s: f64| t.partition_point(|t| *t < time_s);
    at(time_s.start)..at(time_s.end)
}

#[cfg(test)]
#[path = "../tests/unit/standstill.rs"]
mod tests;
