//! Coulomb friction of an arm that turns round again and again: its intervals must hold.

use denavit_codegen::model::{self, Robot};
use denavit_codegen::regressor::RegressorOptions;
use denavit_identify::estimate::{IdentifiedParameter, Options, SlowRows, estimate, parameters};
use denavit_identify::{Identification, Request, identify};
use denavit_measure::condition::{Conditioned, Conditioning, Filter};
use denavit_measure::log::{ColumnMapping, LogOf, MeasuredLog, read_log};
use denavit_numerics::Random;
use denavit_plants::regression::RegressionModel;
use denavit_plants::shipped;
use denavit_simulate::scenario;
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Viscous and Coulomb friction of both joints.
const FRICTION: [[f64; 2]; 2] = [[0.3, 1.2], [0.1, 0.5]];

/// The step of the encoders.
const STEP: f64 = TAU / 20000.0;

/// The planar arm with drives that rub, but for Coulomb friction if there is none.
fn arm(rubs: bool) -> String {
    let shipped = shipped::find("planar_2r").expect("a shipped model");
    let mut arm: Value = serde_json::from_str(shipped.text).expect("JSON");
    for (joint, [viscous, coulomb]) in ["link1", "link2"].into_iter().zip(FRICTION) {
        let coulomb = if rubs { coulomb } else { 0.0 };
        arm["drives"][joint] = json!({"viscous": viscous, "coulomb": coulomb});
    }
    arm.to_string()
}

fn robot() -> Robot {
    model::read("arm", arm(true).as_bytes()).expect("a sound model")
}

fn regression() -> RegressionModel {
    let with = RegressorOptions { friction: true, ..super::INERTIAL };
    RegressionModel::new(&robot(), with, &[]).expect("a model")
}

/// A sum of five sines of random phase in each joint, under PD control; encoders of 20000 steps,
/// torques with noise of 0.05 N m.
fn experiment(seed: u64) -> MeasuredLog {
    let measurement = json!({"resolution": STEP, "logged": true, "torque_noise": 0.05});
    simulated(seed, true, 0.7, measurement)
}

/// The same with other measurements, of waves of another frequency \[rad/s\].
fn simulated(seed: u64, rubs: bool, frequency: f64, measurement: Value) -> MeasuredLog {
    let mut random = Random::new(seed);
    let mut reference = |size: f64| {
        let mut waves = [Vec::new(), Vec::new()];
        for harmonic in 1..=5 {
            let (phase, amplitude) = (TAU * random.uniform(), size / f64::from(harmonic));
            waves[0].push(amplitude * phase.cos());
            waves[1].push(amplitude * phase.sin());
        }
        let [sines, cosines] = waves;
        let waves = json!({"frequency_rad_s": frequency, "sines": sines, "cosines": cosines});
        json!({"kp": 400, "kd": 40, "reference": {"fourier": waves}})
    };
    let joints = json!({"link1": reference(0.5), "link2": reference(0.7)});
    let text = json!({
        "format": "denavit-scenario/1", "model": "arm", "duration_s": 20,
        "initial": {"on_reference": true}, "drives": "model", "seed": seed,
        "control": {"period_s": 0.001, "joints": joints},
        "measurement": measurement,
        "integrator": {"relative": 1e-6, "absolute": 1e-7},
        "log_period_s": 0.001, "tolerances": {"energy_j": 0.01},
    });
    let load = |name: &str| match name {
        "arm" => Ok(arm(rubs).into_bytes()),
        _ => Err("no such file".to_owned()),
    };
    let read = scenario::read("arm", text.to_string().as_bytes(), &load);
    let run = read.unwrap_or_else(|error| panic!("{error}")).run();
    let csv = run.unwrap_or_else(|error| panic!("{error}")).log.to_csv();
    let model = regression();
    let of = LogOf {
        model: &model.model,
        joints: &model.joints,
        contacts: &[],
        accepts_suspicious: false,
    };
    let log = read_log("arm.csv", csv.as_bytes(), of, &ColumnMapping::default());
    log.unwrap_or_else(|faults| panic!("{faults}"))
}

fn conditioned(seed: u64, cutoff_hz: f64) -> Conditioned {
    let how = Conditioning {
        filter: Some(Filter { order: 4, cutoff_hz }),
        decimation: (400.0 / cutoff_hz) as usize,
        ..Conditioning::default()
    };
    let names = ["link1", "link2"].map(str::to_owned);
    Conditioned::new(experiment(seed), &names, &how).expect("long enough")
}

/// For each parameter how often its interval holds the true value.
fn held(
    seeds: std::ops::RangeInclusive<u64>,
    cutoff_hz: f64,
    slow: SlowRows,
) -> Vec<(String, f64)> {
    let model = regression();
    let mut held: Vec<(String, f64)> =
        model.listed.iter().map(|one| (one.name.clone(), 0.0)).collect();
    let count = seeds.clone().count() as f64;
    for seed in seeds {
        let logs = [conditioned(seed, cutoff_hz)];
        let options =
            Options { slow, position_noise: vec![STEP / 12.0_f64.sqrt(); 2], ..Options::default() };
        let start = vec![0.0; model.rank()];
        let found = estimate(&model, &logs, &[], &options, &start).expect("an estimate");
        for (one, (name, share)) in parameters(&model, &found).iter().zip(&mut held) {
            let truth = match name.split_once("_link") {
                Some(("fv", joint)) => FRICTION[usize::from(joint == "2")][0],
                Some(("fc", joint)) => FRICTION[usize::from(joint == "2")][1],
                _ => one.model_value.expect("the model has values"),
            };
            let interval = one.interval.expect("it is excited");
            *share += f64::from(u8::from((one.value - truth).abs() <= interval)) / count;
        }
    }
    held
}

