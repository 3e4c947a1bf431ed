//! Doubts about logs: columns that are other ones than they are taken for. Another unit, sign or
//! side of the gears, another zero, constant or gain, names of two joints exchanged, signals that
//! are late.
//!
//! All such mistakes are readings of the same columns, and are compared by the evidence that the
//! rows give them: the density of the torques with all parameters integrated out. What is believed
//! of the parameters is that the model's values are off by a little, by as much as they are, or by
//! ten times that; which of these holds is weighed with the rest. So the model's values tell what
//! every parameter could make up for (all torques in mN m), where they are near the truth; and an
//! estimate that explains a log as it stands refutes values that do not. How many samples count
//! is told by how long residuals are alike: what the model lacks makes them few.

mod misreading;
mod policy;
mod reading;
mod sample;
mod search;
mod weigh;
mod window;

pub use misreading::{ExchangedColumns, Misreading};
pub use weigh::GivenValues;

use crate::estimate::noise_of_positions;
use denavit_evidence::policy::{LEFT_OF_EXPLAINED, NOTHING_LIKE};
use denavit_measure::JointIndex;
use denavit_measure::condition::Conditioned;
use denavit_measure::log::ColumnMapping;
use denavit_plants::regression::{RegressionJoint, RegressionModel};
use reading::Reading;
use sample::Sample;
use search::Search;
use std::fmt;
use weigh::{Beliefs, Shares};

/// Samples of a log in which noise of its positions is looked at, before decimation.
const LOOKED_AT: usize = 8192;

/// Columns that seem to be other ones than they are taken for.
#[derive(Clone, Debug, PartialEq)]
pub struct MisreadColumns {
    /// What they seem to be.
    pub misreading: Misreading,
    /// The log odds that they are.
    pub log_odds: f64,
    /// The share of the torques (roots of mean squares, of the joints whose share changes) that the
    /// nominal parameters leave as the log is, and as it seems to be meant; none if there are none.
    pub left_by_model: Option<[f64; 2]>,
    /// The same of an estimate.
    pub left_by_estimate: [f64; 2],
    /// The log, if it is one of several and the others are not misread.
    pub file: Option<String>,
    /// Whether nothing else explains it as well. What may be a model's parameters or a law of
    /// friction that it lacks is not sure.
    pub is_sure: bool,
    /// Its size in standard errors, if it has one.
    pub errors: Option<f64>,
    /// How columns were mapped: a hint says what is right beside that.
    pub given: ColumnMapping,
    joints: Vec<RegressionJoint>,
    step_s: f64,
    /// Whose values `left_by_model` is of, in words.
    values: &'static str,
}

impl MisreadColumns {
    /// What they seem to be, and what shows it.
    pub fn summary(&self) -> String {
        self.to_string().lines().next().unwrap_or_default().to_owned()
    }

    /// How to mend it.
    pub fn hint(&self) -> String {
        self.misreading.hint(&self.joints, &self.given)
    }
}

impl fmt::Display for MisreadColumns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{file}: ")?;
        }
        self.misreading.describe(f, &self.joints, self.step_s)?;
        let [before, after] = self.left_by_estimate.map(share);
        write!(
            f,
            ": the residual of an estimate is {before} of the torques as the log is, and \
             {after} so"
        )?;
        if let Some([before, after]) = self.left_by_model.map(|left| left.map(share)) {
            write!(f, "; {} {before} and {after}", self.values)?;
        }
        if let Some(errors) = self.errors {
            write!(f, "; it is {:.0} of its standard errors large", errors.abs())?;
        }
        write!(f, "\n  hint: {}", self.hint())
    }
}

fn share(share: f64) -> String {
    match share < 0.0995 {
        true => format!("{:.1} %", 100.0 * share),
        false => format!("{:.0} %", 100.0 * share),
    }
}

/// The columns that seem to be other ones, one after the other: each with those before it mended.
/// Of several logs all are misread alike, or some of them, whichever is more likely.
/// `values` are in place of the model's own.
pub fn misread_columns(
    model: &RegressionModel,
    logs: &[&Conditioned],
    values: Option<GivenValues<'_>>,
) -> Vec<MisreadColumns> {
    let alike = misread_alike(model, logs, values);
    if logs.len() == 1 {
        return alike;
    }
    let apart = misread_apart(model, logs, values);
    let odds = |all: &[MisreadColumns]| all.iter().map(|one| one.log_odds).sum::<f64>();
    if odds(&alike) >= odds(&apart) { alike } else { apart }
}

