//! Effects beside each other: an angle that is off turns what bodies do, and a gain scales it.

use super::motion::waves;
use super::one_joint::{diagnosed, log};
use denavit_diagnose::FoundEffect;
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

/// What the robot has and its model lacks.
#[derive(Clone, Copy, Default)]
struct Hidden {
    /// By how much the joints stand further than they read [rad].
    zeros: [f64; 2],
    /// A point mass at the end of the fore arm [kg].
    payload: f64,
    /// Torque of the fore arm over the square of its velocity [N m s^2].
    drag: f64,
    /// By how much of itself the torque of the fore arm reads more.
    gain: f64,
}

/// Torques of the double pendulum, in closed form.
fn torques([[q1, v1, a1], [q2, v2, a2]]: [[f64; 3]; 2], hidden: Hidden) -> [f64; 2] {
    let [[m1, c1, i1], [mass, centre, inertia]] = BODIES;
    let [q1, q2] = [q1 + hidden.zeros[0], q2 + hidden.zeros[1]];
    let m2 = mass + hidden.payload;
    let moment = mass * centre + hidden.payload * ARM;
    let far = inertia + mass * centre * centre + hidden.payload * ARM * ARM;
    let cross = ARM * moment;
    let (sine, cosine) = q2.sin_cos();
    let whole = i1 + m1 * c1 * c1 + m2 * ARM * ARM + far + 2.0 * cross * cosine;
    let weight = 9.81 * moment * (q1 + q2).cos();
    let drag = VISCOUS[1] * v2 + hidden.drag * v2 * v2.abs();
    [
        whole * a1 + (far + cross * cosine) * a2 - cross * sine * (2.0 * v1 + v2) * v2
            + 9.81 * (m1 * c1 + m2 * ARM) * q1.cos()
            + weight
            + VISCOUS[0] * v1,
        (1.0 + hidden.gain)
            * ((far + cross * cosine) * a1 + far * a2 + cross * sine * v1 * v1 + weight + drag),
    ]
}

/// What the joints do.
fn motion(phase: f64, t: f64) -> [[f64; 3]; 2] {
    let [q, qd, qdd] = waves(&[(0.5, 1.0), (0.3, 3.0), (0.1, 5.0)], phase, t);
    let fore = waves(&[(0.6, 2.0), (0.3, 3.0), (0.1, 4.0)], 1.7 * phase + 0.4, t);
    [[q - 1.2, qd, qdd], fore]
}

/// A log of both joints.
fn both(hidden: Hidden, seed: u64) -> MeasuredLog {
    let [mut first, second] = [0, 1].map(|joint| {
        let along = |t: f64| {
            let motion = motion(0.8 * seed as f64, t);
            // the torque goes where the velocity would
            [motion[joint][0], torques(motion, hidden)[joint], 0.0]
        };
        log(&along, &|at| at[1], seed + 10 * joint as u64, [0.05, 0.02][joint])
    });
    first.joints.extend(second.joints);
    first
}

/// Requires that the names of what is hidden are found, each with a value of its parameter.
fn assert_found(hidden: Hidden, expected: &[(&str, &str, f64)]) {
    let (found, candidates) = diagnosed(MODEL, [1, 2].map(|seed| both(hidden, seed)));
    let names = found.effects.iter().map(|one| candidates[one.candidate].name());
    assert_eq!(found.effects.len(), expected.len(), "{:?}", names.collect::<Vec<_>>());
    for (name, parameter, value) in expected {
        let is_own = |one: &&FoundEffect| candidates[one.candidate].name() == *name;
        let one = found.effects.iter().find(is_own).unwrap_or_else(|| panic!("no {name}"));
        let own = one.parameters.iter().find(|own| own.name == *parameter).expect("its own");
        let is_near = (own.value - value).abs() < 3.0 * own.std;
        assert!(is_near && own.std < 0.15 * value.abs(), "{name}: {own:?} for {value}");
    }
}

#[test]
fn a_zero_that_is_far_off_turns_what_its_bodies_do() {
    let hidden = Hidden { zeros: [0.0, 0.3], ..Hidden::default() };
    assert_found(hidden, &[("joint_zero at fore", "dq", 0.3)]);
}

#[test]
fn a_gain_scales_what_another_effect_adds() {
    let hidden = Hidden { gain: 0.25, drag: 0.2, ..Hidden::default() };
    assert_found(
        hidden,
        &[("torque_gain at fore", "g", 0.25), ("quadratic_drag at fore", "c", 0.2)],
    );
}

#[test]
fn a_payload_hangs_otherwise_where_a_zero_is_off() {
    let hidden = Hidden { zeros: [0.15, 0.0], payload: 0.4, ..Hidden::default() };
    let expected = [("joint_zero at upper", "dq", 0.15), ("payload_point at fore", "mass", 0.4)];
    assert_found(hidden, &expected);
}

#[test]
fn a_zero_is_no_body_however_far_it_is_off() {
    for zero in [0.2, -0.5] {
        let hidden = Hidden { zeros: [0.0, zero], ..Hidden::default() };
        assert_found(hidden, &[("joint_zero at fore", "dq", zero)]);
    }
}
