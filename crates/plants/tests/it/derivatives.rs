//! Derivatives that plants have, against central differences of their own functions.

use denavit_codegen::effect;
use denavit_plants::{ContactDerivatives, Cradle, LoadedPlant, Plant, plant_of};

const STEP: f64 = 1e-5;

fn robot(name: &str) -> denavit_codegen::model::Robot {
    let path = format!("{}/../../models/{name}.json", env!("CARGO_MANIFEST_DIR"));
    effect::read_model(&path, &std::fs::read(&path).unwrap(), &[]).unwrap()
}

/// Generated and loaded plants: friction and springs, Coulomb friction, no contact points, sliding
/// joints, contact points on one and on several bodies.
fn plants() -> Vec<Box<dyn Plant>> {
    let mut plants: Vec<Box<dyn Plant>> = Vec::new();
    for name in ["tulip", "planar_biped", "puma560"] {
        plants.push(plant_of(&robot(name), &[]).unwrap());
        plants.push(Box::new(LoadedPlant::new(&robot(name), &[]).unwrap()));
    }
    for name in ["bodies/compass", "bodies/block", "stanford", "tulip_one_torso"] {
        plants.push(Box::new(LoadedPlant::new(&robot(name), &[]).unwrap()));
    }
    plants
}

/// Numbers between -0.8 and 0.8, the same every time.
fn numbers(count: usize, seed: usize) -> Vec<f64> {
    (0..count).map(|k| 0.8 * ((7 * k + 3 * seed) as f64 * 0.737 + 0.3).sin()).collect()
}

/// The derivative of `function` at `x` by central differences: a row for each value.
fn differences(x: &[f64], mut function: impl FnMut(&[f64]) -> Vec<f64>) -> Vec<f64> {
    let columns: Vec<Vec<f64>> = (0..x.len())
        .map(|j| {
            let mut at = |step: f64| {
                let mut moved = x.to_vec();
                moved[j] += step;
                function(&moved)
            };
            let (above, below) = (at(STEP), at(-STEP));
            above.iter().zip(below).map(|(a, b)| (a - b) / (2.0 * STEP)).collect()
        })
        .collect();
    let rows = columns.first().map_or(0, Vec::len);
    (0..rows).flat_map(|row| columns.iter().map(move |column| column[row])).collect()
}

#[track_caller]
fn close(name: &str, found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{name}");
    let scale = expected.iter().fold(1.0_f64, |largest, x| largest.max(x.abs()));
    for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!((found - expected).abs() < 2e-7 * scale, "{name} {k}: {found} {expected}");
    }
}

fn product(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    let row = |row: &[f64]| row.iter().zip(vector).map(|(a, b)| a * b).sum();
    matrix.chunks(vector.len()).map(row).collect()
}

fn sum(mut a: Vec<f64>, b: &[f64]) -> Vec<f64> {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
    a
}

/// D qdd + bias.
fn torques(plant: &mut dyn Plant, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<f64> {
    let n = q.len();
    let (mut mass, mut bias) = (vec![0.0; n * n], vec![0.0; n]);
    plant.mass_matrix(q, &mut mass);
    plant.bias(q, qd, &mut bias);
    sum(product(&mass, qdd), &bias)
}

/// W^T.
fn jacobian(plant: &mut dyn Plant, q: &[f64]) -> Vec<f64> {
    let mut jacobian = vec![0.0; 3 * plant.model().contacts.len() * q.len()];
    plant.contact_jacobian(q, &mut jacobian);
    jacobian
}

/// W^T qdd + (d/dt W^T) qd.
fn accelerations(plant: &mut dyn Plant, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<f64> {
    let mut bias = vec![0.0; 3 * plant.model().contacts.len()];
    plant.contact_bias(q, qd, &mut bias);
    sum(product(&jacobian(plant, q), qdd), &bias)
}

#[test]
fn derivatives_of_inverse_dynamics_are_those_of_mass_matrix_and_bias() {
    for mut plant in plants() {
        let plant = &mut *plant;
        let (name, n) = (plant.model().name.clone(), plant.model().joints.len());
        let [q, qd, qdd] = [1, 2, 3].map(|seed| numbers(n, seed));
        let (mut by_position, mut by_velocity) = (vec![0.0; n * n], vec![0.0; n * n]);
        assert!(plant.inverse_dynamics_derivatives(
            &q,
            &qd,
            &qdd,
            &mut by_position,
            &mut by_velocity
        ));
        close(&name, &by_position, &differences(&q, |q| torques(plant, q, &qd, &qdd)));
        close(&name, &by_velocity, &differences(&qd, |qd| torques(plant, &q, qd, &qdd)));
    }
}

#[test]
fn contact_derivatives_are_those_of_jacobian_and_bias() {
    for mut plant in plants() {
        let plant = &mut *plant;
        let (name, n) = (plant.model().name.clone(), plant.model().joints.len());
        let [q, qd, qdd] = [1, 2, 3].map(|seed| numbers(n, seed));
        let f = numbers(3 * plant.model().contacts.len(), 4);
        let mut found = ContactDerivatives::new(plant.model());
        found.torque_dq.fill(f64::NAN);
        assert!(plant.contact_derivatives(&q, &qd, &qdd, &f, &mut found));
        let velocity = |plant: &mut dyn Plant, q: &[f64]| product(&jacobian(plant, q), &qd);
        close(&name, &found.velocity_dq, &differences(&q, |q| velocity(plant, q)));
        let by_q = differences(&q, |q| accelerations(plant, q, &qd, &qdd));
        close(&name, &found.acceleration_dq, &by_q);
        let by_qd = differences(&qd, |qd| accelerations(plant, &q, qd, &qdd));
        close(&name, &found.acceleration_dqd, &by_qd);
        let torque = |plant: &mut dyn Plant, q: &[f64]| {
            let rows = jacobian(plant, q);
            let column = |j: usize| f.iter().enumerate().map(|(k, f)| rows[k * n + j] * f).sum();
            (0..n).map(column).collect::<Vec<f64>>()
        };
        close(&name, &found.torque_dq, &differences(&q, |q| torque(plant, q)));
    }
}

#[test]
fn plants_written_by_hand_say_that_they_have_none() {
    let mut cradle = Cradle::new(3);
    let n = cradle.model().joints.len();
    let zeros = vec![0.0; n];
    let mut rows = [vec![1.0; n * n], vec![2.0; n * n]];
    let [by_position, by_velocity] = &mut rows;
    assert!(!cradle.inverse_dynamics_derivatives(&zeros, &zeros, &zeros, by_position, by_velocity));
    assert_eq!(rows, [vec![1.0; n * n], vec![2.0; n * n]]);
}
