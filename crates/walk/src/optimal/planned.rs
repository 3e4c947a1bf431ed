//! A step that has been planned, as functions of time.

use super::layout::Layout;
use super::legs::{Legs, Role};
use super::step::Step;
use denavit_plants::trajectory::{
    CubicSpline, EndCondition, Part, QuinticSpline, Reference, Sequence,
};

/// A phase of a planned step, by points in time. The right leg stands.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedPhase {
    /// What reports call it.
    pub name: String,
    /// The closed contacts.
    pub closed: Vec<Role>,
    /// \[s\].
    pub duration_s: f64,
    /// Times of the points since the beginning of the phase \[s\].
    pub times_s: Vec<f64>,
    /// Coordinates at the points [rad, m].
    pub q: Vec<Vec<f64>>,
    /// Their velocities [rad/s, m/s].
    pub qd: Vec<Vec<f64>>,
    /// Their accelerations [rad/s^2, m/s^2].
    pub qdd: Vec<Vec<f64>>,
    /// Torques of the driven joints, in the order of [`Legs::driven`] \[N m\].
    pub torques_nm: Vec<Vec<f64>>,
    /// Forces on all contact points, world frame, three entries each \[N\].
    pub forces_n: Vec<Vec<f64>>,
}

/// A planned step; the next one is the same with the legs swapped.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedStep {
    /// The walker.
    pub legs: Legs,
    /// The phases, one after the other.
    pub phases: Vec<PlannedPhase>,
    /// \[m\].
    pub length_m: f64,
    /// \[s\].
    pub period_s: f64,
}

impl PlannedStep {
    /// The step that the variables of a program describe.
    pub(super) fn of(step: &Step<'_>, x: &[f64]) -> Self {
        let layout = &step.layout;
        let phases = (0..layout.phases.len()).map(|phase| planned_phase(step, x, phase)).collect();
        let durations = &x[layout.durations..layout.durations + layout.phases.len()];
        Self {
            legs: step.legs.clone(),
            phases,
            length_m: x[layout.length],
            period_s: durations.iter().sum(),
        }
    }

    /// The phase in which the stance foot alone stands flat, and the time of its middle since the
    /// beginning of the step \[s\]; the first of all phases if there is none.
    pub fn mid_swing(&self) -> (usize, f64) {
        let flat = [Role::StanceHeel, Role::StanceToe];
        let phase = self.phases.iter().position(|phase| phase.closed == flat).unwrap_or(0);
        let before: f64 = self.phases[..phase].iter().map(|phase| phase.duration_s).sum();
        (phase, before + 0.5 * self.phases[phase].duration_s)
    }

    /// Position, velocity and acceleration of all coordinates at a time since the beginning of
    /// the step.
    pub fn motion(&self, t_s: f64) -> Result<[Vec<f64>; 3], denavit_plants::Error> {
        let mut since = t_s;
        let mut number = 0;
        while number + 1 < self.phases.len() && since > self.phases[number].duration_s {
            since -= self.phases[number].duration_s;
            number += 1;
        }
        let mut motion = [Vec::new(), Vec::new(), Vec::new()];
        for coordinate in 0..self.legs.coordinates {
            let at = self.phases[number].position(coordinate)?.at(since);
            motion[0].push(at.position);
            motion[1].push(at.rate);
            motion[2].push(at.acceleration);
        }
        Ok(motion)
    }

    /// What a driven joint follows, over two steps again and again: phase by phase, its own motion
    /// and then that of its mirror image.
    pub fn reference(&self, joint: usize) -> Result<Reference, denavit_plants::Error> {
        self.two_steps(|phase, step| self.phases[phase].position(self.role_of(joint, step)))
    }

    /// The torque that goes with it.
    pub fn feed_forward(&self, joint: usize) -> Result<Reference, denavit_plants::Error> {
        self.two_steps(|phase, step| {
            let coordinate = self.role_of(joint, step);
            let drive = self.legs.driven.iter().position(|driven| *driven == coordinate);
            self.phases[phase].torque(drive.unwrap_or(0))
        })
    }

    /// The coordinate of the plan that a joint has the part of in the first step or the second.
    pub fn role_of(&self, joint: usize, step: usize) -> usize {
        if step == 0 { joint } else { self.legs.mirror[joint] }
    }

    /// A function of time over two steps, made phase by phase.
    pub fn two_steps(
        &self,
        make: impl Fn(usize, usize) -> Result<Reference, denavit_plants::Error>,
    ) -> Result<Reference, denavit_plants::Error> {
        let mut parts = Vec::new();
        for step in 0..2 {
            for (number, phase) in self.phases.iter().enumerate() {
                parts.push(Part { duration_s: phase.duration_s, reference: make(number, step)? });
            }
        }
        Sequence::new(parts, true).map(Reference::Sequence)
    }
}

impl PlannedPhase {
    /// The motion of a coordinate.
    pub fn position(&self, coordinate: usize) -> Result<Reference, denavit_plants::Error> {
        let column = |rows: &[Vec<f64>]| rows.iter().map(|row| row[coordinate]).collect::<Vec<_>>();
        let [q, qd, qdd] = [&self.q, &self.qd, &self.qdd].map(|rows| column(rows));
        QuinticSpline::new(self.times_s.clone(), q, &qd, &qdd).map(Reference::Quintic)
    }

    /// The torque of a drive: a cubic spline with the slopes of the parabolas at both ends.
    pub fn torque(&self, drive: usize) -> Result<Reference, denavit_plants::Error> {
        let values: Vec<f64> = self.torques_nm.iter().map(|row| row[drive]).collect();
        let ends = self.torque_rates(&values).map(EndCondition::Rate);
        CubicSpline::new(self.times_s.clone(), values, ends).map(Reference::Cubic)
    }

    /// Slopes at both ends of the parabolas through three values.
    pub(super) fn torque_rates(&self, values: &[f64]) -> [f64; 2] {
        let last = values.len() - 1;
        let h = self.times_s[1] - self.times_s[0];
        [
            (-3.0 * values[0] + 4.0 * values[1] - values[2]) / (2.0 * h),
            (3.0 * values[last] - 4.0 * values[last - 1] + values[last - 2]) / (2.0 * h),
        ]
    }
}

fn planned_phase(step: &Step<'_>, x: &[f64], phase: usize) -> PlannedPhase {
    let layout: &Layout = &step.layout;
    let duration_s = x[layout.durations + phase];
    let points = layout.points_of(phase);
    let part = |first: usize, count: usize| x[first..first + count].to_vec();
    let motion = |derivative: usize| {
        points.iter().map(|point| part(layout.motion(point, derivative), layout.n)).collect()
    };
    let force = |first: usize| step.spread(phase, &x[first..first + layout.held[phase].len()]);
    PlannedPhase {
        name: layout.phases[phase].name.clone(),
        closed: layout.phases[phase].closed.clone(),
        duration_s,
        times_s: points.iter().map(|point| point.fraction * duration_s).collect(),
        q: motion(0),
        qd: motion(1),
        qdd: motion(2),
        torques_nm: points.iter().map(|p| part(layout.torques(p), layout.drives)).collect(),
        forces_n: points.iter().map(|point| force(layout.forces(point))).collect(),
    }
}
