//! Motors that do not carry their joints: a brake holds them, or stiction.

use super::estimate::{BlockMaker, nominal_values};
use crate::policy::idle::{ALIKE, FOLLOWS, ROUNDING};
use denavit_measure::JointIndex;
use denavit_measure::condition::Conditioned;
use denavit_plants::regression::RegressionModel;

/// Takes the torques of motors that do not carry their joints out of a log, and says which: the
/// joint rests, and its torque does not change as the load does that the nominal parameters make of
/// the motion of the others. Nothing is known there but that something else holds the joint.
pub fn leave_out_idle_motors(model: &RegressionModel, log: &mut Conditioned) -> Vec<JointIndex> {
    let Some(values) = nominal_values(model) else { return Vec::new() };
    let rests = |joint: &JointIndex| log.resting[joint.0] && !model.joints[joint.0].is_base;
    let resting: Vec<JointIndex> = (0..model.joints.len()).map(JointIndex).filter(rests).collect();
    if resting.is_empty() {
        return resting;
    }
    // rows, torque and load, their squares and their product
    let mut sums = vec![[0.0; 6]; model.joints.len()];
    BlockMaker::new(model, log).for_each_left(&values, |joint, _, [_, torque, left]| {
        let load = torque - left;
        let own = [1.0, torque, load, torque * torque, load * load, torque * load];
        sums[joint.0].iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
    });
    let is_idle = |[rows, torque, load, torques, loads, both]: [f64; 6]| {
        let rounding = ROUNDING * torques;
        let [torques, loads] = [torques - torque * torque / rows, loads - load * load / rows];
        let both = both - torque * load / rows;
        let is_alike = torques > rounding && both * both > ALIKE.powi(2) * torques * loads;
        torques < FOLLOWS.powi(2) * loads && !is_alike
    };
    let idle: Vec<JointIndex> =
        resting.into_iter().filter(|joint| is_idle(sums[joint.0])).collect();
    idle.iter().for_each(|&joint| log.torque[joint.0] = None);
    idle
}
