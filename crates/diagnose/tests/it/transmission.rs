//! A drive whose transmission gives way, where the torque is the drive's, and the position the
//! joint's or the drive's.

use super::motion::waves;
use super::one_joint::{STEP_S, diagnosed, log};
use denavit_measure::log::MeasuredLog;
use std::f64::consts::TAU;

const ROTOR: f64 = 0.5;
const MASS: f64 = 2.0;
const STIFFNESS: f64 = 800.0;
const VISCOUS: f64 = 1.5;
const COULOMB: f64 = 1.0;

const SLED: &str = r#"{
  "format": "denavit-model/1", "name": "sled", "convention": "standard", "gravity": [0, -9.81, 0],
  "links": [{
    "name": "sled", "joint": {"type": "prismatic", "theta": 0, "d": 0, "a": 0, "alpha": 0},
    "body": {"mass": {"value": 2, "std": 0.02}, "com": [0, 0, 0], "about": "com",
             "inertia": {"xx": 1, "yy": 1, "zz": 1, "xy": 0, "xz": 0, "yz": 0}}
  }],
  "drives": {"sled": {"rotor_inertia": {"value": 0.5, "std": 0.005},
                      "viscous": {"value": 1.5, "std": 0.05},
                      "coulomb": {"value": 1, "std": 0.03}}}
}"#;

/// Accelerations [m/s^2] of waves of so many periods in five seconds.
const WAVES: [(f64, f64); 3] = [(3.0, 3.0), (2.5, 6.0), (2.0, 11.0)];

/// The position of the sled, the rate of its rotor, and what bodies and rotor take: in closed form,
/// since the rotor is ahead by what the spring must give.
fn moved(phase: f64) -> impl Fn(f64) -> [f64; 3] {
    move |t| {
        let mut all = [0.0; 3];
        for (size, periods) in WAVES {
            let w = TAU * periods / 5.0;
            let (sine, cosine) = (w * t + periods * phase).sin_cos();
            let (ahead, size) = (1.0 - MASS / STIFFNESS * w * w, size / (w * w));
            all[0] += size * sine;
            all[1] += ahead * size * w * cosine;
            all[2] -= size * w * w * (MASS + ROTOR * ahead) * sine;
        }
        all
    }
}

#[test]
fn a_soft_transmission_is_found_by_the_motion_of_its_rotor() {
    let torque = |at: [f64; 3]| at[2] + VISCOUS * at[1] + COULOMB * at[1].signum();
    let logs = [(0.0, 1), (0.8, 2)].map(|(phase, seed)| log(&moved(phase), &torque, seed, 0.02));
    let (found, candidates) = diagnosed(SLED, logs);
    let names = found.effects.iter().map(|one| candidates[one.candidate].name());
    let [one] = &found.effects[..] else {
        panic!("{:?}, not one of it: {:?}", names.collect::<Vec<_>>(), found.reasons)
    };
    assert_eq!(candidates[one.candidate].effect, "joint_elasticity");
    let swing = (ROTOR / STIFFNESS).sqrt();
    let value = one.parameters[0].value;
    assert!((value / swing - 1.0).abs() < 0.05, "{value} is not {swing}");
}

/// Mass 2 kg at 0.3 m with 0.05 kg m^2 about its centre.
const INERTIA: f64 = 0.05 + 2.0 * 0.09;
const WEIGHT: f64 = 2.0 * 0.3 * 9.81;
/// The play \[rad\].
const GAP: f64 = 0.01;

/// What is between the sides of a soft play: under its weight the rod is as far beyond the gap as
/// that is wide [N m/rad, N m s/rad].
const SIDES: f64 = 575.0;
const GREASE: f64 = 1.84;

/// The same of a hard one, where they touch: a rotor that stands swings in 4 ms.
const HARD: f64 = 31_250.0;
const DAMPED: f64 = 40.0;

/// A controller of the rotor [N m/rad, N m s/rad].
const GAINS: [f64; 2] = [1170.0, 52.0];

const PENDULUM: &str = r#"{
  "format": "denavit-model/1", "name": "pendulum", "convention": "standard",
  "gravity": [0, -9.81, 0],
  "links": [{
    "name": "rod", "joint": {"type": "revolute", "theta": 0, "d": 0, "a": 0.5, "alpha": 0},
    "body": {"mass": {"value": 2, "std": 0.02}, "com": [-0.2, 0, 0], "about": "com",
             "inertia": {"xx": 0.001, "yy": 0.05, "zz": {"value": 0.05, "std": 0.002},
                         "xy": 0, "xz": 0, "yz": 0}}
  }],
  "drives": {"rod": {"rotor_inertia": {"value": 0.5, "std": 0.005},
                     "viscous": {"value": 1.5, "std": 0.05},
                     "coulomb": {"value": 1, "std": 0.03}}}
}"#;

/// Small steps of time between samples.
const WITHIN: u32 = 400;
const H: f64 = STEP_S / WITHIN as f64;

