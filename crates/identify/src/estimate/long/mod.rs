//! A log that is too long to be held at once: its rows as triangles, which are added to each other.
//!
//! The estimate needs no more of the rows than their triangles. What else is asked of a log is
//! asked of its head, which was estimated as any log is: where friction is not the sign of its
//! velocity, how large noise of the positions is, and what it does to the parameters.

mod text;

use super::condensed::{Condensed, PARTS, part_length, plain};
use super::half_cutoff::{SAMPLES, widen};
use super::least_squares::{Estimate, Fit, Method, Options};
use super::left_out::{LeftOut, SlowRows};
use super::rows::BlockMaker;
use super::validate::{JointResidual, Validation};
use crate::error::Error;
use denavit_measure::condition::{Conditioned, Piece};
use denavit_measure::{JointIndex, LogIndex, SampleIndex};
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
    /// Rows that count of a piece of each stretch, as they are and behind half the cutoff.
    halved: [Condensed; 2],
}

/// Pieces in which a log of so many stretches is condensed, each by itself: of a long one parts
/// that errors are found from, so that what is to be held does not grow with the log.
pub fn pieces(stretches: usize) -> usize {
    stretches.min(PARTS)
}

/// Rows of one log that has no parts yet.
fn no_parts(model: &RegressionModel, independent: f64, row_s: f64) -> Condensed {
    let columns = (model.pattern().to_vec(), model.rank());
    Condensed::without_parts(columns, vec![independent], vec![row_s])
}

/// Adds parts that come later, or rows of the part that is the last.
fn join(own: &mut Condensed, its: Condensed, is_same_part: bool) {
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
}

/// Settling times of a filter of half the cutoff that a piece has, at least, behind it.
const SETTLED: usize = 16;

/// The rows of a piece in the middle of a stretch as they are, and behind half the cutoff, so that
/// pieces of all stretches have as many samples as are looked at of any log; none where no position
/// has noise, or the stretch is too short.
fn halved(
    model: &RegressionModel,
    log: &Conditioned,
    left_out: &LeftOut,
    whole: WholeLog,
) -> Option<[Condensed; 2]> {
    let lower = log.filter.as_ref()?.halved()?;
    let is_noisy = log.position_noise.iter().any(|noise| *noise > 0.0);
    let length = (SAMPLES / whole.stretches).max(SETTLED * lower.settling()) / log.decimation;
    // what a stretch is read with beside it is no part of its rows
    let beside = log.range.start.div_ceil(log.decimation);
    let free = log.samples().checked_sub(length + 2 * beside).filter(|_| is_noisy && length > 0)?;
    let piece = Piece { first: SampleIndex(beside + free / 2), samples: length };
    let [plain, lower] = log.halved(piece)?;
    let first = piece.first.0 * log.decimation + plain.range.start - log.range.start;
    let place = [(LogIndex(0), first..first + plain.range.len())];
    let left_out = left_out.of_halved(std::slice::from_ref(log), &place);
    let length = whole.part_length(SAMPLES / log.decimation);
    Some([plain, lower].map(|log| condensed(model, &log, &left_out, length)))
}

impl LongRows {
    /// No rows of the kind that a conditioned stretch has.
    fn none(model: &RegressionModel, log: &Conditioned, whole: WholeLog) -> Self {
        let samples = whole.samples.max(1) as f64;
        let independent = (log.noise_gains()[0][0] * whole.inner as f64).min(samples) / samples;
        let row_s = log.step_s * log.decimation as f64;
        let condensed = no_parts(model, independent, row_s);
        let joints = model.joints.len();
        let all = condensed.pattern.iter().map(|places| Triangle::new(places.len())).collect();
        let halved = [0, 1].map(|_| no_parts(model, 1.0, row_s));
        Self { condensed, all, torque_squares: vec![0.0; joints], samples: 0, halved }
    }

    /// The rows of a conditioned stretch of a log.
    pub fn of_stretch(
        model: &RegressionModel,
        log: &Conditioned,
        rule: &RowRule,
        options: &Options,
        whole: WholeLog,
    ) -> Self {
        let left_out = LeftOut::of_part(model, log, options, &rule.widened);
        let condensed = condensed(model, log, &left_out, whole.part_length(whole.samples));
        let mut found = Self::none(model, log, whole);
        if let Some(halved) = halved(model, log, &left_out, whole) {
            found.halved = halved;
        }
        (found.condensed.parts, found.condensed.log_of_part) =
            (condensed.parts, condensed.log_of_part);
        let offset = log.time_s(SampleIndex(0)) - whole.start_s;
        found.condensed.end_s = condensed.end_s.into_iter().map(|end| end + offset).collect();
        found.samples = log.samples();
        BlockMaker::new(model, log).for_each(|block| {
            for joint in 0..found.all.len() {
                let Some(columns) = block.with_target(JointIndex(joint)) else { continue };
                found.all[joint].push(&columns);
                let [torque, _] = block.torque[joint].as_ref().expect("it has a target");
                found.torque_squares[joint] += torque.iter().map(|one| one * one).sum::<f64>();
            }
        });
        found
    }

    /// Adds the rows of a stretch, or of a piece, that comes later; of a piece that is a part of
    /// the log, as one with those before.
    pub fn add(&mut self, later: Self, is_same_part: bool) {
        join(&mut self.condensed, later.condensed, is_same_part);
        for (own, its) in self.halved.iter_mut().zip(later.halved) {
            join(own, its, is_same_part);
        }
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
    /// Samples of a part of a stretch, where those of all stretches have so many together.
    fn part_length(self, samples: usize) -> usize {
        if self.stretches < PARTS { part_length(samples) } else { usize::MAX }
    }
}

/// The rows of a log that count, in parts of so many samples.
fn condensed(
    model: &RegressionModel,
    log: &Conditioned,
    left_out: &LeftOut,
    length: usize,
) -> Condensed {
    let (pattern, rank) = (model.pattern().to_vec(), model.rank());
    let rows = (std::slice::from_ref(log), left_out);
    Condensed::of_parts(model, rows, pattern, rank, length, &mut plain)
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
        let halved = rows.halved.clone();
        let mut change = fit.change_of(model, halved, &found.weights, &found);
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
