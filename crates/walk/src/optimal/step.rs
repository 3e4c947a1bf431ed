//! A planned step as a nonlinear program.

use super::cost::CostSettings;
use super::layout::{Layout, Units};
use super::legs::{Legs, Role};
use super::limits::StepLimits;
use super::mechanics::Mechanics;
use super::phases::{Axis, Phase, Transition};
use super::point_rows::Clearance;
use super::program::{Linearisation, Program};
use super::rows::{Label, Shape, Sink};
use denavit_plants::Plant;

/// A step of a walker, to be planned.
pub(super) struct Step<'p> {
    pub(super) plant: &'p mut dyn Plant,
    pub(super) legs: Legs,
    pub(super) units: Units,
    pub(super) layout: Layout,
    pub(super) limits: StepLimits,
    pub(super) cost_settings: CostSettings,
    /// Which coordinates slide, and all names.
    pub(super) slides: Vec<bool>,
    pub(super) names: Vec<String>,
    pub(super) contact_names: Vec<String>,
    pub(super) contacts: usize,
    /// Of each coordinate with straight legs, over the length that it moves by: [kg], [kg m].
    pub(super) inertias: Vec<f64>,
    /// What stops a shin that moves at the unit of speed \[N s\].
    pub(super) impulse_ns: f64,
    /// Contacts that stay above the ground, for each point.
    pub(super) clearances: Vec<Vec<Clearance>>,
    pub(super) mechanics: Mechanics,
    shape: Shape,
    scales: Vec<f64>,
    bounds: Vec<[f64; 2]>,
    /// First constraint of each point, and the first one after all.
    firsts: Vec<usize>,
}

impl<'p> Step<'p> {
    pub(super) fn new(
        plant: &'p mut dyn Plant,
        legs: &Legs,
        phases: &[Phase],
        intervals: &[usize],
        limits: StepLimits,
        cost_settings: CostSettings,
    ) -> Self {
        let (units, layout) = (Units::of(legs), Layout::new(legs, phases, intervals));
        let joints = &plant.model().joints;
        let (slides, names): (Vec<bool>, Vec<String>) =
            joints.iter().map(|j| (j.slides, j.name.clone())).unzip();
        let contact_names: Vec<String> =
            plant.model().contacts.iter().map(|contact| contact.name.clone()).collect();
        let n = legs.coordinates;
        let mut mass = vec![0.0; n * n];
        plant.mass_matrix(&vec![0.0; n], &mut mass);
        let over = |row: usize| if slides[row] { 1.0 } else { units.length_m };
        let inertias: Vec<f64> = (0..n).map(|row| mass[row * (n + 1)] / over(row)).collect();
        let impulse_ns = inertias[legs.stance.knee] / units.length_m * units.speed_m_s();
        let scales = layout.scales(plant, units, impulse_ns);
        let clearances = clearances(legs, &layout, &limits);
        let mut step = Self {
            plant,
            legs: legs.clone(),
            units,
            limits,
            cost_settings,
            slides,
            names,
            contacts: contact_names.len(),
            inertias,
            impulse_ns,
            contact_names,
            clearances,
            mechanics: Mechanics::default(),
            shape: Shape::default(),
            scales,
            bounds: Vec::new(),
            firsts: Vec::new(),
            layout,
        };
        step.bounds = step.find_bounds();
        let start = vec![1.0; step.layout.variables];
        let (mut values, mut shape) = (Vec::new(), Shape::default());
        step.assemble(&start, Sink::new(&mut values, None, Some(&mut shape)));
        step.shape = shape;
        step
    }

    /// What each constraint says.
    pub(super) fn labels(&self) -> &[Label] {
        &self.shape.labels
    }

    fn assemble(&mut self, x: &[f64], mut sink: Sink<'_>) {
        self.firsts.clear();
        for number in 0..self.layout.points.len() {
            self.firsts.push(sink.values.len());
            let point = self.layout.points[number];
            self.point_rows(x, &point, &mut sink);
        }
        self.firsts.push(sink.values.len());
        for phase in 0..self.layout.phases.len() {
            for interval in 0..self.layout.intervals[phase] {
                self.interval_rows(x, phase, interval, &mut sink);
            }
        }
        for number in 0..self.layout.transitions.len() {
            self.transition_rows(x, number, &mut sink);
        }
        self.step_rows(x, &mut sink);
    }

