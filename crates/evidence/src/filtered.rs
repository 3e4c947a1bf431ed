//! A channel that an effect filters: a drive follows what is logged by a lag.
//!
//! Data shrink by the gain of the filter, and their density is that of what passes, times this
//! volume: who makes noise smaller predicts nothing by that. That holds for noise of what was
//! measured. A disturbance of the motion is in what is computed, and in what was measured as far as
//! a controller answers it: in a loop that answers a share T of what disturbs it, a gain of H
//! instead of 1 turns a disturbance d into d (1 + (H - 1) T), which is H to the power of T nearly.
//! So the log of the volume is T log |H|, with T the share of what is left that was measured, band
//! by band. A sensor's noise has T = 1.

use crate::policy;
use std::ops::Range;

/// What a filter does to one channel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Filtered {
    /// The channel.
    pub channel: usize,
    /// Its rows as they were measured.
    pub measured: Vec<f64>,
    /// For each row the log of the filter's gain.
    pub log_gain: Vec<f64>,
}

impl Filtered {
    /// The log of by how much data shrink, where a hypothesis leaves so much of the channel.
    pub(crate) fn log_volume(
        &self,
        cells: impl Iterator<Item = (usize, Range<usize>)>,
        left: &[f64],
    ) -> f64 {
        let of_cell = |(_, rows): (usize, Range<usize>)| {
            let log_gain: f64 = self.log_gain[rows.clone()].iter().sum();
            share(&self.measured[rows.clone()], &left[rows]) * log_gain
        };
        cells.filter(|(channel, _)| *channel == self.channel).map(of_cell).sum()
    }
}

/// The share of what is left that was measured, from none to all of it: what is believed of that,
/// with what rows say. What references ask for is in the rows as well, and hides it.
fn share(measured: &[f64], left: &[f64]) -> f64 {
    let [measured, left] = [measured, left].map(tapered);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let [all, both, own] = [dot(&measured, &measured), dot(&measured, &left), dot(&left, &left)];
    // tapering leaves half of the rows independent
    let precision = 0.5 * left.len() as f64 * own / all.max(f64::MIN_POSITIVE);
    let seen = both / own.max(f64::MIN_POSITIVE);
    let [believed, weight] = [1.0, policy::ANSWERED.powi(-2)];
    ((precision * seen + weight * believed) / (precision + weight)).clamp(0.0, 1.0)
}

/// Lines of rows that are tapered towards their ends (Hann): a motion whose ends differ is in all
/// lines of a cosine transform.
fn tapered(lines: &[f64]) -> Vec<f64> {
    lines.windows(5).map(|near| 0.5 * near[2] - 0.25 * (near[0] + near[4])).collect()
}
