//! Estimates from measurements as instruments give them: noise of positions, steps, filters, laps.

use super::INERTIAL;
use super::estimate::{Experiment, bare};
use denavit_identify::estimate::{BlockMaker, Condensed, Method, Options, estimate, parameters};
use denavit_measure::ErrorKind;
use denavit_measure::JointIndex;
use denavit_measure::condition::{Averaging, Conditioned, Conditioning, Filter};
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_numerics::Random;
use denavit_plants::regression::RegressionModel;
use std::f64::consts::TAU;

fn model() -> RegressionModel {
    RegressionModel::new(&bare("planar_2r"), INERTIAL, &[]).expect("a model")
}

fn truth(model: &RegressionModel) -> Vec<f64> {
    model.listed.iter().map(|one| one.value.expect("the model has all values")).collect()
}

/// The sum of all errors, each over the size of its parameter.
fn error(model: &RegressionModel, logs: &[Conditioned], z: &[Conditioned], o: &Options) -> f64 {
    let start = vec![0.0; model.rank()];
    let found = estimate(model, logs, z, o, &start).expect("an estimate");
    let listed = parameters(model, &found);
    listed
        .iter()
        .zip(truth(model))
        .map(|(one, truth)| ((one.value - truth) / truth.abs().max(0.1)).abs())
        .sum()
}

/// With noise of the accelerations, in which the torques are linear.
fn noisy(clean: &Conditioned, deviation: f64, seed: u64) -> Conditioned {
    let mut data = clean.clone();
    let mut random = Random::new(seed);
    let [_, accelerations] = data.rates.as_mut().expect("given");
    for column in accelerations {
        column.iter_mut().for_each(|value| *value += deviation * random.normal());
    }
    data
}

/// Noise of the motion makes least squares too small; instruments without it do not.
#[test]
fn instruments_remove_the_bias_of_noisy_motion() {
    let model = model();
    let robot = bare("planar_2r");
    let clean = Experiment { samples: 6000, noise: 0.02, seed: 8, friction: false }.run(&robot);
    let noisy = noisy(&clean, 3.0, 5);
    let own = std::slice::from_ref(&noisy);
    let plain = error(&model, own, &[], &Options::default());
    let options = Options { method: Method::Instrumental, ..Options::default() };
    let ours = error(&model, own, std::slice::from_ref(&clean), &options);
    assert!(ours < 0.3 * plain, "{ours} {plain}");
    // Instruments of another length are refused.
    let mut short = clean.clone();
    short.range.end -= 1;
    let start = vec![0.0; model.rank()];
    assert!(estimate(&model, &[noisy], &[short], &options, &start).is_err());
}

#[test]
fn without_noise_every_method_finds_the_truth() {
    let model = model();
    let robot = bare("planar_2r");
    let clean = Experiment { samples: 600, noise: 0.0, seed: 8, friction: false }.run(&robot);
    for method in [Method::Ordinary, Method::Weighted, Method::Total, Method::Instrumental] {
        let options = Options { method, ..Options::default() };
        let own = std::slice::from_ref(&clean);
        assert!(error(&model, own, own, &options) < 1e-6, "{method:?}");
    }
}

/// A log of positions and torques alone.
fn log(step_s: f64, samples: usize, encoder: f64, laps: bool) -> MeasuredLog {
    let robot = bare("planar_2r");
    let mut plant = denavit_plants::LoadedPlant::new(&robot, &[]).expect("values");
    let mut random = Random::new(77);
    let mut joints = vec![JointSignals::default(), JointSignals::default()];
    for k in 0..samples {
        let t = step_s * k as f64;
        let ratio = if laps { 2.0 } else { 1.618 };
        let (u, v) = (TAU * 0.5 * t, TAU * 0.5 * ratio * t);
        let [wu, wv] = [TAU * 0.5, TAU * 0.5 * ratio];
        let q = [0.7 * u.sin() + 0.4 * v.cos(), 0.5 * v.sin() - 0.6 * u.cos()];
        let qd = [0.7 * wu * u.cos() - 0.4 * wv * v.sin(), 0.5 * wv * v.cos() + 0.6 * wu * u.sin()];
        let qdd = [
            -0.7 * wu * wu * u.sin() - 0.4 * wv * wv * v.cos(),
            -0.5 * wv * wv * v.sin() + 0.6 * wu * wu * u.cos(),
        ];
        let torque = inverse(&mut plant, &q, &qd, &qdd);
        for (joint, (q, torque)) in joints.iter_mut().zip(q.into_iter().zip(torque)) {
            let seen = if encoder > 0.0 { (q / encoder).round() * encoder } else { q };
            joint.q.push(seen);
            joint.tau.get_or_insert_default().push(torque + 0.05 * random.normal());
        }
    }
    MeasuredLog { file: "made".to_owned(), step_s, joints, ..MeasuredLog::default() }
}

fn inverse(plant: &mut dyn denavit_plants::Plant, q: &[f64], qd: &[f64], qdd: &[f64]) -> [f64; 2] {
    let (mut mass, mut bias) = ([0.0; 4], [0.0; 2]);
    plant.mass_matrix(q, &mut mass);
    plant.bias(q, qd, &mut bias);
    [0, 1].map(|j| mass[2 * j] * qdd[0] + mass[2 * j + 1] * qdd[1] + bias[j])
}

fn names() -> Vec<String> {
    model().joints.iter().map(|joint| joint.name.clone()).collect()
}

