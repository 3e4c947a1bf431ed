//! Identification: from motion and torques to parameters.

mod emps;
mod estimate;
mod friction;
mod leg;
mod log;
mod misread;
mod noise;
mod regression;
mod wrenches;

use denavit_codegen::model::{self, Robot};
use denavit_codegen::regressor::RegressorOptions;
use denavit_numerics::Random;
use denavit_plants::regression::RegressionModel;
use denavit_plants::shipped;

/// A shipped robot.
pub(crate) fn robot(name: &str) -> Robot {
    let shipped = shipped::find(name).expect("a shipped model");
    model::read(name, shipped.text.as_bytes()).expect("shipped models are sound")
}

/// Bodies alone.
pub(crate) const INERTIAL: RegressorOptions = RegressorOptions {
    friction: false,
    rotor: false,
    offset: false,
    only_modelled: false,
    unknowns: denavit_codegen::regressor::Unknowns::Parameters,
};

/// Columns of a seeded motion: q, qd, qdd of every joint.
pub(crate) fn random_motion(joints: usize, samples: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut random = Random::new(seed);
    (0..3 * joints).map(|_| (0..samples).map(|_| random.normal()).collect()).collect()
}

/// Torques of values of phi.
pub(crate) fn torques(model: &RegressionModel, motion: &[Vec<f64>], phi: &[f64]) -> Vec<Vec<f64>> {
    let motion: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
    let mut rows = Default::default();
    model.evaluator().evaluate(&motion, &mut rows).expect("the motion has every column");
    let of_joint = |(joint, pattern): (usize, &Vec<usize>)| {
        let own: Vec<f64> = pattern.iter().map(|&place| phi[place]).collect();
        let mut torque = vec![0.0; rows.samples()];
        rows.torque(joint, &own, &mut torque);
        torque
    };
    model.pattern().iter().enumerate().map(of_joint).collect()
}
