//! Constraints between phases: positions go on, velocities go on or jump by an impact, and at the
//! end of the step the legs swap.

use super::layout::Point;
use super::mechanics::Moment;
use super::phases::{Axis, Transition};
use super::rows::{EQUAL, Label, POSITIVE, Sink};
use super::step::Step;

impl Step<'_> {
    /// All constraints of a transition.
    pub(super) fn transition_rows(&mut self, x: &[f64], number: usize, sink: &mut Sink<'_>) {
        let transition = self.layout.transitions[number].clone();
        let before = *self.layout.last_of(transition.from);
        let after = self.layout.points_of(transition.to)[0];
        self.continuity_rows(x, &before, &after, &transition, sink);
        if transition.is_impact() {
            self.impact_rows(x, &before, &after, number, sink);
            self.after_impact_rows(x, &after, &transition, sink);
            self.before_impact_rows(x, &before, &transition, sink);
        }
    }

    /// The coordinate of the phase before that goes on as coordinate `index`.
    fn source(&self, transition: &Transition, index: usize) -> usize {
        if transition.swaps { self.legs.mirror[index] } else { index }
    }

    fn transition_label(&self, transition: &Transition, what: &'static str) -> Label {
        Label {
            what,
            part: String::new(),
            phase: transition.to,
            fraction: 0.0,
            size: 1.0,
            unit: "",
        }
    }

    fn continuity_rows(
        &self,
        x: &[f64],
        before: &Point,
        after: &Point,
        transition: &Transition,
        sink: &mut Sink<'_>,
    ) {
        let derivatives = if transition.is_impact() { 0..1 } else { 0..2 };
        for derivative in derivatives {
            for index in 0..self.layout.n {
                let from = self.layout.motion(before, derivative) + self.source(transition, index);
                let to = self.layout.motion(after, derivative) + index;
                let moves_on = derivative == 0 && transition.swaps && index == self.legs.base_x;
                let shift = if moves_on { x[self.layout.length] } else { 0.0 };
                let label = || {
                    let (mut size, mut unit) = match self.slides[index] {
                        true => (self.units.length_m, "m"),
                        false => (1.0, "rad"),
                    };
                    if derivative == 1 {
                        size /= self.units.time_s;
                        unit = if self.slides[index] { "m/s" } else { "rad/s" };
                    }
                    let what = if transition.swaps { "periodicity" } else { "continuity" };
                    let part = self.names[index].clone();
                    Label { part, size, unit, ..self.transition_label(transition, what) }
                };
                sink.row(x[to] - x[from] + shift, EQUAL, label);
                sink.entry(to, 1.0);
                sink.entry(from, -1.0);
                if moves_on {
                    sink.entry(self.layout.length, 1.0);
                }
            }
        }
    }

    /// D (qd+ - qd-) = W P.
    fn impact_rows(
        &mut self,
        x: &[f64],
        before: &Point,
        after: &Point,
        number: usize,
        sink: &mut Sink<'_>,
    ) {
        let n = self.layout.n;
        let transition = self.layout.transitions[number].clone();
        let [q, to] = [0, 1].map(|derivative| self.layout.motion(after, derivative));
        let from = self.layout.motion(before, 1);
        let jump: Vec<f64> =
            (0..n).map(|i| x[to + i] - x[from + self.source(&transition, i)]).collect();
        let first = self.layout.impulses[number];
        let held = self.layout.held[transition.to].clone();
        let impulses = self.spread(transition.to, &x[first..first + held.len()]);
        let (still, none) = (vec![0.0; n], vec![0.0; 3 * self.contacts]);
        let at = Moment { q: &x[q..q + n], qd: &still, qdd: &jump, forces: &impulses };
        let resting = Moment { qdd: &still, forces: &none, ..at };
        // gravity has no impulse: what it adds is taken off again
        self.mechanics.differentiate(self.plant, resting);
        let gravity = (self.mechanics.residual.clone(), self.mechanics.residual_q.clone());
        self.mechanics.differentiate(self.plant, at);
        let mechanics = &self.mechanics;
        for row in 0..n {
            let label = || {
                // a foot has little inertia: its row counts by the velocity that it means
                let size = self.inertias[row] * self.units.speed_m_s();
                let unit = if self.slides[row] { "N s" } else { "N m s" };
                let part = self.names[row].clone();
                Label { part, size, unit, ..self.transition_label(&transition, "impact") }
            };
            sink.row(mechanics.residual[row] - gravity.0[row], EQUAL, label);
            for column in 0..n {
                let place = row * n + column;
                sink.entry(q + column, mechanics.residual_q[place] - gravity.1[place]);
                sink.entry(to + column, mechanics.mass[place]);
                let source = self.source(&transition, column);
                sink.entry(from + source, -mechanics.mass[place]);
            }
            for (index, (contact, axis)) in held.iter().enumerate() {
                let w = mechanics.jacobian[(3 * contact + axis.index()) * n + row];
                sink.entry(first + index, -w);
            }
        }
        let size = self.impulse_ns;
        let label = |part: &str| Label {
            part: part.to_owned(),
            size,
            unit: "N s",
            ..self.transition_label(&transition, "friction cone of an impact")
        };
        self.cones(transition.to, first, x, sink, &label);
    }

    /// After an impact closed contacts are at rest, those that close are on the ground, and those
    /// that open rise.
    fn after_impact_rows(
        &mut self,
        x: &[f64],
        after: &Point,
        transition: &Transition,
        sink: &mut Sink<'_>,
    ) {
        let n = self.layout.n;
        let [q, qd] = [0, 1].map(|derivative| self.layout.motion(after, derivative));
        self.weigh_velocity(x, after);
        let mechanics = &self.mechanics;
        let label = |what, contact: usize, size, unit| Label {
            part: self.contact_names[contact].clone(),
            size,
            unit,
            ..self.transition_label(transition, what)
        };
        let speed = self.units.speed_m_s();
        for (contact, axis) in &self.layout.held[transition.to] {
            let row = 3 * contact + axis.index();
            let what = "velocity of a closed contact";
            sink.row(mechanics.velocity[row], EQUAL, || label(what, *contact, speed, "m/s"));
            sink.entries(q, &mechanics.contacts().velocity_dq[row * n..(row + 1) * n]);
            sink.entries(qd, &mechanics.jacobian[row * n..(row + 1) * n]);
        }
        for role in &transition.closing {
            let contact = self.legs.contact(*role);
            let row = 3 * contact + Axis::Up.index();
            let height = mechanics.positions[row] - self.legs.ground_m;
            let what = "height of a contact that closes";
            sink.row(height, EQUAL, || label(what, contact, self.units.length_m, "m"));
            sink.entries(q, &mechanics.jacobian[row * n..(row + 1) * n]);
        }
        for role in &transition.opening {
            let contact = self.legs.contact(*role);
            let row = 3 * contact + Axis::Up.index();
            let what = "velocity of a contact that opens";
            let range = POSITIVE;
            sink.row(mechanics.velocity[row], range, || label(what, contact, speed, "m/s"));
            sink.entries(q, &mechanics.contacts().velocity_dq[row * n..(row + 1) * n]);
            sink.entries(qd, &mechanics.jacobian[row * n..(row + 1) * n]);
        }
    }

    /// Contacts that close come down, and the thigh swings as it may.
    fn before_impact_rows(
        &mut self,
        x: &[f64],
        before: &Point,
        transition: &Transition,
        sink: &mut Sink<'_>,
    ) {
        let n = self.layout.n;
        let [q, qd] = [0, 1].map(|derivative| self.layout.motion(before, derivative));
        self.weigh_velocity(x, before);
        let mechanics = &self.mechanics;
        for role in &transition.closing {
            let source = if transition.swaps { role.swapped() } else { *role };
            let contact = self.legs.contact(source);
            let row = 3 * contact + Axis::Up.index();
            let label = || Label {
                part: self.contact_names[contact].clone(),
                size: self.units.speed_m_s(),
                unit: "m/s",
                phase: transition.from,
                fraction: 1.0,
                ..self.transition_label(transition, "velocity of touchdown")
            };
            sink.row(-mechanics.velocity[row] - self.limits.touchdown_m_s, POSITIVE, label);
            for column in 0..n {
                sink.entry(q + column, -mechanics.contacts().velocity_dq[row * n + column]);
                sink.entry(qd + column, -mechanics.jacobian[row * n + column]);
            }
        }
        if transition.swaps && self.limits.thigh_rad_s.is_finite() {
            let label = || Label {
                size: 1.0 / self.units.time_s,
                unit: "rad/s",
                phase: transition.from,
                fraction: 1.0,
                ..self.transition_label(transition, "angular velocity of the swing thigh")
            };
            // positive angles of hips swing thighs back, and lean the torso forward
            let (hip, pitch) = (qd + self.legs.swing.hip, qd + self.legs.pitch);
            let forwards = -x[hip] - x[pitch];
            sink.row(forwards, [self.limits.thigh_rad_s, f64::INFINITY], label);
            sink.entry(hip, -1.0);
            sink.entry(pitch, -1.0);
        }
    }

    /// Evaluates contact velocities at a point.
    fn weigh_velocity(&mut self, x: &[f64], point: &Point) {
        let n = self.layout.n;
        let [q, qd] = [0, 1].map(|derivative| self.layout.motion(point, derivative));
        let (still, none) = (vec![0.0; n], vec![0.0; 3 * self.contacts]);
        let moment = Moment { q: &x[q..q + n], qd: &x[qd..qd + n], qdd: &still, forces: &none };
        self.mechanics.differentiate(self.plant, moment);
    }
}
