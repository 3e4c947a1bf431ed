//! Directions of the coordinates that the motion does not depend on: along the ground, or the turn
//! of a body that nothing turns. Deviations along them stay for ever (their multipliers are 1).

use denavit_numerics::Random;
use denavit_plants::Plant;
use denavit_simulate::Control;
use nalgebra::DMatrix;

/// A direction that the motion does not depend on.
#[derive(Clone, Debug, PartialEq)]
pub struct Symmetry {
    /// Share of each coordinate.
    pub direction: Vec<f64>,
    /// Whether velocities along it do not matter either.
    pub is_free: bool,
}

const SAMPLES: u64 = 6;
/// Entries smaller than this are 0.
const ZERO: f64 = 1e-9;
/// How far a direction is followed [rad, m].
const SHIFT: f64 = 0.37;

/// All constant directions along which heights of contact points, mass matrix, bias and control
/// stay what they are, at random states from a fixed seed.
pub(super) fn find(plant: &mut dyn Plant, control: &Control) -> Vec<Symmetry> {
    if plant.guards() > 0 || plant.model().contacts.is_empty() {
        return Vec::new();
    }
    let n = plant.model().joints.len();
    let mut random = Random::new(7);
    let states: Vec<[Vec<f64>; 2]> = (0..SAMPLES)
        .map(|_| [0, 1].map(|_| (0..n).map(|_| random.uniform() - 0.5).collect()))
        .collect();
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (joint, law) in control.joints.iter().enumerate() {
        if law.reference.is_some() {
            rows.push((0..n).map(|column| f64::from(u8::from(column == joint))).collect());
        }
    }
    for [q, _] in &states {
        rows.extend(heights(plant, q));
    }
    let mut found = Vec::new();
    for direction in null_space(&rows, n) {
        if states.iter().all(|[q, qd]| stays(plant, [q, qd], &direction)) {
            let is_free = states.iter().all(|[q, qd]| is_free(plant, [q, qd], &direction));
            found.push(Symmetry { direction, is_free });
        }
    }
    found
}

/// Derivatives of the heights of contact points by the coordinates.
fn heights(plant: &mut dyn Plant, q: &[f64]) -> Vec<Vec<f64>> {
    let (n, points) = (q.len(), plant.model().contacts.len());
    let normal = plant.model().ground.normal;
    let mut jacobian = vec![0.0; 3 * points * n];
    plant.contact_jacobian(q, &mut jacobian);
    let row = |point: &[f64]| {
        (0..n).map(|j| (0..3).map(|axis| normal[axis] * point[axis * n + j]).sum()).collect()
    };
    jacobian.chunks_exact(3 * n).map(row).collect()
}

fn shifted(values: &[f64], direction: &[f64]) -> Vec<f64> {
    values.iter().zip(direction).map(|(value, share)| value + SHIFT * share).collect()
}

fn stays(plant: &mut dyn Plant, [q, qd]: [&[f64]; 2], direction: &[f64]) -> bool {
    let moved = shifted(q, direction);
    let [here, there] = [q, &moved].map(|q| {
        let (n, points) = (q.len(), plant.model().contacts.len());
        let mut values = vec![0.0; n * n + n + 3 * points * n];
        let (mass, rest) = values.split_at_mut(n * n);
        let (bias, jacobian) = rest.split_at_mut(n);
        plant.mass_matrix(q, mass);
        plant.bias(q, qd, bias);
        plant.contact_jacobian(q, jacobian);
        values
    });
    alike(&here, &there)
}

/// Nothing pushes along it, and nothing depends on the velocity along it.
fn is_free(plant: &mut dyn Plant, [q, qd]: [&[f64]; 2], direction: &[f64]) -> bool {
    let (n, points) = (q.len(), plant.model().contacts.len());
    let mut jacobian = vec![0.0; 3 * points * n];
    plant.contact_jacobian(q, &mut jacobian);
    let along = |row: &[f64]| row.iter().zip(direction).map(|(a, b)| a * b).sum::<f64>();
    if jacobian.chunks_exact(n).any(|row| along(row).abs() > ZERO) {
        return false;
    }
    let [mut here, mut there] = [vec![0.0; n], vec![0.0; n]];
    plant.bias(q, qd, &mut here);
    plant.bias(q, &shifted(qd, direction), &mut there);
    along(&here).abs() <= ZERO && alike(&here, &there)
}

fn alike(a: &[f64], b: &[f64]) -> bool {
    let size = a.iter().fold(1.0_f64, |most, entry| most.max(entry.abs()));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= ZERO * size)
}

/// A basis of the null space of some rows with as few entries as elimination leaves; each has
/// length 1.
fn null_space(rows: &[Vec<f64>], n: usize) -> Vec<Vec<f64>> {
    let mut matrix = DMatrix::from_fn(rows.len(), n, |row, column| rows[row][column]);
    let mut pivots: Vec<usize> = Vec::new();
    for column in 0..n {
        let top = pivots.len();
        let below = (top..matrix.nrows())
            .max_by(|a, b| matrix[(*a, column)].abs().total_cmp(&matrix[(*b, column)].abs()));
        let Some(row) = below.filter(|row| matrix[(*row, column)].abs() > ZERO) else { continue };
        matrix.swap_rows(top, row);
        let pivot = matrix[(top, column)];
        matrix.row_mut(top).scale_mut(1.0 / pivot);
        let line = matrix.row(top).into_owned();
        for other in (0..matrix.nrows()).filter(|other| *other != top) {
            let factor = matrix[(other, column)];
            let mut row = matrix.row_mut(other);
            row -= factor * &line;
        }
        pivots.push(column);
    }
    let free = (0..n).filter(|column| !pivots.contains(column));
    free.map(|column| {
        let mut vector = vec![0.0; n];
        vector[column] = 1.0;
        for (row, &pivot) in pivots.iter().enumerate() {
            vector[pivot] = -matrix[(row, column)];
        }
        let length = vector.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
        vector.into_iter().map(|entry| entry / length).collect()
    })
    .collect()
}
