//! A drive at its limit: logs have what was demanded of it.

use super::motion::SLED;
use super::one_joint::{STEP_S, diagnosed, log};
use denavit_diagnose::Verdict;
use std::f64::consts::TAU;

const MASS: f64 = 2.0;
const LIMIT: f64 = 5.0;
/// Demanded accelerations [m/s^2] of waves of so many periods in five seconds.
const WAVES: [(f64, f64); 3] = [(1.5, 3.0), (1.2, 5.0), (0.8, 8.0)];
/// Steps of the integration to a sample.
const WITHIN: usize = 20;

/// Position, rate and demanded acceleration of a sled whose drive gives no more than it can.
fn limited(phase: f64) -> impl Fn(f64) -> [f64; 3] {
    let step_s = STEP_S / WITHIN as f64;
    let demanded = move |t: f64| {
        let angle = |periods: f64| TAU * periods / 5.0 * t + periods * phase;
        WAVES.iter().map(|(size, periods)| size * angle(*periods).sin()).sum::<f64>()
    };
    let (mut rate, mut rates) = (0.0, Vec::new());
    for k in 0..7500 * WITHIN {
        rates.push(rate);
        // the middle of a step is where its acceleration is
        let at = demanded(step_s * (k as f64 + 0.5));
        rate += step_s * at.clamp(-LIMIT / MASS, LIMIT / MASS);
    }
    let drift = rates.iter().sum::<f64>() / rates.len() as f64;
    let (mut position, mut states) = (0.0, Vec::new());
    for (k, both) in rates.windows(2).enumerate() {
        if k % WITHIN == 0 {
            states.push([position, both[0] - drift]);
        }
        position += step_s * (0.5 * (both[0] + both[1]) - drift);
    }
    move |t| {
        let [q, qd] = states[(t / STEP_S).round() as usize];
        [q, qd, demanded(t)]
    }
}

#[test]
fn the_limit_of_a_drive_is_found_where_logs_have_what_was_demanded() {
    let demand = |at: [f64; 3]| MASS * at[2];
    let logs = [(0.0, 1), (0.8, 2)].map(|(phase, seed)| log(&limited(phase), &demand, seed, 0.02));
    let (found, candidates) = diagnosed(SLED, logs);
    let [one] = &found.effects[..] else { panic!("{:?}", found.reasons) };
    assert_eq!(candidates[one.candidate].effect, "torque_saturation");
    assert!(one.alternatives.is_empty(), "{:?}", one.alternatives);
    let [inverse] = &one.parameters[..] else { panic!("{:?}", one.parameters) };
    assert!((inverse.value * LIMIT - 1.0).abs() < 0.01, "{}", 1.0 / inverse.value);
    assert_eq!(found.verdict, Verdict::Explained, "{:?}", found.reasons);
    // The sled moves as it did if the limit is there.
    let gaps = found.motion.expect("asked for").expect("a sled can be simulated");
    for [before, after] in [&gaps.train, &gaps.held_out] {
        assert!(after.all < 0.2 * before.all, "{} {}", before.all, after.all);
    }
}
