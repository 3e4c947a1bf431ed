//! Signals between their samples.

/// A signal at so many places in the cell of each sample, by the cubic through four samples. Beyond
/// its ends it goes on turned about its last sample.
pub(super) fn between(signal: &[f64], within: usize) -> Vec<f64> {
    let last = signal.len() as isize - 1;
    let at = |k: isize| {
        let within = k.clamp(0, last);
        let turned = (2 * within - k).clamp(0, last);
        2.0 * signal[within as usize] - signal[turned as usize]
    };
    let middle = 0.5 * (within - 1) as f64;
    let mut fine = Vec::with_capacity(signal.len() * within);
    for k in 0..signal.len() as isize {
        for part in 0..within {
            let x = (part as f64 - middle) / within as f64;
            // From the sample before a place to the one after.
            let (from, u) = if x < 0.0 { (k - 1, x + 1.0) } else { (k, x) };
            fine.push(cubic([-1, 0, 1, 2].map(|offset| at(from + offset)), u));
        }
    }
    fine
}

/// The cubic through values at -1, 0, 1 and 2, between 0 and 1.
pub(super) fn cubic([a, b, c, d]: [f64; 4], u: f64) -> f64 {
    -a * u * (u - 1.0) * (u - 2.0) / 6.0 + b * (u + 1.0) * (u - 1.0) * (u - 2.0) / 2.0
        - c * (u + 1.0) * u * (u - 2.0) / 2.0
        + d * (u + 1.0) * u * (u - 1.0) / 6.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_between_samples_of_a_cubic_is_on_it() {
        let cubic = |x: f64| 0.3 - 1.1 * x + 0.7 * x * x - 0.05 * x * x * x;
        let signal: Vec<f64> = (0..12).map(|k| cubic(f64::from(k))).collect();
        for (k, value) in between(&signal, 3).iter().enumerate().skip(6).take(24) {
            let x = (k as f64 - 1.0) / 3.0;
            assert!((value - cubic(x)).abs() < 1e-12, "{k}: {value} {}", cubic(x));
        }
    }
}
