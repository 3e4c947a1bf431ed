//! All that identification says: data alone, for tables, files and reports to show.

use super::doubt::{GivenValues, MisreadColumns, misread_apart, misread_columns};
use super::error::Error;
use super::estimate::{
    Consistent, ContradictingLog, Convergence, Estimate, HeldOut, IdentifiedParameter, Judgement,
    Options, ShownLogs, SlowRows, Standing, Status, Unexplained, Validation, biased_frictions,
    consistent, contradicting_logs, convergence, estimate, filter_errors, lacking, long_enough,
    noise_of_positions, parameters, unexplained_joints, validate,
};
use super::noisy_logs::{MOST, biasing_logs, noisy_logs, shown_logs};
use super::odd_log::odd_log;
use crate::policy::identification::{FAR, NOISY, OTHER, SHORT, SMEARED};
use denavit_measure::condition::Conditioned;
use denavit_measure::{JointIndex, LogIndex};
use denavit_plants::regression::{RegressionJoint, RegressionModel};

/// What is to be identified, from what.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// Base parameters and their columns.
    pub model: &'a RegressionModel,
    /// Logs to estimate from.
    pub train: &'a [Conditioned],
    /// Logs to judge the estimate with.
    pub validate: &'a [Conditioned],
    /// Logs of the same motion without its noise, for instrumental variables.
    pub instruments: &'a [Conditioned],
    /// How.
    pub options: &'a Options,
}

/// What was identified.
#[derive(Clone, Debug)]
pub struct Identification {
    /// The base parameters that are listed.
    pub parameters: Vec<IdentifiedParameter>,
    /// What is left of the torques of the logs that the estimate is from.
    pub train: Validation,
    /// What is left of those of other logs; none without any.
    pub validate: Option<Validation>,
    /// What is left with the values that the model had of the logs that were not used, or, without
    /// any, of those that were; none if the model lacks a value.
    pub before: Option<f64>,
    /// Columns that seem to be other ones than they are taken for, one after the other: each with
    /// those before it mended; those of the logs for validation at last.
    pub misread: Vec<MisreadColumns>,
    /// Logs for the estimate that contradict the others, and those for validation that contradict
    /// the logs for the estimate.
    pub contradicting_logs: Vec<ContradictingLog>,
    /// Logs of several for the estimate of which noise of the positions makes most, and its share.
    pub noisy_logs: Vec<(String, f64)>,
    /// The joint of whose torque the filter makes most by itself, since the motion is too fast for
    /// it, and how much: a share of its root of mean square.
    pub filter_error: Option<(String, f64)>,
    /// Rows that were left out, joint by joint.
    pub left_out: Vec<LeftOutRows>,
    /// Joints whose Coulomb friction was estimated by the sign of a rate that is near 0 in so much
    /// of the logs that it is biased, each with the share of samples.
    pub reversals: Vec<(String, f64)>,
    /// Joints of whose torque nearly all is left, or much that is no noise, in the logs for
    /// validation or, if there are none, those of the estimate.
    pub unexplained: Vec<Unexplained>,
    /// Joints of whose torque something is left that is no noise, with its share.
    pub lacking: Vec<(String, f64)>,
    /// Periods of the filter's cutoff that all logs for the estimate have.
    pub periods: f64,
    /// The estimate came about so.
    pub convergence: Vec<Convergence>,
    /// The nearest bodies that exist.
    pub consistent: Consistent,
    /// The estimate on the joint axes.
    pub estimate: Estimate,
}

/// Rows of a joint that do not count, since it turns round or is slow there.
#[derive(Clone, Debug, PartialEq)]
pub struct LeftOutRows {
    /// The joint.
    pub joint: String,
    /// Samples that are left out, after decimation.
    pub samples: usize,
    /// Of so many.
    pub of: usize,
    /// The share of the joint's torque that is left of the others, as roots of mean squares.
    pub left: f64,
}

impl Identification {
    /// Whether noise makes most of what the motion shows of some parameters: what is found says
    /// neither how far they are off nor whether columns are what they are taken for.
    pub fn is_noise(&self) -> bool {
        self.estimate.noise_share > MOST
    }

    /// Whether the logs are short for their filters.
    pub fn is_short(&self) -> bool {
        self.periods < SHORT
    }

    /// Whether the nominal parameters leave far more than there is.
    pub fn is_of_other_robot(&self) -> bool {
        self.before.is_some_and(|before| before > OTHER)
    }

    /// Whether the nearest bodies are far from the estimate, and noise does not make most of it.
    pub fn is_of_no_bodies(&self) -> bool {
        self.consistent.distance > FAR && !self.is_noise()
    }

    /// The names of parameters that the motion does not show.
    pub fn not_excited(&self) -> Vec<&str> {
        let hidden = self.parameters.iter().filter(|one| one.status == Status::NotExcited);
        hidden.map(|one| one.name.as_str()).collect()
    }
}

