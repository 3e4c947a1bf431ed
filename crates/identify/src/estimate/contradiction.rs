//! Logs that contradict the others: parameters of their own would explain what those of all do not.
//!
//! A log of another payload, of another gain of its torques or with an offset is as smooth as the
//! others: it is not its noise that tells it, but that its own estimate leaves much less (a test
//! of equal parameters, Chow 1960, with samples as independent as the filter leaves them).

use super::comparison::Comparison;
use super::condensed::Condensed;
use super::least_squares::{Estimate, Fit, Method, Options};
use super::left_out::{LeftOut, NumberedLog};
use super::noise_bias::noise_squares;
use super::own_estimate::{Own, Tested, spread};
use super::rows::BlockMaker;
use super::unexplained::ShownLogs;
use crate::policy::contradiction::{ALIKE, OF_BEATS, OF_CHANCE, OF_OWN, OF_OWN_ALONE, OF_TORQUE};
use denavit_measure::condition::Conditioned;
use denavit_measure::{JointIndex, LogIndex};
use denavit_numerics::least_squares::Triangle;
use denavit_plants::regression::RegressionModel;
use nalgebra::{DMatrix, DVector};
use std::borrow::Cow;

/// Samples of a log that are looked at behind half the cutoff, before decimation.
pub(super) const SAMPLES: usize = 200_000;

/// A log that contradicts the others.
#[derive(Clone, Debug, PartialEq)]
pub struct ContradictingLog {
    /// Its name.
    pub file: String,
    /// The joints that tell it.
    pub joints: Vec<ContradictingJoint>,
    /// Which side is believed.
    pub standing: Standing,
}

/// Which of logs that contradict each other are believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// The others: they are more, and longer together, than those that contradict them.
    OfFew,
    /// The same, but parameters are not theirs alone.
    OfFewFollowed,
    /// Neither.
    Undecided,
    /// Those for the estimate: this one is for validation.
    HeldOut,
}

/// A joint whose torques in a log contradict those in the others.
#[derive(Clone, Debug, PartialEq)]
pub struct ContradictingJoint {
    /// The joint.
    pub joint: String,
    /// The share of its torque that is left, as root of mean square,
    pub left: f64,
    /// and that own parameters of the log would leave.
    pub own: f64,
    /// What is left is like this.
    pub like: Option<Likeness>,
}

/// What is left of a torque beside that of other logs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Likeness {
    /// A constant more, in this unit.
    Constant(f64, &'static str),
    /// So many times as large.
    Factor(f64),
}

/// The logs that contradict the others, of some, one after another: each is held against what the
/// others say without it, and of those that contradict them the one without which the others agree
/// best is left out, until the others agree.
pub(crate) fn contradicting_logs(
    model: &RegressionModel,
    shown_logs: ShownLogs<'_>,
    found: &Estimate,
    options: &Options,
) -> Vec<ContradictingLog> {
    let ShownLogs { logs, shown } = shown_logs;
    if logs.len() < 2 || found.condensed.rank != model.rank() {
        return Vec::new();
    }
    // those whose own noise is large beside what the others agree on: an estimate of all rows alike
    // is asked with weights, too
    let is_alike = options.method == Method::Ordinary;
    let condensed = &*plain(model, logs, found, options);
    let fit = Fit { options, start: found.solution.phi.as_slice() };
    let weighted = (is_alike || is_by_row(options)).then(|| fit.settled(condensed, true).weights);
    let weights = weighted.as_ref().unwrap_or(&found.weights);
    let left_out = &found.left_out;
    let comparison = Comparison { model, logs, condensed, weights, fit, left_out };
    let mut agreeing = shown.to_vec();
    let mut told: Vec<(LogIndex, ContradictingLog)> = Vec::new();
    while agreeing.len() > 1 {
        let mut odd = comparison.odd(&agreeing);
        if agreeing.len() > 2 && odd.len() > 1 {
            let best = comparison.oddest(&agreeing, &odd);
            odd.retain(|(log, _)| *log == best);
        }
        agreeing.retain(|log| odd.iter().all(|(other, _)| other != log));
        told.extend(odd.iter().cloned());
        if odd.is_empty() {
            break;
        }
    }
    let numbers = || (0..logs.len()).map(LogIndex);
    let noisy = numbers().filter(|log| !agreeing.is_empty() && !shown.contains(log));
    told.extend(noisy.filter_map(|log| Some((log, comparison.against(log, &agreeing)?))));
    told.sort_by_key(|(log, _)| *log);
    let time_s = |log: LogIndex| logs[log.0].range.len() as f64 * logs[log.0].step_s;
    let [all, few] =
        [numbers().map(time_s).sum::<f64>(), told.iter().map(|(log, _)| time_s(*log)).sum()];
    if !told.is_empty() && 2 * told.len() < logs.len() && 2.0 * few < all {
        let is_followed = !comparison.is_of(&agreeing, &found.solution.phi);
        let standing = if is_followed { Standing::OfFewFollowed } else { Standing::OfFew };
        told.iter_mut().for_each(|(_, one)| one.standing = standing);
    }
    told.into_iter().map(|(_, one)| one).collect()
}

