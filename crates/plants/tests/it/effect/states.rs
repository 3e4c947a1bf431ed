//! Laws with states against an integration of their own.

use denavit_codegen::effect::find;
use denavit_codegen::model::JointKind;
use denavit_plants::effect::{EffectLaw, JointSamples};

/// Rates by two lines that say what the papers say, integrated by the classical Runge-Kutta
/// method with many small steps between samples.
fn runge_kutta(
    t: &[f64],
    rate_of: &dyn Fn(f64) -> f64,
    bristle: &dyn Fn(f64, f64) -> f64,
) -> Vec<f64> {
    const SMALL: usize = 400;
    let (mut z, mut path) = (0.0, vec![0.0]);
    for pair in t.windows(2) {
        let h = (pair[1] - pair[0]) / SMALL as f64;
        for step in 0..SMALL {
            let now = pair[0] + step as f64 * h;
            let f = |at: f64, z: f64| bristle(rate_of(at), z);
            let k1 = f(now, z);
            let k2 = f(now + h / 2.0, z + h / 2.0 * k1);
            let k3 = f(now + h / 2.0, z + h / 2.0 * k2);
            let k4 = f(now + h, z + h * k3);
            z += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
        path.push(z);
    }
    path
}

fn compare(name: &str, values: &[f64], torque_of: &dyn Fn(&[f64]) -> Vec<f64>, most: f64) {
    let effect = find(name).expect("shipped");
    let law = EffectLaw::new(effect, JointKind::Revolute).expect("a law");
    let t: Vec<f64> = (0..1500).map(|k| f64::from(k) * 0.001).collect();
    let qd: Vec<f64> = t.iter().map(|&t| rate(t)).collect();
    let samples = JointSamples { t: &t, qd: &qd, ..JointSamples::default() };
    let found = law.torque(&samples, values);
    let expected = torque_of(&t);
    let worst = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0_f64, f64::max);
    let largest = expected.iter().fold(0.0_f64, |most, torque| most.max(torque.abs()));
    assert!(worst < most * largest, "{name}: {worst} of {largest}");
}

fn rate(t: f64) -> f64 {
    0.4 * (7.0 * t + 0.3).sin() + 0.1 * (19.0 * t).cos()
}

#[test]
fn dahls_bristle_is_that_of_small_steps() {
    let (fc, slip) = (1.7, 0.004);
    let bristle = |v: f64, z: f64| (v - v.abs() * z) / slip;
    compare(
        "dahl",
        &[fc, slip],
        &|t| runge_kutta(t, &rate, &bristle).iter().map(|z| fc * z).collect(),
        1e-3,
    );
}

#[test]
fn dahls_bristle_is_exact_at_constant_rate() {
    let effect = find("dahl").expect("shipped");
    let law = EffectLaw::new(effect, JointKind::Revolute).expect("a law");
    // steps of many slips and of a fraction of one
    let t = [0.0, 0.001, 0.002, 0.01, 0.5, 0.6];
    let (fc, slip, v) = (2.0, 0.01, 0.3);
    let qd = [v; 6];
    let samples = JointSamples { t: &t, qd: &qd, ..JointSamples::default() };
    let found = law.torque(&samples, &[fc, slip]);
    for (t, found) in t.iter().zip(found) {
        let expected = fc * -(-v * t / slip).exp_m1();
        assert!((found - expected).abs() < 1e-12, "{t}: {found} is not {expected}");
    }
}
