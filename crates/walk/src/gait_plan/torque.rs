//! Torques that a planned motion needs, and ground forces that go with it.

use denavit_numerics::MinimumNorm;
use denavit_plants::Plant;

/// A robot at one time of its motion.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Moment {
    /// [rad, m], and derivatives by time.
    pub(super) q: Vec<f64>,
    pub(super) qd: Vec<f64>,
    pub(super) qdd: Vec<f64>,
}

/// Pivots below this part of the largest are zero.
const RANK: f64 = 1e-12;

/// Torques of all coordinates, zero for those of the base, which nothing drives: what drives it are
/// ground forces. Of these, those with the least sum of squares over `weights`, one for each contact
/// point; zero is a point that carries nothing.
pub(super) fn torques(plant: &mut dyn Plant, moment: &Moment, weights: &[f64]) -> Vec<f64> {
    let (n, rows) = (moment.q.len(), 3 * weights.len());
    let mut mass = vec![0.0; n * n];
    let mut needed = vec![0.0; n];
    let mut jacobian = vec![0.0; rows * n];
    plant.mass_matrix(&moment.q, &mut mass);
    plant.bias(&moment.q, &moment.qd, &mut needed);
    plant.contact_jacobian(&moment.q, &mut jacobian);
    for (row, torque) in needed.iter_mut().enumerate() {
        *torque += mass[row * n..(row + 1) * n]
            .iter()
            .zip(&moment.qdd)
            .map(|(entry, acceleration)| entry * acceleration)
            .sum::<f64>();
    }
    let joints = plant.model().joints.iter().enumerate();
    let base: Vec<usize> = joints.filter(|(_, joint)| !joint.drivable).map(|(at, _)| at).collect();
    let count = base.len();
    let mut square = vec![0.0; count * count];
    for (i, a) in base.iter().enumerate() {
        for (j, b) in base.iter().enumerate() {
            let entry =
                |row: usize| weights[row / 3] * jacobian[row * n + a] * jacobian[row * n + b];
            square[i * count + j] = (0..rows).map(entry).sum();
        }
    }
    let wanted: Vec<f64> = base.iter().map(|joint| needed[*joint]).collect();
    let mut multipliers = vec![0.0; count];
    let mut system = MinimumNorm::new();
    system.factor(&square, count, RANK);
    system.solve(&wanted, &mut multipliers);
    for row in 0..rows {
        let along = base.iter().zip(&multipliers);
        let force: f64 = along.map(|(joint, by)| jacobian[row * n + joint] * by).sum();
        let force = weights[row / 3] * force;
        for (torque, entry) in needed.iter_mut().zip(&jacobian[row * n..(row + 1) * n]) {
            *torque -= entry * force;
        }
    }
    base.iter().for_each(|joint| needed[*joint] = 0.0);
    needed
}
