//! Where the sign of a joint's rate says little: near its reversals, and while it hardly moves; and
//! functions of a rate that pass the filter as the torque does.

use super::{Butterworth, Conditioned, Decimator, STENCIL, acceleration, rate};
use std::ops::Range;

/// Samples that are left within which a decimated one has nearly all of its weight.
const WEIGHED: f64 = 2.5;

impl Conditioned {
    fn rate_at(&self, joint: usize, k: usize) -> f64 {
        match &self.rates {
            Some([rates, _]) => rates[joint][k],
            None => rate(&self.q[joint], k) / self.step_s,
        }
    }

    /// Root of the mean square of a joint's acceleration [rad/s^2, m/s^2].
    fn usual_acceleration(&self, joint: usize) -> f64 {
        let squares = self.range.clone().map(|k| {
            let own = match &self.rates {
                Some([_, accelerations]) => accelerations[joint][k],
                None => acceleration(&self.q[joint], k) / (self.step_s * self.step_s),
            };
            own * own
        });
        (squares.sum::<f64>() / self.range.len().max(1) as f64).sqrt()
    }

    /// A function of a joint's rate at samples of `range`, which must lie within
    /// [`Conditioned::range`], after the filter that positions and torques went through. A function
    /// that is linear over what a filter takes away needs no filter of its own; one that jumps,
    /// as friction does, is smeared over by the filter of the torque, and must be alike.
    pub fn of_rate(
        &self,
        joint: usize,
        range: Range<usize>,
        function: impl Fn(f64) -> f64,
    ) -> Vec<f64> {
        let settling = self.filter.as_ref().map_or(0, Butterworth::settling);
        let stencil = if self.rates.is_some() { 0 } else { STENCIL };
        let first = range.start.saturating_sub(settling).max(stencil);
        let last = (range.end + settling).min(self.q[joint].len() - stencil);
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
    pub fn slow(&self, joint: usize, slowest: f64, around: usize) -> Vec<bool> {
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
    pub fn near_reversals(&self, joint: usize, times: f64) -> Option<Vec<bool>> {
        let smear = self.filter.as_ref()?.smear();
        let slowest = times * self.usual_acceleration(joint) * self.step_s * smear as f64;
        Some(self.slow(joint, slowest, smear))
    }

    /// For each of so many samples that are left, from `first` on, whether it has its weight from
    /// samples of [`Conditioned::range`] that are not among `left_out`.
    pub(crate) fn counts(&self, left_out: &[bool], first: usize, samples: usize) -> Vec<bool> {
        let (factor, reach) = (self.decimation.max(1), Decimator::reach_of(self.decimation));
        let half = (WEIGHED * factor as f64).ceil() as usize;
        let half = half.min(reach);
        let counts = |sample: usize| {
            let middle = reach + sample * factor;
            !left_out[middle - half..=middle + half].contains(&true)
        };
        (first..first + samples).map(counts).collect()
    }
}
