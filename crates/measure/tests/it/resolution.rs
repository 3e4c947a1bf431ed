//! Steps, digits and noise that signals were made with are found in them.

use denavit_measure::resolution::Resolution;
use denavit_numerics::Random;
use std::f64::consts::TAU;

const STEP_S: f64 = 1e-3;

/// A smooth motion of two waves.
fn motion(t: f64) -> f64 {
    0.8 * (TAU * 0.3 * t).sin() + 0.3 * (TAU * 0.7 * t).cos()
}

fn times(samples: usize) -> Vec<f64> {
    (0..samples).map(|k| STEP_S * k as f64).collect()
}

fn stepped(value: f64, step: f64) -> f64 {
    (value / step).round() * step
}

/// As a file has it that was written with so many decimals.
fn printed(value: f64, decimals: usize) -> f64 {
    format!("{value:.decimals$}").parse().expect("a number")
}

fn resolution(make: impl Fn(f64) -> f64) -> Resolution {
    let t = times(8000);
    Resolution::of(&t, &t.iter().map(|t| make(*t)).collect::<Vec<f64>>())
}

#[track_caller]
fn is_near(found: Option<f64>, expected: f64, share: f64) {
    let found = found.unwrap_or_else(|| panic!("no step, where there is one of {expected}"));
    assert!((found / expected - 1.0).abs() < share, "{found} is not {expected}");
}

#[test]
fn steps_are_found_in_double_precision() {
    for step in [TAU / 4000.0, TAU / 20_000.0, TAU / 200_000.0, 1.1e-5, 2.3e-6, 7e-7] {
        let found = resolution(|t| stepped(motion(t), step));
        is_near(found.encoder_step, step, 1e-9);
        assert_eq!(found.printed, 0.0);
    }
}

/// The step that the issue names, and coarser printing down to 2.4 digits a step.
#[test]
fn steps_are_found_under_printed_digits() {
    for (step, decimals) in [
        (2.397e-5, 6),
        (2.397e-6, 6),
        (2.397e-5, 5),
        (TAU / 20_000.0, 4),
        (TAU / 4000.0, 4),
        (TAU / 65_536.0, 6),
        (TAU / 20_000.0, 7),
    ] {
        let found = resolution(|t| printed(stepped(motion(t), step), decimals));
        is_near(found.encoder_step, step, 1e-4);
        let digit = 10.0_f64.powi(-(decimals as i32));
        assert!((found.printed / digit - 1.0).abs() < 1e-9, "{found:?}");
        let both = (step * step + digit * digit).sqrt();
        assert!((found.step() / both - 1.0).abs() < 1e-4, "{found:?}");
    }
}

/// Below two digits of printing nothing tells a step: what is left is the printing.
#[test]
fn steps_that_printing_hides_are_not_made_up() {
    for step in [1.9e-4, 1.3e-4, 1e-4, 2.4e-5] {
        let found = resolution(|t| printed(stepped(motion(t), step), 4));
        assert_eq!(found.encoder_step, None, "{step}");
        assert!((found.printed / 1e-4 - 1.0).abs() < 1e-9, "{found:?}");
    }
}

#[test]
fn steps_are_found_in_single_precision() {
    let step = 2.397e-5;
    let single = |t: f64| stepped(motion(t), step) as f32;
    let shortest = |t: f64| format!("{}", single(t)).parse::<f64>().expect("a number");
    for found in [resolution(|t| f64::from(single(t))), resolution(shortest)] {
        is_near(found.encoder_step, step, 1e-6);
        // numbers from 0.5 to 1 are 2^-24 apart, smaller ones less
        let least = 2.0_f64.powi(-26);
        assert!(found.printed > least && found.printed < 4.0 * least, "{found:?}");
    }
}

#[test]
fn significant_digits_are_digits_of_the_largest_values() {
    let found = resolution(|t| format!("{:.4e}", motion(t)).parse().expect("a number"));
    assert!((2e-5..1.01e-4).contains(&found.printed), "{found:?}");
    assert_eq!(found.encoder_step, None);
}

