//! The state, as places of what is planned.

use super::pendulum::Pendulum;
use crate::gait_plan::{Biped, SolePlace};
use denavit_plants::Plant;
use denavit_simulate::Sensed;

/// Where everything is that is planned.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measured {
    pub(super) t_s: f64,
    pub(super) q: Vec<f64>,
    pub(super) qd: Vec<f64>,
    pub(super) pendulum: Pendulum,
    /// Right and left.
    pub(super) soles: [SolePlace; 2],
    /// Whether a point of each foot is closed.
    pub(super) touches: [bool; 2],
}

impl Measured {
    pub(super) fn of(
        plant: &mut dyn Plant,
        biped: &Biped,
        omega: f64,
        sensed: &Sensed<'_>,
    ) -> Self {
        let (n, points) = (sensed.q.len(), plant.model().contacts.len());
        let mut positions = vec![0.0; 3 * points];
        plant.contact_positions(sensed.q, &mut positions);
        let mut rows = vec![0.0; 3 * n];
        plant.center_of_mass_jacobian(sensed.q, &mut rows);
        let [x, y, _] = plant.center_of_mass(sensed.q);
        let speed = |axis: usize| -> f64 {
            rows[axis * n..(axis + 1) * n].iter().zip(sensed.qd).map(|(a, b)| a * b).sum()
        };
        let center_m = [x, y];
        let touches = |side: usize| {
            biped.soles[side].points.iter().any(|point| sensed.closed.contains(point))
        };
        Self {
            t_s: sensed.t_s,
            q: sensed.q.to_vec(),
            qd: sensed.qd.to_vec(),
            pendulum: Pendulum {
                center_m,
                divergent_m: [0, 1].map(|axis| center_m[axis] + speed(axis) / omega),
            },
            soles: [0, 1].map(|side| biped.place(side, &positions)),
            touches: [0, 1].map(touches),
        }
    }
}
