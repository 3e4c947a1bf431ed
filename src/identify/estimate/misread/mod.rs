//! Columns that are other ones than they are taken for: another unit, sign or side of the gears,
//! names of two joints exchanged, torques that are late.
//!
//! All such mistakes are readings of the same columns, and each is judged alike, by two witnesses:
//! the torques that the model's own values make of the motion, and how well an estimate can explain
//! the torques at all. The first is needed where every parameter can make up for the mistake (all
//! torques in mN m); the second holds where the model's values are far from true. A reading that
//! one of them speaks for and the other speaks against is none.

mod balance;
mod reading;

pub(in crate::identify) use balance::nominal_values;
pub use reading::{ExchangedColumns, Misreading};

use super::report::{IdentifiedParameter, Status};
use crate::identify::condition::Conditioned;
use crate::plants::regression::{RegressionJoint, RegressionModel};
use balance::{Balance, Change, Shares, root_mean_square};
use reading::{Reading, hypotheses};
use std::fmt;

/// A witness speaks for a reading if what is left falls to this share,
const BETTER: f64 = 0.5;

/// and to less than this: by the model's own values where all joints are in question, or the sign
/// of a torque; other columns of single joints, which other faults of a model's values resemble
/// more, if an estimate speaks for it too, and if not; and by an estimate.
const LEFT_OF_ALL: f64 = 0.63;
const LEFT_OF_ONE: f64 = 0.32;
const LEFT_ALONE: f64 = 0.1;
const LEFT_BY_ESTIMATE: f64 = 0.4;

/// What is of all joints alike changes what is left of half of them, at least.
const HALF: f64 = 0.5;

/// What leaves less than this has nothing to be explained better; for delays, which show in little,
/// an estimate that leaves less than this.
const EXPLAINED: f64 = 0.02;
const PROMPT: f64 = 0.005;

/// A witness speaks against a reading if more than this many times is left.
const WORSE: f64 = 1.25;

/// What an estimate leaves of a log that it explains as the log stands, and the share left by the
/// model's own values below which these are near: then they may be somewhat off, and a reading that
/// they alone speak for is a guess.
pub(in crate::identify) const CLEAN: f64 = 0.015;
const NEAR: f64 = 0.5;

/// From this share on, left by the model's own values, single columns are looked at.
const FAR: f64 = 0.05;

/// The share of what is left by the model's own values that noise of the positions explains.
const NOISE: f64 = 0.5;

/// Readings that are estimated with, at most; those that the model's own values like best.
const ESTIMATED: usize = 80;

/// Torques are at most so late \[s\].
const LATEST_S: f64 = 0.2;

/// Standard errors by which friction is below 0.
const SURE: f64 = 5.0;

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
    names: Vec<String>,
    step_s: f64,
}

impl MisreadColumns {
    /// What they seem to be, and what shows it.
    pub fn summary(&self) -> String {
        self.to_string().lines().next().unwrap_or_default().to_owned()
    }

    /// Whether the model's own values alone speak for it, which are near: where an estimate leaves
    /// next to nothing of the log as it stands, that is no reason.
    pub(in crate::identify) fn is_guess(&self) -> bool {
        let is_near = self.left_by_model.is_some_and(|[before, _]| before < NEAR);
        is_near && !self.is_sure && self.left_by_estimate.is_none()
    }

    /// How to mend it.
    pub fn hint(&self) -> String {
        self.misreading.hint(&self.names)
    }
}

