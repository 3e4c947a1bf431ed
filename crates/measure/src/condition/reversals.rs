//! Where the sign of a joint's rate says little: near its reversals, and while it hardly moves; and
//! functions of a rate that pass the filter as the torque does.

use super::{Butterworth, Conditioned, Decimator, STENCIL};
use crate::policy::reversals::{NOISE, STEPS, STILL, WEIGHED};
use crate::{JointIndex, SampleIndex};
use denavit_numerics::rms;
use std::ops::Range;

/// Periods of the filter's cutoff that a rest takes, at least.
const RESTS: usize = 6;

impl Conditioned {
    fn rate_at(&self, joint: JointIndex, k: usize) -> f64 {
        self.moved(joint, 1, k)
    }

    /// Root of the mean square of a joint's rate (order 1) [rad/s, m/s], or acceleration (order 2)
    /// [rad/s^2, m/s^2].
    pub(super) fn usual(&self, joint: JointIndex, order: usize) -> f64 {
        rms(self.range.clone().map(|k| self.moved(joint, order, k)))
    }

    /// A function of a joint's rate at samples of `range`, which must lie within
    /// [`Conditioned::range`], after the filter that positions and torques went through. A function
    /// that is linear over what a filter takes away needs no filter of its own; one that jumps,
    /// as friction does, is smeared over by the filter of the torque, and must be alike.
    pub fn of_rate(
        &self,
        joint: JointIndex,
        range: Range<usize>,
        function: impl Fn(f64) -> f64,
    ) -> Vec<f64> {
        let settling = self.filter.as_ref().map_or(0, Butterworth::settling);
        let stencil = if self.rates.is_some() { 0 } else { STENCIL };
        let first = range.start.saturating_sub(settling).max(stencil);
        let last = (range.end + settling).min(self.q[joint.0].len() - stencil);
        let mut values: Vec<f64> =
            (first..last).map(|k| function(self.rate_at(joint, k))).collect();
        if let Some(filter) = &self.filter {
            filter.zero_phase(&mut values);
        }
        values.drain(..range.start - first);
        values.truncate(range.len());
        values
    }

    /// For each sample of [`Conditioned::range`] whether a joint is not faster than `slowest`
    /// [rad/s, m/s], or turns round within so many samples.
    pub fn slow(&self, joint: JointIndex, slowest: f64, around: usize) -> Vec<bool> {
        let first = self.range.start;
        let rates = self.range.clone().map(|k| self.rate_at(joint, k));
        let mut is_slow: Vec<bool> = rates.map(|rate| rate.abs() <= slowest).collect();
        let samples = is_slow.len();
        let mut end = 0;
        for at in 1..samples {
            let is_forward = |at: usize| self.rate_at(joint, first + at) > 0.0;
            if is_forward(at - 1) != is_forward(at) {
                let last = (at + around).min(samples);
                is_slow[end.max(at.saturating_sub(around)).min(last)..last].fill(true);
                end = last;
            }
        }
        is_slow
    }

    /// For each sample of [`Conditioned::range`] whether it is within the filter's time of a
    /// reversal of a joint, or slower than so many `times` what its usual acceleration makes of it
    /// in that time: where what depends on the sign of the rate is smeared over. None without a
    /// filter.
    pub fn near_reversals(&self, joint: JointIndex, times: f64) -> Option<Vec<bool>> {
        let smear = self.filter.as_ref()?.smear();
        let slowest = times * self.usual(joint, 2) * self.step_s * smear as f64;
        Some(self.slow(joint, slowest, smear))
    }

    /// For each sample of [`Conditioned::range`] whether the sign of a joint's rate is not known
    /// there, if that is so anywhere: the joint is no faster than noise of its position makes it,
    /// or than two steps of its encoder in a period of the filter's cutoff, for such a period at
    /// least; and a period before and after, where the filter smears that over. Where it turns
    /// round faster than that, the filter smears the sign over alike.
    pub fn unsure_signs(&self, joint: JointIndex) -> Option<Vec<bool>> {
        let filter = self.filter.as_ref().filter(|_| !self.resting[joint.0])?;
        let (period, samples) = (2 * filter.smear(), self.range.len());
        let mut is_unsure = vec![false; samples];
        for Range { start, end } in self.slow_spells(joint, filter, 0.0) {
            let last = (end + period).min(samples);
            is_unsure[start.saturating_sub(period)..last].fill(true);
        }
        is_unsure.contains(&true).then_some(is_unsure)
    }

    /// For each sample of [`Conditioned::range`] whether a joint that moves in between rests there:
    /// while the sign of its rate is not known, for some periods of the filter's cutoff, without
    /// the first and the last, into which the filter smears what is beside.
    pub fn rests(&self, joint: JointIndex) -> Vec<bool> {
        let Some(filter) = &self.filter else { return vec![false; self.range.len()] };
        let least = STILL * self.usual(joint, 1);
        let period = 2 * filter.smear();
        let mut rests = vec![false; self.range.len()];
        for Range { start, end } in self.slow_spells(joint, filter, least) {
            if end - start > RESTS * period {
                rests[start + period..end - period].fill(true);
            }
        }
        rests
    }

    /// The samples of [`Conditioned::range`] in which a joint is no faster than noise of its
    /// position makes it, than two steps of its encoder in a period of the filter's cutoff, or than
    /// another rate, for such a period or longer.
    fn slow_spells(
        &self,
        joint: JointIndex,
        filter: &Butterworth,
        least: f64,
    ) -> Vec<Range<usize>> {
        let of_steps = self.encoders[joint.0]
            .map_or(0.0, |one| STEPS * one.step * filter.cutoff() / self.step_s);
        let of_noise = NOISE * self.filter_gains()[1][1].sqrt() * self.position_noise[joint.0];
        let slowest = of_steps.max(of_noise).max(least);
        let mut spells = Vec::new();
        let mut from = 0;
        for at in 0..=self.range.len() {
            let place = self.range.start + at;
            if at < self.range.len() && self.rate_at(joint, place).abs() < slowest {
                continue;
            }
            if at - from >= 2 * filter.smear() {
                spells.push(from..at);
            }
            from = at + 1;
        }
        spells
    }

    /// For each of so many samples that are left, from `first` on, whether it has its weight from
    /// samples of [`Conditioned::range`] that are not among `left_out`.
    pub fn counts(&self, left_out: &[bool], first: SampleIndex, samples: usize) -> Vec<bool> {
        let (factor, reach) = (self.decimation.max(1), Decimator::reach_of(self.decimation));
        let half = (WEIGHED * factor as f64).ceil() as usize;
        let half = half.min(reach);
        let counts = |sample: usize| {
            let middle = reach + sample * factor;
            !left_out[middle - half..=middle + half].contains(&true)
        };
        (first.0..first.0 + samples).map(counts).collect()
    }
}
