//! Logs for validation held against those for the estimate: those that contradict them, and joints
//! of whose torque far more is left than anything explains.
//!
//! A log that contradicts others is told by parameters of its own. One whose time is another, or
//! that shows a law that no parameters make, is not: it is told by what is left of it alone, beside
//! what is left of the logs for the estimate, errors of the parameters, noise of the positions and
//! the filter. Noise of its torques lies beside the cutoff of the filter as well as below it.

use super::condensed::{Condensed, MIN_PART};
use super::contradiction::{Claim, ContradictingLog, SAMPLES, Standing, plain};
use super::filter_error::filter_errors;
use super::least_squares::{Estimate, Options};
use super::left_out::{LeftOut, NumberedLog};
use super::noise_bias::noise_squares;
use super::own_estimate::{Tested, spread};
use super::unexplained::{Unexplained, moves};
use crate::policy::held_out::{MANY, OF_BAND, OF_NOISE, OF_TORQUE};
use denavit_measure::LogIndex;
use denavit_measure::condition::Conditioned;
use denavit_numerics::least_squares::Triangle;
use denavit_plants::regression::RegressionModel;
use nalgebra::DVector;

/// Logs for validation.
pub(crate) struct HeldOut<'a> {
    model: &'a RegressionModel,
    logs: &'a [Conditioned],
    found: &'a Estimate,
    /// Near reversals and at rest friction is not what the sign of a rate says.
    left_out: LeftOut,
    condensed: Condensed,
    weights: Vec<f64>,
}

impl<'a> HeldOut<'a> {
    /// Of an estimate; none without any.
    pub(crate) fn new(
        model: &'a RegressionModel,
        logs: &'a [Conditioned],
        found: &'a Estimate,
        options: &Options,
    ) -> Option<Self> {
        if logs.is_empty() || found.condensed.rank != model.rank() {
            return None;
        }
        let left_out = found.left_out.sure(model, logs, options);
        let condensed = Condensed::counted(model, (logs, &left_out));
        let weights = found.weights_of_joints();
        Some(Self { model, logs, found, left_out, condensed, weights })
    }

    fn tested(&self, at: LogIndex) -> (Tested<'_>, DVector<f64>) {
        let one = Tested::new(&self.condensed, at, &self.weights);
        let phi = one.with_own(&self.found.solution);
        (one, phi)
    }

    /// The logs that contradict those for the estimate: parameters are taken to be anywhere within
    /// their errors, and those that the estimate does not show are the logs' own.
    pub(crate) fn contradicting(
        &self,
        train: &[Conditioned],
        options: &Options,
    ) -> Vec<ContradictingLog> {
        let Self { model, logs, found, ref left_out, .. } = *self;
        let all: Vec<LogIndex> = (0..train.len()).map(LogIndex).collect();
        let means = plain(model, train, found, options);
        let means = &means.means(&all, found.solution.phi.as_slice());
        let of = |at: LogIndex| {
            let (one, phi) = &self.tested(at);
            let covariance = &found.covariance;
            let told = Claim { model, phi, covariance, left_out, means }.against(at, logs, one)?;
            Some(ContradictingLog { standing: Standing::HeldOut, ..told })
        };
        (0..logs.len()).map(LogIndex).filter_map(of).collect()
    }

    /// The joints of which too much is left in each log. `counted` is the share of each joint's
    /// torque that is left of the logs for the estimate.
    pub(crate) fn exceeding(&self, counted: &[f64]) -> Vec<Unexplained> {
        (0..self.logs.len()).flat_map(|at| self.exceeding_in(LogIndex(at), counted)).collect()
    }

    fn exceeding_in(&self, at: LogIndex, counted: &[f64]) -> Vec<Unexplained> {
        let Self { model, logs, found, .. } = *self;
        let (one, phi) = &self.tested(at);
        let noise = found.noise_of_joints();
        let share = |joint: usize| {
            let triangle = &one.triangles[joint];
            let rows = triangle.rows().max(1) as f64;
            let torque = triangle.target_squares() / rows;
            let own = spread(triangle, &model.pattern()[joint], &found.covariance) / rows;
            let known = noise[joint].powi(2).max(counted[joint].powi(2) * torque) + own;
            (torque, self.left(triangle, joint, phi), known)
        };
        let all: Vec<(f64, f64, f64)> = (0..model.joints.len()).map(share).collect();
        let is_much = |&(torque, left, known): &(f64, f64, f64)| {
            left > OF_TORQUE.powi(2) * torque && left > MANY.powi(2) * known
        };
        if !all.iter().any(is_much) {
            return Vec::new();
        }
        let made = self.made(at, &one.triangles, phi);
        let is_noise = self.is_noise(at, phi);
        let moves = moves(model, &[&logs[at.0]]);
        let is_told = |&joint: &usize| {
            let (torque, left, known) = all[joint];
            let is_enough = one.triangles[joint].rows() >= MIN_PART;
            let moves = is_enough && moves[joint] && !model.joints[joint].is_base;
            moves && !is_noise[joint] && is_much(&(torque, left, known + made[joint]))
        };
        let unexplained = |joint: usize| Unexplained {
            file: Some(logs[at.0].file.clone()),
            beside: Some(counted[joint]),
            ..Unexplained::of(&model.joints[joint].name, (all[joint].1 / all[joint].0).sqrt())
        };
        (0..model.joints.len()).filter(is_told).map(unexplained).collect()
    }

    /// The mean square of what phi leaves of a joint's torque.
    fn left(&self, triangle: &Triangle, joint: usize, phi: &DVector<f64>) -> f64 {
        let phi = self.model.of_joint(joint, phi.as_slice());
        triangle.squares(&phi) / triangle.rows().max(1) as f64
    }

    /// What noise of the positions and the filter make of a row of each joint, in mean square.
    fn made(&self, at: LogIndex, triangles: &[Triangle], phi: &DVector<f64>) -> Vec<f64> {
        let Self { model, logs, ref left_out, .. } = *self;
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
    fn is_noise(&self, at: LogIndex, phi: &DVector<f64>) -> Vec<bool> {
        let Self { model, logs, ref left_out, .. } = *self;
        let log = &logs[at.0];
        let piece = log.pieces(SAMPLES)[0];
        let Some(both) = log.halved(piece) else { return vec![false; model.joints.len()] };
        let first = piece.first.0 * log.decimation + both[0].range.start - log.range.start;
        let place = first..first + both[0].range.len();
        let left_out = &left_out.of_places(&[(at, place)], |_| 0);
        let both = both.map(|one| Condensed::counted(model, (&[one], left_out)).whole().remove(0));
        let of = |joint: usize| {
            let [before, after] = both.each_ref().map(|one| self.left(&one[joint], joint, phi));
            after < OF_BAND * (before - after).max(0.0)
        };
        (0..model.joints.len()).map(of).collect()
    }
}
