//! A pendulum whose weight drives it: the torque is a small difference, and errors of the position
//! are as large as it.

use super::one_joint::{diagnosed, log};
use denavit_diagnose::Verdict;

/// 2 kg at 0.5 m, hanging down at 0; its weight takes 9.81 N m across.
const PENDULUM: &str = r#"{
  "format": "denavit-model/1", "name": "pendulum", "convention": "standard",
  "gravity": [9.81, 0, 0],
  "links": [{
    "name": "rod", "joint": {"type": "revolute", "a": 0.5},
    "body": {"mass": 2, "com": [0, 0, 0], "about": "com",
             "inertia": {"xx": 0.05, "yy": 0.05, "zz": 0.1, "xy": 0, "xz": 0, "yz": 0}}
  }],
  "drives": {"rod": {"viscous": 0.05, "coulomb": 0.1}}
}"#;

/// The answer where an encoder is off by some hundredths of a turn of its pendulum, which swings
/// with a frequency in rad/s, less and less; for two logs of other sizes.
fn answer(rate: f64) -> (Verdict, Vec<String>, usize) {
    let torque =
        |[q, qd, qdd]: [f64; 3]| 0.6 * qdd + 9.81 * q.sin() + 0.05 * qd + 0.1 * qd.signum();
    let of = |size: f64, seed: u64| {
        // a wave whose size changes: its derivatives by the product rule
        let motion = |t: f64| {
            let (w, e) = (0.41_f64, 0.3 * size);
            let [a, da, dda] =
                [size + e * (w * t).sin(), e * w * (w * t).cos(), -e * w * w * (w * t).sin()];
            let [s, ds, dds] =
                [(rate * t).sin(), rate * (rate * t).cos(), -rate * rate * (rate * t).sin()];
            [a * s, da * s + a * ds, dda * s + 2.0 * da * ds + a * dds]
        };
        let mut log = log(&motion, &torque, seed, 0.003);
        let off = |q: &mut f64| *q += 0.02 * (5.0 * *q).sin();
        log.joints[0].q.iter_mut().for_each(off);
        log
    };
    let (found, _) = diagnosed(PENDULUM, [of(0.5, 1), of(0.6, 2)]);
    let named = found.effects.iter().filter(|one| one.is_named).count();
    (found.verdict, found.reasons, named)
}

#[test]
fn what_errors_of_positions_make_of_a_small_difference_is_no_physics() {
    let is_said = |reasons: &[String]| reasons.iter().any(|one| one.contains("small difference"));
    // it swings by itself with 4.04 rad/s
    let (verdict, reasons, named) = answer(3.8);
    assert!(verdict == Verdict::CannotTell && named == 0, "{verdict:?} {reasons:?}");
    assert!(is_said(&reasons), "{reasons:?}");
    let (_, reasons, _) = answer(8.0);
    assert!(!is_said(&reasons), "{reasons:?}");
}
