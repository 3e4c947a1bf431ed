//! An arm that is moved from place to place and rests there, with a weight that its model has by
//! a tenth too small.

use super::one_joint::{STEP_S, diagnosed, log};
use denavit_diagnose::Verdict;
use denavit_measure::log::MeasuredLog;
use std::f64::consts::TAU;

/// 2 kg at 0.5 m, hanging down at 0; its weight takes 9.81 N m across.
const ARM: &str = r#"{
  "format": "denavit-model/1", "name": "arm", "convention": "standard", "gravity": [9.81, 0, 0],
  "links": [{
    "name": "arm", "joint": {"type": "revolute", "a": 0.5},
    "body": {"mass": {"value": 2, "std": 0.2}, "com": [0, 0, 0], "about": "com",
             "inertia": {"xx": 0.05, "yy": 0.05, "zz": 0.1, "xy": 0, "xz": 0, "yz": 0}}
  }],
  "drives": {"arm": {"viscous": 0.1, "coulomb": 0.5}}
}"#;

/// The mass that it has.
const MASS: f64 = 2.2;
const COULOMB: f64 = 0.5;
const MOVE_S: f64 = 0.8;
/// Longer than the filter of the torques rings.
const REST_S: f64 = 0.9;

/// Places in turn, as if drawn.
fn place(number: usize, phase: f64) -> f64 {
    0.9 + 0.6 * (2.4 * number as f64 + phase).sin()
}

/// A log in which the drive holds where it rests with nearly the friction with which it leaves:
/// friction at rest balances, and says nothing of the weight.
fn moved(phase: f64, seed: u64) -> MeasuredLog {
    let at = |t: f64| {
        let number = (t / (MOVE_S + REST_S)).floor();
        let within = t - number * (MOVE_S + REST_S);
        let [from, to] = [0, 1].map(|more| place(number as usize + more, phase));
        let next = place(number as usize + 2, phase);
        if within >= MOVE_S {
            let part = (within - MOVE_S) / REST_S;
            let sides = [(to - from).signum(), (next - to).signum()];
            // from the side on which it came to that on which it leaves
            return ([to, 0.0, 0.0], COULOMB * (sides[0] + part * (0.95 * sides[1] - sides[0])));
        }
        // x - sin(x) is smooth where it begins and ends
        let (part, rate) = (within / MOVE_S, 1.0 / MOVE_S);
        let angle = TAU * part;
        let shape =
            [part - angle.sin() / TAU, rate * (1.0 - angle.cos()), rate * rate * TAU * angle.sin()];
        let motion = shape.map(|one| (to - from) * one);
        let friction = COULOMB * (to - from).signum();
        ([from + motion[0], motion[1], motion[2]], friction)
    };
    let motion = |t: f64| at(t).0;
    let mut log = log(&motion, &|_| 0.0, seed, 0.01);
    let torques = log.joints[0].tau.iter_mut().flatten().enumerate();
    for (k, torque) in torques {
        let ([q, qd, qdd], friction) = at(STEP_S * k as f64);
        let weight = MASS * 0.5 * 9.81 * q.sin();
        *torque += (MASS * 0.25 + 0.1) * qdd + weight + 0.1 * qd + friction;
    }
    log
}

#[test]
fn what_holds_a_weight_that_is_known_to_a_tenth_is_no_effect() {
    let (found, candidates) = diagnosed(ARM, [moved(0.0, 1), moved(1.1, 2)]);
    let names: Vec<String> =
        found.effects.iter().map(|one| candidates[one.candidate].name()).collect();
    assert!(names.is_empty(), "{names:?} {:?}", found.reasons);
    assert_eq!(found.verdict, Verdict::NothingMissing, "{:?}", found.reasons);
}
