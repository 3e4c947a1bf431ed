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
