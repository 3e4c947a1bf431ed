//! A drive behind a spring, by hand: pendulum, spring, rotor and friction in closed form; where the
//! spring damps, its deflection is integrated.

use denavit_codegen::effect;
use denavit_codegen::regressor::functions::modelled;
use denavit_diagnose::{
    BeforeSprings, Candidate, Diagnosis, Error, Moved, Request, Verdict, before_springs,
    candidates, diagnose, spring_candidates,
};
use denavit_measure::Split;
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_numerics::Random;
use denavit_plants::regression::RegressionModel;
use std::f64::consts::TAU;

const STEP_S: f64 = 0.002;
const SAMPLES: usize = 7500;
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

/// What is hidden: a torque that brakes the motor, a spring across the joint [N m/rad], a damper
/// beside the series spring [N m s/rad].
#[derive(Clone, Copy)]
struct Hidden {
    drag: f64,
    /// What brakes the link in the same way.
    link_drag: f64,
    across: f64,
    damping: f64,
    /// What the motor reads where spring and joint are at 0, on the joint's side \[rad\].
    zero: f64,
}

const NOTHING: Hidden = Hidden { drag: 0.0, link_drag: 0.0, across: 0.0, damping: 0.0, zero: 0.0 };

/// Torque of the load and its first two derivatives by time.
fn load([q, v, a, jerk, snap]: Angle, Hidden { across, link_drag, .. }: Hidden) -> [f64; 3] {
    // WEIGHT cos q, since the rod points along x at 0.
    let (sine, cosine) = q.sin_cos();
    let [speed, growth] = [v.abs(), a * v.signum()];
    [
        INERTIA * a + WEIGHT * cosine + across * q + link_drag * v * speed,
        INERTIA * jerk - WEIGHT * sine * v + across * v + 2.0 * link_drag * speed * a,
        INERTIA * snap - WEIGHT * (cosine * v * v + sine * a)
            + across * a
            + 2.0 * link_drag * (growth * a + speed * jerk),
    ]
}

/// How far the motor is ahead, with two derivatives by time, at every sample: the spring and the
/// damper pass on what the load takes.
fn deflections(damping: f64, load: impl Fn(f64) -> [f64; 3]) -> Vec<[f64; 3]> {
    const WITHIN: usize = 20;
    let h = STEP_S / WITHIN as f64;
    let mut deflection = load(0.0)[0] / STIFFNESS;
    let of = |k: usize| {
        let t = STEP_S * k as f64;
        let [torque, first, second] = load(t);
        if damping == 0.0 {
            return [torque, first, second].map(|torque| torque / STIFFNESS);
        }
        let rate = |t: f64, s: f64| (load(t)[0] - STIFFNESS * s) / damping;
        let own = rate(t, deflection);
        let found = [deflection, own, (first - STIFFNESS * own) / damping];
        for step in 0..WITHIN {
            // Heun's method of third order.
            let (t, s) = (t + h * step as f64, deflection);
            let a = rate(t, s);
            let b = rate(t + h / 3.0, s + h / 3.0 * a);
            let c = rate(t + 2.0 / 3.0 * h, s + 2.0 / 3.0 * h * b);
            deflection += 0.25 * h * (a + 3.0 * c);
        }
        found
    };
    (0..SAMPLES).map(of).collect()
}

/// A log of the motor before the spring.
fn log(seed: u64, hidden: Hidden) -> MeasuredLog {
    let Hidden { drag, damping, zero, .. } = hidden;
    let mut random = Random::new(seed);
    let waves: Vec<[f64; 3]> = (1..=4)
        .map(|k| [0.5 / f64::from(k), TAU * f64::from(k) / 4.0, TAU * random.uniform()])
        .collect();
    let mut own = JointSignals::default();
    let (mut motor, mut torque) = (Vec::new(), Vec::new());
    let load_at = |t: f64| load(angle(t, &waves), hidden);
    for (k, [ahead, first, second]) in deflections(damping, load_at).into_iter().enumerate() {
        let at = angle(STEP_S * k as f64, &waves);
        let [spring, ..] = load(at, hidden);
        // Joint side: what the spring passes on bends it.
        let [turned, rate, acceleration] = [at[0] + ahead, at[1] + first, at[2] + second];
        let drive = GEAR * GEAR * (ROTOR * acceleration + VISCOUS * rate)
            + GEAR * COULOMB * rate.signum()
            + drag * rate * rate.abs();
        own.q.push((at[0] * 20_000.0).round() / 20_000.0);
        motor.push((GEAR * (turned + zero) * 2_000.0).round() / 2_000.0);
        torque.push((spring + drive + 0.02 * random.normal()) / GEAR);
    }
    (own.step, own.motor_step) = (Some(1.0 / 20_000.0), Some(1.0 / 2_000.0));
    (own.motor, own.motor_torque) = (Some(motor), Some(torque));
    MeasuredLog {
        file: "made".to_owned(),
        step_s: STEP_S,
        joints: vec![own],
        ..MeasuredLog::default()
    }
}

/// Verdict, and names of what was found with the first value of each and its error.
type Said = (Verdict, Vec<(String, [f64; 2])>);

