//! Motion that repeats: its period, found or given, and the mean of its laps.

use denavit_measure::condition::Laps;
use std::f64::consts::TAU;

fn two_harmonics(period: f64, samples: usize) -> Vec<f64> {
    let at = |k: usize| {
        let angle = TAU * k as f64 / period;
        angle.sin() + 0.4 * (3.0 * angle).cos()
    };
    (0..samples).map(at).collect()
}

#[test]
fn the_period_of_two_harmonics_is_found() {
    let signal = two_harmonics(640.0, 2700);
    let laps = Laps::find(&[signal], 1e-3, 20..2680).expect("it repeats");
    assert_eq!((laps.samples, laps.count), (640, 4));
    assert!((laps.period - 640.0).abs() < 1e-6, "{}", laps.period);
}

/// Neither a period that is found nor one that is given to few digits is rounded to samples.
#[test]
fn periods_have_fractions_of_samples() {
    for period in [628.318, 62.831_853, 40.5] {
        let positions = [two_harmonics(period, 6000)];
        let rounded = (period * 10.0_f64).round() / 10.0;
        let found = Laps::find(&positions, 1e-3, 20..5980).expect("it repeats");
        let given = Laps::given(&positions, 1e-3 * rounded, 1e-3, 20..5980).expect("it repeats");
        for laps in [found, given] {
            assert!((laps.period - period).abs() < 1e-4, "{} {period}", laps.period);
            let mean = laps.mean(&positions[0]);
            // the seam is none
            let bend = |a: f64, b: f64, c: f64| (a - 2.0 * b + c).abs();
            let inside = mean.windows(3).map(|one| bend(one[0], one[1], one[2]));
            let most = inside.fold(0.0, f64::max);
            let n = laps.samples;
            for seam in
                [bend(mean[n - 2], mean[n - 1], mean[0]), bend(mean[n - 1], mean[0], mean[1])]
            {
                assert!(seam < 1.1 * most, "{period}: {seam} {most}");
            }
        }
    }
}

/// Laps of 640 samples are none of 600; a joint that rests but for noise has no say.
#[test]
fn a_period_with_which_nothing_repeats_is_refused() {
    let mut random = denavit_numerics::Random::new(3);
    let noise: Vec<f64> = (0..2700).map(|_| 1e-4 * random.normal()).collect();
    let positions = [two_harmonics(640.0, 2700), noise];
    let given = |period_s: f64| Laps::given(&positions, period_s, 1e-3, 20..2680);
    assert_eq!(given(0.64).map(|laps| laps.count), Ok(4));
    for wrong in [0.6, 0.32, 0.7] {
        let refused = given(wrong).expect_err("other laps").to_string();
        assert!(refused.contains("% of the variance of a joint"), "{wrong}: {refused}");
    }
}

/// Laps that are 0.3 to 0.6 % off repeat to 2 % of the variance, but have a seam.
#[test]
fn a_period_that_is_off_by_samples_is_refused() {
    let positions = [two_harmonics(640.0, 2700)];
    let given = |period_s: f64| Laps::given(&positions, period_s, 1e-3, 20..2680);
    for (wrong, is_longer) in [(0.638, true), (0.6425, false), (0.644, false)] {
        let expected = if is_longer { "is longer by" } else { "is shorter by" };
        let refused = given(wrong).expect_err("other laps").to_string();
        assert!(refused.contains(expected), "{wrong}: {refused}");
    }
    assert!(given(0.6405).is_ok());
}

#[test]
fn what_never_repeats_has_no_period() {
    let slope: Vec<f64> = (0..1000).map(f64::from).collect();
    let refused = Laps::find(&[slope], 1e-3, 0..1000).expect_err("no period").to_string();
    assert!(refused.contains("the motion does not repeat"), "{refused}");
}

#[test]
fn laps_are_averaged() {
    let mut random = denavit_numerics::Random::new(3);
    let noisy: Vec<f64> =
        two_harmonics(500.0, 5000).into_iter().map(|x| x + 0.1 * random.normal()).collect();
    let laps = Laps { start: 0, period: 500.0, samples: 500, count: 10 };
    let mean = laps.mean(&noisy);
    let clean = two_harmonics(500.0, 500);
    assert!(mean.iter().zip(&clean).all(|(a, b)| (a - b).abs() < 0.2));
}
