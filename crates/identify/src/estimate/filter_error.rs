//! What the filter does to a motion that is too fast for it, or whose samples are too far apart.
//!
//! Torques are no linear function of the motion: those of a filtered motion are not the filtered
//! ones. How much that matters is seen by doing it once more: torques are computed of the motion
//! that the filter left, both go through the filter again, and are compared.

use super::validate::validate;
use denavit_measure::condition::{Conditioned, STENCIL};
use denavit_plants::regression::{RegressionJoint, RegressionModel};

/// Samples that are looked at in all.
const SAMPLES: usize = 20_000;

/// The error that the filter makes of each joint's torque by itself, root of mean square over root
/// of mean square, with phi; 0 where none was measured. Coulomb friction, whose rows near reversals
/// are left out, has no part in it.
pub(crate) fn filter_errors(
    model: &RegressionModel,
    logs: &[Conditioned],
    phi: &[f64],
) -> Vec<f64> {
    let mut smooth = phi.to_vec();
    for &(joint, place) in model.coulomb() {
        smooth[model.pattern()[joint][place]] = 0.0;
    }
    let longest = SAMPLES / logs.len().max(1);
    let again: Vec<Conditioned> =
        logs.iter().filter_map(|log| filtered_again(model, log, longest, &smooth)).collect();
    let left = validate(model, &smooth, &again);
    let of_joint =
        |joint: &RegressionJoint| left.joint(&joint.name).map_or(0.0, |one| one.relative);
    model.joints.iter().map(of_joint).collect()
}

/// The middle of a log, its filtered motion filtered once more, with the torques that phi makes of
/// it; none if the filter leaves nothing of it.
fn filtered_again(
    model: &RegressionModel,
    log: &Conditioned,
    longest: usize,
    phi: &[f64],
) -> Option<Conditioned> {
    let filter = log.filter.as_ref()?;
    let edge = filter.settling() + STENCIL;
    let length = log.range.len().min(longest.max(4 * edge));
    let start = log.range.start + (log.range.len() - length) / 2;
    let range = edge..length.checked_sub(edge).filter(|end| *end > edge)?;
    let filtered = |mut column: Vec<f64>| {
        filter.zero_phase(&mut column);
        column
    };
    let again = |column: &[f64]| filtered(column[start..start + length].to_vec());
    let mut motion = Vec::new();
    log.motion(start..start + length, &mut motion);
    let torques = log.torque.iter().zip(model.torques(&motion, phi));
    let torques =
        torques.map(|(measured, torque)| measured.as_ref().map(|_| filtered(torque))).collect();
    let found = Conditioned {
        file: log.file.clone(),
        step_s: log.step_s,
        q: log.q.iter().map(|q| again(q)).collect(),
        rates: log.rates.as_ref().map(|both| {
            both.each_ref().map(|columns| columns.iter().map(|column| again(column)).collect())
        }),
        torque: torques,
        range,
        decimation: log.decimation,
        filter: log.filter.clone(),
        ..Conditioned::default()
    };
    (found.samples() > 0).then_some(found)
}
