//! Noise of measured positions, and joints that move no further than it.

use super::{Conditioned, Piece};
use crate::JointIndex;
use crate::log::JointSignals;
use crate::policy::noise::{GAINS, POSITION, ROUNDING, VELOCITY, WHITE};
use denavit_numerics::Random;

/// The order of the differences that noise is read from: of smooth signals they are next to
/// nothing.
const ORDER: usize = 6;

/// Samples that are looked at, in so many blocks.
const BLOCK: usize = 256;
const BLOCKS: usize = 64;

/// The deviation of white noise of a signal, from its differences of sixth order; none if these are
/// not those of white noise. What is rare, as jumps are, does not count.
pub(super) fn white_noise(signal: &[f64]) -> Option<f64> {
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

/// Deviation of a measured position [rad, m], and the encoder if its steps are what makes it: its
/// error is anywhere within a step, whose size may be known from elsewhere; the log may show more
/// noise than that.
pub(super) fn position_noise(
    signals: &JointSignals,
    resolution: Option<f64>,
) -> (f64, Option<Encoder>) {
    let level = signals.q.first().copied().unwrap_or(0.0);
    let encoder = signals.step.or(resolution).map(|step| Encoder { step, level });
    let of_steps = encoder.map_or(0.0, |encoder| encoder.step / 12.0_f64.sqrt());
    match white_noise(&signals.q) {
        Some(white) if white > of_steps => (white, None),
        _ => (of_steps, encoder),
    }
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
            let is_slow = self.usual(JointIndex(joint), 1) <= VELOCITY * of_rate * noise;
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

impl Conditioned {
    /// A piece with the noise of the positions once more: added, and subtracted. Steps of an
    /// encoder are those that the motion makes, which while it is slow are no white noise.
    pub fn piece_with_noise(&self, piece: Piece, random: &mut Random) -> [Self; 2] {
        let mut added = self.piece(piece);
        let mut subtracted = added.clone();
        for joint in 0..added.q.len() {
            let noise = self.noise_like(joint, &added.q[joint], random);
            let both = added.q[joint].iter_mut().zip(&mut subtracted.q[joint]);
            for ((plus, minus), noise) in both.zip(noise) {
                *plus += noise;
                *minus -= noise;
            }
        }
        [added, subtracted]
    }

    /// Noise of a position after the filter.
    fn noise_like(&self, joint: usize, q: &[f64], random: &mut Random) -> Vec<f64> {
        let deviation = self.position_noise[joint];
        let mut noise: Vec<f64> = match self.encoders[joint] {
            _ if deviation == 0.0 => return vec![0.0; q.len()],
            Some(encoder) => encoder.errors(q, random),
            None => {
                // laps are alike, but for their noise
                let laps = self.laps.map_or(1, |laps| laps.count.max(1)) as f64;
                q.iter().map(|_| deviation / laps.sqrt() * random.normal()).collect()
            }
        };
        if let Some(filter) = &self.filter {
            filter.zero_phase(&mut noise);
        }
        noise
    }
}

/// An encoder whose steps are the noise of its position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    /// The distance of its levels [rad, m].
    pub step: f64,
    /// One of them.
    pub level: f64,
}

impl Encoder {
    /// The errors of steps along a motion that was seen through them, with levels elsewhere.
    fn errors(self, q: &[f64], random: &mut Random) -> Vec<f64> {
        let zero = self.step * random.uniform();
        let error = |q: f64| ((q + zero) / self.step).round() * self.step - zero - q;
        self.between_steps(q).into_iter().map(error).collect()
    }

    /// A motion whose filter may follow the steps, without them: straight lines from where it goes
    /// over from one level to the next to where it does so again.
    fn between_steps(self, q: &[f64]) -> Vec<f64> {
        let middles: Vec<f64> = q.iter().map(|q| (q - self.level) / self.step + 0.5).collect();
        let mut lines = Vec::with_capacity(q.len());
        // the last place where it went over, and what was left there
        let (mut begin, mut from) = (-1.0, q.first().copied().unwrap_or(0.0));
        let mut line_to = |lines: &mut Vec<f64>, end: f64, to: f64| {
            while (lines.len() as f64) <= end && lines.len() < q.len() {
                let along = (lines.len() as f64 - begin) / (end - begin);
                lines.push(from + (to - from) * along);
            }
            (begin, from) = (end, to);
        };
        for (k, pair) in middles.windows(2).enumerate() {
            let (one, other) = (pair[0], pair[1]);
            if one.floor() != other.floor() {
                // of several, the one before the second sample
                let over = if other > one { other.floor() } else { other.floor() + 1.0 };
                let at = k as f64 + (over - one) / (other - one);
                line_to(&mut lines, at, self.level + (over - 0.5) * self.step);
            }
        }
        let last = q.last().copied().unwrap_or(0.0);
        line_to(&mut lines, q.len() as f64, last);
        lines
    }
}

#[cfg(test)]
#[path = "../../tests/unit/noise.rs"]
mod tests;
