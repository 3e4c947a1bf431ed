//! Rows that are left out: where a joint turns round or hardly moves, its friction is not what the
//! sign of its rate says, and the filter smears that over its own time.

use super::least_squares::Options;
use super::rows::BlockMaker;
use crate::policy::left_out::{BIAS, LEAST, NOISE};
use denavit_measure::condition::{Butterworth, Conditioned};
use denavit_measure::{JointIndex, LogIndex, SampleIndex};
use denavit_plants::regression::{CoulombLaw, RegressionModel};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Which rows of a joint are left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum SlowRows {
    /// Those within the filter's time of a reversal, of joints whose Coulomb friction, as the sign
    /// of a rate, is large enough for them to bias it.
    #[default]
    Biasing,
    /// None.
    Kept,
    /// Those in which the joint is not faster than this, or turns round [rad/s, m/s].
    Below(f64),
    /// The same with three times what noise of the position makes of a rate.
    Noise,
}

/// Whether a share of samples near reversals biases Coulomb friction of a value and variance.
pub fn is_biased(share: f64, friction: f64, variance: f64) -> bool {
    friction.abs() * share > BIAS * variance.max(0.0).sqrt()
}

/// The samples over which a log's filter smears what jumps.
fn smear(log: &Conditioned) -> usize {
    log.filter.as_ref().map_or(0, Butterworth::smear)
}

/// Samples that are left out, and so many beside them.
fn wider(all: &[bool], beside: usize) -> Vec<bool> {
    let mut wider = all.to_vec();
    for at in (1..all.len()).filter(|&at| all[at] != all[at - 1]) {
        wider[at.saturating_sub(beside)..(at + beside).min(all.len())].fill(true);
    }
    wider
}

/// For each log the samples near reversals of a joint.
fn near(logs: &[Conditioned], joint: JointIndex, times: f64) -> Vec<Vec<bool>> {
    let of_log = |log: &Conditioned| {
        log.near_reversals(joint, times).unwrap_or_else(|| vec![false; log.range.len()])
    };
    logs.iter().map(of_log).collect()
}

/// Samples of all logs near reversals of a joint, of those in which its rate has a sign, and the
/// number of these: a rest is no reversal.
fn near_of_moving(logs: &[Conditioned], joint: JointIndex) -> (usize, usize) {
    let of_log = |(log, near): (&Conditioned, Vec<bool>)| {
        let unsure = log.unsure_signs(joint).unwrap_or_else(|| vec![false; near.len()]);
        let moving = near.into_iter().zip(unsure).filter(|(_, unsure)| !unsure);
        moving.fold((0, 0), |(near, all), (one, _)| (near + usize::from(one), all + 1))
    };
    let all = logs.iter().zip(near(logs, joint, 1.0)).map(of_log);
    all.fold((0, 0), |(near, all), (one, of)| (near + one, all + of))
}

/// The joints whose Coulomb friction, as the sign of a rate, is biased by rows near reversals by
/// more than its error shows, each with the share of samples.
pub(crate) fn biased_frictions(
    model: &RegressionModel,
    logs: &[Conditioned],
    phi: &DVector<f64>,
    covariance: &DMatrix<f64>,
) -> Vec<(JointIndex, f64)> {
    if model.law != CoulombLaw::Sign {
        return Vec::new();
    }
    let is_resting = |joint: usize| logs.iter().all(|log| log.resting.get(joint) == Some(&true));
    let biased = |&(joint, place): &(usize, usize)| {
        if is_resting(joint) {
            return None; // it has no column
        }
        let at = model.pattern()[joint][place];
        let (near, all) = near_of_moving(logs, JointIndex(joint));
        let share = near as f64 / all.max(1) as f64;
        is_biased(share, phi[at], covariance[(at, at)]).then_some((JointIndex(joint), share))
    };
    model.coulomb().iter().filter_map(biased).collect()
}

