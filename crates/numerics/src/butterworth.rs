//! Butterworth low-pass filters, forwards and backwards, so that nothing is delayed.

use std::f64::consts::PI;

/// A section of second order (or of first, with the last coefficients 0) with gain 1 at rest:
/// y = b0 x + z1, transposed direct form II.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

impl Section {
    /// The state in which a constant input of 1 gives a constant output of 1.
    fn at_rest(&self) -> [f64; 2] {
        [1.0 - self.b[0], self.b[2] - self.a[1]]
    }

    fn next<const LANES: usize>(
        &self,
        state: &mut [[f64; LANES]; 2],
        x: [f64; LANES],
    ) -> [f64; LANES] {
        let [first, second] = state;
        let mut y = x;
        for lane in 0..LANES {
            y[lane] = self.b[0] * x[lane] + first[lane];
            first[lane] = self.b[1] * x[lane] - self.a[0] * y[lane] + second[lane];
            second[lane] = self.b[2] * x[lane] - self.a[1] * y[lane];
        }
        y
    }
}

/// A Butterworth low-pass filter of a sampled signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Butterworth {
    sections: Vec<Section>,
    order: usize,
    /// The cutoff of one pass, in cycles per sample.
    cutoff: f64,
    /// Samples after which a transient has died down.
    settling: usize,
    /// Samples on either side of a step that two passes smear it over.
    smear: usize,
}

impl Butterworth {
    /// The cutoff of one pass, in cycles per sample.
    pub fn cutoff(&self) -> f64 {
        self.cutoff
    }

    /// Samples on either side of a step that two passes smear it over: half a period of the
    /// cutoff.
    pub fn smear(&self) -> usize {
        self.smear
    }

    /// The filter of an order (of one pass; two passes have twice the slope) whose single pass
    /// halves the power at `cutoff_hz`. None if the cutoff is not between 0 and half the
    /// sampling rate, or the order not from 1 to 10.
    pub fn new(order: usize, cutoff_hz: f64, step_s: f64) -> Option<Self> {
        let relative = cutoff_hz * step_s;
        if !(relative > 0.0 && relative < 0.5 && (1..=10).contains(&order)) {
            return None;
        }
        // The bilinear transform takes tan(pi f h) for the analog frequency.
        let w = (PI * relative).tan();
        let pairs = (0..order / 2).map(|pair| {
            let damping = 2.0 * (PI * (2 * pair + 1) as f64 / (2 * order) as f64).sin();
            let scale = 1.0 / (1.0 + damping * w + w * w);
            let b = w * w * scale;
            let a = [2.0 * (w * w - 1.0) * scale, (1.0 - damping * w + w * w) * scale];
            Section { b: [b, 2.0 * b, b], a }
        });
        let single = (order % 2 == 1).then(|| {
            let b = w / (1.0 + w);
            Section { b: [b, b, 0.0], a: [(w - 1.0) / (w + 1.0), 0.0] }
        });
        let sections = pairs.chain(single).collect();
        let settling = (order as f64 / relative).ceil().min(1e7) as usize;
        let smear = (0.5 / relative).ceil().min(1e7) as usize;
        Some(Self { sections, order, cutoff: relative, settling, smear })
    }

    /// The filter of the same order with half the cutoff.
    pub fn halved(&self) -> Option<Self> {
        Self::new(self.order, 0.5 * self.cutoff, 1.0)
    }

    /// Samples at each end that depend on what was not measured.
    pub fn settling(&self) -> usize {
        self.settling
    }

    /// Samples after which both passes have forgotten all but a share of what was before. Poles of
    /// one pass are apart, so that its transients are their powers; both passes have them twice,
    /// which makes that so many times as much.
    pub fn memory(&self, share: f64) -> usize {
        let radius = |section: &Section| match section.a {
            [a, 0.0] => a.abs(),
            [_, b] => b.sqrt(),
        };
        let slowest = self.sections.iter().map(radius).fold(0.0, f64::max);
        let samples = |share: f64| share.ln() / slowest.ln();
        let first = samples(share);
        samples(share / first.max(1.0)).ceil().clamp(1.0, 1e8) as usize
    }

    /// Filters a signal forwards and backwards, in place. Beyond its ends the signal is taken to
    /// go on turned about its last sample, and to have been at rest before that, so that neither
    /// steps nor slopes make transients.
    pub fn zero_phase(&self, signal: &mut [f64]) {
        self.zero_phase_lanes(signal.as_chunks_mut::<1>().0);
    }

    /// What both passes make of a sample of 1 among so many zeros on either side.
    pub fn zero_phase_impulse(&self, reach: usize) -> Vec<f64> {
        let mut impulse = vec![0.0; 2 * reach + 1];
        impulse[reach] = 1.0;
        self.zero_phase(&mut impulse);
        impulse
    }

