//! Laws with states against an integration of their own.

use denavit_codegen::effect::{find, read};
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
    compare_law(&law, values, &torque_of(&times()), most);
}

fn times() -> Vec<f64> {
    (0..1500).map(|k| f64::from(k) * 0.001).collect()
}

fn compare_law(law: &EffectLaw, values: &[f64], expected: &[f64], most: f64) {
    let t = times();
    let qd: Vec<f64> = t.iter().map(|&t| rate(t)).collect();
    let samples = JointSamples { t: &t, qd: &qd, ..JointSamples::default() };
    let found = law.torque(&samples, values);
    let name = &law.name;
    let worst = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0_f64, f64::max);
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

/// A bristle by a rate that is piecewise in it has no second derivative by it, and is not affine.
#[test]
fn a_bristle_whose_rate_is_piecewise_is_that_of_small_steps() {
    let (fc, slip) = (1.7, 0.02);
    let torque = |bristle: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
        runge_kutta(&times(), &rate, bristle).iter().map(|z| fc * z).collect()
    };
    let of_size = |v: f64, z: f64| (v - v * z.abs()) / slip;
    let of_side = |v: f64, z: f64| if z * v.signum() < 1.0 { v / slip } else { 0.0 };
    let of_size: &dyn Fn(f64, f64) -> f64 = &of_size;
    let rates =
        [("(qd - qd*abs(z))/slip", of_size), ("select(z*sign(qd) < 1, qd, 0)/slip", &of_side)];
    for (rate_of, bristle) in rates {
        let text = format!(
            r#"{{"format": "denavit-effect/1", "name": "own", "title": "own", "description": "own",
            "source": "own", "kind": "state", "at": "joint", "parameters": {{
            "fc": {{"unit": "torque", "description": "size", "nominal": 0, "bounds": [0, null]}},
            "slip": {{"unit": "position", "description": "reach", "bounds": ["0.001", 1],
                      "start": ["0.02"]}}}},
            "states": {{"z": {{"unit": "1", "rate": "{rate_of}", "initial": 0}}}},
            "torque": "fc*z"}}"#
        );
        let effect = read("own.json", text.as_bytes()).expect("an effect");
        let law = EffectLaw::new(&effect, JointKind::Revolute).expect("a law");
        compare_law(&law, &[fc, slip], &torque(bristle), 2e-2);
    }
}