impl fmt::Display for MisreadColumns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{file}: ")?;
        }
        self.misreading.describe(f, (&self.names, self.step_s))?;
        let percent = |[before, after]: [f64; 2]| {
            format!("{} of the torques as the log is, and {} so", share(before), share(after))
        };
        match (self.left_by_model, self.left_by_estimate) {
            (Some(own), Some(fit)) => write!(
                f,
                ": the model's own values leave {}; an estimate {} and {}",
                percent(own),
                share(fit[0]),
                share(fit[1])
            )?,
            (Some(own), None) => write!(f, ": the model's own values leave {}", percent(own))?,
            (None, Some(fit)) => write!(f, ": an estimate leaves {}", percent(fit))?,
            (None, None) => write!(f, ": its friction would be below 0")?,
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

/// What two witnesses say of a reading.
struct Verdict {
    misreading: Misreading,
    own: Option<Change>,
    fit: Change,
    by_own: bool,
    by_fit: bool,
}

impl Verdict {
    /// `after` is what an estimate leaves of each joint.
    fn new(misreading: Misreading, own: Option<Change>, [before, after]: [&Shares; 2]) -> Self {
        let fit = Change::of(before, after);
        let own_torques = misreading.torques_of().into_iter().filter_map(|joint| after[joint]);
        let is_explained = own_torques.fold(0.0, f64::max) < LEFT_BY_ESTIMATE;
        let is_late = matches!(misreading, Misreading::Late(_));
        let least = if is_late { PROMPT } else { EXPLAINED };
        let by_fit = is_explained
            && fit.ratio < BETTER
            && fit.left[0] > least
            && fit.left[1] < LEFT_BY_ESTIMATE;
        // a torque against that of the model is no parameter that is far off
        let is_sign = matches!(misreading, Misreading::Torque(_, -1.0));
        let most = match (misreading.is_of_all() || is_sign, by_fit) {
            (true, _) => LEFT_OF_ALL,
            (false, true) => LEFT_OF_ONE,
            (false, false) => LEFT_ALONE,
        };
        let by_own = own.is_some_and(|own| {
            let is_enough = !misreading.is_of_all() || own.joints >= HALF;
            let is_guess = own.left[0] < NEAR && root_mean_square(before) < CLEAN;
            is_enough
                && !is_guess
                && own.ratio < BETTER
                && own.left[0] > EXPLAINED
                && own.left[1] < most
        });
        Self { misreading, own, fit, by_own, by_fit }
    }

    fn is_believed(&self) -> bool {
        let against_fit = self.fit.ratio > WORSE && self.fit.left[1] > EXPLAINED;
        let against_own = self.own.is_some_and(|own| own.ratio > WORSE && own.left[1] > EXPLAINED);
        (self.by_own && !against_fit) || (self.by_fit && !against_own)
    }

    fn is_sure(&self) -> bool {
        match self.misreading {
            Misreading::Late(_) => self.by_own && self.by_fit,
            misreading => {
                let is_near = self.own.is_some_and(|own| own.left[0] < NEAR);
                self.by_fit || (self.by_own && misreading.is_of_all() && !is_near)
            }
        }
    }

    /// Less is better.
    fn rank(&self) -> f64 {
        self.own.map_or(1.0, |own| own.ratio) * self.fit.ratio
    }
}

/// What search and answers have in common.
struct Search<'a> {
    model: &'a RegressionModel,
    balance: Balance<'a>,
    /// How much of each joint's torque noise of the positions makes by the model's own values.
    noise: Option<&'a [f64]>,
    latest: isize,
}

/// The columns that seem to be other ones, one after the other: each with those before it mended.
/// `noise` is the share of each joint's torque that noise of the positions makes by the model's own
/// values: where that explains what these leave, nothing is tried that makes less of it, whatever
/// is true.
pub fn misread_columns(
    model: &RegressionModel,
    logs: &[Conditioned],
    (listed, noise): (&[IdentifiedParameter], Option<&[f64]>),
) -> Vec<MisreadColumns> {
    let mut found = misread_alike(model, logs, noise);
    if found.is_empty() && logs.len() > 1 {
        // one log among good ones
        for log in logs {
            let own = misread_alike(model, std::slice::from_ref(log), noise);
            let named = |one| MisreadColumns { file: Some(log.file.clone()), ..one };
            found.extend(own.into_iter().map(named));
        }
    }
    for joint in rubbing_backwards(model, listed) {
        let is_told = |one: &MisreadColumns| match one.misreading {
            Misreading::Torque(of, -1.0) => of == joint,
            Misreading::Torques(-1.0) => true,
            _ => false,
        };
        if !found.iter().any(is_told) {
            found.push(MisreadColumns {
                misreading: Misreading::Torque(joint, -1.0),
                left_by_model: None,
                left_by_estimate: None,
                file: None,
                is_sure: false,
                names: names(model),
                step_s: 0.0,
            });
        }
    }
    found
}

