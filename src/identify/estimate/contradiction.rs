//! Logs that contradict the others: parameters of their own would explain what those of all do not.
//!
//! A log of another payload, of another gain of its torques or with an offset is as smooth as the
//! others: it is not its noise that tells it, but that its own estimate leaves much less (a test
//! of equal parameters, Chow 1960, with samples as independent as the filter leaves them).

use super::condensed::Condensed;
use super::least_squares::{Estimate, Fit, Method, Options};
use super::left_out::LeftOut;
use super::noise_bias::noise_squares;
use super::own_estimate::{Own, Tested, of_joint, spread, total};
use super::rows::BlockMaker;
use super::triangle::Triangle;
use crate::identify::condition::Conditioned;
use crate::plants::regression::RegressionModel;
use nalgebra::{DMatrix, DVector};
use std::fmt;

/// What own parameters explain must be this share of a joint's torque, as root of mean square, and
/// so many times what they leave, which noise may have made them follow; where parts of the log do
/// not say for how long that is alike, so many times,
const OF_TORQUE: f64 = 0.03;
const OF_OWN: f64 = 0.5;
const OF_OWN_ALONE: f64 = 1.5;

/// and this many times what chance explains with as many parameters, in variance.
const OF_CHANCE: f64 = 25.0;

/// and what noise of the positions makes of it, in variance: to follow that, parameters of a log's
/// own are biased. That noise is known to a few times, since steps of an encoder may beat with the
/// samples: what is less than these is asked behind half the cutoff, too, and where the filter
/// follows the steps nothing is.
const OF_NOISE: f64 = 4.0;
const OF_BEATS: f64 = 10.0;

/// Samples of a log that are looked at behind half the cutoff, before decimation.
const SAMPLES: usize = 200_000;

/// What a constant or a factor leaves of the squares of what it is told for, at most.
const ALIKE: f64 = 0.25;

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
    /// The same, but parameters are those of all logs alike.
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

impl fmt::Display for ContradictingLog {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, joints, standing } = self;
        let of = |one: &ContradictingJoint| {
            let ContradictingJoint { joint, left, own, like } = one;
            let like = match like {
                None => String::new(),
                Some(Likeness::Constant(by, unit)) => format!(", as if {by:+.3} {unit} were added"),
                Some(Likeness::Factor(by)) => format!(", as if it were {by:.3} times as large"),
            };
            let [left, own] = [left, own].map(|share| 100.0 * share);
            format!("{left:.1} % of the torque of {joint} is left, {own:.1} % by its own{like}")
        };
        let joints: Vec<String> = joints.iter().map(of).collect();
        match standing {
            Standing::OfFew | Standing::OfFewFollowed => {
                write!(
                    f,
                    "{file} contradicts the other logs, which no parameters explain together "
                )?;
                write!(f, "with it")?;
            }
            Standing::Undecided => write!(f, "{file} and the other logs contradict each other")?,
            Standing::HeldOut => {
                write!(f, "{file} and the logs for the estimate contradict each other")?;
            }
        }
        write!(
            f,
            ": {}. It may be of another payload, gain, offset or robot, or show a law that the \
             model lacks. ",
            joints.join("; ")
        )?;
        match standing {
            Standing::OfFew => write!(f, "Parameters are those of the others; leave it out."),
            Standing::OfFewFollowed => write!(
                f,
                "Parameters are those of all logs alike, as --method ols has them; leave it out."
            ),
            Standing::HeldOut => write!(f, "Which of them are right cannot be told."),
            Standing::Undecided => write!(
                f,
                "The logs that agree are not both more and longer together than those that do \
                 not: which of them are right cannot be told, and what was found is not to be \
                 believed. Look at each log by itself."
            ),
        }
    }
}

/// The logs that contradict the others, of some: those whose own noise is large beside what the
/// others agree on, so that an estimate of all rows alike is asked with weights, too.
pub(in crate::identify) fn contradicting_logs(
    model: &RegressionModel,
    (logs, shown): (&[Conditioned], &[usize]),
    (found, options): (&Estimate, &Options),
) -> Vec<ContradictingLog> {
    if shown.len() < 2 || found.condensed.rank != model.rank() {
        return Vec::new();
    }
    let is_alike = options.method == Method::Ordinary;
    // by other methods rows are weighted one by one
    let is_by_row = matches!(options.method, Method::Robust(_) | Method::Likelihood);
    let plain = is_by_row.then(|| Condensed::counted(model, (logs, &found.left_out)));
    let condensed = plain.as_ref().unwrap_or(&found.condensed);
    let start = found.solution.phi.as_slice();
    let settled = || Fit { options, start }.settled(condensed, true);
    let weighted = (is_alike || is_by_row).then(settled);
    let (phi, weights) = match &weighted {
        Some(weighted) => (&weighted.solution.phi, &weighted.weights),
        None => (&found.solution.phi, &found.weights),
    };
    let left_out = &found.left_out;
    let of_logs = (phi.as_slice(), 1);
    let sums = |log: usize| left_sums(model, ((log, &logs[log]), left_out), of_logs);
    let sums: Vec<Vec<Vec<[f64; 2]>>> = (0..logs.len()).map(sums).collect();
    let told = shown.iter().filter_map(|&log| {
        let one = Tested::new(condensed, log, &weights[log]);
        let others = shown.iter().filter(|&&other| other != log).map(|&other| &sums[other]);
        let claim = Claim { model, phi, covariance: None, left_out, means: &means(others) };
        Some((log, claim.against((log, logs), one)?))
    });
    let mut told: Vec<(usize, ContradictingLog)> = told.collect();
    let time_s = |log: usize| logs[log].range.len() as f64 * logs[log].step_s;
    let [all, few] = [
        shown.iter().map(|&log| time_s(log)).sum::<f64>(),
        told.iter().map(|(log, _)| time_s(*log)).sum(),
    ];
    if 2 * told.len() < shown.len() && 2.0 * few < all {
        let standing = if is_alike { Standing::OfFewFollowed } else { Standing::OfFew };
        told.iter_mut().for_each(|(_, one)| one.standing = standing);
    }
    told.into_iter().map(|(_, one)| one).collect()
}

