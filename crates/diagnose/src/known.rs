//! What the rows of a joint tell of its torque, where its drive turns around or rests.
//!
//! A drive passes each reversal late by a time of its own: it sticks for milliseconds, and its
//! readings are of another time than its torque. While it rests, its friction is anything up to
//! that of sliding. Noise is taken to be even in time, so that rows count by what is not known of
//! them. That is of the motion and repeats with it: many laps tell no more of it than one.

use super::nominal::{Nominal, Phi};
use super::rows::{PerJoint, torques as torques_of};
use super::signals::{Shared, Signals};
use crate::policy::known::{CREEP, RINGING};
use denavit_evidence::policy;
use denavit_measure::JointIndex;
use denavit_numerics::derivative;

/// For each joint what each row of a log counts, from 0 to 1.
pub(super) fn weights(nominal: &Nominal<'_>, signals: &Signals, phi: &Phi) -> PerJoint {
    let heights = heights(nominal, signals, phi);
    let samples = signals.samples() as f64 * signals.step_s / signals.log_step_s;
    let laps = signals.laps.map_or(1.0, |laps| samples / laps.period);
    let of_joint = |(joint, heights): (usize, &Vec<f64>)| {
        let level = policy::NOISE_LEVEL * nominal.usual[joint][0];
        let weight = |unknown: &f64| {
            if *unknown == 0.0 { 1.0 } else { level / level.hypot(*unknown) }
        };
        let late: Vec<f64> =
            late(signals, JointIndex(joint), heights).iter().map(|by| by.abs()).collect();
        let [late, resting] =
            [signals.rows_of(&late), resting(signals, JointIndex(joint), heights)];
        let of_lap = late.iter().zip(resting).map(|(a, b)| a.hypot(b));
        let unknown: Vec<f64> = of_lap.map(|unknown| laps.sqrt() * unknown).collect();
        even(with_ringing(&unknown).iter().map(weight).collect())
    };
    heights.iter().enumerate().map(of_joint).collect()
}

/// Weights of which the largest is 1: where all rows are as little known, noise is even again.
fn even(weights: Vec<f64>) -> Vec<f64> {
    let most = weights.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    weights.into_iter().map(|weight| weight / most).collect()
}

/// What friction of some height lacks at the samples of the motion where it turns around later.
/// What a drive holds with at rest is unknown itself, and has no side.
fn late(signals: &Signals, joint: JointIndex, heights: &[f64]) -> Vec<f64> {
    let side = |rate: f64| if rate == 0.0 { 0.0 } else { rate.signum() };
    let sides = heights.iter().zip(signals.creeping(joint));
    let step: Vec<f64> = sides.map(|(height, rate)| height * side(rate)).collect();
    derivative(&step, signals.step_s).iter().map(|by| -policy::LATE_S * by).collect()
}

/// For each joint what its friction lacks where all its reversals are late by the same time.
pub(super) fn late_reversals(nominal: &Nominal<'_>, signals: &Signals, phi: &Phi) -> PerJoint {
    let heights = heights(nominal, signals, phi);
    let of = |(joint, heights): (usize, &Vec<f64>)| late(signals, JointIndex(joint), heights);
    heights.iter().enumerate().map(of).collect()
}

/// What friction of some height may differ by in the rows, since the drive rests: up to where it
/// needs all that it slides with, for what it needs beyond that is to be told.
fn resting(signals: &Signals, joint: JointIndex, heights: &[f64]) -> Vec<f64> {
    let mut resting = vec![0.0; heights.len()];
    for rest in &signals.rests[joint.0] {
        let samples = rest.held(&signals.t);
        resting[samples.clone()].copy_from_slice(&heights[samples]);
    }
    signals.rows_of(&resting)
}

/// What is unknown in rows, or beside them, where the filter rings.
fn with_ringing(rows: &[f64]) -> Vec<f64> {
    let of = |k: usize| {
        let near = &rows[k.saturating_sub(1)..(k + 2).min(rows.len())];
        near.iter().fold(rows[k].abs(), |most, row| most.max(RINGING * row.abs()))
    };
    (0..rows.len()).map(of).collect()
}

/// How high the step of each joint's friction is at a reversal, with what a model may lack of it.
fn heights(nominal: &Nominal<'_>, signals: &Signals, phi: &Phi) -> PerJoint {
    let creeping = |direction: f64| {
        let mut moved = signals.clone();
        for joint in 0..signals.joints() {
            moved.drive_mut(JointIndex(joint))[0].fill(direction * CREEP);
            Shared::make_mut(&mut moved.qd[joint]).fill(direction * CREEP);
        }
        torques_of(nominal, &moved, phi)
    };
    let [forth, back] = [1.0, -1.0].map(creeping);
    let of_joint = |joint: usize| {
        let lacking = policy::STEP * nominal.usual[joint][0];
        let both = forth[joint].iter().zip(&back[joint]);
        both.map(|(forth, back)| 0.5 * (forth - back).abs() + lacking).collect()
    };
    (0..signals.joints()).map(of_joint).collect()
}

#[cfg(test)]
#[path = "../tests/unit/known.rs"]
mod tests;
