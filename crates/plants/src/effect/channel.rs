//! What is logged of a true quantity, and the true quantity behind what is logged.
//!
//! Delays are taken from a cubic through four samples around the delayed time, lags are exact for a
//! quantity that is linear between samples; beyond the ends the quantity rests.

use super::program::LawProgram;
use super::transmission::TransmissionLaw;
use super::{EffectLaw, JointSamples, columns, gradient, inputs, names};
use crate::error::Error;
use denavit_codegen::effect::{Channel, Effect, Measured};
use denavit_codegen::expr::{Dag, ExprId};

/// The law of a logged channel.
#[derive(Clone, Debug)]
pub(super) struct ChannelLaw {
    pub(super) channel: Channel,
    /// Whether the law gives the truth for what is logged.
    pub(super) is_inverse: bool,
    /// Whether it acts on time alone.
    is_timing: bool,
    /// Whether it is nothing but a delay.
    is_delay: bool,
    /// Whether what is logged is the truth times a constant.
    is_gain: bool,
    /// Delay, lag, then their derivatives by the parameters.
    timing: LawProgram,
    /// The columns of `slope`.
    columns: Vec<usize>,
    /// The derivative of the logged value by the true one.
    slope: LawProgram,
    /// What is between the drive and the joint.
    pub(super) transmission: Option<TransmissionLaw>,
}

impl ChannelLaw {
    pub(super) fn new(dag: &mut Dag, effect: &Effect, measured: &Measured) -> Result<Self, Error> {
        let parameters: Vec<ExprId> = effect.parameters.iter().map(|p| p.symbol).collect();
        let timing = [measured.delay_s, measured.lag_s];
        let mut entries = timing.to_vec();
        entries.extend(gradient(dag, &timing, &parameters).concat());
        let timing = LawProgram::new(dag, &names(effect), Vec::new(), entries)?;
        let id = dag.find_symbol(measured.channel.as_str());
        let channel = dag.symbol_expr(id.expect("the channel is a symbol of its law"));
        let is_timing = measured.value == channel && measured.transmission.is_none();
        let is_delay = is_timing && measured.lag_s == dag.zero();
        let slope = gradient(dag, &[measured.value], &[channel]).concat();
        let columns = columns(dag, &slope);
        let is_scaled = columns.is_empty() && dag.mul(slope[0], channel) == measured.value;
        let is_gain = is_scaled && !is_timing && measured.transmission.is_none();
        let inputs = inputs(dag, &columns, &[]);
        let slope = LawProgram::new(dag, &names(effect), inputs, slope)?;
        let Measured { channel, is_inverse, transmission, .. } = *measured;
        let transmission = transmission.map(|one| TransmissionLaw::new(dag, effect, one));
        let transmission = transmission.transpose()?;
        Ok(Self {
            channel,
            is_inverse,
            is_timing,
            is_delay,
            is_gain: is_gain && !is_inverse,
            timing,
            columns,
            slope,
            transmission,
        })
    }
}

impl ChannelLaw {
    fn channel_of<'s>(&self, samples: &JointSamples<'s>) -> &'s [f64] {
        match self.channel {
            Channel::Torque => samples.tau,
            Channel::Position => samples.q,
            Channel::Rate => samples.qd,
        }
    }

    /// Samples with another channel.
    fn with<'s>(&self, samples: &JointSamples<'s>, channel: &'s [f64]) -> JointSamples<'s> {
        match self.channel {
            Channel::Torque => JointSamples { tau: channel, ..*samples },
            Channel::Position => JointSamples { q: channel, ..*samples },
            Channel::Rate => JointSamples { qd: channel, ..*samples },
        }
    }
}

/// Rounds of the fixed point in [`EffectLaw::solved`]: laws are small, each round gains digits.
const ROUNDS: usize = 60;

impl EffectLaw {
    /// What is logged where the samples are the truth; the channel itself for effects that change
    /// no channel of the log. Delay and lag need the times of the samples. Of a transmission it is
    /// the truth: what its drive must do for that is not found.
    pub fn logged(&self, samples: &JointSamples<'_>, values: &[f64]) -> Vec<f64> {
        let Some(law) = &self.channel else { return samples.tau.to_vec() };
        match law.is_inverse {
            true => self.taken_back(law, samples, values),
            false => self.given(law, samples, values),
        }
    }

