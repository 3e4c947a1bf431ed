//! A foot that stands flat: the base follows from the joints.

use super::legs::Legs;
use super::phases::{Axis, Phase};
use super::planned::PlannedStep;
use denavit_numerics::MinimumNorm;
use denavit_plants::Plant;

/// The stance foot flat on the ground, its held point at x = 0.
#[derive(Clone, Debug)]
pub(super) struct StanceFoot {
    legs: Legs,
    /// Conditions on its contact points.
    held: Vec<(usize, Axis)>,
    /// Coordinates of the base.
    base: Vec<usize>,
    system: MinimumNorm,
}

/// Newton's method ends when places are as exact as this \[m\].
const EXACT_M: f64 = 1e-14;

impl StanceFoot {
    /// That of the phase in the middle of the swing.
    pub(super) fn at_mid_swing(step: &PlannedStep) -> Self {
        let legs = step.legs.clone();
        let closed = &step.phases[step.mid_swing().0].closed;
        let held = Phase::new("", closed, 1.0).held().into_iter();
        let held = held.map(|(role, axis)| (legs.contact(role), axis)).collect();
        let base = (0..legs.coordinates).filter(|index| !legs.driven.contains(index)).collect();
        Self { legs, held, base, system: MinimumNorm::new() }
    }

    /// Gives the base the position that the joints ask for.
    pub(super) fn hold_positions(&mut self, plant: &mut dyn Plant, q: &mut [f64]) {
        let n = q.len();
        let stance = self.legs.stance;
        // a flat foot: the angles from the world to it add up to nothing
        q[self.legs.pitch] = -(q[stance.hip] + q[stance.knee] + q[stance.ankle]);
        let contacts = plant.model().contacts.len();
        let (mut places, mut rows) = (vec![0.0; 3 * contacts], vec![0.0; 3 * contacts * n]);
        for _ in 0..8 {
            plant.contact_positions(q, &mut places);
            plant.contact_jacobian(q, &mut rows);
            let error = |(contact, axis): &(usize, Axis)| {
                let target = if *axis == Axis::Up { self.legs.ground_m } else { 0.0 };
                target - places[3 * contact + axis.index()]
            };
            let errors: Vec<f64> = self.held.iter().map(error).collect();
            if errors.iter().all(|error| error.abs() < EXACT_M) {
                break;
            }
            self.move_base(&rows, &errors, q);
        }
    }

    /// Gives the base the velocity that those of the joints ask for.
    pub(super) fn hold_velocities(&mut self, plant: &mut dyn Plant, q: &[f64], qd: &mut [f64]) {
        let n = q.len();
        let mut rows = vec![0.0; 3 * plant.model().contacts.len() * n];
        plant.contact_jacobian(q, &mut rows);
        let speed = |(contact, axis): &(usize, Axis)| {
            let row = 3 * contact + axis.index();
            -(0..n).map(|k| rows[row * n + k] * qd[k]).sum::<f64>()
        };
        let speeds: Vec<f64> = self.held.iter().map(speed).collect();
        self.move_base(&rows, &speeds, qd);
    }

    /// Adds what the base must change by so that the held points change by `errors`.
    fn move_base(&mut self, rows: &[f64], errors: &[f64], values: &mut [f64]) {
        let n = values.len();
        let row = |(contact, axis): &(usize, Axis)| 3 * contact + axis.index();
        let entries = self
            .held
            .iter()
            .flat_map(|held| self.base.iter().map(move |b| rows[row(held) * n + b]));
        let matrix: Vec<f64> = entries.collect();
        self.system.factor(&matrix, self.base.len(), 1e-12);
        let mut change = vec![0.0; self.base.len()];
        self.system.solve(errors, &mut change);
        self.base.iter().zip(&change).for_each(|(index, change)| values[*index] += change);
    }
}
