//! A drive that follows its demand late, where the log has what was demanded.

use super::one_joint::{STEP_S, diagnosed, log};
use denavit_diagnose::Verdict;
use denavit_measure::log::MeasuredLog;
use std::f64::consts::TAU;

const SLED: &str = r#"{
  "format": "denavit-model/1", "name": "sled", "convention": "standard", "gravity": [0, -9.81, 0],
  "links": [{
    "name": "sled", "joint": {"type": "prismatic", "theta": 0, "d": 0, "a": 0, "alpha": 0},
    "body": {"mass": {"value": 2, "std": 0.002}, "com": [0, 0, 0], "about": "com",
             "inertia": {"xx": 1, "yy": 1, "zz": 1, "xy": 0, "xz": 0, "yz": 0}}
  }],
  "drives": {"sled": {"viscous": {"value": 0.5, "std": 0.005},
                      "coulomb": {"value": 2, "std": 0.02}}}
}"#;

const MASS: f64 = 2.0;
const VISCOUS: f64 = 0.5;
const COULOMB: f64 = 2.0;
/// Steps of the integration to a sample.
const WITHIN: usize = 40;

/// What a drive gives of what is demanded of it, sample by sample of the integration.
type Given<'g> = &'g mut dyn FnMut(f64) -> f64;

/// A log of a sled with dry friction that a controller moves along waves. It sticks where it turns
/// around, and longer the later its drive is.
fn controlled(phase: f64, seed: u64, given: Given<'_>) -> MeasuredLog {
    let h = STEP_S / WITHIN as f64;
    let (mut position, mut rate) = (0.0_f64, 0.0_f64);
    let (mut positions, mut demands) = (Vec::new(), Vec::new());
    let waves = [(0.1, 0.4), (0.06, 0.7)];
    for k in 0..7501 * WITHIN {
        let t = h * k as f64;
        let (mut wanted, mut wanted_rate) = (0.0, 0.0);
        for (size, hz) in waves {
            let angle = TAU * hz * t + hz * phase;
            wanted += size * angle.sin();
            wanted_rate += size * TAU * hz * angle.cos();
        }
        let demand = 800.0 * (wanted - position) + 80.0 * (wanted_rate - rate);
        if k % WITHIN == 0 {
            positions.push(position);
            demands.push(demand);
        }
        let free = given(demand) - VISCOUS * rate;
        let side = if rate == 0.0 { free.signum() } else { rate.signum() };
        let next = rate + h * (free - COULOMB * side) / MASS;
        let holds = rate == 0.0 && free.abs() <= COULOMB;
        rate = if holds || next * rate < 0.0 { 0.0 } else { next };
        position += h * rate;
    }
    let at = |t: f64| (t / STEP_S).round() as usize;
    log(&|t| [positions[at(t)], demands[at(t)], 0.0], &|[_, demand, _]| demand, seed, 0.02)
}

/// A drive that follows by a lag, after a delay \[s\].
fn late(lag_s: f64, delay_s: f64) -> impl FnMut(f64) -> f64 {
    let h = STEP_S / WITHIN as f64;
    let (mut given, mut demands) = (0.0, vec![0.0; 1 + (delay_s / h).round() as usize]);
    let mut next = 0;
    move |demand| {
        demands[next] = demand;
        next = (next + 1) % demands.len();
        let follows = if lag_s > 0.0 { 1.0 - (-h / lag_s).exp() } else { 1.0 };
        given += follows * (demands[next] - given);
        given
    }
}

/// The names that are found, and the value of the first.
fn found(lag_s: f64, delay_s: f64) -> (Vec<String>, Option<[f64; 2]>) {
    let of = |phase: f64, seed: u64| controlled(phase, seed, &mut late(lag_s, delay_s));
    let (found, candidates) = diagnosed(SLED, [of(0.0, 1), of(2.0, 2)]);
    let verdict =
        if found.effects.is_empty() { Verdict::NothingMissing } else { Verdict::Explained };
    assert_eq!(found.verdict, verdict, "{:?}", found.reasons);
    let value = found.effects.first().map(|one| {
        let parameter = &one.parameters[0];
        [parameter.value, parameter.std]
    });
    (found.effects.iter().map(|one| candidates[one.candidate].effect.clone()).collect(), value)
}

#[test]
fn a_lag_of_the_drive_is_found_with_nothing_of_its_friction() {
    let (names, value) = found(0.012, 0.0);
    assert_eq!(names, ["drive_lag"]);
    let [value, std] = value.expect("one is found");
    assert!((value - 0.012).abs() < 3.0 * std && std < 1e-3, "{value} +- {std}");
}

#[test]
fn a_delay_of_the_drive_is_one_of_the_log_that_is_ahead() {
    let (names, value) = found(0.0, 0.008);
    assert_eq!(names, ["torque_delay"]);
    let [value, std] = value.expect("one is found");
    assert!((value + 0.008).abs() < 3.0 * std && std < 1e-3, "{value} +- {std}");
}

/// Friction changes its side late where a drive sticks. That says nothing of how late its drive is.
#[test]
fn a_delay_has_no_part_in_the_time_between_channels() {
    let (names, value) = found(0.0, 0.0025);
    assert_eq!(names, ["torque_delay"]);
    let [value, std] = value.expect("one is found");
    let off = (value + 0.0025).abs();
    assert!(off < 4.0 * std && off < 1e-4, "{value} +- {std}");
}

#[test]
fn a_drive_that_is_not_late_lacks_nothing() {
    assert_eq!(found(0.0, 0.0), (Vec::new(), None));
}
