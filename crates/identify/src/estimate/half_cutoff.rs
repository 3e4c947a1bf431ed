//! What changes with half the cutoff of the filter: more than chance where noise of the positions
//! biases parameters in a way that it does not by itself.
//!
//! A loop that is closed over the encoder of the log answers its steps, so that motion and noise
//! are no longer independent of each other; steps that the filter follows are no white noise.
//! Whatever the mechanism, a lower filter leaves less of it. Both estimates are of the same
//! samples, so that the error of their difference is known much better than their own: from the
//! difference of what each part of the logs does to them (Hausman 1978).

use super::condensed::{Condensed, Rows};
use super::errors::{FEWEST_PARTS, Problem};
use super::least_squares::{Estimate, Fit};
use crate::policy::half_cutoff::OF_CHANGE;
use crate::policy::report::BIASING;
use denavit_measure::LogIndex;
use denavit_measure::condition::Conditioned;
use denavit_numerics::long_run;
use denavit_plants::regression::RegressionModel;
use nalgebra::{DMatrix, DVector};

/// Samples of all logs that are looked at, before decimation.
const SAMPLES: usize = 200_000;

/// How a parameter changes with half the cutoff of the filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfCutoff {
    /// By how much.
    pub change: f64,
    /// The standard deviation of that by chance.
    pub deviation: f64,
    /// The standard error of the parameter without what the change adds to it.
    pub own_std: f64,
}

impl HalfCutoff {
    /// Whether it changes by more than so many deviations by chance, and by more than an interval
    /// without the change forgives.
    pub(super) fn is_beyond(&self, deviations: f64) -> bool {
        self.change.abs() > (BIASING * self.own_std).max(deviations * self.deviation)
    }

    /// What a change is more than chance.
    fn beyond(&self) -> f64 {
        let squared = self.change * self.change - self.deviation * self.deviation;
        OF_CHANGE * squared.max(0.0).sqrt() * self.change.signum()
    }
}

/// Adds what changes of the listed parameters are more than chance to a covariance of phi: an
/// unknown bias.
pub(super) fn widen(
    changes: &mut [HalfCutoff],
    model: &RegressionModel,
    covariance: &mut DMatrix<f64>,
) {
    let own = deviations(model, covariance);
    changes.iter_mut().zip(&own).for_each(|(one, own)| one.own_std = *own);
    let listed = DVector::from_iterator(changes.len(), changes.iter().map(HalfCutoff::beyond));
    if let Some(bias) = model.to_listed().clone().lu().solve(&listed) {
        *covariance += &bias * bias.transpose();
    }
}

impl Fit<'_> {
    /// How listed parameters change with half the cutoff, rows weighted as they are; none where no
    /// position has noise, or logs are too short for it.
    pub(super) fn change(
        &self,
        model: &RegressionModel,
        (logs, left_out): Rows<'_>,
        found: &Estimate,
    ) -> Option<Vec<HalfCutoff>> {
        let noisy = |log: &&Conditioned| log.position_noise.iter().any(|noise| *noise > 0.0);
        let (mut own, mut halved, mut places) = (Vec::new(), Vec::new(), Vec::new());
        for (number, log) in logs.iter().enumerate().filter(|(_, log)| noisy(log)) {
            for piece in log.pieces(SAMPLES / logs.len()) {
                let Some([plain, lower]) = log.halved(piece) else { continue };
                let first = piece.first.0 * log.decimation + plain.range.start - log.range.start;
                places.push((LogIndex(number), first..first + plain.range.len()));
                own.push(plain);
                halved.push(lower);
            }
        }
        if own.is_empty() {
            return None;
        }
        let left_out = left_out.of_halved(logs, &places);
        let weights = places.iter().map(|(number, _)| found.weights[number.0].clone());
        let weights = &weights.collect::<Vec<_>>()[..];
        let both = [own, halved].map(|logs| {
            let condensed = Condensed::counted(model, (&logs, &left_out));
            let solution = self.solved(&condensed, &condensed.whole(), weights);
            (condensed, solution)
        });
        let [(condensed, _), _] = &both;
        let parts = condensed.parts.len();
        let used = found.solution.excited();
        if parts < FEWEST_PARTS || both.iter().any(|(_, solution)| solution.excited() < used) {
            return None;
        }
        let [before, after] = both.each_ref().map(|(condensed, solution)| {
            Problem { condensed, weights, prior: &self.options.prior, solution }.influences()
        });
        let apart: Vec<DVector<f64>> =
            before.into_iter().zip(after).map(|(one, other)| other - one).collect();
        let [before, after] = both.each_ref().map(|(_, solution)| &solution.phi);
        let change = model.to_listed() * (after - before);
        let deviation = deviations(model, &long_run(&apart, &condensed.log_of_part));
        let both = change.iter().zip(&deviation);
        let of =
            |(&change, &deviation): (&f64, &f64)| HalfCutoff { change, deviation, own_std: 0.0 };
        Some(both.map(of).collect())
    }
}

/// Standard deviations of the listed parameters.
fn deviations(model: &RegressionModel, covariance: &DMatrix<f64>) -> DVector<f64> {
    let listed = model.to_listed() * covariance * model.to_listed().transpose();
    listed.diagonal().map(|variance| variance.max(0.0).sqrt())
}
