//! A log that is too long to be held at once, as stretches of it that are conditioned one by one.
//!
//! What a filter makes of a sample depends on all others, but less and less the farther they are.
//! A stretch is read with so much of the log before and after it that what the rest would change is
//! below 1e-13 of the signal. So its samples are those of the whole log, and so are the samples
//! that are left after decimation, which stand where they do in the whole.

use super::{Butterworth, Conditioned, Conditioning, Decimator, Derivatives, STENCIL, lawful};
use crate::policy::stretch::FORGOTTEN;
use std::ops::Range;

/// Samples that are regressed at once: stretches have whole blocks, so that these are of the same
/// samples as in the whole log.
const BLOCK: usize = 512;

/// Samples of a stretch, before decimation: they are in memory at once.
const USUAL: usize = 1 << 17;

/// How a long log is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stretches {
    /// Samples of the log.
    samples: usize,
    /// Samples at each end of the log that depend on what was not measured.
    edge: usize,
    /// Samples on either side of a stretch that it is read with.
    overlap: usize,
    decimation: usize,
    /// Samples of a stretch that are left after decimation.
    length: usize,
}

/// A stretch of a long log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stretch {
    /// The samples that are read.
    pub read: Range<usize>,
    /// Those of them that count, counted in the whole log.
    range: Range<usize>,
}

impl Stretches {
    /// Of a log of so many samples at this distance \[s\].
    ///
    /// None if there is no such filter, or the log is too short for it.
    pub fn new(samples: usize, step_s: f64, how: &Conditioning) -> Option<Self> {
        let filter = how.filter.map(|filter| lawful(filter, step_s)).transpose().ok()?;
        let filter = filter.as_ref();
        let stencil = if how.derivatives == Derivatives::Logged { 0 } else { STENCIL };
        let edge = stencil + filter.map_or(0, Butterworth::settling);
        let overlap = stencil + filter.map_or(0, |filter| filter.memory(FORGOTTEN));
        let decimation = how.decimation.max(1);
        let blocks = (USUAL / (BLOCK * decimation)).max(1);
        let cut = Self { samples, edge, overlap, decimation, length: blocks * BLOCK };
        (cut.kept() > 0).then_some(cut)
    }

    /// Samples of the log that are left after decimation.
    pub fn kept(&self) -> usize {
        let cut = 2 * (self.edge + Decimator::reach_of(self.decimation));
        self.samples.saturating_sub(cut).div_ceil(self.decimation)
    }

    /// Samples of the log that do not depend on what was not measured.
    pub fn inner(&self) -> usize {
        self.samples.saturating_sub(2 * self.edge)
    }

    /// How many stretches there are.
    pub fn count(&self) -> usize {
        self.kept().div_ceil(self.length)
    }

    /// A stretch by its number, from 0.
    pub fn get(&self, number: usize) -> Stretch {
        let first = number * self.length;
        let kept = self.length.min(self.kept() - first);
        let start = self.edge + first * self.decimation;
        let end = start + 2 * Decimator::reach_of(self.decimation) + (kept - 1) * self.decimation;
        let from = start.saturating_sub(self.overlap.max(self.edge));
        let to = (end + 1 + self.overlap.max(self.edge)).min(self.samples);
        Stretch { read: from..to, range: start..end + 1 }
    }
}

