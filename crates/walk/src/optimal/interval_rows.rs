//! Collocation over one interval, and conditions on the whole step.
//!
//! Hermite-Simpson: positions and velocities are cubic over an interval with the slopes that
//! velocities and accelerations give at its ends and, by Simpson's rule, in its middle. The error
//! is of fourth order.

use super::phases::Axis;
use super::rows::{EQUAL, Label, Sink};
use super::step::Step;

impl Step<'_> {
    /// The middle lies on the cubic of the ends, and the ends differ by Simpson's rule.
    pub(super) fn interval_rows(
        &self,
        x: &[f64],
        phase: usize,
        interval: usize,
        sink: &mut Sink<'_>,
    ) {
        let layout = &self.layout;
        let points = &layout.points_of(phase)[2 * interval..2 * interval + 3];
        let duration = layout.durations + phase;
        let share = 1.0 / layout.intervals[phase] as f64;
        let h = x[duration] * share;
        for derivative in 0..2 {
            for index in 0..layout.n {
                let values =
                    [0, 1, 2].map(|p: usize| layout.motion(&points[p], derivative) + index);
                let slopes = values.map(|value| value + layout.n);
                let label = || self.collocation_label(index, derivative, phase, points[1].fraction);
                let [from, middle, to] = values.map(|at| x[at]);
                let [s0, s1, s2] = slopes.map(|at| x[at]);
                let rise = (s0 + 4.0 * s1 + s2) / 6.0;
                sink.row(to - from - h * rise, EQUAL, label);
                sink.entry(values[0], -1.0);
                sink.entry(values[2], 1.0);
                for (slope, weight) in slopes.iter().zip([1.0, 4.0, 1.0]) {
                    sink.entry(*slope, -h * weight / 6.0);
                }
                sink.entry(duration, -share * rise);
                let bend = (s0 - s2) / 8.0;
                sink.row(middle - (from + to) / 2.0 - h * bend, EQUAL, label);
                sink.entry(values[0], -0.5);
                sink.entry(values[1], 1.0);
                sink.entry(values[2], -0.5);
                sink.entry(slopes[0], -h / 8.0);
                sink.entry(slopes[2], h / 8.0);
                sink.entry(duration, -share * bend);
            }
        }
    }

    fn collocation_label(
        &self,
        index: usize,
        derivative: usize,
        phase: usize,
        fraction: f64,
    ) -> Label {
        let length = if self.slides[index] { self.units.length_m } else { 1.0 };
        let (what, size, unit) = match (derivative, self.slides[index]) {
            (0, true) => ("collocation of a position", length, "m"),
            (0, false) => ("collocation of a position", length, "rad"),
            (_, true) => ("collocation of a velocity", length / self.units.time_s, "m/s"),
            (_, false) => ("collocation of a velocity", length / self.units.time_s, "rad/s"),
        };
        Label { what, part: self.names[index].clone(), phase, fraction, size, unit }
    }

    /// Speed, length, and where the stance foot stands.
    pub(super) fn step_rows(&mut self, x: &[f64], sink: &mut Sink<'_>) {
        let label = |what, part: &str| Label {
            what,
            part: part.to_owned(),
            phase: 0,
            fraction: 0.0,
            size: self.units.length_m,
            unit: "m",
        };
        let durations = self.layout.durations..self.layout.durations + self.layout.phases.len();
        let (speed, length) = (self.limits.speed_m_s, self.layout.length);
        let period: f64 = x[durations.clone()].iter().sum();
        sink.row(x[length] - speed * period, EQUAL, || label("walking speed", ""));
        sink.entry(length, 1.0);
        durations.for_each(|duration| sink.entry(duration, -speed));
        // the first contact that is held along the ground stands at x = 0
        let Some((contact, _)) = self.layout.held[0].iter().find(|held| held.1 == Axis::Along)
        else {
            return;
        };
        let (n, first) = (self.layout.n, self.layout.points[0].start);
        let q = &x[first..first + n];
        let (mut places, mut rows) =
            (vec![0.0; 3 * self.contacts], vec![0.0; 3 * self.contacts * n]);
        self.plant.contact_positions(q, &mut places);
        self.plant.contact_jacobian(q, &mut rows);
        let name = &self.contact_names[*contact];
        sink.row(places[3 * contact], EQUAL, || label("place of the stance foot", name));
        sink.entries(first, &rows[3 * contact * n..(3 * contact + 1) * n]);
    }
}