fn found(hidden: Hidden) -> Result<Said, Error> {
    let (diagnosis, candidates) = diagnosed(hidden)?;
    let named = diagnosis.effects.iter().map(|one| {
        let first = &one.parameters[0];
        (candidates[one.candidate].name(), [first.value, first.std])
    });
    Ok((diagnosis.verdict, named.collect()))
}

fn diagnosed(hidden: Hidden) -> Result<(Diagnosis, Vec<Candidate>), Error> {
    let robot =
        denavit_codegen::model::read("elastic_pendulum", MODEL.as_bytes()).expect("a model");
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("parameters");
    let (mut train, mut held_out) = (vec![log(5, hidden)], vec![log(6, hidden)]);
    let before = before_springs(&robot, &model.joints, &mut [&mut train, &mut held_out]);
    let BeforeSprings { robot, springs } = before.expect("the logs have the motor");
    assert!((springs[0].stiffness - STIFFNESS).abs() < 1e-9 * STIFFNESS);
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("parameters");
    let mut candidates = candidates(effect::catalogue(), &robot, &model);
    candidates.append(&mut spring_candidates(effect::catalogue(), &springs, &model));
    let logs = Split { train: train.clone(), held_out: held_out.clone() };
    let moved = Moved { source: MODEL, effects: effect::catalogue(), numbers: &[], logs };
    let request = Request {
        model: &model,
        springs: &springs,
        train,
        held_out,
        candidates: &candidates,
        given: Vec::new(),
        aliases: None,
        experiment: None,
        moved: Some(&moved),
        most_effects: 6,
        filters: None,
    };
    let diagnosis = diagnose(request, &mut |_| true)?;
    Ok((diagnosis, candidates))
}

/// How far the model with what was found moves apart from the logs, and from those held out.
fn apart(found: &Diagnosis) -> [[f64; 2]; 2] {
    let gaps = found.motion.as_ref().expect("asked for").as_ref().expect("can be simulated");
    [&gaps.train, &gaps.held_out].map(|[before, after]| {
        assert!(after.is_estimated);
        [before.all, after.all]
    })
}

/// The motion of the logs is in closed form, and so is what moves there: a model that has all of it
/// goes along as one does where nothing is hidden, from where the motor is less its zero, and one
/// that lacks it does not.
#[test]
fn a_model_with_what_was_found_moves_as_the_motor_behind_a_spring_does() {
    let (whole, _) = diagnosed(NOTHING).expect("logs that say something");
    let noise = apart(&whole).map(|[_, after]| after);
    for hidden in [
        Hidden { drag: 0.15, zero: 0.05, ..NOTHING },
        Hidden { across: 0.5, zero: -0.3, ..NOTHING },
        Hidden { damping: 0.1, ..NOTHING },
    ] {
        let (found, _) = diagnosed(hidden).expect("logs that say something");
        assert_eq!(found.effects.len(), 1, "{:?}", found.reasons);
        for ([before, after], noise) in apart(&found).into_iter().zip(noise) {
            assert!(before > 3.0 * noise, "{before} {noise}");
            assert!(after < 2.0 * noise && after < 0.01, "{after} {noise}");
        }
    }
}

/// One effect is found, of that name, and its first value is within three of its errors, which are
/// less than a twentieth of it.
fn is_found(hidden: Hidden, name: &str, truth: f64) {
    let (verdict, effects) = found(hidden).expect("logs that say something");
    let [(own, [value, std])] = &effects[..] else { panic!("{verdict:?}: {effects:?}") };
    assert_eq!((verdict, own.as_str()), (Verdict::Explained, name));
    assert!((value - truth).abs() < 3.0 * std && *std < 0.05 * truth, "{value} {std}");
}

#[test]
fn a_motor_behind_a_spring_lacks_nothing() {
    assert_eq!(found(NOTHING), Ok((Verdict::NothingMissing, Vec::new())));
}

#[test]
fn what_brakes_a_motor_behind_a_spring_is_named() {
    is_found(Hidden { drag: 0.15, ..NOTHING }, "quadratic_drag at rod", 0.15);
}

/// The same law on the other side is in both balances.
#[test]
fn what_brakes_a_link_behind_a_spring_is_named_there() {
    let hidden = Hidden { link_drag: 0.15, ..NOTHING };
    is_found(hidden, "quadratic_drag at rod behind its spring", 0.15);
    // A model with it, whose file says the side, moves as the link does.
    let (found, _) = diagnosed(hidden).expect("logs that say something");
    for [before, after] in apart(&found) {
        assert!(after < 0.3 * before, "{before} {after}");
    }
}

/// The balance of the motor has nothing of it.
#[test]
fn a_damper_beside_a_spring_is_named() {
    is_found(Hidden { damping: 0.1, ..NOTHING }, "damper at rod", 0.1);
}

/// What the link feels is in both balances.
#[test]
fn a_spring_across_a_joint_behind_a_spring_is_named() {
    is_found(Hidden { across: 0.5, ..NOTHING }, "spring at rod", 0.5);
}