/// The same of each log by itself, with its name.
pub(crate) fn misread_apart(
    model: &RegressionModel,
    logs: &[&Conditioned],
    values: Option<GivenValues<'_>>,
) -> Vec<MisreadColumns> {
    let of = |log: &&Conditioned| {
        let own = misread_alike(model, &[log], values);
        let file = log.file.clone();
        own.into_iter().map(move |one| MisreadColumns { file: Some(file.clone()), ..one })
    };
    logs.iter().flat_map(of).collect()
}

/// The same of logs that are all misread alike.
fn misread_alike(
    model: &RegressionModel,
    logs: &[&Conditioned],
    values: Option<GivenValues<'_>>,
) -> Vec<MisreadColumns> {
    let step_s = logs.iter().map(|log| log.step_s).fold(f64::INFINITY, f64::min);
    let shortest = logs.iter().map(|log| log.range.len()).min().unwrap_or(0);
    let latest = (policy::LATEST_S / step_s).min(shortest as f64 / 8.0) as isize;
    let beliefs = Beliefs::new(model, values);
    let given = beliefs.values.as_ref();
    let pieces = plain_pieces(logs);
    let pieces: Vec<&Conditioned> = pieces.iter().collect();
    let noise = given.map(|phi| noise_of_positions(model, &pieces, phi.as_slice()));
    let joints = model.joints.len();
    let readings = 3 * joints * joints / 2 + 20 * joints + 30;
    let [fewest, most] = policy::SAMPLES;
    let samples = (policy::SAMPLES_READ / readings).clamp(fewest, most);
    let sample = Sample::new(model, logs, 2 * latest + 1, samples);
    if (0..joints).map(JointIndex).all(|joint| !sample.is_measured(joint)) {
        return Vec::new();
    }
    let noise = [noise.unwrap_or_default(), Vec::new()];
    let mut search = Search { sample, beliefs, noise, latest, step_s };
    search.learn_noise(&pieces);
    let mut all: Vec<MisreadColumns> = Vec::new();
    let mut reading = Reading::straight(joints);
    while all.len() <= joints + 1 {
        let Some(found) = search.best(&reading) else { break };
        if all.iter().any(|one| one.misreading.is_like(found.misreading)) {
            break;
        }
        let before = search.left(&reading);
        reading = reading.with(found.misreading, &model.joints);
        let after = search.left(&reading);
        let left_by_estimate = of_changed([&before.1, &after.1]);
        let left_by_model = before.0.zip(after.0).map(|both| of_changed([&both.0, &both.1]));
        // what a law of friction lacks is like a delay, which leaves much
        let [before, after] = left_by_estimate;
        let explained = (before * before - after * after).max(0.0).sqrt();
        let is_law = found.misreading.is_late() && after > LEFT_OF_EXPLAINED * explained;
        all.push(MisreadColumns {
            misreading: found.misreading,
            log_odds: found.log_odds,
            left_by_model,
            left_by_estimate,
            file: None,
            is_sure: found.is_sure() && !is_law && left_by_estimate[1] < NOTHING_LIKE,
            errors: found.errors,
            given: ColumnMapping::default(),
            joints: model.joints.clone(),
            step_s,
            values: match values {
                Some(_) => "the values that the other logs give",
                None => "the nominal parameters",
            },
        });
    }
    all
}

/// Pieces of logs in which noise of their positions is looked at: of rows that are not decimated,
/// as those of readings are not.
fn plain_pieces(logs: &[&Conditioned]) -> Vec<Conditioned> {
    let of_log = |log: &&Conditioned| -> Vec<Conditioned> {
        let pieces = log.pieces(LOOKED_AT).into_iter();
        pieces.map(|piece| Conditioned { decimation: 1, ..log.piece(piece) }).collect()
    };
    logs.iter().flat_map(of_log).collect()
}

/// Roots of the mean squares of shares, before and after, over the joints whose share changes most.
fn of_changed([before, after]: [&Shares; 2]) -> [f64; 2] {
    let both = before.iter().zip(after).filter_map(|(before, after)| before.zip(*after));
    let change = |(before, after): &(f64, f64)| (after / before).ln().abs();
    let both: Vec<(f64, f64)> = both.filter(|(before, _)| *before > 0.0).collect();
    let most = both.iter().map(change).fold(0.0, f64::max);
    let changed: Vec<&(f64, f64)> = both.iter().filter(|one| change(one) >= 0.5 * most).collect();
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| {
        let squares: f64 = changed.iter().map(|one| of(one).powi(2)).sum();
        (squares / changed.len().max(1) as f64).sqrt()
    };
    [mean(&|one| one.0), mean(&|one| one.1)]
}