/// One of several logs.
#[derive(Clone, Copy)]
pub(super) struct NumberedLog<'a> {
    /// Its place among them.
    pub(super) number: LogIndex,
    pub(super) log: &'a Conditioned,
}

/// For each log and joint whether samples before decimation are left out; none where all count.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LeftOut {
    pub(super) rows: Vec<Vec<Option<Vec<bool>>>>,
    /// Joints whose rows near reversals are left out, and the times they were widened to.
    widened: Vec<(JointIndex, f64)>,
}

impl LeftOut {
    fn of(rows: Vec<Vec<Option<Vec<bool>>>>) -> Self {
        Self { rows, widened: Vec::new() }
    }

    /// Nothing.
    pub(super) fn none(logs: &[Conditioned]) -> Self {
        Self::of(logs.iter().map(|log| vec![None; log.joints()]).collect())
    }

    /// What the options ask for before anything is known of friction, however little that leaves;
    /// by default where the sign of a rate is not known.
    pub(super) fn asked(model: &RegressionModel, logs: &[Conditioned], options: &Options) -> Self {
        let of_log = |log: &Conditioned| -> Vec<Option<Vec<bool>>> {
            let slowest: Vec<f64> = match options.slow {
                SlowRows::Biasing => {
                    let has_sign = |joint: &usize| {
                        let mut frictions = model.coulomb().iter();
                        model.law == CoulombLaw::Sign && frictions.any(|(of, _)| of == joint)
                    };
                    let unsure = |joint: usize| {
                        log.unsure_signs(JointIndex(joint)).filter(|_| has_sign(&joint))
                    };
                    return (0..log.joints()).map(unsure).collect();
                }
                SlowRows::Kept => return vec![None; log.joints()],
                SlowRows::Below(rate) => vec![rate; log.joints()],
                SlowRows::Noise => {
                    let of_rate = NOISE * log.noise_gains()[1][1].sqrt();
                    let noise = |joint: usize| options.position_noise.get(joint).copied();
                    (0..log.joints()).map(|at| of_rate * noise(at).unwrap_or(0.0)).collect()
                }
            };
            let slow = |joint: usize| Some(log.slow(JointIndex(joint), slowest[joint], 1));
            (0..log.joints()).map(slow).collect()
        };
        Self::of(logs.iter().map(of_log).collect())
    }

    /// What the options ask for of a part of a log, and rows near reversals of joints, so often
    /// widened, however little that leaves of it: other parts have more.
    pub(super) fn of_part(
        model: &RegressionModel,
        log: &Conditioned,
        options: &Options,
        widened: &[(JointIndex, f64)],
    ) -> Self {
        let mut part = Self::asked(model, std::slice::from_ref(log), options);
        for &(joint, times) in widened {
            let Some(mut near) = log.near_reversals(joint, times) else { continue };
            let before = part.rows[0][joint.0].iter().flatten();
            near.iter_mut().zip(before).for_each(|(near, before)| *near |= before);
            part.rows[0][joint.0] = Some(near);
        }
        part
    }

    /// The same of other logs.
    pub(super) fn of_others(
        &self,
        model: &RegressionModel,
        logs: &[Conditioned],
        options: &Options,
    ) -> Self {
        let mut others = Self::asked(model, logs, options);
        self.widened.iter().for_each(|&(joint, times)| _ = others.widen(logs, joint, times));
        others
    }

    /// Joints whose rows near reversals are left out, and the times they were widened to.
    pub(super) fn widened(&self) -> &[(JointIndex, f64)] {
        &self.widened
    }