/// Whether rows are weighted one by one.
fn is_by_row(options: &Options) -> bool {
    matches!(options.method, Method::Robust(_) | Method::Likelihood)
}

/// The rows of an estimate as they were measured.
pub(super) fn plain<'a>(
    model: &RegressionModel,
    logs: &[Conditioned],
    found: &'a Estimate,
    options: &Options,
) -> Cow<'a, Condensed> {
    match is_by_row(options) {
        true => Cow::Owned(Condensed::counted(model, (logs, &found.left_out))),
        false => Cow::Borrowed(&found.condensed),
    }
}

/// What others say of a log.
pub(super) struct Claim<'a> {
    pub(super) model: &'a RegressionModel,
    pub(super) phi: &'a DVector<f64>,
    /// That of phi.
    pub(super) covariance: &'a DMatrix<f64>,
    /// The rows of logs that are left out.
    pub(super) left_out: &'a LeftOut,
    /// The mean of what phi leaves of each joint's torque in the other logs.
    pub(super) means: &'a [f64],
}

impl Claim<'_> {
    /// Whether a log of this number contradicts it.
    pub(super) fn against(
        &self,
        at: LogIndex,
        logs: &[Conditioned],
        one: &Tested<'_>,
    ) -> Option<ContradictingLog> {
        let log = &logs[at.0];
        let named = |Told { joint, left, own, .. }: Told| ContradictingJoint {
            joint: self.model.joints[joint.0].name.clone(),
            left,
            own,
            like: likeness(self.model, log, joint, self.phi.as_slice()),
        };
        let joints: Vec<_> = self.told(at, logs, one).into_iter().map(named).collect();
        let (file, standing) = (log.file.clone(), Standing::Undecided);
        (!joints.is_empty()).then_some(ContradictingLog { file, joints, standing })
    }

    /// The joints that tell it. Those of whose torque noise of the positions may make as much, or
    /// as much as would tell it, are asked behind half the cutoff, which leaves less of it, and so
    /// on: of a long log in its first piece.
    fn told(&self, at: LogIndex, logs: &[Conditioned], one: &Tested<'_>) -> Vec<Told> {
        let log = &logs[at.0];
        // where the sign of a rate is not known, a constant may be friction
        let is_known =
            |joint: usize| !log.resting[joint] && log.unsure_signs(JointIndex(joint)).is_none();
        let signs: Vec<bool> = (0..self.model.joints.len()).map(is_known).collect();
        let mut told = self.joints(one, &signs);
        let noise =
            noise_squares(self.model, NumberedLog { number: at, log }, self.left_out, self.phi);
        told.retain(|told| told.explained > OF_BEATS * noise[told.joint.0]);
        let is_noisy = |joint: usize| {
            let torque = one.triangles[joint].target_squares();
            OF_BEATS * noise[joint] > OF_TORQUE.powi(2) * torque
        };
        let is_open = |joint: usize| is_noisy(joint) && told.iter().all(|one| one.joint.0 != joint);
        let open: Vec<usize> = (0..signs.len()).filter(|&joint| is_open(joint)).collect();
        let piece = log.pieces(SAMPLES)[0];
        let halved = if open.is_empty() { None } else { log.halved(piece) };
        if let Some([_, lower]) = halved {
            let first = piece.first.0 * log.decimation + lower.range.start - log.range.start;
            let place = first..first + lower.range.len();
            let left_out = &self.left_out.of_halved(logs, &[(at, place)]);
            let lower = &[lower];
            let condensed = Condensed::counted(self.model, (lower, left_out));
            let one = Tested::new(&condensed, LogIndex(0), one.weights);
            let lower = Claim { left_out, ..*self }.told(LogIndex(0), lower, &one);
            told.extend(lower.into_iter().filter(|one| open.contains(&one.joint.0)));
        }
        told
    }

    /// The joints of whose torque an estimate of a log's own, or a constant beside what others
    /// have, leaves much less than phi does.
    fn joints(&self, one: &Tested<'_>, signs: &[bool]) -> Vec<Told> {
        let Self { model, phi, covariance, .. } = *self;
        let pattern = model.pattern();
        let own = one.own(phi.as_slice());
        let of_own = if one.has_parts() { OF_OWN } else { OF_OWN_ALONE };
        let of = |(joint, triangle): (usize, &Triangle)| {
            let rows = triangle.rows() as f64;
            let all = triangle.target_squares();
            let left = triangle.squares(&model.of_joint(joint, phi.as_slice()));
            let unsure = spread(triangle, &pattern[joint], covariance);
            let constant = one.constant(left, JointIndex(joint), phi.as_slice(), self.means[joint]);
            let constant = signs[joint].then_some(constant);
            let told = |Own { squares, variance, chance }: &Own| {
                let explained = (left - squares).max(0.0);
                let chance = chance + unsure;
                let is_much = explained > OF_TORQUE.powi(2) * all
                    && explained > of_own.powi(2) * variance * rows
                    && explained > OF_CHANCE * chance;
                let [left, own] = [left, variance * rows].map(|one| (one / all).sqrt());
                is_much.then_some(Told { joint: JointIndex(joint), left, own, explained })
            };
            let both = std::iter::once(&own[joint]).chain(&constant).filter_map(told);
            both.max_by(|a, b| a.explained.total_cmp(&b.explained))
        };
        one.triangles.iter().enumerate().filter_map(of).collect()
    }
}

