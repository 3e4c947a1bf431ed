//! Fewer samples: a low-pass filter of finite length, then every n-th sample.

use std::f64::consts::PI;

/// Half the length of the filter, in samples that are left.
const HALF_LENGTH: usize = 6;

/// A filter that passes what fewer samples can hold, and the factor by which they are fewer.
#[derive(Clone, Debug, PartialEq)]
pub struct Decimator {
    factor: usize,
    /// The weights from the middle outwards; they sum up to 1 with their mirror images.
    weights: Vec<f64>,
}

impl Decimator {
    /// The decimator by a factor, which passes what is below `edge`, in cycles per sample, as far
    /// as fewer samples hold it: up to 0.8 of their Nyquist frequency. By 1 it does nothing.
    pub fn new(factor: usize, edge: f64) -> Self {
        let factor = factor.max(1);
        let half = Self::reach_of(factor);
        if half == 0 {
            return Self { factor, weights: vec![1.0] };
        }
        // Blackman's window
        let cutoff = edge.min(0.4 / factor as f64);
        let weight = |k: usize| {
            let x = PI * k as f64 / (half + 1) as f64;
            let window = 0.42 + 0.5 * x.cos() + 0.08 * (2.0 * x).cos();
            let phase = 2.0 * PI * cutoff * k as f64;
            let sinc = if k == 0 { 1.0 } else { phase.sin() / phase };
            window * sinc
        };
        let mut weights: Vec<f64> = (0..=half).map(weight).collect();
        let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
        weights.iter_mut().for_each(|weight| *weight /= sum);
        Self { factor, weights }
    }

    /// Samples on either side that one depends on that a factor leaves.
    pub fn reach_of(factor: usize) -> usize {
        if factor > 1 { HALF_LENGTH * factor } else { 0 }
    }

    /// One sample in so many is left.
    pub fn factor(&self) -> usize {
        self.factor
    }

    /// Samples on either side that one that is left depends on.
    pub fn reach(&self) -> usize {
        self.weights.len() - 1
    }

    /// Filters without leaving samples out: entry k of `output` is about entry `reach + k`.
    pub fn smooth(&self, input: &[f64], output: &mut [f64]) {
        for (k, out) in output.iter_mut().enumerate() {
            *out = self.about(input, self.reach() + k);
        }
    }

    fn about(&self, input: &[f64], middle: usize) -> f64 {
        let mut sum = self.weights[0] * input[middle];
        for (distance, weight) in self.weights.iter().enumerate().skip(1) {
            sum += weight * (input[middle - distance] + input[middle + distance]);
        }
        sum
    }

    /// Filters and decimates: entry k of `output` is the one about entry `reach + k factor` of
    /// `input`.
    pub fn apply(&self, input: &[f64], output: &mut [f64]) {
        for (k, out) in output.iter_mut().enumerate() {
            *out = self.about(input, self.reach() + k * self.factor);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gain(decimator: &Decimator, cycles: f64) -> f64 {
        let reach = decimator.reach();
        let input: Vec<f64> = (0..=2 * reach)
            .map(|k| (2.0 * PI * cycles * (k as f64 - reach as f64)).cos())
            .collect();
        let mut output = [0.0];
        decimator.apply(&input, &mut output);
        output[0]
    }

    #[test]
    fn what_would_fold_over_is_gone_and_the_rest_passes() {
        for factor in [2, 5, 10] {
            let decimator = Decimator::new(factor, 0.5);
            let nyquist = 0.5 / factor as f64;
            assert!((gain(&decimator, 0.0) - 1.0).abs() < 1e-12);
            assert!((gain(&decimator, 0.4 * nyquist) - 1.0).abs() < 1e-2);
            for cycles in [1.3, 1.7, 1.95].map(|times| times * nyquist) {
                assert!(gain(&decimator, cycles).abs() < 1e-3, "{factor} {cycles}");
            }
        }
        // an edge far below the rate that is left: half of a wave passes there
        let low = Decimator::new(10, 0.02);
        assert!((gain(&low, 0.005) - 1.0).abs() < 0.02 && (gain(&low, 0.02) - 0.5).abs() < 0.1);
        assert!(gain(&low, 0.04).abs() < 0.02, "{}", gain(&low, 0.04));
        let mut same = [0.0; 3];
        Decimator::new(1, 0.5).apply(&[1.0, 2.0, 3.0], &mut same);
        assert_eq!(same, [1.0, 2.0, 3.0]);
    }
}
