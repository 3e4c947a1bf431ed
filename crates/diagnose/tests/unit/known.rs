//! Tests of what is private in `known.rs`.

use super::*;
use crate::Filters;
use denavit_codegen::regressor::functions::modelled;
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_plants::regression::RegressionModel;
use std::f64::consts::TAU;

const SLED: &str = r#"{
  "format": "denavit-model/1", "name": "sled", "convention": "standard",
  "gravity": [0, -9.81, 0],
  "links": [{
    "name": "sled", "joint": {"type": "prismatic", "theta": 0, "d": 0, "a": 0, "alpha": 0},
    "body": {"mass": 2, "com": [0, 0, 0], "about": "com",
             "inertia": {"xx": 1, "yy": 1, "zz": 1, "xy": 0, "xz": 0, "yz": 0}}
  }],
  "drives": {"sled": {"viscous": 0, "coulomb": 1}}
}"#;

const COULOMB: f64 = 1.0;
const HZ: f64 = 0.5;

/// A sled that an exact torque moves in waves of a period of 2 s, for so many samples.
fn waves(samples: i32) -> MeasuredLog {
    let at = |k: i32| TAU * HZ * 0.002 * f64::from(k);
    let q: Vec<f64> = (0..samples).map(|k| 0.2 * at(k).sin()).collect();
    let torque = |k: i32| {
        let acceleration = -0.2 * (TAU * HZ).powi(2) * at(k).sin();
        2.0 * acceleration + COULOMB * at(k).cos().signum()
    };
    let tau = Some((0..samples).map(torque).collect());
    let joints = vec![JointSignals { q, tau, ..JointSignals::default() }];
    MeasuredLog { file: "waves".into(), step_s: 0.002, joints, ..MeasuredLog::default() }
}

/// What a test finds with the model of the sled, and waves of so many samples.
fn in_waves<T>(samples: i32, find: impl Fn(&Nominal<'_>, &Signals, &Phi) -> T) -> T {
    let robot = denavit_codegen::model::read("sled", SLED.as_bytes()).expect("a model");
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("parameters");
    let signals = Signals::new(waves(samples), Filters::of_torques(10.0)).expect("long enough");
    let logs = [signals];
    let nominal = Nominal::new(&model).moving_as(&logs);
    let ([signals], phi) = (&logs, nominal.phi(&vec![0.0; nominal.len()]));
    find(&nominal, signals, &phi)
}

#[test]
fn rows_at_reversals_count_less_and_late_ones_lack_an_impulse() {
    in_waves(8000, rows_and_impulses);
}

fn rows_and_impulses(nominal: &Nominal<'_>, signals: &Signals, phi: &Phi) {
    let [weights] = &weights(nominal, signals, phi)[..] else { panic!("one joint") };
    for (t, weight) in signals.at_rows(&signals.t).iter().zip(weights) {
        // The rate is that of a cosine, and 0 a quarter of a period after its extremes.
        let from_reversal_s =
            ((t * 2.0 * HZ - 0.5).round() - (t * 2.0 * HZ - 0.5)).abs() / (2.0 * HZ);
        match from_reversal_s {
            near if near < 0.02 => assert!(*weight < 0.1, "{t}: {weight}"),
            far if far > 0.3 => assert!(*weight > 0.99, "{t}: {weight}"),
            _ => {}
        }
    }

    // Of a step of friction that is late by a time, that time its height is missing.
    let [late] = &late_reversals(nominal, signals, phi)[..] else { panic!("one joint") };
    let height = COULOMB + policy::STEP * nominal.usual[0][0];
    let half = (1.0 / HZ / signals.step_s / 2.0) as usize;
    for (k, samples) in late.chunks_exact(half).enumerate() {
        let (first, last) = (k * half, (k + 1) * half - 1);
        let [from, to] = [first, last].map(|k| signals.qd[0][k].signum());
        let impulse = signals.step_s * samples.iter().sum::<f64>();
        let wanted = -policy::LATE_S * height * (to - from);
        assert!((impulse - wanted).abs() < 1e-3 * policy::LATE_S, "{k}: {impulse} {wanted}");
    }
}

#[test]
fn laps_tell_no_more_of_reversals_than_one_lap() {
    let near_reversals = |nominal: &Nominal<'_>, signals: &Signals, phi: &Phi| -> f64 {
        let rates = signals.at_rows(&signals.qd[0]);
        let weights = &weights(nominal, signals, phi)[0];
        let near = rates.iter().zip(weights).filter(|(rate, _)| rate.abs() < 0.03);
        near.map(|(_, weight)| weight * weight).sum()
    };
    let [few, many] = [5000, 20_000].map(|samples| in_waves(samples, near_reversals));
    assert!((many / few - 1.0).abs() < 0.25, "{few} {many}");
}
