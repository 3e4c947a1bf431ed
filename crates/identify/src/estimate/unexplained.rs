//! Joints whose torque an estimate does not explain, in all logs, in one of them, or while a joint
//! rests.

use super::least_squares::Estimate;
use super::left_over::Left;
use super::rows::BlockMaker;
use super::validate::{Validation, validate};
use crate::policy::unexplained::{ALIKE, AT_REST, LEFT, LEFT_ALIKE, LEFT_AT_REST, STICTION};
use denavit_measure::condition::Conditioned;
use denavit_measure::{JointIndex, LogIndex, SampleIndex};
use denavit_plants::regression::{RegressionJoint, RegressionModel};
use std::collections::VecDeque;

/// Samples of each log that are looked at, and in blocks of so many.
const BLOCKS: usize = 16;
const BLOCK: usize = 64;

/// Whether each joint moves, against the one of its kind (turning, sliding) that moves most.
pub(super) fn moves(model: &RegressionModel, logs: &[&Conditioned]) -> Vec<bool> {
    let n = model.joints.len();
    let mut ranges = vec![[f64::INFINITY, f64::NEG_INFINITY]; n];
    for log in logs {
        let samples = log.samples();
        let step = samples.div_ceil(BLOCKS).max(BLOCK);
        for first in (0..samples).step_by(step) {
            let mut motion = Vec::new();
            log.motion_at(SampleIndex(first), BLOCK.min(samples - first), &mut motion);
            for ([low, high], positions) in ranges.iter_mut().zip(&motion) {
                *low = positions.iter().copied().fold(*low, f64::min);
                *high = positions.iter().copied().fold(*high, f64::max);
            }
        }
    }
    let ranges: Vec<f64> = ranges.iter().map(|[low, high]| (high - low).max(0.0)).collect();
    let most = |slides: bool| {
        let alike = ranges.iter().zip(&model.joints).filter(|(_, joint)| joint.slides == slides);
        alike.map(|(range, _)| *range).fold(0.0, f64::max)
    };
    let most = [false, true].map(most);
    let of_joint = |(range, joint): (&f64, &RegressionJoint)| {
        *range > AT_REST * most[usize::from(joint.slides)]
    };
    ranges.iter().zip(&model.joints).map(of_joint).collect()
}

/// Samples that are left in so many periods of the filter's cutoff.
pub(super) fn samples_of(log: &Conditioned, periods: f64) -> usize {
    let cutoff = log.filter.as_ref().map_or(0.5, |filter| filter.cutoff());
    ((periods / (cutoff * log.decimation.max(1) as f64)).ceil().min(1e6) as usize).max(1)
}

/// A joint of whose torque nearly all is left, or much that is no noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Unexplained {
    /// The joint.
    pub joint: String,
    /// The log, if it is one of several and not all are like it.
    pub file: Option<String>,
    /// Root of the mean square of the residual over that of the torque.
    pub share: f64,
    /// The longest time that the joint rests in between \[s\], if it is that of which it is left;
    /// all of the log if it never moves.
    pub rest_s: Option<[f64; 2]>,
    /// What is left of it in the logs for the estimate, if it is that beside which too much is
    /// left in a log for validation.
    pub beside: Option<f64>,
}

impl Unexplained {
    /// A joint that moves, of whose torque this share is left in all logs.
    pub(crate) fn of(joint: &str, share: f64) -> Self {
        Self { joint: joint.to_owned(), file: None, share, rest_s: None, beside: None }
    }
}

/// Logs, of some of which noise makes most.
#[derive(Clone, Copy)]
pub struct ShownLogs<'a> {
    /// All of them.
    pub logs: &'a [Conditioned],
    /// The numbers of the others, which show what the model says.
    pub shown: &'a [LogIndex],
}

/// What joints are judged by.
#[derive(Clone, Copy)]
pub struct Judgement<'a> {
    /// The estimate.
    pub found: &'a Estimate,
    /// What it leaves of the logs of which noise does not make most, together.
    pub left: &'a Validation,
    /// The share of each joint's torque that is left of the rows that count: what is left of those
    /// near reversals is no misfit.
    pub counted: &'a [f64],
}

/// The joints of whose torque nearly all is left, or much that is no noise, of all logs together of
/// which noise does not make most, or of one of these. Equations of a floating base are none of
/// joints.
pub fn unexplained_joints(
    model: &RegressionModel,
    shown_logs: ShownLogs<'_>,
    judged: Judgement<'_>,
) -> Vec<Unexplained> {
    let ShownLogs { logs, shown } = shown_logs;
    let phi = judged.found.solution.phi.as_slice();
    let together: Vec<&Conditioned> = shown.iter().map(|&log| &logs[log.0]).collect();
    let mut all = moving(model, &together, judged, LEFT);
    for &log in &together {
        let left = validate(model, phi, &[log]);
        let mut own = resting(model, log, judged.found, &left);
        if logs.len() > 1 {
            own.extend(moving(model, &[log], Judgement { left: &left, ..judged }, f64::INFINITY));
        }
        own.retain(|one| all.iter().all(|other| other.joint != one.joint || other.file.is_some()));
        let file = (logs.len() > 1).then(|| log.file.clone());
        all.extend(own.into_iter().map(|one| Unexplained { file: file.clone(), ..one }));
    }
    all
}

