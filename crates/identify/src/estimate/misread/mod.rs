//! Columns that are other ones than they are taken for: another unit, sign or side of the gears,
//! another zero, names of two joints exchanged, signals that are late.
//!
//! All such mistakes are readings of the same columns, and each is judged alike, by two witnesses:
//! the torques that the model's own values make of the motion, and how well an estimate can explain
//! the torques at all. The first is needed where every parameter can make up for the mistake (all
//! torques in mN m); the second holds where the model's values are far from true. A reading that
//! one of them speaks for and the other speaks against is none.

mod balance;
mod constants;
mod misreading;
mod reading;
mod search;
mod verdict;
mod window;

pub use misreading::{ExchangedColumns, Misreading};
pub(crate) use verdict::CLEAN;

use super::least_squares::Estimate;
use super::likelihood::noise_of_positions;
use super::report::{IdentifiedParameter, Status};
use balance::Balance;
pub(crate) use balance::nominal_values;
use denavit_measure::condition::Conditioned;
use denavit_measure::log::ColumnMapping;
use denavit_plants::regression::{RegressionJoint, RegressionModel};
use reading::Reading;
use search::Search;
use std::fmt;
use verdict::{NEAR, WORSE};

/// Signals are at most so late \[s\].
const LATEST_S: f64 = 0.2;

/// How often the cutoff is halved to look for readings that make more of noise, and samples of all
/// logs that are looked at then, before decimation.
const HALVINGS: usize = 2;
const SAMPLES: usize = 200_000;

/// Standard errors by which friction is surely above or below 0.
const SURE: f64 = 5.0;

/// What is known of logs before their columns are doubted.
#[derive(Clone, Copy, Debug, Default)]
pub struct Evidence<'a> {
    /// Values of phi, in place of the model's own: an estimate from other logs.
    pub values: Option<&'a [f64]>,
    /// What was estimated from these logs.
    pub listed: &'a [IdentifiedParameter],
}

/// Columns that seem to be other ones than they are taken for.
#[derive(Clone, Debug, PartialEq)]
pub struct MisreadColumns {
    /// What they seem to be.
    pub misreading: Misreading,
    /// The share of the torques (roots of mean squares, of the joints whose share changes) that the
    /// model's own values leave as the log is, and as it seems to be meant; none if they say
    /// nothing.
    pub left_by_model: Option<[f64; 2]>,
    /// The same of an estimate.
    pub left_by_estimate: Option<[f64; 2]>,
    /// The log, if it is one of several and the others are not misread.
    pub file: Option<String>,
    /// Whether nothing else explains it as well. What may be a model's parameters or a law of
    /// friction that it lacks is not sure.
    pub is_sure: bool,
    /// Its size in standard errors, of a constant that an estimate has beside the parameters.
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

    /// Whether the model's own values alone speak for it, which are near: where an estimate leaves
    /// next to nothing of the log as it stands, that is no reason.
    pub(crate) fn is_guess(&self) -> bool {
        let is_near = self.left_by_model.is_some_and(|[before, _]| before < NEAR);
        let is_zero = matches!(self.misreading, Misreading::Zero(..));
        is_near && !self.is_sure && !is_zero && self.left_by_estimate.is_none()
    }

