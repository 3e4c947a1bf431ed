//! Noise of measured positions, and joints that move no further than it.

use super::{Conditioned, rate};
use crate::identify::log::JointSignals;

/// The order of the differences that noise is read from: of smooth signals they are next to
/// nothing.
const ORDER: usize = 6;

/// Variances of differences of white noise of variance 1: of this order, and of the one below.
const GAINS: [f64; 2] = [924.0, 252.0];

/// What white noise has of the ratio of these, at least: differences of a smooth signal become
/// smaller with each order.
const WHITE: f64 = 0.9;

/// Samples that are looked at, in so many blocks.
const BLOCK: usize = 256;
const BLOCKS: usize = 64;

/// A joint moves if its rate is more than so many times what noise makes of one,
const RATE: f64 = 2.0;

/// or its position goes further from its mean than so many times its noise.
const POSITION: f64 = 3.0;

/// What rounding makes of a position.
const ROUNDING: f64 = 1e-10;

/// The deviation of white noise of a signal, from its differences of sixth order; none if these are
/// not those of white noise. What is rare, as jumps are, does not count.
pub(crate) fn white_noise(signal: &[f64]) -> Option<f64> {
    let every = signal.len().div_ceil(BLOCK * BLOCKS).max(1);
    let mut squares: Vec<[f64; 2]> = Vec::new();
    for block in signal.chunks(BLOCK).step_by(every).filter(|block| block.len() > 4 * ORDER) {
        let mut differences = block.to_vec();
        let mut of_block = [0.0; 2];
        for order in 1..=ORDER {
            differences = differences.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let mean = differences.iter().map(|d| d * d).sum::<f64>() / differences.len() as f64;
            match ORDER - order {
                0 => of_block[0] = mean / GAINS[0],
                1 => of_block[1] = mean / GAINS[1],
                _ => {}
            }
        }
        squares.push(of_block);
    }
    squares.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let [high, low] = *squares.get(squares.len() / 2)?;
    (high > WHITE * low && high > 0.0).then(|| high.sqrt())
}

/// Deviation of a measured position [rad, m]: an encoder's error is anywhere within its step, whose
/// size may be known from elsewhere; without steps, what the log shows.
pub(super) fn position_noise(signals: &JointSignals, resolution: Option<f64>) -> f64 {
    let of_steps = signals.step.or(resolution).map(|step| step / 12.0_f64.sqrt());
    of_steps.or_else(|| white_noise(&signals.q)).unwrap_or(0.0)
}

impl Conditioned {
    /// Takes joints that move no further than their noise for what they are: at rest, where the
    /// sign of a rate says nothing.
    pub(super) fn rest(&mut self) {
        let of_rate = self.filter_gains()[1][1].sqrt();
        let range = self.range.clone();
        let samples = range.len().max(1) as f64;
        let mut resting_noise = self.position_noise.clone();
        for (joint, noise) in self.position_noise.iter().enumerate() {
            let q = &self.q[joint];
            let mean = q[range.clone()].iter().sum::<f64>() / samples;
            // a constant that was filtered is one but for rounding
            let noise = noise.max(ROUNDING * (mean.abs() + 1e-3));
            let spread = q[range.clone()].iter().map(|q| (q - mean).powi(2)).sum::<f64>();
            let rates = range.clone().map(|k| match &self.rates {
                Some([rates, _]) => rates[joint][k],
                None => rate(q, k) / self.step_s,
            });
            let rates = rates.map(|rate| rate * rate).sum::<f64>();
            let is_slow = (rates / samples).sqrt() <= RATE * of_rate * noise;
            let is_resting = is_slow && (spread / samples).sqrt() <= POSITION * noise;
            self.resting.push(is_resting);
            if is_resting {
                resting_noise[joint] = 0.0;
                self.q[joint].fill(mean);
                for column in self.rates.iter_mut().flatten() {
                    column[joint].fill(0.0);
                }
            }
        }
        self.position_noise = resting_noise;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::Random;

    /// Noise far below the motion is seen, where samples are close enough to say so.
    #[test]
    fn white_noise_is_told_from_motion() {
        let mut random = Random::new(4);
        for deviation in [1e-6, 1e-4, 1e-2] {
            let at = |k: usize| (0.004 * k as f64).sin() + 0.3 * (0.011 * k as f64).cos();
            let noisy: Vec<f64> = (0..5000).map(|k| at(k) + deviation * random.normal()).collect();
            let found = white_noise(&noisy).expect("there is noise");
            assert!((found / deviation - 1.0).abs() < 0.1, "{found} {deviation}");
        }
        let fast: Vec<f64> = (0..5000).map(|k| (0.3 * f64::from(k)).sin()).collect();
        assert_eq!(white_noise(&fast), None);
        assert_eq!(white_noise(&[0.3; 500]), None);
    }
}
