//! A log that is too long to be held at once: its rows as triangles, which are added to each other.
//!
//! The estimate needs no more of the rows than their triangles. What else is asked of a log is
//! asked of its head, which was estimated as any log is: where friction is not the sign of its
//! velocity, how large noise of the positions is, and what it does to the parameters.

mod text;

use super::condensed::{Condensed, PARTS, part_length, plain};
use super::half_cutoff::widen;
use super::least_squares::{Estimate, Fit, Method, Options};
use super::left_out::{LeftOut, SlowRows};
use super::rows::BlockMaker;
use super::validate::{JointResidual, Validation};
use crate::error::Error;
use denavit_measure::condition::Conditioned;
use denavit_measure::{JointIndex, SampleIndex};
use denavit_numerics::least_squares::Triangle;
use denavit_plants::regression::{CoulombLaw, RegressionJoint, RegressionModel};

/// What the head of a long log says of the rows of the rest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RowRule {
    /// Joints whose rows near velocity reversals are left out, and the times their range was
    /// widened to.
    pub widened: Vec<(JointIndex, f64)>,
}

/// The rows of some stretches of a long log.
#[derive(Clone, Debug, PartialEq)]
pub struct LongRows {
    /// The rows that count, of one log.
    condensed: Condensed,
    /// All rows, joint by joint.
    all: Vec<Triangle>,
    /// For each joint the sum of the squares of its torque, of all rows.
    torque_squares: Vec<f64>,
    /// Samples that are left after decimation.
    samples: usize,
}

/// Pieces in which a log of so many stretches is condensed, each by itself: of a long one parts
/// that errors are found from, so that what is to be held does not grow with the log.
pub fn pieces(stretches: usize) -> usize {
    stretches.min(PARTS)
}

impl LongRows {
    /// The rows of a conditioned stretch of a log.
    pub fn of_stretch(
        model: &RegressionModel,
        log: &Conditioned,
        rule: &RowRule,
        options: &Options,
        whole: WholeLog,
    ) -> Self {
        let left_out = LeftOut::of_part(model, log, options, &rule.widened);
        let (pattern, rank) = (model.pattern().to_vec(), model.rank());
        let (rows, length) = ((std::slice::from_ref(log), &left_out), whole.part_length());
        let mut condensed = Condensed::of_parts(model, rows, pattern, rank, length, &mut plain);
        let samples = whole.samples.max(1) as f64;
        let independent = (log.noise_gains()[0][0] * whole.inner as f64).min(samples) / samples;
        condensed.independent = vec![independent];
        let offset = log.time_s(SampleIndex(0)) - whole.start_s;
        condensed.end_s.iter_mut().for_each(|end| *end += offset);
        let widths = condensed.pattern.iter().map(Vec::len);
        let mut all: Vec<Triangle> = widths.map(Triangle::new).collect();
        let mut torque_squares = vec![0.0; all.len()];
        BlockMaker::new(model, log).for_each(|block| {
            for (joint, (all, squares)) in all.iter_mut().zip(&mut torque_squares).enumerate() {
                let Some(columns) = block.with_target(JointIndex(joint)) else { continue };
                all.push(&columns);
                let [torque, _] = block.torque[joint].as_ref().expect("it has a target");
                *squares += torque.iter().map(|one| one * one).sum::<f64>();
            }
        });
        Self { condensed, all, torque_squares, samples: log.samples() }
    }

    /// Adds the rows of a stretch, or of a piece, that comes later; of a piece that is a part of
    /// the log, as one with those before.
    pub fn add(&mut self, later: Self, is_same_part: bool) {
        let (own, its) = (&mut self.condensed, later.condensed);
        if is_same_part && let (Some(part), [next]) = (own.parts.last_mut(), &its.parts[..]) {
            for (sum, one) in part.iter_mut().zip(next).filter(|(_, one)| one.rows() > 0) {
                sum.merge(one);
            }
            own.end_s.pop();
        } else {
            own.parts.extend(its.parts);
            own.log_of_part.extend(its.log_of_part);
        }
        own.end_s.extend(its.end_s);
        for (sum, one) in self.all.iter_mut().zip(&later.all).filter(|(_, one)| one.rows() > 0) {
            sum.merge(one);
        }
        for (sum, one) in self.torque_squares.iter_mut().zip(&later.torque_squares) {
            *sum += one;
        }
        self.samples += later.samples;
    }