    /// The true channel where the samples are what is logged, the other columns being true. Of a
    /// joint behind a transmission it is what is logged: how far it is behind is not found here.
    pub fn corrected(&self, samples: &JointSamples<'_>, values: &[f64]) -> Vec<f64> {
        let Some(law) = &self.channel else { return samples.tau.to_vec() };
        if law.transmission.is_some() && law.is_inverse {
            let logged = law.channel_of(samples);
            let Some(through) = self.through(samples, values) else { return logged.to_vec() };
            return logged.iter().zip(through.torque).map(|(logged, more)| logged - more).collect();
        }
        match law.is_inverse {
            true => self.given(law, samples, values),
            false => self.taken_back(law, samples, values),
        }
    }

    /// What the law gives of the channel of the samples.
    fn given(&self, law: &ChannelLaw, samples: &JointSamples<'_>, values: &[f64]) -> Vec<f64> {
        let value = self.value(samples, values).swap_remove(0);
        let [delay, lag] = self.timing(law, values);
        lagged(samples.t, &shifted(samples.t, &value, delay), lag)
    }

    /// The channel of which the law gives that of the samples.
    fn taken_back(&self, law: &ChannelLaw, samples: &JointSamples<'_>, values: &[f64]) -> Vec<f64> {
        let [delay, lag] = self.timing(law, values);
        let given = law.channel_of(samples);
        // before the lag: y + lag dy/dt; before the delay: ahead
        let mut wanted = given.to_vec();
        if lag != 0.0 {
            let rate = rate(samples.t, given);
            wanted.iter_mut().zip(rate).for_each(|(y, rate)| *y += lag * rate);
        }
        self.solved(law, samples, values, &shifted(samples.t, &wanted, -delay))
    }

    /// What the channel must be for the law to give what is wanted.
    fn solved(
        &self,
        law: &ChannelLaw,
        samples: &JointSamples<'_>,
        values: &[f64],
        wanted: &[f64],
    ) -> Vec<f64> {
        let mut truth = wanted.to_vec();
        for _ in 0..ROUNDS {
            let trial = law.with(samples, &truth);
            let found = self.value(&trial, values).swap_remove(0);
            let columns: Vec<&[f64]> = law.columns.iter().map(|&at| trial.column(at)).collect();
            let slope = law.slope.run(&columns, values, truth.len()).swap_remove(0);
            let mut largest = 0.0_f64;
            let next: Vec<f64> = (0..truth.len())
                .map(|k| {
                    let slope = if slope[k].abs() > 1e-3 { slope[k] } else { 1.0 };
                    let step = (wanted[k] - found[k]) / slope;
                    largest = largest.max(step.abs() / (1.0 + truth[k].abs()));
                    truth[k] + step
                })
                .collect();
            truth = next;
            if largest < 1e-15 {
                break;
            }
        }
        truth
    }

    /// The derivative by each parameter of what the law gives of the channel of the samples.
    pub(super) fn given_gradient(
        &self,
        samples: &JointSamples<'_>,
        values: &[f64],
    ) -> Vec<Vec<f64>> {
        let Some(law) = &self.channel else { return Vec::new() };
        let mut columns = self.value(samples, values);
        let count = self.parameters.len();
        let timing = law.timing.run(&[], values, 1);
        let [delay, lag] = [timing[0][0], timing[1][0]];
        let through = |column: &[f64]| lagged(samples.t, &shifted(samples.t, column, delay), lag);
        let value = shifted(samples.t, &columns[0], delay);
        let by_delay = lagged(samples.t, &rate(samples.t, &value), lag);
        let by_lag = lag_sensitivity(samples.t, &value, lag);
        columns
            .split_off(1)
            .iter()
            .enumerate()
            .map(|(parameter, column)| {
                let by = |row: usize| timing[2 + row * count + parameter][0];
                let mut moved = through(column);
                for (k, moved) in moved.iter_mut().enumerate() {
                    *moved += by(1) * by_lag[k] - by(0) * by_delay[k];
                }
                moved
            })
            .collect()
    }

    /// The delay of a law that is nothing else \[s\], and its derivatives by the parameters.
    pub fn delay(&self, values: &[f64]) -> Option<(f64, Vec<f64>)> {
        let law = self.channel.as_ref().filter(|law| law.is_delay)?;
        let timing = law.timing.run(&[], values, 1);
        let gradient = timing[2..2 + self.parameters.len()].iter().map(|entry| entry[0]);
        Some((timing[0][0], gradient.collect()))
    }

    /// Whether the law is nothing but a delay of its channel.
    pub fn is_delay(&self) -> bool {
        self.channel.as_ref().is_some_and(|law| law.is_delay)
    }

    /// Whether the law is of the time of its channel alone.
    pub fn is_timing(&self) -> bool {
        self.channel.as_ref().is_some_and(|law| law.is_timing)
    }

