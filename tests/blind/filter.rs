//! Zero-phase filtering and differences.

use std::f64::consts::PI;

/// Butterworth low pass of fourth order, forwards and backwards: no phase, eighth order in gain.
#[derive(Clone, Copy, Debug)]
pub struct LowPass {
    sections: [[f64; 5]; 2],
}

impl LowPass {
    /// Half the power per pass at `cutoff_hz`, by the bilinear transform with prewarping.
    pub fn new(cutoff_hz: f64, step_s: f64) -> Self {
        let warped = (PI * cutoff_hz * step_s).tan();
        let section = |pole: f64| {
            let damping = 2.0 * (PI * pole / 8.0).cos();
            let scale = 1.0 + damping * warped + warped * warped;
            let gain = warped * warped / scale;
            let back = [
                2.0 * (warped * warped - 1.0) / scale,
                (1.0 - damping * warped + warped * warped) / scale,
            ];
            [gain, 2.0 * gain, gain, back[0], back[1]]
        };
        Self { sections: [section(1.0), section(3.0)] }
    }

    fn pass(&self, signal: &mut [f64]) {
        for [b0, b1, b2, a1, a2] in self.sections {
            let start = signal.first().copied().unwrap_or_default();
            // the state of rest at the first sample
            let (mut one, mut two) = (start * (1.0 - b0), start * (b2 - a2));
            for value in signal.iter_mut() {
                let input = *value;
                let output = b0 * input + one;
                one = b1 * input - a1 * output + two;
                two = b2 * input - a2 * output;
                *value = output;
            }
        }
    }

    /// The filtered signal.
    pub fn apply(&self, signal: &[f64]) -> Vec<f64> {
        let mut filtered = signal.to_vec();
        for _ in 0..2 {
            self.pass(&mut filtered);
            filtered.reverse();
        }
        filtered
    }
}

/// Central differences of fourth order; at the ends, of the nearest sample that has one.
pub fn rate(signal: &[f64], step_s: f64) -> Vec<f64> {
    let count = signal.len();
    if count < 5 {
        return vec![0.0; count];
    }
    let at = |k: usize| {
        let k = k.clamp(2, count - 3);
        let outer = signal[k - 2] - signal[k + 2];
        (outer + 8.0 * (signal[k + 1] - signal[k - 1])) / (12.0 * step_s)
    };
    (0..count).map(at).collect()
}
