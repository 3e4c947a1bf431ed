//! Weights that outliers lose (iteratively reweighted least squares; Huber 1964, Beaton and Tukey
//! 1974).

use super::condensed::Rows;
use super::errors::{Errors, FEWEST_PARTS, Problem};
use super::left_out::NumberedLog;
use super::weights::ByLog;
use crate::policy::robust::{BISQUARE, HUBER, LEAST_SLOPE};
use denavit_measure::condition::Conditioned;
use denavit_measure::{JointIndex, LogIndex, SampleIndex};
use denavit_numerics::least_squares::solve;
use denavit_numerics::median;
use denavit_plants::regression::RegressionModel;
use nalgebra::DMatrix;

/// Residuals that a scale is found from, at most.
const SCALE_SAMPLES: usize = 40_000;

/// How residuals lose weight as they grow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// Beyond 1.345 deviations they count by their size, not its square.
    Huber,
    /// Beyond 4.685 deviations they do not count.
    Bisquare,
}

impl Loss {
    /// The factor of both sides of a row whose residual is so many deviations.
    pub(super) fn factor(self, deviations: f64) -> f64 {
        let size = deviations.abs();
        match self {
            Self::Huber if size <= HUBER => 1.0,
            Self::Huber => (HUBER / size).sqrt(),
            Self::Bisquare if size < BISQUARE => 1.0 - (size / BISQUARE).powi(2),
            Self::Bisquare => 0.0,
        }
    }

    /// psi' of a residual of so many deviations, where psi is what it weighs times its size.
    fn slope(self, deviations: f64) -> f64 {
        let size = deviations.abs();
        match self {
            Self::Huber => f64::from(u8::from(size <= HUBER)),
            Self::Bisquare if size < BISQUARE => {
                let squared = (size / BISQUARE).powi(2);
                (1.0 - squared) * (1.0 - 5.0 * squared)
            }
            Self::Bisquare => 0.0,
        }
    }
}

/// What the residuals of a joint do to an estimate that bends with their loss: a change of the
/// target moves psi by psi', which is less than the weight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Influence {
    /// Mean of psi' over that of the weights.
    slope: f64,
    /// Mean of psi^2 over that of the weights.
    spread: f64,
}

/// The influences of all joints' residuals, whose deviations are `scales`.
pub(super) fn influences(
    model: &RegressionModel,
    rows: Rows<'_>,
    phi: &[f64],
    scales: &[Vec<f64>],
    loss: Loss,
) -> Vec<Influence> {
    let mut sums = vec![[0.0; 3]; model.joints.len()];
    for (number, scales) in scales.iter().enumerate() {
        counted_residuals(model, LogIndex(number), rows, phi, |joint, _, residual| {
            let sums = &mut sums[joint.0];
            let deviations = residual / scales[joint.0].max(f64::MIN_POSITIVE);
            let weight = loss.factor(deviations).powi(2);
            sums[0] += weight;
            sums[1] += loss.slope(deviations);
            sums[2] += (weight * deviations).powi(2);
        });
    }
    let of = |[weights, slopes, squares]: [f64; 3]| match weights > 0.0 {
        true => Influence {
            slope: (slopes / weights).clamp(LEAST_SLOPE, 1.0),
            spread: squares / weights,
        },
        false => Influence { slope: 1.0, spread: 1.0 },
    };
    sums.into_iter().map(of).collect()
}

impl Problem<'_> {
    /// The covariance of phi, and its degrees of freedom, of an estimate whose weights follow its
    /// residuals: A^-1 S A^-1 with S the covariance of the scores, psi, and A their slope (Huber
    /// 1981), which the weights alone overstate.
    pub(super) fn robust_covariance(
        &self,
        errors: Errors,
        influences: &[Influence],
    ) -> DMatrix<f64> {
        let Self { condensed, weights, prior, solution } = self;
        let (rank, triangles) = (condensed.rank, condensed.whole());
        let of = |times: &dyn Fn(&Influence) -> f64| {
            let of_log = |weights: &Vec<f64>| {
                let both = weights.iter().zip(influences);
                both.map(|(one, by)| one * times(by).sqrt()).collect()
            };
            let weights: ByLog = weights.iter().map(of_log).collect();
            condensed.system(&triangles, &weights, prior)
        };
        let squared = |r: &DMatrix<f64>| {
            let w = r.columns(0, rank);
            w.tr_mul(&w)
        };
        let slope = solve(&of(&|one| one.slope), solution.phi.as_slice()).covariance();
        let plain = self.covariance(errors);
        if errors == Errors::Classical || condensed.parts.len() < FEWEST_PARTS {
            return &slope * squared(&of(&|one| one.spread)) * &slope;
        }
        let turned = slope * squared(&of(&|_| 1.0));
        &turned * plain * turned.transpose()
    }
}

/// For each log the deviation of each joint's residuals, by their median, which outliers do not
/// move.
pub(super) fn scales(model: &RegressionModel, rows: Rows<'_>, phi: &[f64]) -> ByLog {
    let samples: usize = rows.0.iter().map(Conditioned::samples).sum();
    let stride = samples.div_ceil(SCALE_SAMPLES).max(1);
    let of_log = |number: LogIndex| {
        let mut found: Vec<Vec<f64>> = vec![Vec::new(); model.joints.len()];
        counted_residuals(model, number, rows, phi, |joint, sample, residual| {
            if sample.0.is_multiple_of(stride) {
                found[joint.0].push(residual.abs());
            }
        });
        found.into_iter().map(deviation).collect()
    };
    (0..rows.0.len()).map(LogIndex).map(of_log).collect()
}

/// Calls `visit` with the joint, the sample and the residual of every row of a log that counts:
/// those that are left out are no noise.
fn counted_residuals(
    model: &RegressionModel,
    number: LogIndex,
    (logs, left_out): Rows<'_>,
    phi: &[f64],
    mut visit: impl FnMut(JointIndex, SampleIndex, f64),
) {
    let own = NumberedLog { number, log: &logs[number.0] };
    left_out.for_each_left(model, own, phi, |joint, sample, left, counts| {
        if counts {
            visit(joint, sample, left);
        }
    });
}

/// The deviation of residuals of these sizes, if they are normal.
fn deviation(sizes: Vec<f64>) -> f64 {
    1.4826 * median(sizes)
}