    fn find_bounds(&self) -> Vec<[f64; 2]> {
        let (layout, limits, legs) = (&self.layout, &self.limits, &self.legs);
        let mut bounds = vec![[f64::NEG_INFINITY, f64::INFINITY]; layout.variables];
        for point in &layout.points {
            for (index, joint) in self.plant.model().joints.iter().enumerate() {
                let margin = limits.position_margin_rad;
                if let Some([low, high]) = joint.position_limits {
                    bounds[layout.motion(point, 0) + index] = [low + margin, high - margin];
                }
            }
            let lean = limits.lean_rad;
            bounds[layout.motion(point, 0) + legs.pitch] = [-lean, lean];
            if layout.phases[point.phase].is_in_flight(false) {
                let knee = &mut bounds[layout.motion(point, 0) + legs.stance.knee];
                knee[1] = knee[1].min(limits.stance_knee_rad.max(knee[0] + 1e-3));
            }
            for (drive, joint) in legs.driven.iter().enumerate() {
                let own = self.plant.model().joints[*joint].torque_limits;
                let most = limits.torque_nm.unwrap_or(f64::INFINITY);
                let [low, high] = own.unwrap_or([-most, most]);
                bounds[layout.torques(point) + drive] = [low.max(-most), high.min(most)];
            }
            for (index, (_, axis)) in layout.held[point.phase].iter().enumerate() {
                if *axis == Axis::Up {
                    let least = limits.contact_force * self.units.force_n;
                    bounds[layout.forces(point) + index] = [least, f64::INFINITY];
                }
            }
        }
        for phase in 0..layout.phases.len() {
            bounds[layout.durations + phase] = [limits.phase_s, f64::INFINITY];
        }
        for (number, transition) in layout.transitions.iter().enumerate() {
            if !transition.is_impact() {
                continue;
            }
            for (index, (_, axis)) in layout.held[transition.to].iter().enumerate() {
                if *axis == Axis::Up {
                    bounds[layout.impulses[number] + index] = [0.0, f64::INFINITY];
                }
            }
        }
        let shortest = 0.05 * self.units.length_m;
        let length = limits.step_length_m.map_or([shortest, f64::INFINITY], |l| [l, l]);
        bounds[layout.length] = length;
        bounds
    }

    /// Curvature of the constraints of each point in the Lagrangian, by differences of exact
    /// gradients, without its negative part.
    fn curvature(&mut self, x: &[f64], multipliers: &[f64], linear: &mut Linearisation) {
        let n = self.layout.n;
        for number in 0..self.layout.points.len() {
            let point = self.layout.points[number];
            let size = 3 * n + self.layout.drives + self.layout.held[point.phase].len();
            let first = self.firsts[number];
            let weights = &multipliers[first..self.firsts[number + 1]];
            let mut hessian = nalgebra::DMatrix::zeros(size, size);
            let mut moved = x.to_vec();
            let (mut plus, mut minus) = (vec![0.0; size], vec![0.0; size]);
            let curved = (0..3 * n).chain(3 * n + self.layout.drives..size);
            for column in curved {
                let at = point.start + column;
                let h = 1e-4 * self.scales[at];
                moved[at] = x[at] + h;
                self.weighted_gradient(&moved, &point, weights, &mut plus);
                moved[at] = x[at] - h;
                self.weighted_gradient(&moved, &point, weights, &mut minus);
                moved[at] = x[at];
                for row in 0..size {
                    hessian[(row, column)] = (plus[row] - minus[row]) / (2.0 * h)
                        * self.scales[at]
                        * self.scales[point.start + row];
                }
            }
            let symmetric = (&hessian + hessian.transpose()) * 0.5;
            let eigen = symmetric.symmetric_eigen();
            let positive = eigen.eigenvalues.map(|value| value.max(0.0));
            let projected = &eigen.eigenvectors
                * nalgebra::DMatrix::from_diagonal(&positive)
                * eigen.eigenvectors.transpose();
            for column in 0..size {
                for row in 0..=column {
                    let scale = self.scales[point.start + row] * self.scales[point.start + column];
                    let value = projected[(row, column)] / scale;
                    linear.hessian.add(point.start + row, point.start + column, value);
                }
            }
        }
    }
}

