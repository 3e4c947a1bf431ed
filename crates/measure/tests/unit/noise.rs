//! Tests of what is private in `noise.rs`.

use super::*;

/// Noise far below the motion is seen, where samples are close enough to say so.
#[test]
fn white_noise_is_told_from_motion() {
    let mut random = Random::new(4);
    for deviation in [1e-6, 1e-4, 1e-2] {
        let at = |k: usize| (0.004 * k as f64).sin() + 0.3 * (0.011 * k as f64).cos();
        let noisy: Vec<f64> = (0..5000).map(|k| at(k) + deviation * random.normal()).collect();
        let found = white_noise(&noisy).expect("there is noise");
        assert!((found / deviation - 1.0).abs() < 0.1, "{found} {deviation}");
    }
    let fast: Vec<f64> = (0..5000).map(|k| (0.3 * f64::from(k)).sin()).collect();
    assert_eq!(white_noise(&fast), None);
    assert_eq!(white_noise(&[0.3; 500]), None);
}