impl Conditioned {
    /// The samples that are a stretch's own, of a log that is what was read of it.
    pub fn of_stretch(mut self, stretch: &Stretch) -> Self {
        let from = stretch.read.start;
        self.range = stretch.range.start - from..stretch.range.end - from;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::super::Filter;
    use super::*;
    use crate::SampleIndex;
    use crate::log::{JointSignals, MeasuredLog};
    use denavit_numerics::Random;

    const STEP_S: f64 = 1e-3;

    fn walk(samples: usize) -> [Vec<f64>; 2] {
        let mut random = Random::new(8);
        let mut noisy = |size: f64, slow: f64| -> Vec<f64> {
            let at = |k: usize| (slow * k as f64).sin() + 0.3 * (2.7 * slow * k as f64).cos();
            (0..samples).map(|k| size * at(k) + 1e-3 * random.normal()).collect()
        };
        [noisy(1.0, 0.002), noisy(30.0, 0.003)]
    }

    fn log([q, tau]: &[Vec<f64>; 2], of: Range<usize>) -> MeasuredLog {
        let joint = JointSignals {
            q: q[of.clone()].to_vec(),
            tau: Some(tau[of.clone()].to_vec()),
            ..JointSignals::default()
        };
        MeasuredLog {
            start_s: STEP_S * of.start as f64,
            step_s: STEP_S,
            joints: vec![joint],
            ..MeasuredLog::default()
        }
    }

    fn conditioned(log: MeasuredLog, how: &Conditioning) -> Conditioned {
        Conditioned::new(log, &["joint".to_owned()], how).expect("long enough")
    }

    /// Every sample that is left of the whole is left of one stretch, with its time, motion and
    /// torque; of orders, cutoffs and decimations of which poles are near the circle and far.
    #[test]
    fn stretches_have_the_samples_of_the_whole() {
        let signals = walk(400_000);
        let cases = [(4, 6.25, 40, 3), (4, 100.0, 4, 3), (1, 20.0, 10, 3), (8, 50.0, 1, 4)];
        for (order, cutoff_hz, decimation, expected) in cases {
            let filter = Some(Filter { order, cutoff_hz });
            let how = Conditioning { filter, decimation, ..Conditioning::default() };
            let whole = conditioned(log(&signals, 0..400_000), &how);
            let cut = Stretches::new(400_000, STEP_S, &how).expect("long enough");
            assert_eq!(cut.kept(), whole.samples());
            assert!((expected..=expected + 1).contains(&cut.count()), "{}", cut.count());
            let mut first = 0;
            let (mut ours, mut its) = (Vec::new(), Vec::new());
            let mut scale = [0.0_f64; 3];
            let mut off = [0.0_f64; 3];
            for number in 0..cut.count() {
                let stretch = cut.get(number);
                let part = conditioned(log(&signals, stretch.read.clone()), &how);
                let part = part.of_stretch(&stretch);
                let samples = part.samples();
                part.motion_at(SampleIndex(0), samples, &mut ours);
                whole.motion_at(SampleIndex(first), samples, &mut its);
                for order in 0..3 {
                    for (a, b) in ours[order].iter().zip(&its[order]) {
                        off[order] = off[order].max((a - b).abs());
                        scale[order] = scale[order].max(b.abs());
                    }
                }
                let at =
                    |k: usize| part.time_s(SampleIndex(k)) - whole.time_s(SampleIndex(first + k));
                assert!(at(0).abs() < 1e-9 && at(samples - 1).abs() < 1e-9);
                first += samples;
            }
            assert_eq!(first, whole.samples());
            // differences of positions lose digits: steps are 1 ms
            for (order, most) in [1e-13, 1e-11, 1e-9].into_iter().enumerate() {
                assert!(
                    off[order] <= most * scale[order],
                    "{cutoff_hz} {order}: {off:?} {scale:?}"
                );
            }
        }
    }

    /// A log that is shorter than its edges has no stretches; one with a single sample left, one.
    #[test]
    fn short_logs_have_one_stretch_or_none() {
        let filter = Some(Filter { order: 4, cutoff_hz: 10.0 });
        let how = Conditioning { filter, decimation: 4, ..Conditioning::default() };
        let edges = 2 * (400 + STENCIL + Decimator::reach_of(4));
        assert_eq!(Stretches::new(edges, STEP_S, &how), None);
        let one = Stretches::new(edges + 1, STEP_S, &how).expect("one sample");
        assert_eq!((one.kept(), one.count(), one.get(0).read), (1, 1, 0..edges + 1));
        let beyond = Some(Filter { order: 4, cutoff_hz: 600.0 });
        let beyond = Conditioning { filter: beyond, ..Conditioning::default() };
        assert_eq!(Stretches::new(100_000, STEP_S, &beyond), None);
    }
}
