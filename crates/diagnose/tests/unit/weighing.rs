//! Tests of what is private in `weighing.rs`.

use super::*;
use crate::Filters;
use denavit_codegen::regressor::functions::modelled;
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_numerics::Random;
use denavit_plants::regression::RegressionModel;

const SLED: &str = r#"{
  "format": "denavit-model/1", "name": "sled", "convention": "standard",
  "gravity": [0, -9.81, 0],
  "links": [{
    "name": "sled", "joint": {"type": "prismatic", "theta": 0, "d": 0, "a": 0, "alpha": 0},
    "body": {"mass": {"value": 2, "std": 0.1}, "com": [0, 0, 0], "about": "com",
             "inertia": {"xx": 1, "yy": 1, "zz": 1, "xy": 0, "xz": 0, "yz": 0}}
  }],
  "drives": {"sled": {"viscous": 0.5}}
}"#;

/// A sled in slow waves, with noise of its position.
fn waves() -> MeasuredLog {
    let mut random = Random::new(1);
    let at = |k: i32| 3.0 * 0.002 * f64::from(k);
    let q = (0..6000).map(|k| 0.2 * at(k).sin() + 1e-4 * random.normal()).collect();
    let torque = |k: i32| 2.0 * -1.8 * at(k).sin() + 0.5 * 0.6 * at(k).cos();
    let tau = Some((0..6000).map(torque).collect());
    let joints = vec![JointSignals { q, tau, ..JointSignals::default() }];
    MeasuredLog { file: "waves".into(), step_s: 0.002, joints, ..MeasuredLog::default() }
}

/// Noise of accelerations is as large as the mass that it is multiplied by: what a mass does above
/// the driven frequency must not speak for or against an effect that leaves another mass.
#[test]
fn what_numbers_do_in_the_same_data_is_no_merit_of_an_effect() {
    let robot = denavit_codegen::model::read("sled", SLED.as_bytes()).expect("a model");
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("parameters");
    let signals = vec![Signals::new(waves(), Filters::of_torques(15.0)).expect("long enough")];
    let nominal = Nominal::new(&model).moving_as(&signals);
    let z = vec![0.0; nominal.len()];
    let data = Data::new(&nominal, signals, &z);
    let nothing = Effects { candidates: &[], taken: &[] };
    let z = vec![0.0; data.columns.len()];
    let first = Weighing::new(vec![&data], nothing, [&z, &z], &[]);
    let mut other = z.clone();
    other[0] = 3.0;
    let log_evidence =
        |weighing: &Weighing<'_>| weighing.base.weigh(&[], None, policy::ROUNDS[1]).log_evidence;
    let now = log_evidence(&first);
    assert_eq!(log_evidence(&first.in_same_data(&other, &[])), now);
    assert!((log_evidence(&first.beside(&other, &[])) - now).abs() > 1.0);
}

/// Lines with factors are the rows of the same sum: the transform and its transpose.
#[test]
fn factors_of_lines_are_in_their_rows() {
    let robot = denavit_codegen::model::read("sled", SLED.as_bytes()).expect("a model");
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("parameters");
    let signals = vec![Signals::new(waves(), Filters::of_torques(15.0)).expect("long enough")];
    let nominal = Nominal::new(&model).moving_as(&signals);
    let data = Data::new(&nominal, signals, &vec![0.0; nominal.len()]);
    let spectra = Spectra::new(&[&data], 15.0);
    let mut random = Random::new(2);
    let rows: Vec<f64> = (0..data.rows()).map(|_| random.normal()).collect();
    let lines = spectra.of_rows(&[&data], &[&rows], f64::INFINITY);
    let factors: Spectrum =
        lines.iter().map(|all| all.iter().map(|_| random.normal()).collect()).collect();
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let of_lines = sum(&lines.concat(), &factors.concat());
    let of_rows = sum(&rows, &spectra.to_rows(&[&data], &factors)[0]);
    assert!((of_lines - of_rows).abs() < 1e-9 * of_lines.abs(), "{of_lines} {of_rows}");
    assert!(data.weights.iter().any(|weight| *weight < 0.9), "rows count alike");
}
