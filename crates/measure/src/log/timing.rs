//! Time stamps: how far they are from equal distances.

/// How the distances of time stamps scatter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timing {
    /// Root of mean square of what distances are off, over the usual one.
    pub jitter: f64,
    /// The most that one is off, over the usual one.
    pub largest: f64,
    /// Samples that are missing, by the usual distance.
    pub dropped: usize,
    /// The most that are missing at once.
    pub most_dropped: usize,
    /// The distance of printed times \[s\]; 0 of those that have all their digits.
    pub printed_s: f64,
}

impl Timing {
    /// The scatter of times whose usual distance is `usual`, printed to `printed_s`.
    pub(super) fn new(time: &[f64], usual: f64, printed_s: f64) -> Self {
        let mut found = Self { printed_s, ..Self::default() };
        let mut squares = 0.0;
        for pair in time.windows(2) {
            let samples = samples_between(pair, usual);
            let off = (pair[1] - pair[0]) / usual - samples as f64;
            squares += off * off;
            found.largest = found.largest.max(off.abs());
            found.dropped = found.dropped.saturating_add(samples - 1);
            found.most_dropped = found.most_dropped.max(samples - 1);
        }
        found.jitter = (squares / time.len().saturating_sub(1).max(1) as f64).sqrt();
        found
    }

    /// Whether times without drops are equally distant ones that printing has rounded: none is
    /// further from their line than half a digit.
    pub(super) fn is_printing(&self, time: &[f64]) -> bool {
        let count = time.len() as f64;
        let middle = 0.5 * (count - 1.0);
        let at = |row: usize| row as f64 - middle;
        let mean = time.iter().map(|t| t - time[0]).sum::<f64>() / count;
        let rows = || time.iter().enumerate().map(|(row, t)| (at(row), t - time[0] - mean));
        let squares: f64 = rows().map(|(at, _)| at * at).sum();
        let slope = rows().map(|(at, t)| at * t).sum::<f64>() / squares;
        // the line is as sure as rounded times make it: at its ends 2 u / sqrt(12 N), 3.5 times
        let most = self.printed_s * (0.5 + 2.0 / count.sqrt());
        self.dropped == 0 && rows().all(|(at, t)| (t - slope * at).abs() <= most)
    }
}

/// The number of usual distances between two times, 1 at least.
pub(super) fn samples_between(pair: &[f64], usual: f64) -> usize {
    ((pair[1] - pair[0]) / usual).round().max(1.0) as usize
}
