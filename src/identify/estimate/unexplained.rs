//! Joints whose torque an estimate does not explain, although they move.

use super::validate::Validation;
use crate::identify::condition::Conditioned;
use crate::plants::regression::{RegressionJoint, RegressionModel};

/// The share of a joint's torque, as root of mean square, that must be left.
const LEFT: f64 = 0.9;

/// A joint that moves less than this share of the one of its kind that moves most is at rest:
/// nothing but noise may be in its torque.
const AT_REST: f64 = 0.01;

/// Samples of each log that are looked at, and in blocks of so many.
const BLOCKS: usize = 16;
const BLOCK: usize = 64;

/// Whether each joint moves, against the one of its kind (turning, sliding) that moves most.
fn moves(model: &RegressionModel, logs: &[Conditioned]) -> Vec<bool> {
    let n = model.joints.len();
    let mut ranges = vec![[f64::INFINITY, f64::NEG_INFINITY]; n];
    for log in logs {
        let samples = log.samples();
        let step = samples.div_ceil(BLOCKS).max(BLOCK);
        for first in (0..samples).step_by(step) {
            let mut motion = Vec::new();
            log.motion_at(first, BLOCK.min(samples - first), &mut motion);
            for ([low, high], positions) in ranges.iter_mut().zip(&motion) {
                *low = positions.iter().copied().fold(*low, f64::min);
                *high = positions.iter().copied().fold(*high, f64::max);
            }
        }
    }
    let ranges: Vec<f64> = ranges.iter().map(|[low, high]| (high - low).max(0.0)).collect();
    let most = |slides: bool| {
        let alike = ranges.iter().zip(&model.joints).filter(|(_, joint)| joint.slides == slides);
        alike.map(|(range, _)| *range).fold(0.0, f64::max)
    };
    let most = [false, true].map(most);
    let of_joint = |(range, joint): (&f64, &RegressionJoint)| {
        *range > AT_REST * most[usize::from(joint.slides)]
    };
    ranges.iter().zip(&model.joints).map(of_joint).collect()
}

/// The joints that move and of whose torque nearly all is left, each with the share: root of mean
/// square of the residual over that of the torque. Equations of a floating base are none of joints.
pub fn unexplained_joints(
    model: &RegressionModel,
    logs: &[Conditioned],
    left: &Validation,
) -> Vec<(String, f64)> {
    let moving = moves(model, logs);
    let of = |(joint, moves): (&RegressionJoint, &bool)| {
        let found = left.joints.iter().find(|one| one.name == joint.name)?;
        let is_left = *moves && !joint.is_base && found.relative > LEFT;
        is_left.then(|| (joint.name.clone(), found.relative))
    };
    model.joints.iter().zip(&moving).filter_map(of).collect()
}
