//! The gap of models in motion, against what a missing force does to a mass.

use super::one_joint::{STEP_S, diagnosed, log};
use std::f64::consts::TAU;

const MASS: f64 = 2.0;
const OFFSET: f64 = 0.8;
/// Amplitudes [m] of waves of so many periods in five seconds.
const WAVES: [(f64, f64); 3] = [(0.2, 1.0), (0.1, 2.0), (0.05, 4.0)];

pub(super) const SLED: &str = r#"{
  "format": "denavit-model/1", "name": "sled", "convention": "standard", "gravity": [0, -9.81, 0],
  "links": [{
    "name": "sled", "joint": {"type": "prismatic", "theta": 0, "d": 0, "a": 0, "alpha": 0},
    "body": {"mass": {"value": 2, "std": 0.002}, "com": [0, 0, 0], "about": "com",
             "inertia": {"xx": 1, "yy": 1, "zz": 1, "xy": 0, "xz": 0, "yz": 0}}
  }]
}"#;

pub(super) fn motion(phase: f64) -> impl Fn(f64) -> [f64; 3] {
    move |t| waves(&WAVES, phase, t)
}

/// Position, velocity and acceleration of waves of so many periods in five seconds.
pub(super) fn waves(waves: &[(f64, f64)], phase: f64, t: f64) -> [f64; 3] {
    let mut all = [0.0; 3];
    for (size, periods) in waves {
        let w = TAU * periods / 5.0;
        let (sine, cosine) = (w * t + periods * phase).sin_cos();
        all[0] += size * sine;
        all[1] += size * w * cosine;
        all[2] -= size * w * w * sine;
    }
    all
}

#[test]
fn a_missing_force_moves_a_mass_by_half_its_acceleration_times_the_square_of_time() {
    let torque = |at: [f64; 3]| MASS * at[2] + OFFSET;
    let logs = [(0.0, 1), (0.8, 2)].map(|(phase, seed)| log(&motion(phase), &torque, seed, 0.01));
    let (found, candidates) = diagnosed(SLED, logs);
    let [one] = &found.effects[..] else { panic!("{:?}", found.reasons) };
    assert_eq!(candidates[one.candidate].effect, "torque_offset");
    // Windows have 100 samples after their first: s from one step to 0.2 s. What a sum of sines
    // goes in s has the mean square A^2 (1 - cos w s) over all beginnings.
    let times = || (1..=100).map(|k| STEP_S * f64::from(k));
    let mean = |of: &dyn Fn(f64) -> f64| times().map(of).sum::<f64>() / 100.0;
    let error = mean(&|s| (0.5 * OFFSET / MASS * s * s).powi(2));
    let went = WAVES.iter().map(|(size, periods)| {
        let w = TAU * periods / 5.0;
        mean(&|s| size * size * (1.0 - (w * s).cos()))
    });
    let expected = (error / went.sum::<f64>()).sqrt();
    let gaps = found.motion.expect("asked for").expect("a sled can be simulated");
    for [before, after] in [&gaps.train, &gaps.held_out] {
        assert!((before.all / expected - 1.0).abs() < 0.1, "{} {expected}", before.all);
        assert_eq!(before.per_joint, [Some(before.all)]);
        assert!(after.all < 0.05 * expected, "{} {expected}", after.all);
    }
}
