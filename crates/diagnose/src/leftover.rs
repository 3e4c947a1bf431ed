//! What is left of a channel when all is explained that has a name.
//!
//! Noise of sensors and of drives is as strong in the bands in which a robot moves as in the ones
//! above. What has more in the slow ones is a disturbance, or physics without a name.

use super::hypothesis::Hypothesis;
use super::spectra::Spectra;
use super::weighing::{Weighing, add};
use denavit_evidence::policy;
use denavit_numerics::median;

/// The excess of one channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leftover {
    /// The channel: a joint, or after all joints a spring.
    pub equation: usize,
    /// What slow bands have beyond the level of faster ones, as a share of the torque.
    pub share: f64,
}

/// What each channel has left in slow bands beyond its level in faster ones, by the variances of
/// all cells.
pub(super) fn leftovers(spectra: &Spectra, variances: &[f64]) -> Vec<Leftover> {
    let mut variances = variances.iter();
    let of = |(equation, bands): (usize, &Vec<std::ops::Range<usize>>)| {
        let filled = bands.iter().filter(|rows| !rows.is_empty());
        let all: Vec<(f64, f64)> =
            filled.map(|rows| (rows.len() as f64, *variances.next().expect("a cell"))).collect();
        // the fastest band is where the filter already takes away
        let inner = &all[..all.len().saturating_sub(1)];
        let fast = &inner[inner.len() / 2..];
        let flat = policy::FLAT * median(fast.iter().map(|(_, variance)| *variance).collect());
        let squares = inner.iter().map(|(rows, variance)| rows * (variance - flat).max(0.0));
        Leftover { equation, share: spectra.share_of_squares(equation, squares.sum()) }
    };
    spectra.layout.bands.iter().enumerate().map(of).collect()
}

impl Weighing<'_> {
    /// What a hypothesis leaves of each channel, as a share of its torque.
    pub(super) fn left(&self, hypothesis: &Hypothesis) -> Vec<f64> {
        let mut left = self.base.left(&hypothesis.weighed.own);
        for place in 0..hypothesis.parts.len() {
            add(&mut left, &hypothesis.torque(place), -1.0);
        }
        (0..left.len()).map(|channel| self.spectra.share(&left, channel)).collect()
    }

    /// The same of what is no noise: what slow bands have beyond it, or all that is more than
    /// sensors have.
    pub(super) fn open(&self, hypothesis: &Hypothesis, floor: &[f64]) -> Vec<f64> {
        let slow = leftovers(&self.spectra, &hypothesis.weighed.variances);
        let all = self.left(hypothesis).into_iter().zip(floor).zip(slow);
        all.map(|((left, floor), slow)| if is_broad(left, *floor) { left } else { slow.share })
            .collect()
    }
}

/// Whether what is left, as a share of the torque, is more than sensors have, however even its
/// spectrum is.
pub(super) fn is_broad(left: f64, floor: f64) -> bool {
    left > policy::BROAD && left > policy::BROAD_OF_NOISE * floor
}