    /// Whether what is logged is the truth times a constant.
    pub fn is_gain(&self) -> bool {
        self.channel.as_ref().is_some_and(|law| law.is_gain)
    }

    /// What a torque is multiplied by in its log, sample by sample; none of laws of another
    /// channel, of time, and of what is between the drive and the joint.
    pub fn factor(&self, samples: &JointSamples<'_>, values: &[f64]) -> Option<Vec<f64>> {
        let does_more =
            |law: &&ChannelLaw| law.is_inverse || law.is_timing || law.transmission.is_some();
        let law = self.channel.as_ref();
        let law = law.filter(|law| law.channel == Channel::Torque && !does_more(law))?;
        let columns: Vec<&[f64]> = law.columns.iter().map(|&at| samples.column(at)).collect();
        Some(law.slope.run(&columns, values, samples.len()).swap_remove(0))
    }

    /// Whether the truth is what is logged, at another time: a drive that follows its command.
    pub fn follows_log(&self) -> bool {
        self.channel.as_ref().is_some_and(|law| law.is_inverse && law.is_timing)
    }

    /// What a channel that lags leaves of the variance of a frequency \[Hz\].
    pub fn gain(&self, hz: f64, values: &[f64]) -> f64 {
        let lag = self.channel.as_ref().map_or(0.0, |law| self.timing(law, values)[1]);
        1.0 / (1.0 + (std::f64::consts::TAU * hz * lag).powi(2))
    }

    fn timing(&self, law: &ChannelLaw, values: &[f64]) -> [f64; 2] {
        let timing = law.timing.run(&[], values, 1);
        [timing[0][0], timing[1][0]]
    }
}

/// y(t - delay), from the cubic through the four samples around that time.
fn shifted(t: &[f64], y: &[f64], delay: f64) -> Vec<f64> {
    if delay == 0.0 || t.len() < 4 {
        return y.to_vec();
    }
    let last = t.len() - 1;
    t.iter()
        .map(|&now| {
            let at = now - delay;
            if at <= t[0] || at >= t[last] {
                return if at <= t[0] { y[0] } else { y[last] };
            }
            let after = t.partition_point(|&time| time < at).clamp(1, last);
            let first = after.saturating_sub(2).min(last - 3);
            lagrange(&t[first..first + 4], &y[first..first + 4], at)
        })
        .collect()
}

/// The polynomial through points, at one place.
fn lagrange(t: &[f64], y: &[f64], at: f64) -> f64 {
    let weight = |i: usize| -> f64 {
        let others = (0..t.len()).filter(|&j| j != i);
        others.map(|j| (at - t[j]) / (t[i] - t[j])).product()
    };
    (0..t.len()).map(|i| weight(i) * y[i]).sum()
}

/// dy/dt by central differences, one-sided at the ends.
fn rate(t: &[f64], y: &[f64]) -> Vec<f64> {
    let last = t.len().saturating_sub(1);
    (0..t.len())
        .map(|k| {
            let (from, to) = (k.saturating_sub(1), (k + 1).min(last));
            if from == to { 0.0 } else { (y[to] - y[from]) / (t[to] - t[from]) }
        })
        .collect()
}

/// x of lag dx/dt = y - x, which starts at rest; y itself without lag.
fn lagged(t: &[f64], y: &[f64], lag: f64) -> Vec<f64> {
    if lag <= 0.0 || y.is_empty() {
        return y.to_vec();
    }
    let mut x = vec![y[0]];
    for k in 1..y.len() {
        let (h, before) = (t[k] - t[k - 1], x[k - 1]);
        let decay = (-h / lag).exp();
        // y is linear on the way: x follows it by the lag once the start has decayed
        let slope = (y[k] - y[k - 1]) / h;
        x.push(y[k] - lag * slope + decay * (before - y[k - 1] + lag * slope));
    }
    x
}

/// The derivative of [`lagged`] by the lag: of its steps, and -dy/dt where there is no lag.
fn lag_sensitivity(t: &[f64], y: &[f64], lag: f64) -> Vec<f64> {
    if lag <= 0.0 || y.is_empty() {
        return rate(t, y).iter().map(|rate| -rate).collect();
    }
    let x = lagged(t, y, lag);
    let mut moved = vec![0.0];
    for k in 1..y.len() {
        let h = t[k] - t[k - 1];
        let decay = (-h / lag).exp();
        let slope = (y[k] - y[k - 1]) / h;
        let by_decay = decay * h / (lag * lag) * (x[k - 1] - y[k - 1] + lag * slope);
        moved.push(-slope + by_decay + decay * (moved[k - 1] + slope));
    }
    moved
}