    /// Samples that are left after decimation.
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// For each joint the rows that do not count, of how many.
    pub(crate) fn left_out(&self) -> Vec<[usize; 2]> {
        let counted = |joint: usize| -> usize {
            self.condensed.parts.iter().map(|part| part[joint].rows()).sum()
        };
        let all = self.all.iter().enumerate();
        all.map(|(joint, all)| [all.rows() - counted(joint), all.rows()]).collect()
    }

    /// What phi leaves of the torques, of all rows. What triangles do not say is that of the head:
    /// the largest residual, how it is correlated with itself, and what pictures show.
    pub(crate) fn left(
        &self,
        model: &RegressionModel,
        phi: &[f64],
        head: &Validation,
    ) -> Validation {
        let one = |(at, joint): (usize, &RegressionJoint)| {
            let rows = self.all[at].rows();
            let of_head = head.joint(&joint.name);
            let rms = |squares: f64| (squares / rows as f64).sqrt();
            let own = self.condensed.of_joint(JointIndex(at), phi);
            let residual_rms = rms(self.all[at].squares(&own));
            let torque_rms = rms(self.torque_squares[at]);
            (rows > 0).then(|| JointResidual {
                name: joint.name.clone(),
                torque_rms,
                residual_rms,
                relative: if torque_rms > 0.0 { residual_rms / torque_rms } else { 0.0 },
                ..of_head.cloned().unwrap_or_default()
            })
        };
        let joints: Vec<JointResidual> = model.joints.iter().enumerate().filter_map(one).collect();
        Validation::of_joints(joints, self.samples)
    }
}

/// What a stretch has to know of the log that it is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WholeLog {
    /// Samples that are left after decimation.
    pub samples: usize,
    /// Samples that do not depend on what was not measured.
    pub inner: usize,
    /// Stretches.
    pub stretches: usize,
    /// When its first sample was measured \[s\].
    pub start_s: f64,
}

impl WholeLog {
    /// Samples of a part of a stretch.
    fn part_length(self) -> usize {
        if self.stretches < PARTS { part_length(self.samples) } else { usize::MAX }
    }
}

impl Estimate {
    /// What the head of a long log, conditioned, says of the rows of the rest. By default rows near
    /// velocity reversals are left out of every joint that has enough others: how much they bias
    /// friction is compared with its error, which becomes smaller with the log, and the bias does
    /// not.
    pub fn row_rule(
        &self,
        model: &RegressionModel,
        head: &[Conditioned],
        options: &Options,
    ) -> RowRule {
        let mut left_out = self.left_out.clone();
        if options.slow == SlowRows::Biasing && model.law == CoulombLaw::Sign {
            for joint in model.coulomb().iter().map(|(joint, _)| JointIndex(*joint)) {
                if left_out.widened().iter().all(|(widened, _)| *widened != joint) {
                    left_out.widen(head, joint, 1.0);
                }
            }
        }
        RowRule { widened: left_out.widened().to_vec() }
    }

    /// The estimate of a long log of whose head this one is: by least squares, weighted perhaps.
    /// What noise of the positions does to the parameters is known of the head, and does not become
    /// less with more rows.
    ///
    /// # Errors
    /// There are fewer rows than parameters, or none.
    pub(crate) fn of_long(
        self,
        model: &RegressionModel,
        rows: &LongRows,
        options: &Options,
    ) -> Result<Self, Error> {
        let start = model.model_axes().unwrap_or_else(|| vec![0.0; model.rank()]);
        let fit = Fit { options, start: &start };
        let has_torque = rows.all.iter().any(|one| one.rows() > 0);
        let mut found = fit.of_condensed(rows.condensed.clone(), has_torque)?;
        let covariance = fit.problem(&found).covariance(options.errors);
        (found.covariance, found.degrees_of_freedom) = fit.errors(model, &found, covariance);
        let mut change = self.change;
        if let Some(change) = &mut change {
            widen(change, model, &mut found.covariance);
        }
        Ok(Self {
            noise_bias: self.noise_bias,
            noise_share: self.noise_share,
            noise_of_logs: self.noise_of_logs,
            left_out: self.left_out,
            change,
            ..found
        })
    }
}

/// Whether triangles are enough for an estimate by this method.
pub fn is_of_triangles(method: Method) -> bool {
    matches!(method, Method::Ordinary | Method::Weighted)
}