    /// The same of other logs, and all besides where Coulomb friction as the sign of a rate is not
    /// sure, however little that leaves: near reversals and at rest, where the sign is that of
    /// noise or of the filter, and beside, as far as the filter smears that.
    pub(super) fn sure(
        &self,
        model: &RegressionModel,
        logs: &[Conditioned],
        options: &Options,
    ) -> Self {
        let mut sure = self.of_others(model, logs, options);
        let coulomb = model.coulomb().iter().filter(|_| model.law == CoulombLaw::Sign);
        for &(joint, _) in coulomb {
            for (log, rows) in logs.iter().zip(&mut sure.rows) {
                let Some(mut unsure) = log.near_reversals(JointIndex(joint), 1.0) else { continue };
                for all in rows[joint].iter().chain(&log.unsure_signs(JointIndex(joint))) {
                    unsure.iter_mut().zip(all).for_each(|(unsure, one)| *unsure |= one);
                }
                rows[joint] = Some(wider(&unsure, 2 * smear(log)));
            }
        }
        sure
    }

    /// The same of pieces whose edges and filters smear over twice the time: each with its log,
    /// where its first sample stands there, and how many it has.
    pub(super) fn of_halved(
        &self,
        logs: &[Conditioned],
        pieces: &[(LogIndex, Range<usize>)],
    ) -> Self {
        self.of_places(pieces, |number| smear(&logs[number.0]))
    }

    /// The same of places of logs, and of so many beside those that are left out.
    pub(super) fn of_places(
        &self,
        places: &[(LogIndex, Range<usize>)],
        beside: impl Fn(LogIndex) -> usize,
    ) -> Self {
        let of = |(number, range): &(LogIndex, Range<usize>)| {
            let beside = beside(*number);
            let part = |all: &Vec<bool>| wider(all, beside)[range.clone()].to_vec();
            self.rows[number.0].iter().map(|one| one.as_ref().map(part)).collect()
        };
        Self::of(places.iter().map(of).collect())
    }

    /// Leaves out a joint's rows near reversals; not if that leaves too few.
    pub(super) fn widen(&mut self, logs: &[Conditioned], joint: JointIndex, times: f64) -> bool {
        let mut near = near(logs, joint, times);
        for (near, before) in near.iter_mut().zip(&self.rows) {
            let before = before[joint.0].iter().flatten();
            near.iter_mut().zip(before).for_each(|(near, before)| *near |= before);
        }
        let counted = |(log, near): (&Conditioned, &Vec<bool>)| {
            let counts = log.counts(near, SampleIndex(0), log.samples()).into_iter();
            counts.filter(|counts| *counts).count()
        };
        let kept: usize = logs.iter().zip(&near).map(counted).sum();
        let all: usize = logs.iter().map(Conditioned::samples).sum();
        let is_enough = kept as f64 >= LEAST * all as f64;
        if is_enough {
            for (of_log, near) in self.rows.iter_mut().zip(near) {
                of_log[joint.0] = Some(near);
            }
            self.widened.push((joint, times));
        }
        is_enough
    }

    /// Calls `visit` with joint, sample and what phi leaves of the torque of every row of a log,
    /// and whether it counts.
    pub(super) fn for_each_left(
        &self,
        model: &RegressionModel,
        own: NumberedLog<'_>,
        phi: &[f64],
        mut visit: impl FnMut(JointIndex, SampleIndex, f64, bool),
    ) {
        let all =
            |joint: usize| self.counts(own, JointIndex(joint), SampleIndex(0), own.log.samples());
        let counts: Vec<Option<Vec<bool>>> = (0..model.joints.len()).map(all).collect();
        BlockMaker::new(model, own.log).for_each_left(phi, |joint, sample, [.., left]| {
            let counts = counts[joint.0].as_ref().is_none_or(|counts| counts[sample.0]);
            visit(joint, sample, left, counts);
        });
    }

    /// Which of so many samples that are left after decimation count for a joint, from `first` on;
    /// none where all do.
    pub(super) fn counts(
        &self,
        NumberedLog { number, log }: NumberedLog<'_>,
        joint: JointIndex,
        first: SampleIndex,
        samples: usize,
    ) -> Option<Vec<bool>> {
        let left_out = self.rows[number.0][joint.0].as_ref()?;
        Some(log.counts(left_out, first, samples))
    }
}
