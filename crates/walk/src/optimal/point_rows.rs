//! Constraints at one point of a phase: dynamics, contacts that stay, friction, clearance.

use super::layout::Point;
use super::legs::Role;
use super::mechanics::Moment;
use super::phases::Axis;
use super::rows::{EQUAL, Label, POSITIVE, Sink};
use super::step::Step;

/// A contact that may not touch the ground at a point, and how high it has to be \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Clearance {
    pub(super) contact: usize,
    pub(super) height_m: f64,
    /// Whether it closes at the end of the phase: until then it is as high as it comes down, at
    /// least, in the time that is left.
    pub(super) descends: bool,
}

impl Step<'_> {
    /// The forces on all contact points, of those on a phase's held contacts.
    pub(super) fn spread(&self, phase: usize, held: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; 3 * self.contacts];
        for ((contact, axis), force) in self.layout.held[phase].iter().zip(held) {
            forces[3 * contact + axis.index()] += force;
        }
        forces
    }

    /// Evaluates the mechanics at a point.
    fn weigh(&mut self, x: &[f64], point: &Point, differentiates: bool) {
        let n = self.layout.n;
        let part = |derivative: usize| {
            let start = self.layout.motion(point, derivative);
            &x[start..start + n]
        };
        let first = self.layout.forces(point);
        let forces =
            self.spread(point.phase, &x[first..first + self.layout.held[point.phase].len()]);
        let moment = Moment { q: part(0), qd: part(1), qdd: part(2), forces: &forces };
        match differentiates {
            true => self.mechanics.differentiate(self.plant, moment),
            false => self.mechanics.evaluate(self.plant, moment),
        }
    }

    /// All constraints at a point.
    pub(super) fn point_rows(&mut self, x: &[f64], point: &Point, sink: &mut Sink<'_>) {
        self.weigh(x, point, sink.differentiates());
        self.dynamics_rows(point, x, sink);
        self.contact_rows(point, sink);
        self.friction_rows(point, x, sink);
        self.clearance_rows(point, x, sink);
    }

    fn dynamics_rows(&self, point: &Point, x: &[f64], sink: &mut Sink<'_>) {
        let (n, mechanics) = (self.layout.n, &self.mechanics);
        let torques = self.layout.torques(point);
        for row in 0..n {
            let drive = self.legs.driven.iter().position(|joint| *joint == row);
            let torque = drive.map_or(0.0, |drive| x[torques + drive]);
            sink.row(mechanics.residual[row] - torque, EQUAL, || self.dynamics_label(row, point));
            if !sink.differentiates() {
                continue;
            }
            let at = row * n..(row + 1) * n;
            sink.entries(self.layout.motion(point, 0), &mechanics.residual_q[at.clone()]);
            sink.entries(self.layout.motion(point, 1), &mechanics.residual_qd[at.clone()]);
            sink.entries(self.layout.motion(point, 2), &mechanics.mass[at]);
            if let Some(drive) = drive {
                sink.entry(torques + drive, -1.0);
            }
            for (index, (contact, axis)) in self.layout.held[point.phase].iter().enumerate() {
                let w = mechanics.jacobian[(3 * contact + axis.index()) * n + row];
                sink.entry(self.layout.forces(point) + index, -w);
            }
        }
    }

    fn dynamics_label(&self, row: usize, point: &Point) -> Label {
        let slides = self.slides[row];
        Label {
            what: "equation of motion",
            part: self.names[row].clone(),
            phase: point.phase,
            fraction: point.fraction,
            size: if slides { self.units.force_n } else { self.units.moment_nm() },
            unit: if slides { "N" } else { "N m" },
        }
    }

    /// Contact points that are closed are not accelerated.
    fn contact_rows(&self, point: &Point, sink: &mut Sink<'_>) {
        let (n, mechanics) = (self.layout.n, &self.mechanics);
        for (contact, axis) in &self.layout.held[point.phase] {
            let row = 3 * contact + axis.index();
            sink.row(mechanics.acceleration[row], EQUAL, || Label {
                what: "acceleration of a closed contact",
                part: self.contact_names[*contact].clone(),
                phase: point.phase,
                fraction: point.fraction,
                size: self.legs.gravity,
                unit: "m/s^2",
            });
            if !sink.differentiates() {
                continue;
            }
            let at = row * n..(row + 1) * n;
            sink.entries(
                self.layout.motion(point, 0),
                &mechanics.contacts().acceleration_dq[at.clone()],
            );
            sink.entries(
                self.layout.motion(point, 1),
                &mechanics.contacts().acceleration_dqd[at.clone()],
            );
            sink.entries(self.layout.motion(point, 2), &mechanics.jacobian[at]);
        }
    }

    fn friction_rows(&self, point: &Point, x: &[f64], sink: &mut Sink<'_>) {
        let label = |part: &str| Label {
            what: "friction cone",
            part: part.to_owned(),
            phase: point.phase,
            fraction: point.fraction,
            size: self.units.force_n,
            unit: "N",
        };
        self.cones(point.phase, self.layout.forces(point), x, sink, &label);
    }

    /// The friction cones of both feet, for forces or impulses.
    pub(super) fn cones(
        &self,
        phase: usize,
        first: usize,
        x: &[f64],
        sink: &mut Sink<'_>,
        label: &dyn Fn(&str) -> Label,
    ) {
        for stance in [true, false] {
            let roles = Role::ALL.iter().filter(|role| role.is_stance() == stance);
            let points: Vec<usize> = roles.map(|role| self.legs.contact(*role)).collect();
            let of = |wanted: Axis| {
                let held = self.layout.held[phase].iter().enumerate();
                let chosen = held.filter(move |(_, (contact, axis))| {
                    points.contains(contact) && *axis == wanted
                });
                chosen.map(|(index, _)| first + index).collect::<Vec<usize>>()
            };
            let normals = of.clone()(Axis::Up);
            let along = of(Axis::Along);
            if along.is_empty() {
                continue;
            }
            let foot = if stance { "stance foot" } else { "swing foot" };
            for sign in [1.0, -1.0] {
                let pressed: f64 = normals.iter().map(|index| x[*index]).sum();
                let sheared: f64 = along.iter().map(|index| x[*index]).sum();
                let value = self.limits.friction * pressed + sign * sheared;
                sink.row(value, POSITIVE, || label(foot));
                normals.iter().for_each(|index| sink.entry(*index, self.limits.friction));
                along.iter().for_each(|index| sink.entry(*index, sign));
            }
        }
    }

    /// Contacts that are open stay above the ground.
    fn clearance_rows(&self, point: &Point, x: &[f64], sink: &mut Sink<'_>) {
        let (n, mechanics) = (self.layout.n, &self.mechanics);
        let number = self.layout.first[point.phase] + point.index;
        for clearance in &self.clearances[number] {
            let row = 3 * clearance.contact + Axis::Up.index();
            let duration = self.layout.durations + point.phase;
            let speed = if clearance.descends { self.limits.touchdown_m_s } else { 0.0 };
            let descent = speed * (1.0 - point.fraction);
            let least = clearance.height_m + descent * x[duration];
            let height = mechanics.positions[row] - self.legs.ground_m - least;
            sink.row(height, POSITIVE, || Label {
                what: "clearance",
                part: self.contact_names[clearance.contact].clone(),
                phase: point.phase,
                fraction: point.fraction,
                size: self.units.length_m,
                unit: "m",
            });
            sink.entries(self.layout.motion(point, 0), &mechanics.jacobian[row * n..(row + 1) * n]);
            sink.entry(duration, -descent);
        }
    }

    /// The gradient, by the variables of a point, of its constraints weighted with multipliers: the
    /// part of the Lagrangian that is curved.
    pub(super) fn weighted_gradient(
        &mut self,
        x: &[f64],
        point: &Point,
        multipliers: &[f64],
        gradient: &mut [f64],
    ) {
        let (n, phase) = (self.layout.n, point.phase);
        self.weigh(x, point, true);
        gradient.fill(0.0);
        let mechanics = &self.mechanics;
        let mut add = |weight: f64, first: usize, values: &[f64]| {
            let places = gradient[first..first + values.len()].iter_mut();
            places.zip(values).for_each(|(entry, value)| *entry += weight * value);
        };
        for row in 0..n {
            let size = self.dynamics_size(row);
            let (weight, at) = (multipliers[row] / size, row * n..(row + 1) * n);
            add(weight, 0, &mechanics.residual_q[at.clone()]);
            add(weight, n, &mechanics.residual_qd[at.clone()]);
            add(weight, 2 * n, &mechanics.mass[at]);
            let forces = 3 * n + self.layout.drives;
            for (index, (contact, axis)) in self.layout.held[phase].iter().enumerate() {
                let w = mechanics.jacobian[(3 * contact + axis.index()) * n + row];
                add(weight, forces + index, &[-w]);
            }
        }
        let held = &self.layout.held[phase];
        for ((contact, axis), multiplier) in held.iter().zip(&multipliers[n..]) {
            let (row, weight) = (3 * contact + axis.index(), multiplier / self.legs.gravity);
            let at = row * n..(row + 1) * n;
            add(weight, 0, &mechanics.contacts().acceleration_dq[at.clone()]);
            add(weight, n, &mechanics.contacts().acceleration_dqd[at.clone()]);
            add(weight, 2 * n, &mechanics.jacobian[at]);
        }
        let number = self.layout.first[phase] + point.index;
        let clearances = &self.clearances[number];
        let last = multipliers.len() - clearances.len();
        for (clearance, multiplier) in clearances.iter().zip(&multipliers[last..]) {
            let row = 3 * clearance.contact + Axis::Up.index();
            let weight = multiplier / self.units.length_m;
            add(weight, 0, &mechanics.jacobian[row * n..(row + 1) * n]);
        }
    }

    fn dynamics_size(&self, row: usize) -> f64 {
        if self.slides[row] { self.units.force_n } else { self.units.moment_nm() }
    }
}