/// The same of logs that are all misread alike.
fn misread_alike(
    model: &RegressionModel,
    logs: &[Conditioned],
    noise: Option<&[f64]>,
) -> Vec<MisreadColumns> {
    let step_s = logs.iter().map(|log| log.step_s).fold(f64::INFINITY, f64::min);
    let shortest = logs.iter().map(|log| log.range.len()).min().unwrap_or(0);
    let latest = (LATEST_S / step_s).min(shortest as f64 / 8.0) as isize;
    let balance = Balance::new(model, logs);
    let mut search = Search { model, balance, noise, latest };
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
            names: names(model),
            step_s,
        });
    }
    found
}

fn names(model: &RegressionModel) -> Vec<String> {
    model.joints.iter().map(|joint| joint.name.clone()).collect()
}

impl Search<'_> {
    /// Whether noise of the positions explains what the model's own values leave of a torque, or,
    /// where these are near, what an estimate does.
    fn is_noisy(&self, own: &Shares, fit: &Shares) -> bool {
        let is_near = root_mean_square(own) < NEAR;
        self.is_noise(own) || (is_near && self.is_noise(fit))
    }

    fn is_noise(&self, left: &Shares) -> bool {
        let both = left.iter().zip(self.noise.unwrap_or_default());
        let is_noise = |(left, noise): (&Option<f64>, &f64)| {
            left.is_some_and(|left| left > EXPLAINED && *noise > NOISE * left)
        };
        both.into_iter().any(is_noise)
    }

    fn joints(&self) -> &[RegressionJoint] {
        &self.model.joints
    }

    /// The reading that is believed most, beside one.
    fn best(&mut self, reading: &Reading) -> Option<Verdict> {
        let straight = self.balance.left(reading, true);
        let (own, fit) = (straight.own, straight.fit?);
        let is_misfit = root_mean_square(&fit) > EXPLAINED;
        let is_far = own.as_ref().is_some_and(|own| root_mean_square(own) > FAR);
        let single = is_misfit || is_far;
        let is_noisy = own.as_ref().is_some_and(|own| self.is_noisy(own, &fit));
        let is_measured = |joint: usize| fit[joint].is_some();
        let mut tried = hypotheses(self.model, &is_measured, [single, is_noisy]);
        tried.retain(|one| reading.with(*one, self.joints()) != *reading);
        let late = (reading.late == 0).then(|| self.lateness(reading, &fit)).flatten();
        tried.extend(late);
        let mut judged: Vec<(Misreading, Option<Change>)> = Vec::new();
        for one in tried {
            let other = reading.with(one, &self.model.joints);
            let change = own.as_ref().and_then(|own| {
                let after = self.balance.left(&other, false).own?;
                Some(Change::of(own, &after))
            });
            // without a misfit an estimate can speak against a reading, not for it
            let is_open = is_misfit || Some(one) == late;
            if is_open || change.is_some_and(|change| change.ratio < BETTER) {
                judged.push((one, change));
            }
        }
        let ratio = |one: &(Misreading, Option<Change>)| one.1.map_or(1.0, |own| own.ratio);
        judged.sort_by(|a, b| ratio(a).total_cmp(&ratio(b)));
        judged.truncate(ESTIMATED);
        let mut best: Option<Verdict> = None;
        for (one, change) in judged {
            let other = reading.with(one, &self.model.joints);
            let Some(after) = self.balance.left(&other, true).fit else { continue };
            let verdict = Verdict::new(one, change, [&fit, &after]);
            let is_better = best.as_ref().is_none_or(|best| verdict.rank() < best.rank());
            if verdict.is_believed() && is_better {
                best = Some(verdict);
            }
        }
        best
    }

    /// How late torques are if they are: the delay with which an estimate leaves least.
    fn lateness(&mut self, reading: &Reading, fit: &Shares) -> Option<Misreading> {
        let prompt = total(fit);
        if prompt < PROMPT || self.latest < 1 {
            return None;
        }
        let left = |search: &mut Self, samples: isize| {
            let other = reading.with(Misreading::Late(samples), &search.model.joints);
            search.balance.left(&other, true).fit.map_or(f64::INFINITY, |fit| total(&fit))
        };
        // what is late by many samples is better explained with the first of them mended
        let [early, late] = [-1, 1].map(|samples| left(self, samples));
        if early.min(late) >= prompt {
            return None;
        }
        let sign = if early < late { -1 } else { 1 };
        let mut ladder = vec![0, 1];
        while let Some(next) =
            ladder.last().map(|last| last + (last / 2).max(1)).filter(|next| *next <= self.latest)
        {
            ladder.push(next);
        }
        let shares: Vec<f64> = ladder.iter().map(|&samples| left(self, sign * samples)).collect();
        let at = (0..ladder.len()).min_by(|&a, &b| shares[a].total_cmp(&shares[b]))?;
        let mut low = ladder[at.saturating_sub(1)];
        let mut high = ladder[(at + 1).min(ladder.len() - 1)];
        while high - low > 2 {
            let third = (high - low) / 3;
            let [a, b] = [low + third, high - third];
            if left(self, sign * a) < left(self, sign * b) {
                high = b;
            } else {
                low = a;
            }
        }
        let best = (low..=high).map(|samples| (sign * samples, left(self, sign * samples)));
        let (samples, _) = best.min_by(|a, b| a.1.total_cmp(&b.1))?;
        (samples != 0).then_some(Misreading::Late(samples))
    }
}

