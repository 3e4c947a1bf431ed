//! Momentum and centre of mass: matrices times velocities, and derivatives by time.

use crate::laws::{SEEDS, apply, for_each_robot};
use denavit_codegen::function::FunctionName::*;
use denavit_codegen::number::Residue;

#[test]
fn the_centroidal_matrix_times_the_velocities_is_the_momentum() {
    for_each_robot(&[CentroidalMomentumMatrix, Momentum], |robot| {
        let matrix = robot.entries(CentroidalMomentumMatrix, "centroidal_momentum_matrix");
        let momentum = [
            robot.entries(Momentum, "linear_momentum"),
            robot.entries(Momentum, "angular_momentum"),
        ]
        .concat();
        assert_eq!(matrix.len(), 6 * robot.joints.len());
        for seed in SEEDS {
            let qd = robot.values(&robot.symbols(|joint| joint.qd), seed);
            let found = apply(&robot.values(&matrix, seed), &qd);
            assert_eq!(found, robot.values(&momentum, seed), "{}", robot.name);
        }
    });
}

#[test]
fn angular_momenta_of_bodies_add_up_to_that_of_the_robot() {
    for_each_robot(&[AngularMomenta, Momentum], |robot| {
        let momenta = robot.entries(AngularMomenta, "angular_momenta");
        let angular = robot.entries(Momentum, "angular_momentum");
        assert_eq!(momenta.len(), 3 * robot.joints.len());
        for seed in SEEDS {
            let found = robot.values(&momenta, seed);
            let along = |axis| found.iter().skip(axis).step_by(3);
            let sums = [0, 1, 2].map(|axis| along(axis).fold(Residue::ZERO, |sum, &h| sum + h));
            assert_eq!(sums.to_vec(), robot.values(&angular, seed), "{}", robot.name);
        }
    });
}

#[test]
fn the_centroidal_bias_is_the_derivative_of_the_matrix_times_the_velocities() {
    for_each_robot(&[CentroidalMomentumMatrix, CentroidalMomentumBias], |robot| {
        let matrix = robot.entries(CentroidalMomentumMatrix, "centroidal_momentum_matrix");
        let bias = robot.entries(CentroidalMomentumBias, "centroidal_momentum_bias");
        let slope = robot.time_derivative(&matrix);
        for seed in SEEDS {
            let qd = robot.values(&robot.symbols(|joint| joint.qd), seed);
            let found = apply(&robot.values(&slope, seed), &qd);
            assert_eq!(found, robot.values(&bias, seed), "{}", robot.name);
        }
    });
}

#[test]
fn the_bias_of_the_centre_of_mass_is_the_derivative_of_its_jacobian_times_the_velocities() {
    for_each_robot(&[CenterOfMass, CenterOfMassJacobian, CenterOfMassBias], |robot| {
        let jacobian = robot.entries(CenterOfMassJacobian, "center_of_mass_jacobian");
        let bias = robot.entries(CenterOfMassBias, "center_of_mass_bias");
        let slope = robot.time_derivative(&jacobian);
        for seed in SEEDS {
            let qd = robot.values(&robot.symbols(|joint| joint.qd), seed);
            let found = apply(&robot.values(&slope, seed), &qd);
            assert_eq!(found, robot.values(&bias, seed), "{}", robot.name);
        }
    });
}