/// A small curvature in every variable, in scales, so that steps are unique.
const DAMPING: f64 = 1e-5;

impl Program for Step<'_> {
    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn ranges(&self) -> &[[f64; 2]] {
        &self.shape.ranges
    }

    fn evaluate(&mut self, x: &[f64], constraints: &mut Vec<f64>) -> f64 {
        self.assemble(x, Sink::new(constraints, None, None));
        self.cost(x, None)
    }

    fn linearise(&mut self, x: &[f64], multipliers: &[f64], linear: &mut Linearisation) {
        linear.clear(self.layout.variables);
        let mut values = Vec::new();
        self.assemble(x, Sink::new(&mut values, Some(&mut linear.jacobian), None));
        self.cost(x, Some(linear));
        if multipliers.iter().any(|multiplier| *multiplier != 0.0) {
            self.curvature(x, multipliers, linear);
        }
        for (index, scale) in self.scales.iter().enumerate() {
            linear.hessian.add(index, index, DAMPING / (scale * scale));
        }
    }
}

/// Contacts that stay above the ground, for each point but those where they may touch it.
fn clearances(legs: &Legs, layout: &Layout, limits: &StepLimits) -> Vec<Vec<Clearance>> {
    let flight = |point: usize| layout.phases[layout.points[point].phase].is_in_flight(false);
    let flown: Vec<usize> = (0..layout.points.len()).filter(|point| flight(*point)).collect();
    let (first, last) = match flown[..] {
        [first, .., last] => (first, last),
        _ => (0, 0),
    };
    let time = |point: usize| {
        let at = &layout.points[point];
        let before: f64 = layout.phases[..at.phase].iter().map(|phase| phase.share).sum();
        before + at.fraction * layout.phases[at.phase].share
    };
    let height = |point: usize| {
        if !flight(point) || last == first {
            return 0.0;
        }
        let share = (time(point) - time(first)) / (time(last) - time(first));
        let ramp = limits.clearance_ramp.max(1e-3);
        // a foot leaves the ground from rest, and comes down to it
        let rise = (share / ramp).powi(2);
        limits.clearance_m * rise.min((1.0 - share) / ramp).min(1.0)
    };
    let of = |point: usize| {
        let phase = layout.points[point].phase;
        let open = Role::ALL.into_iter().filter(|role| !layout.phases[phase].holds(*role));
        let clearance = |role: Role| Clearance {
            contact: legs.contact(role),
            height_m: if role.is_stance() { 0.0 } else { height(point) },
            descends: closes(layout, phase, role),
        };
        open.filter(|role| !touches(layout, point, *role)).map(clearance).collect()
    };
    (0..layout.points.len()).map(of).collect()
}

/// Whether an open contact closes at the end of a phase.
fn closes(layout: &Layout, phase: usize, role: Role) -> bool {
    layout.transitions.iter().any(|transition| {
        let after = if transition.swaps { role.swapped() } else { role };
        transition.from == phase && transition.closing.contains(&after)
    })
}

