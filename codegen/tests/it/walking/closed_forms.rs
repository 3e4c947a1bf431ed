//! Points of the ground by hand: a foot that tilts under a pendulum, capture points.

use crate::laws::Derived;
use crate::robots::{fixture, load};
use denavit_codegen::expr::{Floats, evaluate};
use denavit_codegen::function::FunctionName::{self, *};
use denavit_codegen::model::{Robot, bake};
use std::f64::consts::{FRAC_PI_2, PI};

/// Values of a function's entries at the numbers of `point`; all other symbols are 0.
fn values(robot: &Robot, name: FunctionName, point: &[(&str, f64)]) -> Vec<f64> {
    let robot = bake(robot).unwrap();
    let derived = Derived::new(&robot, &[name]);
    let entries = derived.derivation.functions[0].entries();
    let value = |symbol: &str| {
        let given = point.iter().find(|(name, _)| *name == symbol);
        Some(given.map_or(0.0, |(_, value)| *value))
    };
    evaluate(&derived.derivation.dag, &entries, &mut Floats::new(value)).unwrap()
}

#[track_caller]
fn close(found: &[f64], expected: [f64; 3]) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}

/// The numbers of tests/fixtures/foot_and_pendulum.json: a foot of 2 kg with its centre of mass
/// 0.1 m ahead of the ankle and 0.03 m below, 0.05 kg m^2 about it; a point mass of 3 kg 0.7 m from
/// the ankle.
const FOOT: (f64, [f64; 2], f64) = (2.0, [0.1, -0.03], 0.05);
const PENDULUM: (f64, f64) = (3.0, 0.7);
const GRAVITY: f64 = 10.0;

/// Position and acceleration of a point that turns about a moving one in the x-z plane, from x
/// towards z.
fn turning(arm: [f64; 2], angle: f64, speed: f64, acceleration: f64) -> [[f64; 2]; 2] {
    let (sin, cos) = angle.sin_cos();
    let place = [cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1]];
    let speeding = [0, 1].map(|k| {
        let across = [-place[1], place[0]][k];
        acceleration * across - speed * speed * place[k]
    });
    [place, speeding]
}

#[test]
fn a_foot_that_tilts_under_a_pendulum() {
    let robot = fixture("foot_and_pendulum.json");
    let (ankle, ankle_acceleration) = ([0.2, 0.3], [0.9, -1.7]);
    // Angles from x up to z: of the foot, which tilts, and of the leg.
    let (tilt, tilting, tilt_acceleration) = (0.25, -0.6, 3.0);
    let (lean, leaning, lean_acceleration) = (1.4, 0.8, -2.0);
    let point = [
        ("q_base_x", ankle[0]),
        ("q_base_z", ankle[1]),
        ("qdd_base_x", ankle_acceleration[0]),
        ("qdd_base_z", ankle_acceleration[1]),
        // Joints turn from z towards x, and the leg stands up where they are 0.
        ("q_base_pitch", -tilt),
        ("qd_base_pitch", -tilting),
        ("qdd_base_pitch", -tilt_acceleration),
        ("q_leg", FRAC_PI_2 - lean + tilt),
        ("qd_leg", tilting - leaning),
        ("qdd_leg", tilt_acceleration - lean_acceleration),
    ];
    let (foot_mass, arm, inertia) = FOOT;
    let (mass, length) = PENDULUM;
    let sum = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
    let [foot, foot_speeding] = turning(arm, tilt, tilting, tilt_acceleration);
    let (foot, foot_speeding) = (sum(ankle, foot), sum(ankle_acceleration, foot_speeding));
    let [bob, bob_speeding] = turning([length, 0.0], lean, leaning, lean_acceleration);
    let (bob, bob_speeding) = (sum(ankle, bob), sum(ankle_acceleration, bob_speeding));
    // Moments about y = 0 in the plane, from x to z: x Fz - z Fx, and Fz = 0 leaves x.
    let moment =
        |m: f64, place: [f64; 2], a: [f64; 2]| m * (place[0] * (a[1] + GRAVITY) - place[1] * a[0]);
    let pendulum = moment(mass, bob, bob_speeding);
    let pressing = mass * (bob_speeding[1] + GRAVITY);
    let still = (pendulum + foot_mass * GRAVITY * foot[0]) / (pressing + foot_mass * GRAVITY);
    let spinning = moment(foot_mass, foot, foot_speeding) + inertia * tilt_acceleration;
    let exact = (pendulum + spinning) / (pressing + foot_mass * (foot_speeding[1] + GRAVITY));
    assert!((still - exact).abs() > 0.01, "the case tells them apart: {still} {exact}");
    close(&values(&robot, FootRotationIndicator, &point), [still, 0.0, 0.0]);
    close(&values(&robot, ZeroMomentPoint, &point), [exact, 0.0, 0.0]);
}

#[test]
fn the_capture_point_is_ahead_by_the_velocity_over_the_pendulums_frequency() {
    // A block of 1 kg on a slope of 10 degrees, its centre of mass 0.6 m above, at 0.5 m/s along
    // it.
    let angle = PI / 18.0;
    let (normal, along) = ([angle.sin(), angle.cos()], [angle.cos(), -angle.sin()]);
    let (height, speed, gravity) = (0.6, 0.5, 9.81);
    let point = [
        ("q_base_x", height * normal[0]),
        ("q_base_z", height * normal[1]),
        ("qd_base_x", speed * along[0] + 0.2 * normal[0]),
        ("qd_base_z", speed * along[1] + 0.2 * normal[1]),
    ];
    // Pressing is gravity across the plane; where the mass could rest is straight below it.
    let time = (height / (gravity * angle.cos())).sqrt();
    let ahead = speed * time + height * angle.tan();
    let expected = [ahead * along[0], 0.0, ahead * along[1]];
    close(&values(&load("bodies/slope"), CapturePoint, &point), expected);
}

/// Standing on its capture point, the linear inverted pendulum comes to rest above it: its
/// acceleration there is that of the cart-table model.
#[test]
fn the_cart_table_balances_on_the_capture_point() {
    let (height, speed, start) = (0.8, 0.4, 0.1);
    let robot = load("bodies/slope");
    let mut level = robot.clone();
    let (zero, one) = (level.dag.zero(), level.dag.one());
    level.ground.normal = [zero, zero, one];
    let frequency = (9.81_f64 / height).sqrt();
    let state = [("q_base_x", start), ("q_base_z", height), ("qd_base_x", speed)];
    let point = values(&level, CapturePoint, &state);
    close(&point, [start + speed / frequency, 0.0, 0.0]);
    let braking = ("qdd_base_x", frequency * frequency * (start - point[0]));
    let motion = [state[0], state[1], state[2], braking];
    close(&values(&level, CartTableZmp, &motion), [point[0], 0.0, 0.0]);
}
