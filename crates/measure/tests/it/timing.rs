//! Time stamps that scatter, are dropped, or have few digits.

use super::robot;
use denavit_codegen::regressor::functions::modelled;
use denavit_measure::log::{ColumnMapping, LogFaults, LogOf, LogRemark, MeasuredLog, read_log};
use denavit_numerics::Random;
use denavit_plants::regression::RegressionModel;
use std::f64::consts::TAU;

const STEP: f64 = 2.397e-5;

fn position(t: f64) -> f64 {
    let q = 0.6 * (TAU * 0.7 * t).sin() + 0.2 * (TAU * 1.3 * t).cos();
    (q / STEP).round() * STEP
}

/// A log of two joints at times that are written with so many decimals.
fn read(times: &[f64], decimals: usize) -> Result<MeasuredLog, LogFaults> {
    let robot = robot("planar_2r");
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("a model");
    let mut text = String::from("t,q_link1,q_link2,tau_link1,tau_link2\n");
    for &t in times {
        let (q, tau) = (position(t), (3.0 * t).sin());
        text += &format!("{t:.decimals$},{q:.6},{q:.6},{tau:.3},{tau:.3}\n");
    }
    let of = LogOf {
        model: "planar_2r",
        joints: &model.joints,
        contacts: &[],
        accepts_suspicious: false,
    };
    read_log("log.csv", text.as_bytes(), of, &ColumnMapping::default())
}

fn is_resampled(log: &MeasuredLog) -> bool {
    log.remarks.iter().any(|remark| matches!(remark, LogRemark::Resampled { .. }))
}

/// Scatter of a few percent is interpolated away; the steps of the encoder are not.
#[test]
fn irregular_times_are_interpolated_and_keep_their_resolution() {
    for jitter in [0.01, 0.02, 0.05] {
        let mut random = Random::new(5);
        let times: Vec<f64> =
            (0..4000).map(|k| 2e-3 * (k as f64 + jitter * random.normal())).collect();
        let log = read(&times, 9).expect("it is repaired");
        assert!(is_resampled(&log), "{:?}", log.remarks);
        // distances are differences of two stamps
        let expected = 2.0_f64.sqrt() * jitter;
        assert!((log.timing.jitter / expected - 1.0).abs() < 0.1, "{:?}", log.timing);
        assert!(log.timing.largest > 2.5 * expected && log.timing.largest < 6.0 * expected);
        let found = log.joints[0].resolution.position;
        assert!((found.encoder_step.expect("steps") / STEP - 1.0).abs() < 1e-4, "{found:?}");
        assert_eq!(log.joints[0].step, Some(found.step()));
    }
}

/// 300 samples a second with times to a millisecond: the samples are even, and stay as they are.
#[test]
fn times_with_few_digits_are_no_scatter() {
    let times: Vec<f64> = (0..3000).map(|k| k as f64 / 300.0).collect();
    let log = read(&times, 3).expect("nothing is wrong");
    assert!(!is_resampled(&log), "{:?}", log.remarks);
    assert!((log.timing.printed_s - 1e-3).abs() < 1e-12 && log.timing.jitter > 0.05);
    assert!((log.step_s * 300.0 - 1.0).abs() < 1e-3, "{}", log.step_s);
    let stays = |k: usize| (log.joints[0].q[k] - position(times[k])).abs() < 1e-6;
    assert!((0..3000).all(stays));
    // a scatter of two digits is one
    let mut random = Random::new(6);
    let late: Vec<f64> = (0..3000).map(|k| 0.01 * k as f64 + 2e-3 * random.uniform()).collect();
    assert!(is_resampled(&read(&late, 3).expect("it is repaired")));
}

#[test]
fn dropped_samples_are_counted() {
    let times: Vec<f64> =
        (0..3000).filter(|k| k % 500 > 2 || *k < 500).map(|k| 2e-3 * k as f64).collect();
    let log = read(&times, 9).expect("it is repaired");
    assert_eq!((log.timing.dropped, log.timing.most_dropped), (15, 3));
}

/// A joint that may turn on and on does so; degrees are told where velocities say so.
#[test]
fn many_turns_are_no_degrees() {
    let robot = robot("planar_2r");
    let mut joints = RegressionModel::new(&robot, modelled(&robot), &[]).expect("a model").joints;
    let text = |unit: f64| {
        let mut text = String::from("t,q_link1,q_link2,qd_link1,qd_link2,tau_link1,tau_link2\n");
        for k in 0..3000 {
            let t = 2e-3 * f64::from(k);
            let (q, qd) = (28.0 * (0.6 * t).sin(), 16.8 * (0.6 * t).cos());
            text += &format!("{t},{},{q},{qd},{qd},{},{}\n", unit * q, q.sin(), q.cos());
        }
        text
    };
    let mut read = |unit: f64, limits: Option<[f64; 2]>| {
        joints.iter_mut().for_each(|joint| joint.position_limits = limits);
        let (contacts, accepts_suspicious) = (&[][..], false);
        let of = LogOf { model: "planar_2r", joints: &joints, contacts, accepts_suspicious };
        read_log("log.csv", text(unit).as_bytes(), of, &ColumnMapping::default())
    };
    assert!(read(1.0, None).is_ok());
    let faults = read(1.0_f64.to_degrees(), None).unwrap_err().to_string();
    assert!(faults.contains("times the derivative of its position"), "{faults}");
    let faults = read(1.0, Some([-3.0, 3.0])).unwrap_err().to_string();
    assert!(faults.contains("as if it were in degrees"), "{faults}");
}
