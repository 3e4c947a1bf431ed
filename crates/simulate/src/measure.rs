//! What a sampled controller sees: quantised, noisy, delayed.

use denavit_numerics::Random;
use std::collections::VecDeque;

/// How joints are measured; the default is perfect.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measurement {
    /// Step of the encoders [rad, m]; 0 is none.
    pub resolution: f64,
    /// Standard deviation of the noise of positions [rad, m], added before quantisation.
    pub position_noise: f64,
    /// Standard deviation of the noise of rates [rad/s, m/s].
    pub rate_noise: f64,
    /// How many samples old the newest measurement is.
    pub delay_samples: usize,
    /// Rates are differences of the quantised positions, as an encoder gives them; else they are
    /// measured themselves.
    pub differentiates: bool,
}

/// Measures, sample by sample.
#[derive(Clone, Debug)]
pub(super) struct Instrument {
    measurement: Measurement,
    random: Random,
    /// Newest last.
    samples: VecDeque<(Vec<f64>, Vec<f64>)>,
}

impl Instrument {
    pub(super) fn new(measurement: Measurement, seed: u64) -> Self {
        Self { measurement, random: Random::new(seed), samples: VecDeque::new() }
    }

    /// Takes a sample and gives the one that the delay lets through.
    pub(super) fn sample(&mut self, q: &[f64], qd: &[f64], period_s: f64) -> (&[f64], &[f64]) {
        let Measurement { resolution, position_noise, rate_noise, .. } = self.measurement;
        let mut measured = q.to_vec();
        for entry in &mut measured {
            if position_noise > 0.0 {
                *entry += position_noise * self.random.normal();
            }
            if resolution > 0.0 {
                *entry = (*entry / resolution).round() * resolution;
            }
        }
        let mut rates = qd.to_vec();
        if let (true, Some((last, _))) = (self.measurement.differentiates, self.samples.back()) {
            for (rate, (now, before)) in rates.iter_mut().zip(measured.iter().zip(last)) {
                *rate = (now - before) / period_s;
            }
        }
        if rate_noise > 0.0 {
            rates.iter_mut().for_each(|rate| *rate += rate_noise * self.random.normal());
        }
        self.samples.push_back((measured, rates));
        while self.samples.len() > self.measurement.delay_samples + 1 {
            self.samples.pop_front();
        }
        let (q, qd) = &self.samples[0];
        (q, qd)
    }
}
