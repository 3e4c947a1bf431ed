//! Columns that are other ones than they are taken for: told on several robots, and nothing told
//! of good logs, whatever the nominal parameters.

use super::estimate::{Experiment, bare};
use denavit_codegen::regressor::RegressorOptions;
use denavit_identify::doubt::{ExchangedColumns, Misreading, misread_columns};
use denavit_measure::JointIndex;
use denavit_measure::condition::Conditioned;
use denavit_plants::regression::RegressionModel;
use std::f64::consts::FRAC_PI_2;

const ROBOTS: [&str; 5] = ["planar_2r", "scara", "stanford", "puma560", "tulip_leg6"];

/// Where friction is in the torques, its parameters have no values in the model, or others.
fn made(name: &str, seed: u64, friction: bool) -> (RegressionModel, Conditioned) {
    let robot = bare(name);
    let with = RegressorOptions { friction, ..super::INERTIAL };
    let model = RegressionModel::new(&robot, with, &[]).expect("a model");
    let log = Experiment { samples: 2500, noise: 0.05, seed, friction }.run(&robot);
    (model, log)
}

fn told(model: &RegressionModel, log: &Conditioned) -> Vec<(Misreading, bool)> {
    let found = misread_columns(model, &[log], None);
    found.into_iter().map(|one| (one.misreading, one.is_sure)).collect()
}

/// A log with columns multiplied, exchanged and shifted: what makes it needs the opposite to mend.
fn misread(log: &Conditioned, how: Misreading) -> Conditioned {
    let mut log = log.clone();
    let mut torques = |joints: &[JointIndex], factor: f64| {
        for &joint in joints {
            let column = log.torque[joint.0].as_mut().expect("measured");
            column.iter_mut().for_each(|torque| *torque /= factor);
        }
    };
    let all: Vec<JointIndex> = (0..log.q.len()).map(JointIndex).collect();
    match how {
        Misreading::LateTorque(joint, samples) => {
            log.torque[joint.0].as_mut().expect("measured").rotate_right(samples.unsigned_abs());
            log.range = samples.unsigned_abs()..log.range.end;
        }
        Misreading::Torques(factor) => torques(&all, factor),
        Misreading::Torque(joint, factor) => torques(&[joint], factor),
        Misreading::Late(samples) => {
            for torque in log.torque.iter_mut().flatten() {
                torque.rotate_right(samples.unsigned_abs());
            }
            log.range = samples.unsigned_abs()..log.range.end;
        }
        _ => {}
    }
    let [rates, accelerations] = log.rates.as_mut().expect("given");
    let mut orders = [&mut log.q, rates, accelerations];
    match how {
        Misreading::Time(factor) => {
            log.step_s /= factor;
            for (order, columns) in orders.into_iter().enumerate() {
                let values = columns.iter_mut().flatten();
                values.for_each(|value| *value *= factor.powi(order as i32));
            }
        }
        Misreading::Angles(factor) => {
            let values = orders.into_iter().flatten().flatten();
            values.for_each(|value| *value /= factor);
        }
        Misreading::Zero(joint, offset) => {
            orders[0][joint.0].iter_mut().for_each(|value| *value -= offset);
        }
        Misreading::LatePosition(joint, samples) => {
            for columns in orders {
                columns[joint.0].rotate_right(samples.unsigned_abs());
            }
            log.range = samples.unsigned_abs()..log.range.end;
        }
        Misreading::Position(joint, factor) => {
            for columns in orders {
                columns[joint.0].iter_mut().for_each(|value| *value /= factor);
            }
        }
        Misreading::Exchanged([a, b], columns) => {
            if columns != ExchangedColumns::Torques {
                orders.iter_mut().for_each(|columns| columns.swap(a.0, b.0));
            }
            if columns != ExchangedColumns::Positions {
                log.torque.swap(a.0, b.0);
            }
        }
        _ => {}
    }
    log
}

/// Neither with the nominal parameters but for friction, nor with masses that are 40 % off.
#[test]
fn nothing_is_told_of_good_logs() {
    for name in ROBOTS {
        for (seed, heavier) in [(1, 1.0), (2, 1.4), (3, 0.6)] {
            let (model, log) = made(name, seed, true);
            let log = misread(&log, Misreading::Torques(1.0 / heavier));
            assert_eq!(told(&model, &log), [], "{name} {heavier}");
        }
    }
}

