//! The derivative of a signal at equal distances.

/// Central differences of a signal, one-sided at its ends, whose samples are so far apart.
pub fn derivative(signal: &[f64], step: f64) -> Vec<f64> {
    let last = signal.len().saturating_sub(1);
    let at = |k: usize| {
        let (before, after) = (k.saturating_sub(1), (k + 1).min(last));
        (signal[after] - signal[before]) / (step * (after - before).max(1) as f64)
    };
    (0..signal.len()).map(at).collect()
}
