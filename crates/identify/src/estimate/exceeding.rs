//! Joints of whose torque far more is left in a log for validation than anything explains.
//!
//! A log that contradicts others is told by parameters of its own. One whose time is another, or
//! that shows a law that no parameters make, is not: it is told by what is left of it alone, beside
//! what is left of the logs for the estimate, errors of the parameters, noise of the positions and
//! the filter. Noise of its torques lies beside the cutoff of the filter as well as below it.

use super::condensed::{Condensed, MIN_PART};
use super::filter_error::filter_errors;
use super::least_squares::{Estimate, Options};
use super::left_out::{LeftOut, NumberedLog};
use super::noise_bias::noise_squares;
use super::own_estimate::{Tested, of_joint, spread};
use super::triangle::Triangle;
use super::unexplained::{Unexplained, moves};
use crate::policy::exceeding::{MANY, OF_BAND, OF_NOISE, OF_TORQUE};
use denavit_measure::LogIndex;
use denavit_measure::condition::Conditioned;
use denavit_plants::regression::RegressionModel;
use nalgebra::DVector;

/// Samples of a log that are looked at behind half the cutoff, before decimation.
const SAMPLES: usize = 200_000;

/// The joints of which too much is left in each of some logs for validation. `counted` is the share
/// of each joint's torque that is left of the logs for the estimate.
pub(crate) fn exceeding_joints(
    model: &RegressionModel,
    logs: &[Conditioned],
    found: &Estimate,
    options: &Options,
    counted: &[f64],
) -> Vec<Unexplained> {
    if logs.is_empty() || found.condensed.rank != model.rank() {
        return Vec::new();
    }
    let left_out = &found.left_out.sure(model, logs, options);
    let condensed = Condensed::counted(model, (logs, left_out));
    let noise = found.noise_of_joints();
    let weight = |noise: &f64| if *noise > 0.0 { 1.0 / noise } else { 0.0 };
    let weights: Vec<f64> = noise.iter().map(weight).collect();
    let of_log = |at: LogIndex| {
        let one = Tested::new(&condensed, at, &weights);
        let phi = one.with_own(&found.solution);
        let held_out = HeldOut { model, logs, at, phi: &phi, left_out };
        let share = |joint: usize| {
            let triangle = &one.triangles[joint];
            let rows = triangle.rows().max(1) as f64;
            let torque = triangle.target_squares() / rows;
            let own = spread(triangle, &model.pattern()[joint], &found.covariance) / rows;
            let known = noise[joint].powi(2).max(counted[joint].powi(2) * torque) + own;
            (torque, held_out.left(triangle, joint), known)
        };
        let all: Vec<(f64, f64, f64)> = (0..model.joints.len()).map(share).collect();
        let is_much = |&(torque, left, known): &(f64, f64, f64)| {
            left > OF_TORQUE.powi(2) * torque && left > MANY.powi(2) * known
        };
        if !all.iter().any(is_much) {
            return Vec::new();
        }
        let made = held_out.made(&one.triangles);
        let is_noise = held_out.is_noise();
        let moves = moves(model, &[&logs[at.0]]);
        let is_told = |&joint: &usize| {
            let (torque, left, known) = all[joint];
            let is_enough = one.triangles[joint].rows() >= MIN_PART;
            let moves = is_enough && moves[joint] && !model.joints[joint].is_base;
            moves && !is_noise[joint] && is_much(&(torque, left, known + made[joint]))
        };
        let told = (0..model.joints.len()).filter(is_told);
        let unexplained = told.map(|joint| Unexplained {
            joint: model.joints[joint].name.clone(),
            file: Some(logs[at.0].file.clone()),
            share: (all[joint].1 / all[joint].0).sqrt(),
            rest_s: None,
            beside: Some(counted[joint]),
        });
        unexplained.collect::<Vec<_>>()
    };
    (0..logs.len()).map(LogIndex).flat_map(of_log).collect()
}

/// A log for validation.
struct HeldOut<'a> {
    model: &'a RegressionModel,
    logs: &'a [Conditioned],
    at: LogIndex,
    phi: &'a DVector<f64>,
    left_out: &'a LeftOut,
}

impl HeldOut<'_> {
    /// The mean square of what phi leaves of a joint's torque.
    fn left(&self, triangle: &Triangle, joint: usize) -> f64 {
        let phi = of_joint(&self.model.pattern()[joint], self.phi.as_slice());
        triangle.squares(&phi) / triangle.rows().max(1) as f64
    }

    /// What noise of the positions and the filter make of a row of each joint, in mean square.
    fn made(&self, triangles: &[Triangle]) -> Vec<f64> {
        let Self { model, logs, at, phi, left_out } = *self;
        let smeared = filter_errors(model, &logs[at.0..=at.0], phi.as_slice());
        let noise =
            noise_squares(model, NumberedLog { number: at, log: &logs[at.0] }, left_out, phi);
        let of = |((triangle, noise), share): ((&Triangle, f64), f64)| {
            let squares = OF_NOISE * noise + share * share * triangle.target_squares();
            squares / triangle.rows().max(1) as f64
        };
        triangles.iter().zip(noise).zip(smeared).map(of).collect()
    }

    /// Whether what is left of each joint's torque is like noise of it; not where the log is too
    /// short to tell.
    fn is_noise(&self) -> Vec<bool> {
        let Self { model, logs, at, left_out, .. } = *self;
        let log = &logs[at.0];
        let piece = log.pieces(SAMPLES)[0];
        let Some(both) = log.halved(piece) else { return vec![false; model.joints.len()] };
        let first = piece.first.0 * log.decimation + both[0].range.start - log.range.start;
        let place = first..first + both[0].range.len();
        let left_out = &left_out.of_places(&[(at, place)], |_| 0);
        let both = both.map(|one| Condensed::counted(model, (&[one], left_out)).whole().remove(0));
        let of = |joint: usize| {
            let [before, after] = both.each_ref().map(|one| self.left(&one[joint], joint));
            after < OF_BAND * (before - after).max(0.0)
        };
        (0..model.joints.len()).map(of).collect()
    }
}