    /// [`Self::zero_phase`] of signals side by side, each to the bit what it is alone. Each waits
    /// for its own last sample and for no other's, so that a few take hardly longer than one.
    pub fn zero_phase_lanes<const LANES: usize>(&self, signals: &mut [[f64; LANES]]) {
        let Some((&first, &last)) = signals.first().zip(signals.last()) else { return };
        let (pad, end) = (self.settling.min(signals.len() - 1), signals.len() - 1);
        let turned = |about: [f64; LANES], k: usize| {
            std::array::from_fn(|lane| 2.0 * about[lane] - signals[k][lane])
        };
        let before: Vec<[f64; LANES]> = (1..=pad).rev().map(|k| turned(first, k)).collect();
        let mut after: Vec<[f64; LANES]> = (1..=pad).map(|k| turned(last, end - k)).collect();
        let mut states = self.states(before.first().copied().unwrap_or(first));
        before.iter().for_each(|&x| _ = self.step(&mut states, x));
        for x in signals.iter_mut().chain(&mut after) {
            *x = self.step(&mut states, *x);
        }
        let start = after.last().copied().unwrap_or(signals[end]);
        let mut states = self.states(start);
        for x in after.iter().rev() {
            self.step(&mut states, *x);
        }
        for x in signals.iter_mut().rev() {
            *x = self.step(&mut states, *x);
        }
    }

    fn states<const LANES: usize>(&self, level: [f64; LANES]) -> Vec<[[f64; LANES]; 2]> {
        let at_rest =
            |section: &Section| section.at_rest().map(|state| level.map(|level| state * level));
        self.sections.iter().map(at_rest).collect()
    }

    fn step<const LANES: usize>(
        &self,
        states: &mut [[[f64; LANES]; 2]],
        x: [f64; LANES],
    ) -> [f64; LANES] {
        let sections = self.sections.iter().zip(states);
        sections.fold(x, |x, (section, state)| section.next(state, x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(hz: f64, step_s: f64, samples: usize) -> Vec<f64> {
        (0..samples).map(|k| (2.0 * PI * hz * step_s * k as f64).sin()).collect()
    }

    /// |H|^2 = 1 / (1 + (tan(pi f h)/tan(pi fc h))^(2n)), which two passes have as their gain.
    #[test]
    fn two_passes_have_the_gain_of_the_formula_and_no_delay() {
        let step_s = 1e-3;
        for (order, cutoff) in [(1, 40.0), (2, 30.0), (4, 100.0), (5, 60.0)] {
            let filter = Butterworth::new(order, cutoff, step_s).expect("a lawful cutoff");
            for hz in [5.0, 20.0, 60.0, 150.0] {
                let input = wave(hz, step_s, 4000);
                let mut output = input.clone();
                filter.zero_phase(&mut output);
                let ratio = (PI * hz * step_s).tan() / (PI * cutoff * step_s).tan();
                let gain = 1.0 / (1.0 + ratio.powi(2 * order as i32));
                for k in 1500..2500 {
                    assert!((output[k] - gain * input[k]).abs() < 1e-6, "{order} {cutoff} {hz}");
                }
            }
        }
    }

    #[test]
    fn constants_and_slopes_pass_without_transients() {
        let filter = Butterworth::new(4, 20.0, 1e-3).expect("a lawful cutoff");
        let line: Vec<f64> = (0..3000).map(|k| 3.0 - 2e-3 * f64::from(k)).collect();
        let mut output = line.clone();
        filter.zero_phase(&mut output);
        // The slope has always been there for the signal, not for the filter.
        assert!(line.iter().zip(&output).all(|(a, b)| (a - b).abs() < 1e-3));
        let mut constant = vec![7.5; 500];
        filter.zero_phase(&mut constant);
        assert!(constant.iter().all(|value| (value - 7.5).abs() < 1e-12));
    }

    #[test]
    fn signals_side_by_side_are_what_they_are_alone() {
        let filter = Butterworth::new(4, 20.0, 1e-3).expect("a lawful cutoff");
        let alone = [3.0, 17.0, 40.0].map(|hz| wave(hz, 1e-3, 700));
        let mut lanes: Vec<[f64; 3]> =
            (0..700).map(|k| alone.each_ref().map(|signal| signal[k] + 0.3)).collect();
        filter.zero_phase_lanes(&mut lanes);
        for (lane, signal) in alone.iter().enumerate() {
            let mut signal: Vec<f64> = signal.iter().map(|sample| sample + 0.3).collect();
            filter.zero_phase(&mut signal);
            assert!(lanes.iter().zip(&signal).all(|(x, y)| x[lane].to_bits() == y.to_bits()));
        }
    }

    #[test]
    fn cutoffs_beyond_the_rate_are_refused() {
        assert!(Butterworth::new(4, 500.0, 1e-3).is_none());
        assert!(Butterworth::new(0, 10.0, 1e-3).is_none());
        assert!(Butterworth::new(4, f64::NAN, 1e-3).is_none());
    }
}