/// An estimate before anything is judged by it but its filters.
#[derive(Clone, Debug)]
pub struct Estimated {
    /// The base parameters that are listed.
    pub parameters: Vec<IdentifiedParameter>,
    /// The joint of whose torque the filter makes most by itself, and how much.
    pub filter_error: Option<(String, f64)>,
    /// For each log for the estimate whether its noise of positions biases parameters, so that it
    /// needs a lower filter.
    pub biasing_logs: Vec<bool>,
    left: Validation,
    found: Estimate,
}

/// Estimates, judges, and finds the nearest bodies that exist.
pub fn identify(request: Request<'_>) -> Result<Identification, Error> {
    Ok(estimated(request)?.judged(request))
}

/// Estimates alone: what filters are chosen by.
pub fn estimated(request: Request<'_>) -> Result<Estimated, Error> {
    let Request { model, train, instruments, options, .. } = request;
    let start = model.model_axes().unwrap_or_else(|| vec![0.0; model.rank()]);
    let found = estimate(model, train, instruments, options, &start)?;
    if options.prior.is_empty() {
        long_enough(train, &found)?;
    }
    let phi = found.solution.phi.as_slice();
    let left = validate(model, phi, train);
    let listed = parameters(model, &found);
    Ok(Estimated {
        filter_error: filter_error(model, train, phi, &left),
        biasing_logs: biasing_logs(model, &listed, &found),
        parameters: listed,
        left,
        found,
    })
}

impl Estimated {
    /// Whether a log for validation needs a lower filter.
    pub fn is_noisy(&self, model: &RegressionModel, log: &Conditioned) -> bool {
        let noise = noise_of_positions(model, &[log], self.found.solution.phi.as_slice());
        noise.into_iter().any(|share| share > NOISY)
    }

    /// All that there is to say of it and of the logs that it is from.
    pub fn judged(self, request: Request<'_>) -> Identification {
        let Self { parameters: listed, filter_error, left, found, .. } = self;
        let Request { model, train, validate: held_out, options, .. } = request;
        let given = model.model_axes();
        let phi = found.solution.phi.as_slice();
        let judged = |phi: &[f64]| (!held_out.is_empty()).then(|| validate(model, phi, held_out));
        let held_out_left = judged(phi);
        let torques = torques(model, &left);
        let counted = shares(model, &found, &left);
        // of a log that is noise, much is left
        let shown = shown_logs(train.len(), &found);
        let train_logs = ShownLogs { logs: train, shown: &shown };
        let mut contradicting_logs = contradicting_logs(model, train_logs, &found, options);
        let misread = misread(request, &found, &contradicting_logs);
        let (judges, judging) = match held_out.is_empty() {
            true => (train, shown.clone()),
            false => (held_out, (0..held_out.len()).map(LogIndex).collect()),
        };
        let together: Vec<&Conditioned> = judging.iter().map(|&log| &judges[log.0]).collect();
        let left_together = validate(model, phi, &together);
        let others = HeldOut::new(model, held_out, &found, options);
        let contradicting = others.iter().flat_map(|others| others.contradicting(train, options));
        contradicting_logs.extend(contradicting);
        let judgement = Judgement { found: &found, left: &left_together, counted: &counted };
        let judging_logs = ShownLogs { logs: judges, shown: &judging };
        let mut unexplained = unexplained_joints(model, judging_logs, judgement);
        let is_told = |one: &Unexplained| {
            let contradicts = |log: &ContradictingLog| one.file.as_ref() == Some(&log.file);
            contradicting_logs.iter().any(contradicts)
                || unexplained.iter().any(|other| other.joint == one.joint)
        };
        let exceeding = others.iter().flat_map(|others| others.exceeding(&counted));
        let exceeding: Vec<Unexplained> = exceeding.filter(|one| !is_told(one)).collect();
        unexplained.extend(exceeding);
        Identification {
            unexplained,
            misread,
            reversals: reversals(model, train, &found, options),
            left_out: left_out(model, train, &found, &counted),
            contradicting_logs,
            noisy_logs: noisy_logs(train, &found),
            lacking: lacking(model, train_logs, &found, &torques),
            periods: train.iter().map(Conditioned::periods).sum(),
            parameters: listed,
            filter_error,
            train: left,
            validate: held_out_left,
            before: given.map(|phi| {
                let logs = if held_out.is_empty() { train } else { held_out };
                validate(model, &phi, logs).relative
            }),
            convergence: convergence(model, &found),
            consistent: consistent(model, &found),
            estimate: found,
        }
    }
}

/// For each joint the share of its torque that is noise of the rows that count.
pub(super) fn shares(model: &RegressionModel, found: &Estimate, left: &Validation) -> Vec<f64> {
    let share = |(noise, torque): (f64, f64)| if torque > 0.0 { noise / torque } else { 0.0 };
    found.noise_of_joints().into_iter().zip(torques(model, left)).map(share).collect()
}

