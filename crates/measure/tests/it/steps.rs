//! Steps of encoders, as a log tells them.

use denavit_codegen::regressor::functions::modelled;
use denavit_measure::log::{ColumnMapping, LogOf, read_log};
use denavit_plants::regression::RegressionModel;
use std::f64::consts::TAU;

const ROD: &str = r#"{
  "format": "denavit-model/1", "name": "rod", "convention": "standard", "gravity": [0, 0, -9.81],
  "links": [{
    "name": "rod", "joint": {"type": "revolute", "theta": 0, "d": 0, "a": 1, "alpha": 0},
    "body": {"mass": 1, "com": [0, 0, 0], "about": "com",
             "inertia": {"xx": 1, "yy": 1, "zz": 1, "xy": 0, "xz": 0, "yz": 0}}
  }]
}"#;

/// The step that is found in a log of positions, every millisecond.
fn step_of(positions: &[f64]) -> Option<f64> {
    let robot = denavit_codegen::model::read("rod", ROD.as_bytes()).expect("a model");
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("parameters");
    let (model, joints, contacts) = ("rod", &model.joints[..], &[][..]);
    let of = LogOf { model, joints, contacts, accepts_suspicious: true };
    let rows = positions.iter().enumerate().map(|(k, q)| format!("{},{q:?}\n", 1e-3 * k as f64));
    let text = format!("t,q_rod\n{}", rows.collect::<String>());
    let log = read_log("made", text.as_bytes(), of, &ColumnMapping::default());
    log.expect("a log").joints[0].step
}

fn sampled(step: f64, digits: Option<i32>) -> Vec<f64> {
    let at = |k: usize| {
        let t = 1e-3 * k as f64;
        let q = 0.8 * (TAU * 0.3 * t).sin() + 0.3 * (TAU * 0.7 * t).cos();
        let stepped = if step > 0.0 { (q / step).round() * step } else { q };
        let scale = digits.map_or(1.0, |digits| 10.0_f64.powi(digits));
        if digits.is_some() { (stepped * scale).round() / scale } else { stepped }
    };
    (0..8000).map(at).collect()
}

/// Steps are found to far more digits than one difference has, in full precision and printed
/// to 7 digits, and where hardly any difference is as small as a step.
#[test]
fn steps_of_encoders_are_found() {
    for step in [TAU / 4000.0, TAU / 20_000.0, TAU / 200_000.0, 1e-5, 2e-6, 1e-6] {
        let found = step_of(&sampled(step, None)).expect("steps");
        assert!((found / step - 1.0).abs() < 1e-9, "{step}: {found}");
    }
    // Down to digits that are an eighth of a step.
    for (step, digits) in [(TAU / 20_000.0, 7), (TAU / 262_144.0, 6), (7.964_8e-6, 6), (1.7e-3, 4)]
    {
        let found = step_of(&sampled(step, Some(digits))).expect("steps");
        assert!((found / step - 1.0).abs() < 1e-4, "{step}: {found}");
    }
}

/// Ten steps in three thousand samples.
#[test]
fn steps_of_slow_motion_are_found() {
    let at = |k: usize| 0.01 * (1e-3 * k as f64).sin();
    let slow: Vec<f64> = (0..3000).map(|k| (at(k) / 1e-3).round() * 1e-3).collect();
    let found = step_of(&slow).expect("steps");
    assert!((found / 1e-3 - 1.0).abs() < 1e-9, "{found}");
    // at rest, but for a smooth move of ten samples
    let moved = |k: usize| 0.1 * (0.1 * k.clamp(1000, 1010) as f64).sin();
    let smooth: Vec<f64> = (0..3000).map(moved).collect();
    assert_eq!(step_of(&smooth), None);
}

#[test]
fn smooth_and_noisy_signals_have_none() {
    assert_eq!(step_of(&sampled(0.0, None)), None);
    // Digits are all the steps that a printed signal has.
    for digits in [4, 5, 6] {
        let found = step_of(&sampled(0.0, Some(digits))).expect("digits");
        assert!((found * 10.0_f64.powi(digits) - 1.0).abs() < 1e-6, "{digits}: {found}");
    }
    let mut random = denavit_numerics::Random::new(9);
    let noisy: Vec<f64> =
        sampled(0.0, None).into_iter().map(|q| q + 1e-4 * random.normal()).collect();
    assert_eq!(step_of(&noisy), None);
}
