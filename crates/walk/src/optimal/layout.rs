//! Where the variables of a planned step stand, and of what size they are.

use super::legs::Legs;
use super::phases::{Axis, Phase, Transition, transitions};
use denavit_plants::Plant;

/// Units in which a walker is of size 1: leg, weight, and the time of a fall from rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Units {
    /// Leg \[m\].
    pub length_m: f64,
    /// sqrt(leg over gravity) \[s\].
    pub time_s: f64,
    /// Weight \[N\].
    pub force_n: f64,
}

impl Units {
    /// Those of a walker.
    pub(super) fn of(legs: &Legs) -> Self {
        Self {
            length_m: legs.leg_m,
            time_s: (legs.leg_m / legs.gravity).sqrt(),
            force_n: legs.mass_kg * legs.gravity,
        }
    }

    /// Weight times leg [N m].
    pub(super) fn moment_nm(self) -> f64 {
        self.force_n * self.length_m
    }

    /// Leg over time [m/s].
    pub(super) fn speed_m_s(self) -> f64 {
        self.length_m / self.time_s
    }

    /// Weight times speed \[W\].
    pub(super) fn power_w(self) -> f64 {
        self.force_n * self.speed_m_s()
    }
}

/// An instant of a phase at which the dynamics hold: an end or the middle of an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    /// Its phase.
    pub phase: usize,
    /// Its number in the phase; even ones are ends of intervals.
    pub index: usize,
    /// First variable: q, then qd, qdd, torques, forces.
    pub start: usize,
    /// Share of the phase's duration before it.
    pub fraction: f64,
    /// Its weight in Simpson's rule over the phase, in shares of the phase's duration.
    pub weight: f64,
}

/// Where variables stand: points one after the other, then durations of phases, impulses of
/// impacts, and the length of the step.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layout {
    /// The phases.
    pub phases: Vec<Phase>,
    /// What lies between them.
    pub transitions: Vec<Transition>,
    /// Intervals of each phase.
    pub intervals: Vec<usize>,
    /// The points of all phases.
    pub points: Vec<Point>,
    /// First point of each phase.
    pub first: Vec<usize>,
    /// Number of coordinates.
    pub n: usize,
    /// Number of driven joints.
    pub drives: usize,
    /// First variable of the phases' durations.
    pub durations: usize,
    /// First variable of each transition's impulses.
    pub impulses: Vec<usize>,
    /// Variable of the step's length.
    pub length: usize,
    /// Number of variables.
    pub variables: usize,
    /// Conditions on closed contacts of each phase: contact point and axis.
    pub held: Vec<Vec<(usize, Axis)>>,
}

impl Layout {
    /// The layout of a step with so many intervals in each phase.
    pub(super) fn new(legs: &Legs, phases: &[Phase], intervals: &[usize]) -> Self {
        let (n, drives) = (legs.coordinates, legs.driven.len());
        let of = |phase: &Phase| {
            phase.held().into_iter().map(|(role, axis)| (legs.contact(role), axis)).collect()
        };
        let held: Vec<Vec<(usize, Axis)>> = phases.iter().map(of).collect();
        let (mut points, mut first, mut next) = (Vec::new(), Vec::new(), 0);
        for (phase, count) in intervals.iter().enumerate() {
            first.push(points.len());
            for index in 0..=2 * count {
                let inner = if index % 2 == 1 { 4.0 } else { 2.0 };
                let share = if index == 0 || index == 2 * count { 1.0 } else { inner };
                points.push(Point {
                    phase,
                    index,
                    start: next,
                    fraction: index as f64 / (2 * count) as f64,
                    weight: share / (6 * count) as f64,
                });
                next += 3 * n + drives + held[phase].len();
            }
        }
        let durations = next;
        next += phases.len();
        let transitions = transitions(phases);
        let mut impulses = Vec::new();
        for transition in &transitions {
            impulses.push(next);
            next += if transition.is_impact() { held[transition.to].len() } else { 0 };
        }
        Self {
            phases: phases.to_vec(),
            transitions,
            intervals: intervals.to_vec(),
            points,
            first,
            n,
            drives,
            durations,
            impulses,
            length: next,
            variables: next + 1,
            held,
        }
    }

    /// Intervals of each phase: so many in all, by the phases' shares, two at least in each.
    pub(super) fn shared_out(phases: &[Phase], intervals: usize) -> Vec<usize> {
        let total: f64 = phases.iter().map(|phase| phase.share).sum();
        let of = |phase: &Phase| ((intervals as f64 * phase.share / total).round() as usize).max(2);
        phases.iter().map(of).collect()
    }

    /// First variable of the positions, velocities and accelerations (0, 1, 2) at a point.
    pub(super) fn motion(&self, point: &Point, derivative: usize) -> usize {
        point.start + derivative * self.n
    }

    /// First variable of the torques at a point.
    pub(super) fn torques(&self, point: &Point) -> usize {
        point.start + 3 * self.n
    }

    /// First variable of the forces at a point, in the order of the phase's held contacts.
    pub(super) fn forces(&self, point: &Point) -> usize {
        point.start + 3 * self.n + self.drives
    }

    /// Points of a phase.
    pub(super) fn points_of(&self, phase: usize) -> &[Point] {
        let first = self.first[phase];
        &self.points[first..=first + 2 * self.intervals[phase]]
    }

    /// Last point of a phase.
    pub(super) fn last_of(&self, phase: usize) -> &Point {
        &self.points[self.first[phase] + 2 * self.intervals[phase]]
    }

    /// The scales of the variables.
    pub(super) fn scales(&self, plant: &dyn Plant, units: Units, impulse_ns: f64) -> Vec<f64> {
        let slides: Vec<bool> = plant.model().joints.iter().map(|joint| joint.slides).collect();
        let size = |index: usize| if slides[index] { units.length_m } else { 1.0 };
        let mut scales = vec![0.0; self.variables];
        for point in &self.points {
            for index in 0..self.n {
                let mut scale = size(index);
                for derivative in 0..3 {
                    // accelerations, torques and forces enter linearly
                    let trust = [1.0, 2.0, 20.0][derivative];
                    scales[self.motion(point, derivative) + index] = trust * scale;
                    scale /= units.time_s;
                }
            }
            for index in 0..self.drives {
                scales[self.torques(point) + index] = 5.0 * units.moment_nm();
            }
            for index in 0..self.held[point.phase].len() {
                scales[self.forces(point) + index] = 10.0 * units.force_n;
            }
        }
        for phase in 0..self.phases.len() {
            scales[self.durations + phase] = units.time_s;
        }
        for entry in &mut scales[self.durations + self.phases.len()..self.length] {
            *entry = 20.0 * impulse_ns;
        }
        scales[self.length] = units.length_m;
        scales
    }
}