/// The joints that move and of whose torque much that is no noise is left, or `most` in any case.
fn moving(
    model: &RegressionModel,
    logs: &[&Conditioned],
    judged: Judgement<'_>,
    most: f64,
) -> Vec<Unexplained> {
    let lag = logs.iter().map(|log| samples_of(log, 0.5)).max().unwrap_or(1);
    let of = |((joint, moves), counted): ((&RegressionJoint, bool), &f64)| {
        let found = judged.left.joint(&joint.name)?;
        let is_alike = found.autocorrelation.get(lag - 1).is_some_and(|one| *one > ALIKE);
        let least = if is_alike && *counted > LEFT_ALIKE { LEFT_ALIKE } else { most };
        let is_left = !joint.is_base && moves && found.relative > least;
        is_left.then(|| Unexplained::of(&joint.name, found.relative))
    };
    let moving = moves(model, logs);
    model.joints.iter().zip(moving).zip(judged.counted).filter_map(of).collect()
}

/// The joints of whose torque something that is no noise is left while they rest, and more than
/// stiction holds.
fn resting(
    model: &RegressionModel,
    log: &Conditioned,
    found: &Estimate,
    left: &Validation,
) -> Vec<Unexplained> {
    let moving = moves(model, &[log]);
    let rests: Vec<Vec<bool>> = (0..model.joints.len())
        .map(|joint| match moving[joint] {
            _ if model.joints[joint].is_base || log.torque[joint].is_none() => Vec::new(),
            true => log.rests(JointIndex(joint)),
            false => vec![true; log.range.len()],
        })
        .collect();
    if !rests.iter().flatten().any(|rests| *rests) {
        return Vec::new();
    }
    let first_s = log.start_s + log.step_s * log.range.start as f64;
    let of = |(joint, (own, beyond)): (usize, (Left, f64))| {
        let by_chance = (own.apart / own.rows).sqrt();
        if own.alike <= (ALIKE + by_chance) * own.both || own.both == 0.0 {
            return None; // noise, as far as so many periods tell
        }
        let name = &model.joints[joint].name;
        let share = (beyond / own.rows).sqrt() / left.joint(name)?.torque_rms;
        let spell = longest(&rests[joint]);
        let rest_s = [spell.start, spell.end].map(|at| first_s + log.step_s * at as f64);
        let told = Unexplained { rest_s: Some(rest_s), ..Unexplained::of(name, share) };
        (share > LEFT_AT_REST).then_some(told)
    };
    at_rest(model, log, found, &rests).into_iter().enumerate().filter_map(of).collect()
}

/// What is left of the torque of each joint while it rests, compared over a period of the filter's
/// cutoff, and the sum of the squares of what stiction does not hold of it.
fn at_rest(
    model: &RegressionModel,
    log: &Conditioned,
    found: &Estimate,
    rests: &[Vec<bool>],
) -> Vec<(Left, f64)> {
    let phi = found.solution.phi.as_slice();
    // friction that is not shown holds nothing that is known
    let rows = found.solution.factor.row_iter();
    let is_shown = rows.map(|row| f64::from(u8::from(row.norm() > 0.0)));
    let shown: Vec<f64> = phi.iter().zip(is_shown).map(|(phi, is_shown)| phi * is_shown).collect();
    let mut maker = BlockMaker::new(model, log);
    let apart = samples_of(log, 1.0) as f64;
    let held = |joint: usize| STICTION * maker.coulomb_friction(JointIndex(joint), &shown);
    let held: Vec<f64> = (0..rests.len()).map(held).collect();
    let mut joints = vec![(Left { apart, ..Left::default() }, 0.0); rests.len()];
    let mut recent = vec![VecDeque::new(); joints.len()];
    let places: Vec<usize> = log.places(SampleIndex(0), log.samples()).collect();
    maker.for_each_left(phi, |joint, sample, [.., left]| {
        let place = places[sample.0] - log.range.start;
        let Some(&rests) = rests[joint.0].get(place) else { return };
        let (own, beyond) = &mut joints[joint.0];
        own.add(rests.then_some(left), &mut recent[joint.0]);
        if rests {
            *beyond += (left.abs() - held[joint.0]).max(0.0).powi(2);
        }
    });
    joints
}

/// The longest spell of samples.
fn longest(samples: &[bool]) -> std::ops::Range<usize> {
    let mut end = 0;
    let spells = samples.chunk_by(|one, next| one == next).map(|spell| {
        end += spell.len();
        (spell[0], end - spell.len()..end)
    });
    let spells = spells.filter(|(is_in, _)| *is_in).map(|(_, spell)| spell);
    spells.reduce(|one, next| if next.len() > one.len() { next } else { one }).unwrap_or(0..0)
}