#[test]
fn encoders_and_noise_leave_the_parameters_within_a_few_percent() {
    let model = model();
    let how = Conditioning {
        filter: Some(Filter { order: 4, cutoff_hz: 20.0 }),
        decimation: 10,
        ..Conditioning::default()
    };
    let step = TAU / 20_000.0;
    let data = Conditioned::new(log(1e-3, 20_000, step, false), &names(), &how).expect("long");
    let plain = error(&model, std::slice::from_ref(&data), &[], &Options::default());
    assert!(plain < 0.02 * model.rank() as f64, "{plain}");
    let likely = Options {
        method: Method::Likelihood,
        position_noise: vec![step / 12.0_f64.sqrt(); 2],
        ..Options::default()
    };
    let ours = error(&model, &[data], &[], &likely);
    assert!(ours < 1.2 * plain, "{ours} {plain}");
}

/// Differences of unfiltered positions: what noise does to rates and accelerations is that of the
/// differences alone, and likelihood weighs rows by it.
#[test]
fn likelihood_needs_no_filter() {
    let model = model();
    let how = Conditioning { decimation: 1, ..Conditioning::default() };
    assert_eq!(how.filter, None);
    let step = TAU / 2e6;
    let data = Conditioned::new(log(1e-2, 6000, step, false), &names(), &how).expect("long");
    let likely = Options {
        method: Method::Likelihood,
        position_noise: vec![step / 12.0_f64.sqrt(); 2],
        ..Options::default()
    };
    let ours = error(&model, &[data], &[], &likely);
    assert!(ours < 0.02 * model.rank() as f64, "{ours}");
}

#[test]
fn laps_are_found_and_averaged() {
    let model = model();
    let how = Conditioning { averaging: Averaging::Found, ..Conditioning::default() };
    let data = Conditioned::new(log(2e-3, 8100, 0.0, true), &names(), &how).expect("laps");
    let laps = data.laps.expect("found");
    assert_eq!((laps.samples, laps.count), (1000, 8));
    assert!(error(&model, &[data], &[], &Options::default()) < 0.03 * model.rank() as f64);
    let never = Conditioned::new(log(2e-3, 8100, 0.0, false), &names(), &how);
    assert_eq!(never.expect_err("no laps").kind(), ErrorKind::Laps);
}

#[test]
fn filters_that_cannot_be_are_refused() {
    let filter = |cutoff_hz| Conditioning {
        filter: Some(Filter { order: 4, cutoff_hz }),
        ..Conditioning::default()
    };
    let of = |samples, how| Conditioned::new(log(1e-3, samples, 0.0, false), &names(), &how);
    assert_eq!(of(2000, filter(500.0)).expect_err("above").kind(), ErrorKind::Cutoff);
    let short = of(300, filter(20.0)).expect_err("300 rows");
    assert_eq!((short.kind(), short.rows().map(|rows| rows[0])), (ErrorKind::TooShort, Some(300)));
}

/// A sine turns round twice in its period, and a filter of 10 Hz smears each reversal over 0.05 s
/// on either side: 0.2 of a second. A joint that goes one way has none.
#[test]
fn samples_near_reversals_are_counted() {
    let step_s = 0.001;
    let joint = |q: &dyn Fn(f64) -> f64| JointSignals {
        q: (0..10_000).map(|k| q(step_s * k as f64)).collect(),
        ..JointSignals::default()
    };
    let sine = |t: f64| (TAU * t).sin();
    let joints = vec![joint(&sine), joint(&|t| 0.3 * t)];
    let log = MeasuredLog { step_s, joints, ..MeasuredLog::default() };
    let filter = Some(Filter { order: 4, cutoff_hz: 10.0 });
    let how = Conditioning { filter, ..Conditioning::default() };
    let names = ["a", "b"].map(str::to_owned);
    let conditioned = Conditioned::new(log, &names, &how).expect("long enough");
    let share = |joint: usize| {
        let near = conditioned.near_reversals(JointIndex(joint), 1.0).expect("there is a filter");
        near.iter().filter(|near| **near).count() as f64 / near.len() as f64
    };
    assert!((share(0) - 0.2).abs() < 0.01, "{}", share(0));
    assert_eq!(share(1), 0.0);
}

/// The mean of a log of noise scatters as that of its independent samples does.
#[test]
fn independent_samples_are_those_of_the_band_that_is_left() {
    let model = model();
    for (cutoff_hz, decimation) in [(5.0, 8), (10.0, 1), (2.5, 16)] {
        let filter = Some(Filter { order: 4, cutoff_hz });
        let how = Conditioning { filter, decimation, ..Conditioning::default() };
        let names: Vec<String> = model.joints.iter().map(|joint| joint.name.clone()).collect();
        let mut random = Random::new(7);
        // logs, rows, squares of rows and of the sums of logs; what is said of a row
        let (mut sums, mut said) = ([0.0; 4], 0.0);
        for _ in 0..100 {
            let mut noise = log(0.01, 3000, 0.0, false);
            for joint in &mut noise.joints {
                joint.tau = Some((0..3000).map(|_| random.normal()).collect());
            }
            let noise = Conditioned::new(noise, &names, &how).expect("a log");
            said = Condensed::new(&model, std::slice::from_ref(&noise)).independent[0];
            let mut of_joints = [[0.0; 3]; 2];
            BlockMaker::new(&model, &noise).for_each(|block| {
                for (sums, torque) in of_joints.iter_mut().zip(&block.torque) {
                    let [torque, _] = torque.as_ref().expect("measured");
                    sums[0] += torque.len() as f64;
                    sums[1] += torque.iter().map(|torque| torque * torque).sum::<f64>();
                    sums[2] += torque.iter().sum::<f64>();
                }
            });
            for [rows, squares, sum] in of_joints {
                let own = [1.0, rows, squares, sum * sum];
                sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
            }
        }
        let [_, _, squares, of_sums] = sums;
        // of independent rows the squares of sums are those of the rows
        let share = squares / of_sums;
        assert!((said / share - 1.0).abs() < 0.3, "{cutoff_hz} {decimation}: {said} {share}");
    }
}
