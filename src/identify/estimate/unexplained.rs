//! Joints whose torque an estimate does not explain.

use super::validate::Validation;
use crate::identify::condition::Conditioned;
use crate::plants::regression::{RegressionJoint, RegressionModel};
use std::fmt;

/// The share of a joint's torque, as root of mean square, that must be left.
const LEFT: f64 = 0.9;

/// The share that must be left where it is no noise: noise is another one after half a period of
/// the filter's cutoff, and what is left is still correlated with itself by so much.
const LEFT_ALIKE: f64 = 0.3;
const ALIKE: f64 = 0.5;

/// A joint that moves less than this share of the one of its kind that moves most is at rest:
/// nothing but noise may be in its torque. Of what is no noise this share must be left: it has no
/// friction of its own to be taken for it.
const AT_REST: f64 = 0.01;
const LEFT_AT_REST: f64 = 0.05;

/// Samples of each log that are looked at, and in blocks of so many.
const BLOCKS: usize = 16;
const BLOCK: usize = 64;

/// Whether each joint moves, against the one of its kind (turning, sliding) that moves most.
fn moves(model: &RegressionModel, logs: &[&Conditioned]) -> Vec<bool> {
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

/// Samples that are left after which noise has become another one.
fn memory(logs: &[&Conditioned]) -> usize {
    let of = |log: &&Conditioned| {
        let cutoff = log.filter.as_ref().map_or(0.5, |filter| filter.cutoff());
        (0.5 / (cutoff * log.decimation.max(1) as f64)).ceil().min(1e6) as usize
    };
    logs.iter().map(of).max().unwrap_or(1).max(1)
}

/// A joint of whose torque nearly all is left, or much that is no noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Unexplained {
    /// The joint.
    pub joint: String,
    /// Root of the mean square of the residual over that of the torque.
    pub share: f64,
    /// Whether the joint moves.
    pub moves: bool,
}

impl fmt::Display for Unexplained {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (joint, percent) = (&self.joint, 100.0 * self.share);
        write!(
            f,
            "The torque of {joint} is not explained: {percent:.0} % of it is left, although "
        )?;
        match self.moves {
            true => write!(
                f,
                "the joint moves. Its column may be another quantity, in another unit, or noise, \
                 or the zero of a position may be off, or the model's geometry"
            )?,
            false => write!(
                f,
                "the joint rests and nothing rubs. The column of its position may be stuck while \
                 it moves, or stiction or a brake holds it, which no equation knows"
            )?,
        }
        write!(f, "; what was found is not to be believed.")
    }
}

/// The joints of whose torque nearly all is left, or much that is no noise. `counted` is the share
/// of each joint's torque that is left of the rows that count: what is left of those near reversals
/// is no misfit. Equations of a floating base are none of joints.
pub fn unexplained_joints(
    model: &RegressionModel,
    logs: &[&Conditioned],
    (left, counted): (&Validation, &[f64]),
) -> Vec<Unexplained> {
    let moving = moves(model, logs);
    let lag = memory(logs);
    let of = |((joint, moves), counted): ((&RegressionJoint, &bool), &f64)| {
        let found = left.joints.iter().find(|one| one.name == joint.name)?;
        let is_alike = found.autocorrelation.get(lag - 1).is_some_and(|one| *one > ALIKE);
        let (alike, noise) =
            if *moves { (LEFT_ALIKE, LEFT) } else { (LEFT_AT_REST, f64::INFINITY) };
        let least = if is_alike && *counted > alike { alike } else { noise };
        let (name, share, moves) = (joint.name.clone(), found.relative, *moves);
        let is_left = !joint.is_base && share > least;
        is_left.then_some(Unexplained { joint: name, share, moves })
    };
    model.joints.iter().zip(&moving).zip(counted).filter_map(of).collect()
}
