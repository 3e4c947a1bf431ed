//! A drive behind a spring, by hand: pendulum, spring, rotor and friction in closed form.

use denavit::diagnose::{
    DiagnosisError, Request, SearchOptions, Uncertainty, Verdict, before_springs, diagnose,
};
use denavit::effect;
use denavit::identify::log::{JointSignals, MeasuredLog};
use denavit::plants::regression::RegressionModel;
use denavit::regressor::functions::modelled;
use denavit::simulate::Random;
use std::f64::consts::TAU;

const STEP_S: f64 = 0.002;
const GEAR: f64 = 50.0;
const ROTOR: f64 = 4e-5;
const VISCOUS: f64 = 2e-4;
const COULOMB: f64 = 0.008;
/// Of the spring around the joint [N m/rad]: 30000 N/m on pulleys of 3 cm.
const STIFFNESS: f64 = 27.0;
/// Mass 2 kg at 0.3 m with 0.05 kg m^2 about its centre.
const INERTIA: f64 = 0.05 + 2.0 * 0.09;
const WEIGHT: f64 = 2.0 * 0.3 * 9.81;

const MODEL: &str = r#"{
  "format": "denavit-model/1", "name": "elastic_pendulum", "convention": "standard",
  "gravity": [0, -9.81, 0],
  "links": [{
    "name": "rod",
    "joint": {"type": "revolute", "theta": 0, "d": 0, "a": 0.5, "alpha": 0},
    "body": {"mass": 2, "com": [-0.2, 0, 0], "about": "com",
             "inertia": {"xx": 0.001, "yy": 0.05, "zz": 0.05, "xy": 0, "xz": 0, "yz": 0}}
  }],
  "drives": {"rod": {
    "gear_ratio": 50,
    "rotor_inertia": {"value": "4e-5", "std": "4e-7"},
    "viscous": {"value": "2e-4", "std": "2e-6"},
    "coulomb": {"value": 0.008, "std": 0.0001},
    "series_elastic": {"stiffness": 30000, "motor_radius": 0.03, "load_radius": 0.03}
  }}
}"#;

/// Derivatives of the angle by time, from the 0th to the 4th.
type Angle = [f64; 5];

fn angle(t: f64, waves: &[[f64; 3]]) -> Angle {
    std::array::from_fn(|order| {
        let of = |[a, w, p]: &[f64; 3]| {
            a * w.powi(order as i32) * (w * t + p + 0.25 * TAU * order as f64).sin()
        };
        waves.iter().map(of).sum()
    })
}

/// Torque of the load and its first two derivatives by time.
fn load([q, v, a, jerk, snap]: Angle) -> [f64; 3] {
    // WEIGHT cos q, since the rod points along x at 0.
    let (sine, cosine) = q.sin_cos();
    [
        INERTIA * a + WEIGHT * cosine,
        INERTIA * jerk - WEIGHT * sine * v,
        INERTIA * snap - WEIGHT * (cosine * v * v + sine * a),
    ]
}

/// A log of the motor before the spring, with a torque that is hidden there.
fn log(seed: u64, hidden: impl Fn(f64) -> f64) -> MeasuredLog {
    let mut random = Random::new(seed);
    let waves: Vec<[f64; 3]> = (1..=4)
        .map(|k| [0.5 / f64::from(k), TAU * f64::from(k) / 4.0, TAU * random.uniform()])
        .collect();
    let mut own = JointSignals::default();
    let (mut motor, mut torque) = (Vec::new(), Vec::new());
    for k in 0..7500 {
        let at = angle(STEP_S * f64::from(k), &waves);
        let [spring, first, second] = load(at);
        // Joint side: what the spring passes on bends it.
        let turned = at[0] + spring / STIFFNESS;
        let rate = at[1] + first / STIFFNESS;
        let acceleration = at[2] + second / STIFFNESS;
        let drive = GEAR * GEAR * (ROTOR * acceleration + VISCOUS * rate)
            + GEAR * COULOMB * rate.signum()
            + hidden(rate);
        own.q.push((at[0] * 20_000.0).round() / 20_000.0);
        motor.push((GEAR * turned * 2_000.0).round() / 2_000.0);
        torque.push((spring + drive + 0.02 * random.normal()) / GEAR);
    }
    own.step = Some(1.0 / 20_000.0);
    (own.motor, own.motor_torque) = (Some(motor), Some(torque));
    MeasuredLog {
        file: "made".to_owned(),
        step_s: STEP_S,
        joints: vec![own],
        ..MeasuredLog::default()
    }
}

fn found(hidden: impl Fn(f64) -> f64 + Copy) -> Result<(Verdict, Vec<String>), DiagnosisError> {
    let robot = denavit::model::read("elastic_pendulum", MODEL.as_bytes()).expect("a model");
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("parameters");
    let (mut train, mut held_out) = (vec![log(5, hidden)], vec![log(6, hidden)]);
    let robot = before_springs(&robot, &model.joints, &mut [&mut train, &mut held_out]);
    let robot = robot.expect("the logs have the motor");
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("parameters");
    let candidates = denavit::diagnose::candidates(effect::catalogue(), &robot, &model);
    let request = Request {
        model: &model,
        train,
        held_out,
        candidates: &candidates,
        given: Vec::new(),
        aliases: None,
        experiment: None,
        moved: None,
        uncertainty: Uncertainty::default(),
        options: SearchOptions::default(),
        filters: None,
    };
    let diagnosis = diagnose(request, &mut |_, _| ())?;
    let names = diagnosis.effects.iter().map(|one| candidates[one.candidate].name());
    Ok((diagnosis.verdict, names.collect()))
}

#[test]
fn a_motor_behind_a_spring_lacks_nothing() {
    assert_eq!(found(|_| 0.0), Ok((Verdict::NothingMissing, Vec::new())));
}

#[test]
fn what_brakes_a_motor_behind_a_spring_is_named() {
    let drag = |rate: f64| 0.15 * rate * rate.abs();
    assert_eq!(found(drag), Ok((Verdict::Explained, vec!["quadratic_drag at rod".to_owned()])));
}
