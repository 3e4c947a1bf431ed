//! Torques of a planned motion: inverse dynamics with forces of the ground.
//!
//! D q'' + bias = B tau + J^T F. The rows of the base, which has no motors, say what the forces F
//! of the points that stand must come to. Of one sole they follow from that. Two soles have more
//! of them: the least in the sense of squares, so that all points carry alike. A point that would
//! pull is left out.

use crate::gait_plan::Walker;
use denavit_plants::Plant;
use nalgebra::{DMatrix, DVector};

/// One force that may act: its row of the contact Jacobian, and whether it must not pull.
struct Push {
    row: usize,
    pushes: bool,
}

/// Against singular sums of forces: this share of their largest entry.
const REGULAR: f64 = 1e-9;

/// Torques on all coordinates, those of the base 0, for positions, velocities and accelerations
/// [N m, N]; none if they are not finite.
pub(super) fn torques(
    plant: &mut dyn Plant,
    walker: &Walker,
    standing: [bool; 2],
    [q, qd, qdd]: [&[f64]; 3],
) -> Option<Vec<f64>> {
    let (n, points) = (q.len(), plant.model().contacts.len());
    let mut mass = vec![0.0; n * n];
    plant.mass_matrix(q, &mut mass);
    let mut needed = vec![0.0; n];
    plant.bias(q, qd, &mut needed);
    for (entry, row) in needed.iter_mut().zip(mass.chunks_exact(n)) {
        *entry += row.iter().zip(qdd).map(|(d, a)| d * a).sum::<f64>();
    }
    let mut jacobian = vec![0.0; 3 * points * n];
    plant.contact_jacobian(q, &mut jacobian);
    let base: Vec<usize> = (0..n).filter(|joint| !plant.model().joints[*joint].drivable).collect();
    let feet = (0..2).filter(|side| standing[*side]).map(|side| walker.feet[side]);
    let mut pushes = Vec::new();
    for foot in feet {
        for point in [foot.heel, foot.toe] {
            pushes.push(Push { row: 3 * point, pushes: false });
            pushes.push(Push { row: 3 * point + 2, pushes: true });
        }
    }
    let forces = loop {
        let forces = least_forces(&jacobian, n, &base, &needed, &pushes)?;
        let pulls = (0..pushes.len()).filter(|index| pushes[*index].pushes && forces[*index] < 0.0);
        match pulls.min_by(|a, b| forces[*a].total_cmp(&forces[*b])) {
            Some(most) => drop(pushes.remove(most)),
            None => break forces,
        }
    };
    for (push, force) in pushes.iter().zip(forces.iter()) {
        let row = &jacobian[push.row * n..(push.row + 1) * n];
        needed.iter_mut().zip(row).for_each(|(entry, column)| *entry -= column * force);
    }
    base.iter().for_each(|joint| needed[*joint] = 0.0);
    needed.iter().all(|torque| torque.is_finite()).then_some(needed)
}

/// The least forces that give the base what it needs.
fn least_forces(
    jacobian: &[f64],
    n: usize,
    base: &[usize],
    needed: &[f64],
    pushes: &[Push],
) -> Option<DVector<f64>> {
    let columns =
        DMatrix::from_fn(base.len(), pushes.len(), |i, j| jacobian[pushes[j].row * n + base[i]]);
    let mut sums = &columns * columns.transpose();
    let scale = REGULAR * sums.amax();
    for index in 0..base.len() {
        sums[(index, index)] += scale;
    }
    let right = DVector::from_iterator(base.len(), base.iter().map(|joint| needed[*joint]));
    let multipliers = sums.cholesky()?.solve(&right);
    Some(columns.transpose() * multipliers)
}