/// Root of mean square of each joint's torque; 0 where none was measured.
fn torques(model: &RegressionModel, left: &Validation) -> Vec<f64> {
    let of_joint =
        |joint: &RegressionJoint| left.joint(&joint.name).map_or(0.0, |one| one.torque_rms);
    model.joints.iter().map(of_joint).collect()
}

/// Columns that seem to be other ones than they are taken for. Logs of which noise makes most show
/// nothing of that.
fn misread(
    request: Request<'_>,
    found: &Estimate,
    contradicting: &[ContradictingLog],
) -> Vec<MisreadColumns> {
    let Request { model, train, validate: held_out, .. } = request;
    if found.noise_share > MOST {
        return Vec::new();
    }
    let shown = shown_logs(train.len(), found);
    let logs: Vec<&Conditioned> = shown.iter().map(|&log| &train[log.0]).collect();
    let mut misread = misread_columns(model, &logs, None);
    // values that a log gives which contradicts the others would accuse a good one
    let is_told = |log: &LogIndex| contradicting.iter().any(|one| one.file == train[log.0].file);
    let told: Vec<LogIndex> = shown.iter().copied().filter(is_told).collect();
    let asked = if told.is_empty() { &shown } else { &told };
    let odd = odd_log(model, asked, &shown, found);
    if let (true, Some((log, others))) = (misread.is_empty(), odd) {
        let errors: Vec<f64> = others.factor.row_iter().map(|row| row.norm()).collect();
        let values = GivenValues { phi: others.phi.as_slice(), errors: &errors };
        misread = misread_apart(model, &[&train[log.0]], Some(values));
        if contradicting.iter().any(|one| one.standing == Standing::Undecided) {
            misread.iter_mut().for_each(|one| one.is_sure = false);
        }
    }
    let errors: Vec<f64> =
        found.covariance.diagonal().iter().map(|variance| variance.max(0.0).sqrt()).collect();
    let values = GivenValues { phi: found.solution.phi.as_slice(), errors: &errors };
    let others = misread_apart(model, &held_out.iter().collect::<Vec<_>>(), Some(values));
    let is_told = |one: &MisreadColumns| {
        let is_same = |told: &MisreadColumns| told.misreading.is_like(one.misreading);
        misread.iter().any(|told| told.file.is_none() && is_same(told))
    };
    let others: Vec<MisreadColumns> = others.into_iter().filter(|one| !is_told(one)).collect();
    misread.extend(others);
    misread
}

/// The joint of whose torque the filter makes most by itself, if that is a part of what is left.
fn filter_error(
    model: &RegressionModel,
    logs: &[Conditioned],
    phi: &[f64],
    left: &Validation,
) -> Option<(String, f64)> {
    let names = model.joints.iter().map(|joint| joint.name.clone());
    let is_large = |(name, share): &(String, f64)| {
        let left = left.joint(name);
        *share > SMEARED[0] && left.is_some_and(|left| *share > SMEARED[1] * left.relative)
    };
    let all = names.zip(filter_errors(model, logs, phi)).filter(is_large);
    all.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// The joints whose Coulomb friction is biased by samples that were not left out.
fn reversals(
    model: &RegressionModel,
    logs: &[Conditioned],
    found: &Estimate,
    options: &Options,
) -> Vec<(String, f64)> {
    if !matches!(options.slow, SlowRows::Biasing | SlowRows::Kept) {
        return Vec::new();
    }
    let without = left_out(model, logs, found, &[]);
    let of = |(joint, share): (JointIndex, f64)| (model.joints[joint.0].name.clone(), share);
    let biased = biased_frictions(model, logs, &found.solution.phi, &found.covariance);
    let counted = biased.into_iter().map(of);
    counted.filter(|(name, _)| without.iter().all(|one| one.joint != *name)).collect()
}

/// The rows of each joint that do not count, with the shares that are left of the others.
fn left_out(
    model: &RegressionModel,
    logs: &[Conditioned],
    found: &Estimate,
    counted: &[f64],
) -> Vec<LeftOutRows> {
    let parts = &found.condensed.parts;
    let rows = |joint: usize| parts.iter().map(|part| part[joint].rows()).sum::<usize>();
    let of = |joint: usize| -> usize {
        let measured = logs.iter().filter(|log| log.torque[joint].is_some());
        measured.map(Conditioned::samples).sum()
    };
    let all = (0..model.joints.len()).map(|joint| [of(joint) - rows(joint), of(joint)]);
    left_out_rows(model, all.collect(), counted)
}

/// The joints of whose rows some do not count: how many, and of how many.
pub(super) fn left_out_rows(
    model: &RegressionModel,
    rows: Vec<[usize; 2]>,
    counted: &[f64],
) -> Vec<LeftOutRows> {
    let one = |(joint, [samples, of]): (usize, [usize; 2])| LeftOutRows {
        joint: model.joints[joint].name.clone(),
        samples,
        of,
        left: counted.get(joint).copied().unwrap_or(0.0),
    };
    rows.into_iter().enumerate().map(one).filter(|one| one.samples > 0).collect()
}