/// Whether an open contact is on the ground all the same: it has just opened, or is about to
/// close.
fn touches(layout: &Layout, point: usize, role: Role) -> bool {
    let at = &layout.points[point];
    let is_last = at.index == 2 * layout.intervals[at.phase];
    let opened = |transition: &Transition| {
        transition.to == at.phase && at.index == 0 && transition.opening.contains(&role)
    };
    layout.transitions.iter().any(opened) || (is_last && closes(layout, at.phase, role))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimal::CostKind;
    use crate::optimal::guess::Guess;
    use crate::optimal::phases::{Aspects, phases_of};
    use denavit_numerics::Random;

    fn with_step(kind: CostKind, check: impl FnOnce(&mut Step<'_>)) {
        let mut plant = denavit_plants::planar_biped(&[]).expect("a plant");
        let legs = Legs::of(plant.as_mut()).expect("a walker");
        let phases = phases_of(Aspects::default());
        let limits = StepLimits { thigh_rad_s: 0.1, ..StepLimits::default() };
        let costs = CostSettings {
            kind,
            rounding: 0.05,
            torque: 0.3,
            torque_rate: 1e-3,
            acceleration: 1e-5,
            impulse: 2.0,
        };
        let intervals = [2, 2, 3, 2];
        check(&mut Step::new(plant.as_mut(), &legs, &phases, &intervals, limits, costs));
    }

    /// A point away from the guess: nothing is 0 by chance.
    fn somewhere(step: &mut Step<'_>) -> Vec<f64> {
        let mut random = Random::new(7);
        let guess = step.guess(Guess::default());
        let moved = guess.iter().zip(step.scales());
        moved.map(|(x, scale)| x + 0.05 * scale * random.normal()).collect()
    }

    #[test]
    fn derivatives_of_all_constraints_and_of_both_costs_are_those_of_differences() {
        for kind in [CostKind::CostOfTransport, CostKind::TorqueSquared] {
            with_step(kind, |step| {
                let x = somewhere(step);
                let mut linear = Linearisation::default();
                let none = vec![0.0; step.ranges().len()];
                step.linearise(&x, &none, &mut linear);
                let (rows, columns) = (step.ranges().len(), x.len());
                let mut dense = vec![0.0; rows * columns];
                for (row, column, value) in &linear.jacobian.entries {
                    dense[row * columns + column] += value;
                }
                let (mut plus, mut minus) = (Vec::new(), Vec::new());
                for column in 0..columns {
                    let h = 1e-6 * step.scales()[column];
                    let mut moved = x.clone();
                    moved[column] += h;
                    let above = step.evaluate(&moved, &mut plus);
                    moved[column] -= 2.0 * h;
                    let below = step.evaluate(&moved, &mut minus);
                    let slope = (above - below) / (2.0 * h);
                    let size = step.scales()[column];
                    let error = (slope - linear.gradient[column]).abs() * size;
                    assert!(error < 1e-6, "cost by variable {column}: {error:e}");
                    for row in 0..rows {
                        let slope = (plus[row] - minus[row]) / (2.0 * h);
                        let error = (slope - dense[row * columns + column]).abs() * size;
                        let name = &step.labels()[row];
                        assert!(error < 3e-5, "{name:?} by variable {column}: {error:e}");
                    }
                }
            });
        }
    }

    #[test]
    fn weighted_gradients_are_those_of_the_jacobian() {
        with_step(CostKind::TorqueSquared, |step| {
            let x = somewhere(step);
            let mut linear = Linearisation::default();
            let none = vec![0.0; step.ranges().len()];
            step.linearise(&x, &none, &mut linear);
            let mut random = Random::new(3);
            for number in 0..step.layout.points.len() {
                let point = step.layout.points[number];
                let rows = step.firsts[number]..step.firsts[number + 1];
                let weights: Vec<f64> = rows.clone().map(|_| random.normal()).collect();
                let size =
                    3 * step.layout.n + step.layout.drives + step.layout.held[point.phase].len();
                let mut expected = vec![0.0; size];
                for (row, column, value) in &linear.jacobian.entries {
                    let own = (point.start..point.start + size).contains(column);
                    if rows.contains(row) && own {
                        expected[column - point.start] += weights[row - rows.start] * value;
                    }
                }
                let mut gradient = vec![0.0; size];
                step.weighted_gradient(&x, &point, &weights, &mut gradient);
                // what is linear has no curvature and is left out: torques, and friction cones
                let curved = 3 * step.layout.n;
                for (entry, expected) in gradient[..curved].iter().zip(&expected) {
                    let error = (entry - expected).abs();
                    assert!(error < 1e-9 * (1.0 + expected.abs()), "{error:e}");
                }
            }
        });
    }
}
