//! Torques with the wrong sign: joints whose equations fit the others when they are turned round.
//!
//! The sign of a torque is a convention of whoever wrote the log. A joint that shares parameters
//! with others cannot fit with the other sign; one that shares none fits with parameters of the
//! other sign, of which friction must not be negative.

use super::least_squares::Estimate;
use super::report::{IdentifiedParameter, Status};
use super::solve::stacked;
use super::triangle::Triangle;
use crate::plants::regression::RegressionModel;

/// A joint whose torque seems to have the wrong sign.
#[derive(Clone, Debug, PartialEq)]
pub struct FlippedTorque {
    /// The joint.
    pub joint: String,
    /// The share of all torques, each joint's by its own size, that is left as it is, and with this
    /// joint's torque turned round; none where friction below 0 is what shows it.
    pub left: Option<[f64; 2]>,
}

/// What is left must fall to this share.
const BETTER: f64 = 0.4;

/// Less than this is not for a wrong sign.
const SMALL: f64 = 0.02;

/// Standard errors by which friction is below 0.
const SURE: f64 = 5.0;

/// The joints whose torques fit better with the other sign.
pub fn flipped_torques(
    model: &RegressionModel,
    found: &Estimate,
    listed: &[IdentifiedParameter],
) -> Vec<FlippedTorque> {
    let mut triangles = found.condensed.whole();
    let size = |one: &Triangle| match one.target_squares() {
        squares if squares > 0.0 => 1.0 / squares.sqrt(),
        _ => 0.0,
    };
    let weights: Vec<f64> = triangles.iter().map(size).collect();
    let measured = weights.iter().filter(|weight| **weight > 0.0).count() as f64;
    let rank = found.condensed.rank;
    let left = |triangles: &[Triangle]| {
        let r = stacked(triangles, &found.condensed.pattern, &weights, &[], rank);
        r[(rank, rank)].abs() / measured.max(1.0).sqrt()
    };
    let mut turned = vec![None; triangles.len()];
    let mut before = left(&triangles);
    while before > SMALL {
        let with = |joint: usize| {
            let mut turned = triangles.clone();
            turned[joint].negate_target();
            left(&turned)
        };
        let all = (0..triangles.len()).filter(|&joint| weights[joint] > 0.0);
        let all = all.filter(|&joint| turned[joint].is_none());
        let best = all.map(|joint| (joint, with(joint))).min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((joint, after)) = best.filter(|(_, after)| *after < BETTER * before) else {
            break;
        };
        triangles[joint].negate_target();
        turned[joint] = Some([before, after]);
        before = after;
    }
    let whole = turned.iter().flatten().copied().reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])]);
    // Turned round all together torques fit as well: the model says which half is wrong.
    let opposes = model.model_axes().is_some_and(|phi| agreement(found, &triangles, &phi) < 0.0);
    let mut flipped: Vec<FlippedTorque> = Vec::new();
    if let Some(whole) = whole {
        for (joint, turned) in turned.iter().enumerate().filter(|(at, _)| weights[*at] > 0.0) {
            if turned.is_some() != opposes {
                let joint = model.joints[joint].name.clone();
                flipped.push(FlippedTorque { joint, left: Some(whole) });
            }
        }
    }
    for joint in &model.joints {
        let rubs_backwards = |prefix: &str| {
            let own = format!("{prefix}_{}", joint.name);
            listed.iter().any(|one| {
                let is_sure = one.std.is_some_and(|std| one.value < -SURE * std);
                one.name == own && is_sure && one.status == Status::Identified
            })
        };
        let is_known = flipped.iter().any(|one| one.joint == joint.name);
        if !is_known && (rubs_backwards("fv") && rubs_backwards("fc")) {
            flipped.push(FlippedTorque { joint: joint.name.clone(), left: None });
        }
    }
    flipped
}

/// The sum over joints of the correlation of torques with those of phi.
fn agreement(found: &Estimate, triangles: &[Triangle], phi: &[f64]) -> f64 {
    let of_joint = |(joint, triangle): (usize, &Triangle)| {
        let (r, width) = (triangle.matrix(), triangle.width());
        let own = found.condensed.of_joint(joint, phi);
        let (mut product, mut computed) = (0.0, 0.0);
        for row in 0..width {
            let torque: f64 = (row..width).map(|place| r[(row, place)] * own[place]).sum();
            product += torque * r[(row, width)];
            computed += torque * torque;
        }
        let size = (computed * triangle.target_squares()).sqrt();
        if size > 0.0 { product / size } else { 0.0 }
    };
    triangles.iter().enumerate().map(of_joint).sum()
}