/// A slide in mm, and one log of two whose torques have the wrong sign.
#[test]
fn slides_and_single_logs_are_told() {
    let (model, log) = made("stanford", 4, true);
    let slide = model.joints.iter().position(|joint| joint.slides).expect("it has one");
    let in_mm = misread(&log, Misreading::Position(JointIndex(slide), 1e-3));
    assert_eq!(told(&model, &in_mm), [(Misreading::Lengths(1e-3), true)]);
    let (model, log) = made("planar_2r", 4, true);
    let mut turned =
        misread(&made("planar_2r", 5, true).1, Misreading::Torque(JointIndex(1), -1.0));
    turned.file = "turned".to_owned();
    let found = misread_columns(&model, &[&log, &turned], None);
    let told: Vec<_> = found.iter().map(|one| (one.misreading, one.file.as_deref())).collect();
    assert_eq!(told, [(Misreading::Torque(JointIndex(1), -1.0), Some("turned"))]);
}

#[test]
fn misread_columns_are_told() {
    use Misreading::{
        Angles, Exchanged, Late, LatePosition, LateTorque, Position, Time, Torque, Torques, Zero,
    };
    let degree = 1.0_f64.to_radians();
    let both = [JointIndex(0), JointIndex(1)];
    let cases = [
        Time(10.0),
        Time(0.01),
        Time(1e-3),
        Torques(1e-3),
        Torques(-1.0),
        Torque(JointIndex(1), 1e-3),
        Torque(JointIndex(0), 100.0),
        Torque(JointIndex(1), -1.0),
        Angles(degree),
        Position(JointIndex(1), degree),
        Position(JointIndex(1), -1.0),
        Exchanged(both, ExchangedColumns::Positions),
        Exchanged(both, ExchangedColumns::Torques),
        Exchanged(both, ExchangedColumns::Both),
        Late(5),
        LateTorque(JointIndex(1), 8),
        LatePosition(JointIndex(0), 8),
        Zero(JointIndex(0), 0.1),
        Zero(JointIndex(1), 0.1),
        Zero(JointIndex(1), FRAC_PI_2),
    ];
    let mut missed = Vec::new();
    for name in ["planar_2r", "puma560", "tulip_leg6"] {
        // that of the leg is nearly all of its torque, and its model has other values
        let (model, log) = made(name, 4, name != "tulip_leg6");
        let is_by_degrees =
            |how: Misreading| matches!(how, LateTorque(..) | LatePosition(..) | Zero(..));
        // it takes longest, and has no other joints than the arm before it
        let asked = |how: &Misreading| name != "tulip_leg6" || !is_by_degrees(*how);
        for how in cases.into_iter().filter(asked) {
            let found = told(&model, &misread(&log, how));
            let is_told = found.first().is_some_and(|(one, is_sure)| {
                let is_same = match (*one, how) {
                    (Late(found), Late(made)) => found.abs_diff(made) <= 1,
                    (LateTorque(a, found), LateTorque(b, made))
                    | (LatePosition(a, found), LatePosition(b, made)) => {
                        a == b && found.abs_diff(made) <= 1
                    }
                    (Zero(a, found), Zero(b, made)) => a == b && (found - made).abs() < 0.01,
                    (found, made) => found == made,
                };
                is_same && (*is_sure || is_by_degrees(how) || matches!(how, Late(_)))
            });
            // the last body turns with the zero of its joint, which values may tell all the same,
            // and all bodies with that of a vertical axis
            let is_hidden = match how {
                Zero(JointIndex(0), _) => name != "planar_2r",
                Zero(JointIndex(1), _) => name == "planar_2r",
                _ => false,
            };
            assert!(!is_hidden || found.is_empty() || is_told, "{name}: {how:?} {found:?}");
            if !(is_told || is_hidden) {
                missed.push((name, how, found));
            }
        }
    }
    assert!(missed.is_empty(), "{missed:#?}");
}

/// The zero of the last joint of an arm: its body can turn instead, but values that are true with
/// it, and not without, tell it. Another log tells it of a log for validation.
#[test]
fn zeros_that_no_estimate_sees_are_told_by_values_that_are_true() {
    let (model, log) = made("planar_2r", 4, false);
    let off = misread(&log, Misreading::Zero(JointIndex(1), 0.2));
    let [(Misreading::Zero(JointIndex(1), offset), false)] = told(&model, &off)[..] else {
        panic!("{:?}", told(&model, &off));
    };
    assert!((offset - 0.2).abs() < 0.005, "{offset}");
    let heavier = misread(&off, Misreading::Torques(1.0 / 1.4));
    assert_eq!(told(&model, &heavier), []);
}
