//! Functions for walking of generated and loaded plants, against the plants' other functions.

use crate::derivatives::{differences, numbers, robot};
use denavit_plants::{Cradle, LoadedPlant, Plant, plant_of};
use serde_json::Value;
use std::path::Path;

fn plants(names: &[&str]) -> Vec<Box<dyn Plant>> {
    let mut plants: Vec<Box<dyn Plant>> = Vec::new();
    for name in names {
        plants.push(plant_of(&robot(name), &[]).unwrap());
        plants.push(Box::new(LoadedPlant::new(&robot(name), &[]).unwrap()));
    }
    plants
}

#[track_caller]
fn close(name: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{name}");
    let scale = expected.iter().fold(1.0_f64, |largest, x| largest.max(x.abs()));
    for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!((found - expected).abs() < tolerance * scale, "{name} {k}: {found} {expected}");
    }
}

fn product(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    let row = |row: &[f64]| row.iter().zip(vector).map(|(a, b)| a * b).sum();
    matrix.chunks(vector.len()).map(row).collect()
}

#[test]
fn momentum_and_centre_of_mass_agree_with_the_plants_own() {
    for mut plant in plants(&["tulip", "planar_biped", "puma560", "bodies/compass"]) {
        let plant = &mut *plant;
        let (name, n) = (plant.model().name.clone(), plant.model().joints.len());
        let [q, qd] = [1, 2].map(|seed| numbers(n, seed));
        let mut matrix = vec![0.0; 6 * n];
        plant.walking().unwrap().centroidal_momentum_matrix(&q, &mut matrix);
        close(&name, &product(&matrix, &qd), &plant.momentum(&q, &qd), 1e-12);
        let mut jacobian = vec![0.0; 3 * n];
        plant.center_of_mass_jacobian(&q, &mut jacobian);
        let place = |plant: &mut dyn Plant, q: &[f64]| plant.center_of_mass(q).to_vec();
        close(&name, &jacobian, &differences(&q, |q| place(plant, q)), 2e-9);
        let slope = product(&differences(&q, |q| plant.momentum(q, &qd).to_vec()), &qd);
        let bias = plant.walking().unwrap().centroidal_momentum_bias(&q, &qd);
        close(&name, &bias, &slope, 2e-7);
        let mass = plant.model().mass_kg;
        let falling = plant.walking().unwrap().center_of_mass_bias(&q, &qd);
        let linear: Vec<f64> = falling.iter().map(|entry| mass * entry).collect();
        close(&name, &linear, &bias[..3], 1e-12);
    }
}

/// The body of a joint alone turns about its own centre of mass by L, and goes round that of all
/// with its momentum: L + (c_i - c) x p.
#[test]
fn angular_momenta_of_bodies_are_those_of_robots_without_the_others() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/tulip.json");
    let whole: Value = serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap();
    let mut tulip = plant_of(&robot("tulip"), &[]).unwrap();
    let n = tulip.model().joints.len();
    let [q, qd] = [1, 2].map(|seed| numbers(n, seed));
    let mut momenta = vec![0.0; 3 * n];
    tulip.walking().unwrap().angular_momenta(&q, &qd, &mut momenta);
    let center = tulip.center_of_mass(&q);
    for name in ["right_knee", "left_ankle_x", "left_hip_y"] {
        let mut alone = whole.clone();
        for link in alone["links"].as_array_mut().unwrap() {
            if link["name"] != name {
                link.as_object_mut().unwrap().remove("body");
            }
        }
        let alone = denavit_codegen::model::read("alone", alone.to_string().as_bytes()).unwrap();
        let mut alone = LoadedPlant::new(&alone, &[]).unwrap();
        let [px, py, pz, lx, ly, lz] = alone.momentum(&q, &qd);
        let own = alone.center_of_mass(&q);
        let [x, y, z] = [0, 1, 2].map(|axis| own[axis] - center[axis]);
        let expected = [lx + y * pz - z * py, ly + z * px - x * pz, lz + x * py - y * px];
        let joint = tulip.model().joints.iter().position(|joint| joint.name == name).unwrap();
        close(name, &momenta[3 * joint..3 * joint + 3], &expected, 1e-12);
    }
}

/// At rest all points are straight below the centre of mass; without a ground to stand on there is
/// none.
#[test]
fn points_of_the_ground_at_rest_are_below_the_centre_of_mass() {
    for mut plant in plants(&["tulip", "planar_biped", "bodies/compass"]) {
        let plant = &mut *plant;
        let name = plant.model().name.clone();
        let n = plant.model().joints.len();
        let (mut q, still) = (numbers(n, 1), vec![0.0; n]);
        let base = plant.model().joints.iter().position(|joint| joint.name == "base_z");
        q[base.unwrap()] = 2.0;
        let center = plant.center_of_mass(&q);
        let ground = plant.model().ground;
        let below = {
            let dot = |v: [f64; 3]| (0..3).map(|k| ground.normal[k] * v[k]).sum::<f64>();
            let above = dot([0, 1, 2].map(|k| center[k] - ground.point[k]));
            [center[0], center[1], center[2] - above / ground.normal[2]]
        };
        let links: Vec<usize> = plant.model().contacts.iter().map(|point| point.link).collect();
        let mut walking = plant.walking().unwrap();
        let feet: Vec<Option<[f64; 3]>> = links
            .iter()
            .map(|&link| walking.foot_rotation_indicator(link, &q, &still, &still))
            .collect();
        let points = [
            walking.zero_moment_point(&q, &still, &still),
            walking.cart_table_zmp(&q, &still, &still),
            walking.capture_point(&q, &still),
        ];
        for point in points.into_iter().chain(feet) {
            close(&name, &point.unwrap(), &below, 1e-12);
        }
        assert_eq!(walking.foot_rotation_indicator(0, &q, &still, &still), None, "{name}: no foot");
    }
    let mut arm = plant_of(&robot("puma560"), &[]).unwrap();
    let still = [0.0; 6];
    let mut walking = arm.walking().unwrap();
    assert_eq!(walking.zero_moment_point(&still, &still, &still), None);
    assert_eq!(walking.cart_table_zmp(&still, &still, &still), None);
    assert_eq!(walking.capture_point(&still, &still), None);
}

#[test]
fn plants_written_by_hand_have_a_centre_of_mass_that_moves_all_the_same() {
    let mut cradle = Cradle::new(3);
    assert!(cradle.walking().is_none());
    let mut jacobian = vec![0.0; 9];
    cradle.center_of_mass_jacobian(&[0.0; 3], &mut jacobian);
    let third = 1.0 / 3.0;
    close("cradle", &jacobian, &[third, third, third, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], 1e-15);
}