/// The logs for validation that contradict those for the estimate: parameters are taken to be
/// anywhere within their errors, and those that the estimate does not show are the logs' own.
pub(in crate::identify) fn contradicting_held_out(
    model: &RegressionModel,
    (train, logs): (&[Conditioned], &[Conditioned]),
    (found, options): (&Estimate, &Options),
) -> Vec<ContradictingLog> {
    if logs.is_empty() || found.condensed.rank != model.rank() {
        return Vec::new();
    }
    let left_out = found.left_out.of_others(model, logs, options);
    let condensed = Condensed::counted(model, (logs, &left_out));
    let weight = |noise: f64| if noise > 0.0 { 1.0 / noise } else { 0.0 };
    let weights: Vec<f64> = found.noise_of_joints().into_iter().map(weight).collect();
    let own = (found.solution.phi.as_slice(), 1);
    let sums = |both: (usize, &Conditioned)| left_sums(model, (both, &found.left_out), own);
    let means = &means(&train.iter().enumerate().map(sums).collect::<Vec<_>>());
    let of = |at: usize| {
        let one = Tested::new(&condensed, at, &weights);
        let phi = &one.with_own(&found.solution);
        let (covariance, left_out) = (Some(&found.covariance), &left_out);
        let told = Claim { model, phi, covariance, left_out, means }.against((at, logs), one)?;
        Some(ContradictingLog { standing: Standing::HeldOut, ..told })
    };
    (0..logs.len()).filter_map(of).collect()
}

/// What others say of a log.
struct Claim<'a> {
    model: &'a RegressionModel,
    phi: &'a DVector<f64>,
    /// That of phi, if it is from other logs alone.
    covariance: Option<&'a DMatrix<f64>>,
    /// The rows of logs that are left out.
    left_out: &'a LeftOut,
    /// The mean of what phi leaves of each joint's torque in the other logs.
    means: &'a [f64],
}

