//! Torques that a planned motion needs, and ground forces that go with it.

use denavit_numerics::MinimumNorm;
use denavit_plants::Plant;

/// A robot at one time of its motion.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Moment {
    /// [rad, m], and derivatives by time.
    pub(crate) q: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    pub(crate) qdd: Vec<f64>,
}

/// Pivots below this part of the largest are zero.
const RANK: f64 = 1e-12;

/// Added for joints that nothing drives, whose torques may be off for that [m^2]: the forces on a
/// foot that stands alone are given by the base, and its joint turns a little.
const SLACK: f64 = 1e-6;

/// What carries a robot, and what drives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bearing<'a> {
    /// The share of each contact point in the load; zero is a point that carries nothing.
    pub(crate) weights: &'a [f64],
    /// Joints that nothing drives, besides those of the base.
    pub(crate) free: &'a [usize],
}

/// Torques of all coordinates, zero for those that nothing drives: what drives these are ground
/// forces, the base exactly, joints as nearly as can be. Of these forces, those with the least sum
/// of squares over the weights.
pub(crate) fn torques(plant: &mut dyn Plant, moment: &Moment, bearing: Bearing<'_>) -> Vec<f64> {
    let (n, rows) = (moment.q.len(), 3 * bearing.weights.len());
    let mut jacobian = vec![0.0; rows * n];
    plant.contact_jacobian(&moment.q, &mut jacobian);
    let mut needed = without_ground(plant, moment);
    let joints = plant.model().joints.iter().enumerate();
    let mut undriven: Vec<usize> =
        joints.filter(|(_, joint)| !joint.drivable).map(|(at, _)| at).collect();
    let exact = undriven.len();
    undriven.extend(bearing.free);
    let count = undriven.len();
    let mut square = vec![0.0; count * count];
    for (i, a) in undriven.iter().enumerate() {
        for (j, b) in undriven.iter().enumerate() {
            let entry = |row: usize| {
                bearing.weights[row / 3] * jacobian[row * n + a] * jacobian[row * n + b]
            };
            square[i * count + j] = (0..rows).map(entry).sum();
        }
        if i >= exact {
            square[i * count + i] += SLACK;
        }
    }
    let wanted: Vec<f64> = undriven.iter().map(|joint| needed[*joint]).collect();
    let mut multipliers = vec![0.0; count];
    let mut system = MinimumNorm::new();
    system.factor(&square, count, RANK);
    system.solve(&wanted, &mut multipliers);
    for row in 0..rows {
        let along = undriven.iter().zip(&multipliers);
        let force: f64 = along.map(|(joint, by)| jacobian[row * n + joint] * by).sum();
        let force = bearing.weights[row / 3] * force;
        for (torque, entry) in needed.iter_mut().zip(&jacobian[row * n..(row + 1) * n]) {
            *torque -= entry * force;
        }
    }
    undriven.iter().for_each(|joint| needed[*joint] = 0.0);
    needed
}

/// D qdd + bias: the torques that the motion would need in free flight.
fn without_ground(plant: &mut dyn Plant, moment: &Moment) -> Vec<f64> {
    let n = moment.q.len();
    let mut mass = vec![0.0; n * n];
    let mut needed = vec![0.0; n];
    plant.mass_matrix(&moment.q, &mut mass);
    plant.bias(&moment.q, &moment.qd, &mut needed);
    for (row, torque) in mass.chunks_exact(n).zip(&mut needed) {
        let along = row.iter().zip(&moment.qdd);
        *torque += along.map(|(entry, acceleration)| entry * acceleration).sum::<f64>();
    }
    needed
}