fn worst(held: &[(String, f64)]) -> f64 {
    held.iter().map(|(_, share)| *share).fold(1.0, f64::min)
}

#[test]
fn intervals_of_friction_hold_although_joints_turn_round() {
    let all = held(1..=8, 10.0, SlowRows::default());
    let mean = all.iter().map(|(_, share)| share).sum::<f64>() / all.len() as f64;
    assert!(mean > 0.88 && worst(&all) > 0.6, "{all:?}");
    // with the rows near reversals they do not, which is said
    let model = regression();
    let train = [conditioned(1, 10.0)];
    let of = |slow: SlowRows| -> Identification {
        let options = Options { slow, ..Options::default() };
        let request = Request {
            model: &model,
            train: &train,
            validate: &[],
            instruments: &[],
            options: &options,
        };
        identify(request).expect("an estimate")
    };
    let (without, with) = (of(SlowRows::default()), of(SlowRows::Kept));
    assert_eq!(with.left_out, []);
    assert_eq!(with.reversals.len(), 2, "{:?}", with.reversals);
    assert_eq!(without.reversals, []);
    assert_eq!(without.left_out.len(), 2);
    for rows in &without.left_out {
        assert!(rows.samples > 0 && rows.samples < rows.of, "{rows:?}");
    }
    let wrong = |found: &Identification| {
        let of = |(joint, [_, coulomb]): (&str, [f64; 2])| {
            let name = format!("fc_{joint}");
            let one = found.parameters.iter().find(|one| one.name == name).expect("a parameter");
            (one.value / coulomb - 1.0).abs()
        };
        ["link1", "link2"].into_iter().zip(FRICTION).map(of).sum::<f64>()
    };
    assert!(wrong(&without) < 0.5 * wrong(&with), "{} {}", wrong(&without), wrong(&with));
}

/// The figures of docs/reference/identification.md.
#[test]
#[ignore = "takes minutes: the figures are in the docs"]
fn intervals_of_friction_hold_over_many_seeds() {
    for cutoff_hz in [10.0, 14.0, 20.0] {
        for slow in [SlowRows::Kept, SlowRows::Biasing] {
            let all = held(1..=160, cutoff_hz, slow);
            println!("{cutoff_hz} Hz, {slow:?}: {all:.3?}");
            assert!(slow != SlowRows::Biasing || worst(&all) >= 0.87, "{all:?}");
        }
    }
}

/// Encoders of 12 bits in a slow motion.
const COARSE: f64 = TAU / 4096.0;

/// Friction and what it changes with half the cutoff, of loops closed over the coarse encoders of
/// their logs, or over exact positions, which are then logged as these encoders see them.
fn slow(seed: u64, over_encoder: bool) -> Vec<IdentifiedParameter> {
    let measurement = match over_encoder {
        true => json!({
            "resolution": COARSE, "differentiates": true, "logged": true, "torque_noise": 0.02,
        }),
        false => json!({}),
    };
    let mut log = simulated(seed, false, 0.5, measurement);
    if !over_encoder {
        let mut random = Random::new(seed);
        for joint in &mut log.joints {
            joint.q.iter_mut().for_each(|q| *q = (*q / COARSE).round() * COARSE);
            let torque = joint.tau.iter_mut().flatten();
            torque.for_each(|torque| *torque += 0.02 * random.normal());
            joint.step = Some(COARSE);
        }
    }
    let filter = Some(Filter { order: 4, cutoff_hz: 6.25 });
    let how = Conditioning { filter, decimation: 16, ..Conditioning::default() };
    let names = ["link1", "link2"].map(str::to_owned);
    let logs = [Conditioned::new(log, &names, &how).expect("long enough")];
    let model = regression();
    let start = vec![0.0; model.rank()];
    let found = estimate(&model, &logs, &[], &Options::default(), &start).expect("an estimate");
    let all = parameters(&model, &found).into_iter();
    all.filter(|one| one.name.starts_with('f')).collect()
}

/// A loop answers the steps of its encoder, so that noise and motion of the log are no longer
/// independent: friction is biased by several of its errors. What half the cutoff of the filter
/// changes shows that.
#[test]
fn errors_count_that_a_loop_answers_its_encoder() {
    let truth = |one: &IdentifiedParameter| match one.name.as_str() {
        "fv_link1" => FRICTION[0][0],
        "fv_link2" => FRICTION[1][0],
        _ => 0.0,
    };
    let count = |over_encoder: bool| {
        let [mut held, mut held_without, mut changed] = [0; 3];
        for one in (1..=12).flat_map(|seed| slow(seed, over_encoder)) {
            changed += i32::from(one.is_changed());
            if one.name.ends_with('1') {
                let off = (one.value - truth(&one)).abs();
                let [interval, std] = [one.interval, one.std].map(|one| one.expect("excited"));
                let own_std = one.half_cutoff.expect("long enough").own_std;
                held += i32::from(off <= interval);
                held_without += i32::from(off <= interval * own_std / std);
            }
        }
        [held, held_without, changed]
    };
    // of 24 each
    let [held, held_without, _] = count(true);
    assert!(held >= 19 && held_without <= 12, "{held} {held_without}");
    let [held, _, changed] = count(false);
    assert!(held >= 20 && changed == 0, "{held} {changed}");
}