impl Claim<'_> {
    /// Whether a log of this number contradicts it.
    fn against(
        &self,
        (at, logs): (usize, &[Conditioned]),
        one: Tested<'_>,
    ) -> Option<ContradictingLog> {
        let Self { model, phi, .. } = *self;
        let log = &logs[at];
        // where the sign of a rate is not known, a constant may be friction
        let is_known = |joint: usize| !log.resting[joint] && log.unsure_signs(joint).is_none();
        let signs: Vec<bool> = (0..model.joints.len()).map(is_known).collect();
        let mut told = self.joints((at, log), (&one, &signs));
        if !told.is_empty() {
            let noise = noise_squares(model, ((at, log), self.left_out), phi);
            let is_sure = |one: &Told| one.explained > OF_BEATS * noise[one.joint];
            let lower = match log.follows_steps() || told.iter().all(is_sure) {
                true => Vec::new(),
                false => self.behind_half_the_cutoff((at, logs), (one.weights, &signs)),
            };
            told.retain(|one| {
                let is_less = one.explained > OF_NOISE * noise[one.joint];
                is_sure(one) || (is_less && lower.iter().any(|other| other.joint == one.joint))
            });
        }
        let named = |Told { joint, left, own, .. }: Told| ContradictingJoint {
            joint: model.joints[joint].name.clone(),
            left,
            own,
            like: likeness(model, log, (joint, phi.as_slice())),
        };
        let joints: Vec<ContradictingJoint> = told.into_iter().map(named).collect();
        let (file, standing) = (log.file.clone(), Standing::Undecided);
        (!joints.is_empty()).then_some(ContradictingLog { file, joints, standing })
    }

    /// The joints that tell it behind half the cutoff of the log, where next to no noise of the
    /// positions is left: of a long log in its first piece.
    fn behind_half_the_cutoff(
        &self,
        (at, logs): (usize, &[Conditioned]),
        (weights, signs): (&[f64], &[bool]),
    ) -> Vec<Told> {
        let log = &logs[at];
        let piece = log.pieces(SAMPLES)[0];
        let Some([_, lower]) = log.halved(piece) else { return Vec::new() };
        let first = piece.first * log.decimation + lower.range.start - log.range.start;
        let place = first..first + lower.range.len();
        let left_out = &self.left_out.of_halved(logs, &[(at, place)]);
        let lower = &[lower];
        let condensed = Condensed::counted(self.model, (lower, left_out));
        let one = Tested::new(&condensed, 0, weights);
        Claim { left_out, ..*self }.joints((0, &lower[0]), (&one, signs))
    }

    /// The joints of whose torque an estimate of a log's own, or a constant beside what others
    /// have, leaves much less than phi does.
    fn joints(
        &self,
        (at, log): (usize, &Conditioned),
        (one, signs): (&Tested<'_>, &[bool]),
    ) -> Vec<Told> {
        let Self { model, phi, covariance, .. } = *self;
        let parts = one.condensed.parts.len();
        let sums = left_sums(model, ((at, log), self.left_out), (phi.as_slice(), parts));
        let pattern = model.pattern();
        let own = one.own(phi.as_slice());
        let of_own = if one.has_parts() { OF_OWN } else { OF_OWN_ALONE };
        let of = |(joint, triangle): (usize, &Triangle)| {
            let rows = triangle.rows() as f64;
            let all = triangle.target_squares();
            let left = triangle.squares(&of_joint(&pattern[joint], phi.as_slice()));
            let unsure = covariance.map_or(0.0, |one| spread(triangle, &pattern[joint], one));
            let constant = one.constant(left, (&sums[joint], self.means[joint]));
            let constant = signs[joint].then_some(constant);
            let told = |Own { squares, variance, chance }: &Own| {
                let explained = (left - squares).max(0.0);
                let chance = chance + unsure;
                let is_much = explained > OF_TORQUE.powi(2) * all
                    && explained > of_own.powi(2) * variance * rows
                    && explained > OF_CHANCE * chance;
                let [left, own] = [left, variance * rows].map(|one| (one / all).sqrt());
                is_much.then_some(Told { joint, left, own, explained })
            };
            let both = std::iter::once(&own[joint]).chain(&constant).filter_map(told);
            both.max_by(|a, b| a.explained.total_cmp(&b.explained))
        };
        one.triangles.iter().enumerate().filter_map(of).collect()
    }
}

/// For each joint, and so many parts of a log, rows that count, and the sum of what phi leaves of
/// its torque there.
fn left_sums(
    model: &RegressionModel,
    ((number, log), left_out): ((usize, &Conditioned), &LeftOut),
    (phi, parts): (&[f64], usize),
) -> Vec<Vec<[f64; 2]>> {
    let own: Vec<Vec<f64>> = model.pattern().iter().map(|places| of_joint(places, phi)).collect();
    let mut sums = vec![vec![[0.0; 2]; parts]; own.len()];
    BlockMaker::new(model, log).for_each(|block| {
        for (joint, sums) in sums.iter_mut().enumerate() {
            let Some(left) = block.residual(joint, &own[joint]) else { continue };
            let counts = left_out.counts((number, log), joint, (block.first, block.samples));
            let counted = |at: &usize| counts.as_ref().is_none_or(|counts| counts[*at]);
            for at in (0..left.len()).filter(counted) {
                let [rows, sum] = &mut sums[(block.first + at) * parts / log.samples()];
                (*rows, *sum) = (*rows + 1.0, *sum + left[at]);
            }
        }
    });
    sums
}

/// The mean of what is left of each joint's torque in some logs.
fn means<'a>(logs: impl IntoIterator<Item = &'a Vec<Vec<[f64; 2]>>>) -> Vec<f64> {
    let mut all: Vec<[f64; 2]> = Vec::new();
    for log in logs {
        all.resize(log.len(), [0.0; 2]);
        all.iter_mut().zip(log).for_each(|(all, own)| *all = total(&[*all, total(own)]));
    }
    all.into_iter().map(|[rows, sum]| sum / rows.max(1.0)).collect()
}

/// A joint that tells a contradiction.
struct Told {
    joint: usize,
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
    (joint, phi): (usize, &[f64]),
) -> Option<Likeness> {
    let own: Vec<f64> = model.pattern()[joint].iter().map(|&at| phi[at]).collect();
    // rows, sums of what is left and of its squares, its products with the computed torque, whose
    // squares
    let mut sums = [0.0; 5];
    BlockMaker::new(model, log).for_each(|block| {
        let (Some(left), Some([torque, _])) = (block.residual(joint, &own), &block.torque[joint])
        else {
            return;
        };
        for (left, torque) in left.into_iter().zip(torque) {
            let computed = torque - left;
            let own = [1.0, left, left * left, left * computed, computed * computed];
            sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        }
    });
    let [rows, sum, squares, both, computed] = sums;
    let unit = if model.joints[joint].slides { "N" } else { "N m" };
    let constant = (squares - sum * sum / rows, Likeness::Constant(sum / rows, unit));
    let factor = (squares - both * both / computed, Likeness::Factor(1.0 + both / computed));
    let best = if constant.0 < factor.0 { constant } else { factor };
    (best.0 < ALIKE * squares).then_some(best.1)
}