/// A joint that tells a contradiction.
struct Told {
    joint: JointIndex,
    /// The shares of its torque that phi and parameters of the log's own leave,
    left: f64,
    own: f64,
    /// and the squares that these explain.
    explained: f64,
}

/// Whether what phi leaves of a joint's torque in a log is nearly a constant, or as if the torque
/// were so many times as large.
fn likeness(
    model: &RegressionModel,
    log: &Conditioned,
    joint: JointIndex,
    phi: &[f64],
) -> Option<Likeness> {
    // rows, sums of what is left and of its squares, its products with the computed torque, whose
    // squares
    let mut sums = [0.0; 5];
    BlockMaker::new(model, log).for_each_left(phi, |of, _, [torque, _, left]| {
        if of == joint {
            let computed = torque - left;
            let own = [1.0, left, left * left, left * computed, computed * computed];
            sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        }
    });
    let [rows, sum, squares, both, computed] = sums;
    let unit = if model.joints[joint.0].slides { "N" } else { "N m" };
    let constant = (squares - sum * sum / rows, Likeness::Constant(sum / rows, unit));
    let factor = (squares - both * both / computed, Likeness::Factor(1.0 + both / computed));
    let best = if constant.0 < factor.0 { constant } else { factor };
    (best.0 < ALIKE * squares).then_some(best.1)
}
