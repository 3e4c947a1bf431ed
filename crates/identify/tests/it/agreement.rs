//! Logs that contradict each other, and torques that nothing explains: of several robots, behind
//! filters.

use super::INERTIAL;
use super::estimate::{Experiment, bare};
use denavit_codegen::regressor::RegressorOptions;
use denavit_identify::doubt::{Likeness, Standing};
use denavit_identify::estimate::Options;
use denavit_identify::{Identification, Request, identify};
use denavit_measure::condition::{Conditioned, Conditioning, Filter};
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_numerics::Random;
use denavit_plants::regression::RegressionModel;

const ROBOTS: [&str; 3] = ["planar_2r", "scara", "stanford"];

fn model(name: &str) -> RegressionModel {
    let with = RegressorOptions { friction: true, ..INERTIAL };
    RegressionModel::new(&bare(name), with, &[]).expect("a model")
}

/// A log of 30 s behind a filter, whose torques are changed: joint, sample, position, torque.
fn log(
    name: &str,
    (file, seed): (&str, u64),
    change: &mut dyn FnMut(usize, usize, f64, &mut f64),
) -> Conditioned {
    let made = Experiment { samples: 3000, noise: 0.05, seed, friction: true }.run(&bare(name));
    let signals = |(joint, (q, torque)): (usize, (Vec<f64>, Option<Vec<f64>>))| {
        let mut tau = torque.expect("measured");
        let rows = q.iter().zip(&mut tau).enumerate();
        rows.for_each(|(k, (q, torque))| change(joint, k, *q, torque));
        JointSignals { q, tau: Some(tau), ..JointSignals::default() }
    };
    let joints = made.q.into_iter().zip(made.torque).enumerate().map(signals).collect();
    let step_s = made.step_s;
    let log = MeasuredLog { file: file.to_owned(), step_s, joints, ..MeasuredLog::default() };
    let filter = Some(Filter { order: 4, cutoff_hz: 8.0 });
    let how = Conditioning { filter, decimation: 3, ..Conditioning::default() };
    let names: Vec<String> = model(name).joints.iter().map(|joint| joint.name.clone()).collect();
    Conditioned::new(log, &names, &how).expect("it is long")
}

fn good(name: &str, file: &str, seed: u64) -> Conditioned {
    log(name, (file, seed), &mut |_, _, _, _| {})
}

fn found(name: &str, train: &[Conditioned], validate: &[Conditioned]) -> Identification {
    let (model, options) = (model(name), Options::default());
    let request = Request { model: &model, train, validate, instruments: &[], options: &options };
    identify(request).expect("an estimate")
}

fn told(found: &Identification) -> Vec<(&str, Standing)> {
    found.contradicting_logs.iter().map(|one| (one.file.as_str(), one.standing)).collect()
}

/// Logs of one robot agree, and their torques are explained.
#[test]
fn good_logs_agree() {
    for name in ROBOTS {
        for seed in [1, 11] {
            let train: Vec<Conditioned> =
                ["a", "b", "c"].iter().zip(seed..).map(|(file, at)| good(name, file, at)).collect();
            let found = found(name, &train, &[good(name, "d", seed + 7)]);
            assert_eq!(told(&found), [], "{name} {seed}: {:?}", found.contradicting_logs);
            assert_eq!(found.unexplained, [], "{name} {seed}");
            assert_eq!(found.lacking, [], "{name} {seed}");
        }
    }
}

/// One of three whose torques are all 15 % too large, and one with a constant in its last torque.
#[test]
fn a_gain_and_a_constant_of_one_log_are_told() {
    for name in ROBOTS {
        let last = model(name).joints.len() - 1;
        for seed in [1, 11] {
            let gain = log(name, ("odd", seed), &mut |_, _, _, torque| *torque *= 1.15);
            let train = [good(name, "a", seed + 1), gain, good(name, "b", seed + 2)];
            let found_gain = found(name, &train, &[]);
            assert_eq!(told(&found_gain), [("odd", Standing::OfFew)], "{name} {seed}");
            for joint in &found_gain.contradicting_logs[0].joints {
                if let Some(Likeness::Factor(by)) = joint.like {
                    assert!((by - 1.15).abs() < 0.02, "{name} {seed}: {joint}");
                }
            }
            let mut constant = |joint: usize, _, _, torque: &mut f64| {
                *torque += if joint == last { 1.0 } else { 0.0 };
            };
            let odd = log(name, ("odd", seed), &mut constant);
            let found_constant = found(name, &train[..1], &[odd]);
            assert_eq!(told(&found_constant), [("odd", Standing::HeldOut)], "{name} {seed}");
        }
    }
}

/// Half of a torque that is of something else is not explained; as much noise is. A ripple in a log
/// for validation is not, either.
#[test]
fn what_is_no_noise_is_not_explained() {
    for name in ROBOTS {
        let last = model(name).joints.len() - 1;
        for seed in [1, 11] {
            let train = [good(name, "a", seed)];
            let rms = {
                let torque = train[0].torque[last].as_ref().expect("measured");
                (torque.iter().map(|one| one * one).sum::<f64>() / torque.len() as f64).sqrt()
            };
            let mut random = Random::new(seed);
            let mut noise = |joint: usize, _: usize, _: f64, torque: &mut f64| {
                *torque += if joint == last { 2.0 * rms * random.normal() } else { 0.0 };
            };
            let noisy = log(name, ("b", seed + 1), &mut noise);
            let mut wave = |joint: usize, k: usize, _: f64, torque: &mut f64| {
                let own = rms * (0.033 * k as f64).sin();
                *torque += if joint == last { own } else { 0.0 };
            };
            let other = log(name, ("b", seed + 1), &mut wave);
            let mut ripple = |joint: usize, _: usize, q: f64, torque: &mut f64| {
                *torque += if joint == last { 0.3 * rms * (5.0 * q).sin() } else { 0.0 };
            };
            let rippled = log(name, ("b", seed + 1), &mut ripple);
            let is_told = |one: &Identification| {
                !one.unexplained.is_empty() || !one.contradicting_logs.is_empty()
            };
            let alone = |log: &Conditioned| is_told(&found(name, std::slice::from_ref(log), &[]));
            let after =
                |log: &Conditioned| is_told(&found(name, &train, std::slice::from_ref(log)));
            assert!(!alone(&noisy), "{name} {seed}: noise");
            assert!(alone(&other), "{name} {seed}: wave");
            assert!(!after(&noisy), "{name} {seed}: noise of a log for validation");
            assert!(after(&rippled), "{name} {seed}: ripple of a log for validation");
        }
    }
}