    /// Whether an estimate alone speaks for a delay of one joint that would leave no less of its
    /// torque than it does as it is of the rows that count: the others are near reversals.
    pub(crate) fn is_of_reversals(&self, counted: &[f64]) -> bool {
        let (Misreading::LateTorque(joint, _) | Misreading::LatePosition(joint, _)) =
            self.misreading
        else {
            return false;
        };
        let is_explained = |[_, after]: [f64; 2]| counted[joint] < WORSE * after;
        self.left_by_model.is_none() && self.left_by_estimate.is_some_and(is_explained)
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
        self.misreading.describe(f, (&self.joints, self.step_s))?;
        let percent = |[before, after]: [f64; 2]| {
            format!("{} of the torques as the log is, and {} so", share(before), share(after))
        };
        let values = self.values;
        match (self.left_by_model, self.left_by_estimate) {
            (Some(own), Some(fit)) => write!(
                f,
                ": {values} leave {}; an estimate {} and {}",
                percent(own),
                share(fit[0]),
                share(fit[1])
            )?,
            (Some(own), None) => write!(f, ": {values} leave {}", percent(own))?,
            (None, Some(fit)) => write!(f, ": an estimate leaves {}", percent(fit))?,
            (None, None) => match self.errors {
                Some(errors) => write!(
                    f,
                    ": an estimate sees it, {:.0} of its standard errors large",
                    errors.abs()
                )?,
                None => write!(f, ": its friction would be below 0")?,
            },
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
pub fn misread_columns(
    model: &RegressionModel,
    logs: &[&Conditioned],
    evidence: Evidence<'_>,
) -> Vec<MisreadColumns> {
    let mut found = misread_alike(model, logs, evidence);
    if found.is_empty() && logs.len() > 1 {
        found = misread_apart(model, logs, evidence);
    }
    // what an estimate does not speak for, its friction speaks against
    let signs = signs_of_friction(model, evidence.listed);
    let rubs = |signs: &[i8; 2]| signs.contains(&1) && !signs.contains(&-1);
    found.retain(|one| {
        let is_against = match one.misreading {
            Misreading::Torque(joint, -1.0) | Misreading::Position(joint, -1.0) => {
                rubs(&signs[joint])
            }
            Misreading::Torques(-1.0) | Misreading::Angles(-1.0) => signs.iter().any(rubs),
            _ => false,
        };
        one.left_by_estimate.is_some() || !is_against
    });
    for joint in (0..signs.len()).filter(|&joint| signs[joint] == [-1, -1]) {
        let is_told = |one: &MisreadColumns| match one.misreading {
            Misreading::Torque(of, -1.0) => of == joint,
            Misreading::Torques(-1.0) => true,
            _ => false,
        };
        if !found.iter().any(is_told) {
            found.push(of_logs(model, Misreading::Torque(joint, -1.0)));
        }
    }
    found
}

/// Of columns that neither witness speaks of.
fn of_logs(model: &RegressionModel, misreading: Misreading) -> MisreadColumns {
    MisreadColumns {
        misreading,
        left_by_model: None,
        left_by_estimate: None,
        file: None,
        is_sure: false,
        errors: None,
        given: ColumnMapping::default(),
        joints: model.joints.clone(),
        step_s: 0.0,
        values: "",
    }
}

/// Constants that are off, as an estimate has them beside the parameters.
pub(crate) fn constants_off(
    model: &RegressionModel,
    logs: &[Conditioned],
    found: &Estimate,
) -> Vec<MisreadColumns> {
    let all = constants::constant_errors(model, logs, found).into_iter();
    all.map(|(one, errors)| MisreadColumns { errors: Some(errors), ..of_logs(model, one) })
        .collect()
}

/// The same of each log by itself, with its name.
pub(crate) fn misread_apart(
    model: &RegressionModel,
    logs: &[&Conditioned],
    evidence: Evidence<'_>,
) -> Vec<MisreadColumns> {
    let of = |log: &&Conditioned| {
        let own = misread_alike(model, &[log], evidence);
        let file = log.file.clone();
        own.into_iter().map(move |one| MisreadColumns { file: Some(file.clone()), ..one })
    };
    logs.iter().flat_map(of).collect()
}

/// The same of logs that are all misread alike. Motion that is read too slow has so little noise
/// that its filter may be far too high for what it is: what makes more of noise is looked for
/// behind lower filters, too, unless something is sure.
fn misread_alike(
    model: &RegressionModel,
    logs: &[&Conditioned],
    evidence: Evidence<'_>,
) -> Vec<MisreadColumns> {
    let mut found = misread_as_filtered(model, (logs, false), evidence);
    let mut lower: Vec<Conditioned> = Vec::new();
    for _ in 0..HALVINGS {
        if found.iter().any(|one| one.is_sure) {
            break;
        }
        let before = if lower.is_empty() { logs.to_vec() } else { lower.iter().collect() };
        lower = Conditioned::behind_half_the_cutoff(&before, SAMPLES);
        if lower.is_empty() {
            break;
        }
        let lower: Vec<&Conditioned> = lower.iter().collect();
        let told = misread_as_filtered(model, (&lower, true), evidence);
        if found.is_empty() || told.iter().any(|one| one.is_sure) {
            found = told;
        }
    }
    found
}

/// The same of logs behind the filters that they have, or behind lower ones.
fn misread_as_filtered(
    model: &RegressionModel,
    (logs, is_lower): (&[&Conditioned], bool),
    evidence: Evidence<'_>,
) -> Vec<MisreadColumns> {
    let step_s = logs.iter().map(|log| log.step_s).fold(f64::INFINITY, f64::min);
    let shortest = logs.iter().map(|log| log.range.len()).min().unwrap_or(0);
    let latest = (LATEST_S / step_s).min(shortest as f64 / 8.0) as isize;
    let nominal = nominal_values(model).filter(|_| evidence.values.is_none());
    let values = evidence.values.or(nominal.as_deref());
    let balance = Balance::new(model, (logs, latest), values);
    let noise = values.map(|values| noise_of_positions(model, logs, values)).unwrap_or_default();
    let mut search = Search { model, balance, noise, latest, is_lower };
    let mut found: Vec<MisreadColumns> = Vec::new();
    let mut reading = Reading::straight(model.joints.len());
    while found.len() <= model.joints.len() + 1 {
        let Some(verdict) = search.best(&reading) else { break };
        if found.iter().any(|one| one.misreading == verdict.misreading) {
            break;
        }
        reading = reading.with(verdict.misreading, &model.joints);
        let is_sure = verdict.is_sure();
        found.push(MisreadColumns {
            misreading: verdict.misreading,
            left_by_model: verdict.own.filter(|_| verdict.by_own).map(|own| own.left),
            left_by_estimate: verdict.by_fit.then_some(verdict.fit.left),
            file: None,
            is_sure,
            errors: None,
            given: ColumnMapping::default(),
            joints: model.joints.clone(),
            step_s,
            values: match evidence.values {
                Some(_) => "the values that the other logs give",
                None => "the model's own values",
            },
        });
    }
    found
}

/// The sign of the friction of each joint, viscous or Coulomb, where it is surely of one. None is
/// below 0: where a joint shares no parameter with others, the other sign of its torque fits as
/// well.
fn signs_of_friction(model: &RegressionModel, listed: &[IdentifiedParameter]) -> Vec<[i8; 2]> {
    let sign = |name: String| {
        let is_shown = |one: &&IdentifiedParameter| one.status == Status::Identified;
        let found = listed.iter().filter(is_shown).find(|one| one.name == name);
        let deviations = found.and_then(|one| Some(one.value / one.std?)).unwrap_or(0.0);
        i8::from(deviations > SURE) - i8::from(deviations < -SURE)
    };
    let of = |joint: &RegressionJoint| {
        ["fv", "fc"].map(|prefix| sign(format!("{prefix}_{}", joint.name)))
    };
    model.joints.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A delay that brings what is left of a joint down to what is left of its other rows anyhow
    /// is that of rows near reversals; one that leaves less, or that values speak for, is none.
    #[test]
    fn a_delay_that_mends_rows_near_reversals_alone_is_none() {
        let told = |left_by_estimate, left_by_model| MisreadColumns {
            misreading: Misreading::LatePosition(1, -2),
            left_by_model,
            left_by_estimate: Some(left_by_estimate),
            file: None,
            is_sure: false,
            errors: None,
            given: ColumnMapping::default(),
            joints: Vec::new(),
            step_s: 0.002,
            values: "",
        };
        let counted = [0.02, 0.0038];
        assert!(told([0.009, 0.004], None).is_of_reversals(&counted));
        assert!(!told([0.009, 0.001], None).is_of_reversals(&counted));
        assert!(!told([0.009, 0.004], Some([0.3, 0.1])).is_of_reversals(&counted));
    }
}
