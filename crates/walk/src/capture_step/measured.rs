//! What the controller measures: the state, as places and velocities of what it plans.

use super::pendulum::Pendulum;
use crate::fading::Moving;
use crate::gait_plan::Walker;
use denavit_plants::Plant;
use denavit_simulate::Sensed;

/// Where everything is that is planned.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measured {
    pub(super) t_s: f64,
    pub(super) q: Vec<f64>,
    pub(super) qd: Vec<f64>,
    /// Centre of mass: along x, above the ground.
    pub(super) center: [Moving; 2],
    /// Pitch of the torso.
    pub(super) pitch: Moving,
    /// Right and left foot: ankle along x, height of the sole below it.
    pub(super) feet: [[Moving; 2]; 2],
    /// Whether a point of each foot is closed.
    pub(super) touches: [bool; 2],
}

impl Measured {
    pub(super) fn of(plant: &mut dyn Plant, walker: &Walker, sensed: &Sensed<'_>) -> Self {
        let (n, points) = (sensed.q.len(), plant.model().contacts.len());
        let mut positions = vec![0.0; 3 * points];
        plant.contact_positions(sensed.q, &mut positions);
        let mut jacobian = vec![0.0; 3 * points * n];
        plant.contact_jacobian(sensed.q, &mut jacobian);
        let center = plant.center_of_mass(sensed.q);
        let mut center_rows = vec![0.0; 3 * n];
        plant.center_of_mass_jacobian(sensed.q, &mut center_rows);
        let along = |rows: &[f64], row: usize| -> f64 {
            rows[row * n..(row + 1) * n].iter().zip(sensed.qd).map(|(a, b)| a * b).sum()
        };
        let ground = plant.model().ground;
        let origin_m = ground.point[2];
        let feet = walker.feet.map(|foot| {
            let share = foot.heel_to_ankle_m / (foot.heel_to_ankle_m + foot.ankle_to_toe_m);
            [0, 2].map(|axis| {
                let [heel, toe] = [foot.heel, foot.toe].map(|point| 3 * point + axis);
                let between = |a: f64, b: f64| a + share * (b - a);
                let level = if axis == 2 { origin_m } else { 0.0 };
                Moving {
                    value: between(positions[heel], positions[toe]) - level,
                    rate: between(along(&jacobian, heel), along(&jacobian, toe)),
                }
            })
        });
        let pitch = walker.pitch();
        Self {
            t_s: sensed.t_s,
            q: sensed.q.to_vec(),
            qd: sensed.qd.to_vec(),
            center: [
                Moving { value: center[0], rate: along(&center_rows, 0) },
                Moving { value: center[2] - origin_m, rate: along(&center_rows, 2) },
            ],
            pitch: Moving { value: sensed.q[pitch], rate: sensed.qd[pitch] },
            feet,
            touches: walker.feet.map(|foot| {
                sensed.closed.contains(&foot.heel) || sensed.closed.contains(&foot.toe)
            }),
        }
    }

    /// The pendulum that it is.
    pub(super) fn pendulum(&self, omega: f64) -> Pendulum {
        let Moving { value, rate } = self.center[0];
        Pendulum { center_m: value, capture_m: value + rate / omega }
    }

    /// Places of the ankles along x \[m\].
    pub(super) fn ankles_m(&self) -> [f64; 2] {
        self.feet.map(|foot| foot[0].value)
    }
}
