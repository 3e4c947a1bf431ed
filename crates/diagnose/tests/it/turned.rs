//! An angle that is far off turns what bodies do that are off as well.

use super::motion::waves;
use super::one_joint::{diagnosed, log};
use denavit_measure::log::MeasuredLog;

/// A double pendulum in a vertical plane: its lengths, and what the bodies are, of which the model
/// says something else: masses [kg], distances of their centres \[m\] and inertias [kg m^2].
const ARM: f64 = 0.5;
const BODIES: [[f64; 3]; 2] = [[2.08, 0.255, 0.052], [1.05, 0.258, 0.021]];
const VISCOUS: [f64; 2] = [0.4, 0.2];

const MODEL: &str = r#"{
  "format": "denavit-model/1", "name": "double", "convention": "standard",
  "gravity": [0, -9.81, 0],
  "links": [
    {"name": "upper", "joint": {"type": "revolute", "theta": 0, "d": 0, "a": 0.5, "alpha": 0},
     "body": {"mass": {"value": 2, "std": 0.1}, "com": [{"value": -0.25, "std": 0.0125}, 0, 0],
              "about": "com", "inertia": {"xx": 0.001, "yy": 0.05,
              "zz": {"value": 0.05, "std": 0.0025}, "xy": 0, "xz": 0, "yz": 0}}},
    {"name": "fore", "joint": {"type": "revolute", "theta": 0, "d": 0, "a": 0.5, "alpha": 0},
     "body": {"mass": {"value": 1, "std": 0.05}, "com": [{"value": -0.25, "std": 0.0125}, 0, 0],
              "about": "com", "inertia": {"xx": 0.001, "yy": 0.02,
              "zz": {"value": 0.02, "std": 0.001}, "xy": 0, "xz": 0, "yz": 0}}}],
  "drives": {"upper": {"viscous": {"value": 0.41, "std": 0.02}},
             "fore": {"viscous": {"value": 0.19, "std": 0.01}}}
}"#;

/// Torques of the double pendulum, in closed form.
fn torques([[q1, v1, a1], [q2, v2, a2]]: [[f64; 3]; 2]) -> [f64; 2] {
    let [[m1, c1, i1], [m2, c2, i2]] = BODIES;
    let (far, cross) = (m2 * c2 * c2 + i2, m2 * ARM * c2);
    let (sine, cosine) = q2.sin_cos();
    let whole = i1 + m1 * c1 * c1 + m2 * ARM * ARM + far + 2.0 * cross * cosine;
    let weight = 9.81 * m2 * c2 * (q1 + q2).cos();
    [
        whole * a1 + (far + cross * cosine) * a2 - cross * sine * (2.0 * v1 + v2) * v2
            + 9.81 * (m1 * c1 + m2 * ARM) * q1.cos()
            + weight
            + VISCOUS[0] * v1,
        (far + cross * cosine) * a1 + far * a2 + cross * sine * v1 * v1 + weight + VISCOUS[1] * v2,
    ]
}

/// What the joints do.
fn motion(phase: f64, t: f64) -> [[f64; 3]; 2] {
    let [q, qd, qdd] = waves(&[(0.5, 1.0), (0.3, 3.0), (0.1, 5.0)], phase, t);
    let fore = waves(&[(0.6, 2.0), (0.3, 3.0), (0.1, 4.0)], 1.7 * phase + 0.4, t);
    [[q - 1.2, qd, qdd], fore]
}

/// A log of both joints, the fore one of which stands at an angle where its sensor says 0.
fn both(zero: f64, seed: u64) -> MeasuredLog {
    let [mut first, second] = [0, 1].map(|joint| {
        let along = |t: f64| {
            let [upper, [q, qd, qdd]] = motion(0.8 * seed as f64, t);
            let torques = torques([upper, [q + zero, qd, qdd]]);
            // the torque goes where the velocity would
            [[upper[0], q][joint], torques[joint], 0.0]
        };
        log(&along, &|at| at[1], seed + 10 * joint as u64, [0.05, 0.02][joint])
    });
    first.joints.extend(second.joints);
    first
}

#[test]
fn a_zero_that_is_far_off_turns_what_its_bodies_do() {
    let logs = [1, 2].map(|seed| both(0.3, seed));
    let (found, candidates) = diagnosed(MODEL, logs);
    let [one] = &found.effects[..] else {
        let names = found.effects.iter().map(|one| candidates[one.candidate].name());
        panic!("{:?}", names.collect::<Vec<_>>())
    };
    assert_eq!(candidates[one.candidate].effect, "joint_zero");
    let angle = &one.parameters[0];
    assert!((angle.value - 0.3).abs() < 3.0 * angle.std && angle.std < 0.01, "{angle:?}");
}