/// Angle, velocity and acceleration that a drive is to have.
fn reference(phase: f64, t: f64) -> [f64; 3] {
    let [angle, rate, acceleration] = waves(&[(0.5, 2.0), (0.25, 5.0), (0.1, 9.0)], phase, t);
    [angle - 0.25 * TAU, rate, acceleration]
}

/// How far a drive that is ahead is beyond its gap.
fn beyond(ahead: f64) -> f64 {
    ahead - ahead.clamp(-0.5 * GAP, 0.5 * GAP)
}

/// Angle and velocity of a drive, and what its rotor and soft sides take, sample by sample: the
/// hanging rod goes through the gap by small steps of time.
fn hung(phase: f64) -> impl Fn(f64) -> [f64; 3] {
    let [mut q, mut qd, _] = reference(phase, 0.0);
    let sample = |k: u32| {
        let t = STEP_S * f64::from(k);
        let mut passed = 0.0;
        for step in 0..WITHIN {
            let [motor, rate, _] = reference(phase, t + H * f64::from(step));
            let torque = SIDES * beyond(motor - q) + GREASE * (rate - qd);
            if step == 0 {
                passed = torque;
            }
            qd += H * (torque - WEIGHT * q.cos()) / INERTIA;
            q += H * qd;
        }
        let [motor, rate, acceleration] = reference(phase, t);
        [motor, rate, ROTOR * acceleration + passed]
    };
    let samples: Vec<[f64; 3]> = (0..7500).map(sample).collect();
    move |t| samples[(t / STEP_S).round() as usize]
}

/// Angle and velocity of a rod and the torque of its drive, which a controller moves and which
/// bounces on hard sides, sample by sample.
fn driven(phase: f64) -> impl Fn(f64) -> [f64; 3] {
    let [mut q, mut qd, _] = reference(phase, 0.0);
    let (mut motor, mut rate) = (q, qd);
    let sample = |k: u32| {
        let mut seen = [q, qd, 0.0];
        for step in 0..WITHIN {
            let [asked, speed, _] = reference(phase, STEP_S * f64::from(k) + H * f64::from(step));
            let given = GAINS[0] * (asked - motor) + GAINS[1] * (speed - rate);
            seen[2] += given / f64::from(WITHIN);
            let pressed = beyond(motor - q);
            let damping = if pressed == 0.0 { 0.0 } else { DAMPED };
            let torque = HARD * pressed + damping * (rate - qd);
            let free = rate + H * (given - torque - VISCOUS * rate) / ROTOR;
            rate = free - free.clamp(-H * COULOMB / ROTOR, H * COULOMB / ROTOR);
            motor += H * rate;
            qd += H * (torque - WEIGHT * q.cos()) / INERTIA;
            q += H * qd;
        }
        seen
    };
    let samples: Vec<[f64; 3]> = (0..7500).map(sample).collect();
    move |t| samples[(t / STEP_S).round() as usize]
}

/// The one effect that is found, with its values.
fn one_of(logs: [MeasuredLog; 2]) -> (String, Vec<f64>) {
    let (found, candidates) = diagnosed(PENDULUM, logs);
    let names = found.effects.iter().map(|one| candidates[one.candidate].name());
    let [one] = &found.effects[..] else {
        panic!("{:?}, not one of it: {:?}", names.collect::<Vec<_>>(), found.reasons)
    };
    let values = one.parameters.iter().map(|one| one.value).collect();
    (candidates[one.candidate].effect.clone(), values)
}

#[test]
fn a_gap_with_soft_sides_before_the_joint_is_found_by_how_the_joint_goes_through_it() {
    let torque = |at: [f64; 3]| at[2] + VISCOUS * at[1] + COULOMB * at[1].signum();
    let logs = [(0.0, 1), (0.8, 2)].map(|(phase, seed)| log(&hung(phase), &torque, seed, 0.02));
    let (name, values) = one_of(logs);
    assert_eq!(name, "backlash");
    let [gap, swing, drag] = [0, 1, 2].map(|place| values[place]);
    assert!((gap / GAP - 1.0).abs() < 0.1, "{gap}");
    assert!((swing / (INERTIA / SIDES).sqrt() - 1.0).abs() < 0.1, "{swing}");
    assert!((drag / (GREASE / INERTIA) - 1.0).abs() < 0.3, "{drag}");
}

#[test]
fn a_gap_behind_which_the_joint_is_read_is_found_by_when_its_sides_touch() {
    let torque = |at: [f64; 3]| at[2];
    let logs = [(0.0, 1), (0.8, 2)].map(|(phase, seed)| log(&driven(phase), &torque, seed, 0.02));
    let (name, values) = one_of(logs);
    assert_eq!(name, "play");
    // the filter has an impact begin before it does, so that the gap is crossed sooner
    assert!((values[0] / GAP - 1.0).abs() < 0.15, "{}", values[0]);
}