fn total(shares: &Shares) -> f64 {
    root_mean_square(shares)
}

/// Joints whose viscous and Coulomb friction are surely below 0, as no friction is: where a joint
/// shares no parameter with others, the other sign of its torque fits as well.
fn rubbing_backwards(model: &RegressionModel, listed: &[IdentifiedParameter]) -> Vec<usize> {
    let is_below_0 = |name: String| {
        listed.iter().any(|one| {
            let is_sure = one.std.is_some_and(|std| one.value < -SURE * std);
            one.name == name && is_sure && one.status == Status::Identified
        })
    };
    let rubs_backwards = |joint: &usize| {
        let name = &model.joints[*joint].name;
        ["fv", "fc"].iter().all(|prefix| is_below_0(format!("{prefix}_{name}")))
    };
    (0..model.joints.len()).filter(rubs_backwards).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The model's own values alone: against an estimate that explains the log as it stands they
    /// say nothing where they are near, and they refuse nothing then.
    #[test]
    fn guesses_yield_to_estimates_that_explain_the_log() {
        let verdict = |misreading, before: f64, fit: f64| {
            let own = Change { ratio: 0.3, left: [before, 0.05], joints: 1.0 };
            let fit = vec![Some(fit); 2];
            Verdict::new(misreading, Some(own), [&fit, &fit])
        };
        let of_one = Misreading::Exchanged([0, 1], ExchangedColumns::Positions);
        assert!(!verdict(of_one, 0.2, 0.003).is_believed());
        assert!(verdict(Misreading::Torques(1e-3), 900.0, 0.003).is_sure());
        let of_all = verdict(Misreading::Angles(-1.0), 0.15, 0.05);
        assert!(of_all.is_believed() && !of_all.is_sure());
    }
}