/// Times that scatter by a twentieth of their distance, and cells without a number: the raw cells
/// keep their steps, and the scatter is no noise.
#[test]
fn steps_are_found_whatever_is_repaired_later() {
    let mut random = Random::new(11);
    let (step, mut t) = (2.397e-5, times(8000));
    t.iter_mut().for_each(|t| *t += 0.05 * STEP_S * random.normal());
    let mut q: Vec<f64> = t.iter().map(|t| printed(stepped(motion(*t), step), 6)).collect();
    (30..8000).step_by(97).for_each(|hole| q[hole] = f64::NAN);
    let found = Resolution::of(&t, &q);
    is_near(found.encoder_step, step, 1e-4);
    let white = found.white_std.expect("fast motion through steps is noisy");
    assert!((white / (step / 12.0_f64.sqrt()) - 1.0).abs() < 0.1, "{white}");
}

/// Fast all the time, and hardly ever by one step.
#[test]
fn steps_of_fast_motion_are_found() {
    let step = 2.397e-5;
    is_near(resolution(|t| stepped(4.0 * t + motion(t), step)).encoder_step, step, 1e-8);
    let printed = resolution(|t| printed(stepped(4.0 * t + motion(t), step), 6));
    is_near(printed.encoder_step, step, 1e-4);
}

/// Ten steps in three thousand samples, and back.
#[test]
fn steps_of_slow_motion_are_found() {
    let t = times(3000);
    let slow: Vec<f64> = t.iter().map(|t| stepped(0.01 * t.sin(), 1e-3 / 1.7)).collect();
    is_near(Resolution::of(&t, &slow).encoder_step, 1e-3 / 1.7, 1e-9);
}

#[test]
fn signals_without_steps_have_none() {
    let t = times(8000);
    let smooth: Vec<f64> = t.iter().map(|t| motion(*t)).collect();
    let found = Resolution::of(&t, &smooth);
    assert_eq!(found, Resolution::default());
    for seed in 0..20 {
        let mut random = Random::new(seed);
        let deviation = 10.0_f64.powf(-2.0 - 4.0 * random.uniform());
        let noisy: Vec<f64> = smooth.iter().map(|q| q + deviation * random.normal()).collect();
        assert_eq!(Resolution::of(&t, &noisy).encoder_step, None, "{seed}");
        let digits: Vec<f64> = noisy.iter().map(|q| printed(*q, 4)).collect();
        assert_eq!(Resolution::of(&t, &digits).encoder_step, None, "{seed}");
        let found = Resolution::of(&t, &noisy).white_std;
        assert!((found.expect("noise") / deviation - 1.0).abs() < 0.1, "{found:?} {deviation}");
    }
    let moved = |k: usize| 0.1 * (0.1 * k.clamp(1000, 1010) as f64).sin();
    let short: Vec<f64> = (0..8000).map(moved).collect();
    assert_eq!(Resolution::of(&t, &short).encoder_step, None);
    assert_eq!(Resolution::of(&t, &vec![0.25; 8000]), Resolution::default());
    assert_eq!(Resolution::of(&[0.0], &[0.25]), Resolution::default());
}

/// Analog noise of several counts of a converter: its counts are steps, and its noise is larger.
#[test]
fn noise_of_several_counts_is_larger_than_its_steps() {
    let (count, mut random) = (1.7e-3, Random::new(3));
    let t = times(8000);
    let noise: Vec<f64> = t.iter().map(|_| 4.0 * count * random.normal()).collect();
    let analog: Vec<f64> =
        t.iter().zip(noise).map(|(t, noise)| stepped(motion(*t) + noise, count)).collect();
    let found = Resolution::of(&t, &analog);
    is_near(found.encoder_step, count, 1e-9);
    let white = found.white_std.expect("noise");
    assert!((white / (4.0 * count) - 1.0).abs() < 0.1, "{white}");
}

/// A signal that is read in counts has them at once.
#[test]
fn scaled_signals_have_scaled_resolutions() {
    let counts = resolution(|t| (motion(t) * 4096.0).round());
    assert_eq!((counts.printed, counts.encoder_step), (1.0, None));
    let scaled = counts.scaled(-TAU / 4096.0);
    assert!((scaled.step() / (TAU / 4096.0) - 1.0).abs() < 1e-12);
    assert!(scaled.staircase(1.0).is_some());
}
