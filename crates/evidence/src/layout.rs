//! Where the rows of spectra are: channel by channel, band by band.

use std::ops::Range;

/// The spectrum of a signal in all channels: for each its rows, none where the signal is 0.
pub type Spectrum = Vec<Vec<f64>>;

/// Channels, and for each the rows of its bands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// For each channel the rows of each band; a band may be empty.
    pub bands: Vec<Vec<Range<usize>>>,
    /// For each channel the level at which its noise is expected: a deviation of one row, in the
    /// unit of the channel.
    pub levels: Vec<f64>,
}

impl Layout {
    /// Number of channels.
    pub fn channels(&self) -> usize {
        self.bands.len()
    }

    /// Number of rows of a channel.
    pub fn rows(&self, channel: usize) -> usize {
        self.bands[channel].last().map_or(0, |band| band.end)
    }

    /// All cells that have rows, channel by channel: channel and rows.
    pub fn cells(&self) -> impl Iterator<Item = (usize, Range<usize>)> + '_ {
        let of = |(channel, bands): (usize, &'_ Vec<Range<usize>>)| {
            let bands = bands.clone().into_iter().filter(|rows| !rows.is_empty());
            bands.map(move |rows| (channel, rows))
        };
        self.bands.iter().enumerate().flat_map(of)
    }

    /// The mean square that noise of each cell is expected to have.
    pub(crate) fn expected(&self) -> Vec<f64> {
        self.cells().map(|(channel, _)| self.levels[channel].powi(2)).collect()
    }
}
