//! Signals between their samples.

/// A signal at so many places, at least one, in the cell of each sample, by the cubic through four
/// samples. Beyond its ends it goes on turned about its last sample.
pub fn between(signal: &[f64], within: usize) -> Vec<f64> {
    let last = signal.len() as isize - 1;
    let at = |k: isize| {
        let within = k.clamp(0, last);
        let turned = (2 * within - k).clamp(0, last);
        2.0 * signal[within as usize] - signal[turned as usize]
    };
    let middle = 0.5 * (within - 1) as f64;
    let of_part = |part: usize| {
        let x = (part as f64 - middle) / within as f64;
        // From the sample before a place to the one after.
        let (first, u) = if x < 0.0 { (0, x + 1.0) } else { (1, x) };
        (first, cubic_weights(u))
    };
    let parts: Vec<(usize, [f64; 4])> = (0..within).map(of_part).collect();
    let mut fine = Vec::with_capacity(signal.len() * within);
    for k in 0..signal.len() as isize {
        let around = [-2, -1, 0, 1, 2].map(|offset| at(k + offset));
        for (first, weights) in &parts {
            let both = around[*first..].iter().zip(weights);
            fine.push(both.map(|(sample, weight)| sample * weight).sum());
        }
    }
    fine
}

/// The cubic through values at -1, 0, 1 and 2, at u, between 0 and 1.
pub fn cubic(values: [f64; 4], u: f64) -> f64 {
    values.iter().zip(cubic_weights(u)).map(|(value, weight)| value * weight).sum()
}

/// What each of these values counts.
fn cubic_weights(u: f64) -> [f64; 4] {
    [
        -u * (u - 1.0) * (u - 2.0) / 6.0,
        (u + 1.0) * (u - 1.0) * (u - 2.0) / 2.0,
        -(u + 1.0) * u * (u - 2.0) / 2.0,
        (u + 1.0) * u * (u - 1.0) / 6.0,
    ]
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
