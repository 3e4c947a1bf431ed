//! Torque sensors that do not run true, and gear teeth, on a joint that turns by less than one of
//! their waves.

use super::motion::waves;
use super::one_joint::{diagnosed, log};
use denavit_measure::log::MeasuredLog;

const PENDULUM: &str = r#"{
  "format": "denavit-model/1", "name": "pendulum", "convention": "standard",
  "gravity": [0, -9.81, 0],
  "links": [
    {"name": "rod", "joint": {"type": "revolute", "theta": 0, "d": 0, "a": 0.5, "alpha": 0},
     "body": {"mass": {"value": 2, "std": 0.1}, "com": [{"value": -0.2, "std": 0.01}, 0, 0],
              "about": "com", "inertia": {"xx": 0.001, "yy": 0.04,
              "zz": {"value": 0.04, "std": 0.002}, "xy": 0, "xz": 0, "yz": 0}}}],
  "drives": {"rod": {"viscous": {"value": 0.15, "std": 0.01},
                     "coulomb": {"value": 0.4, "std": 0.02}}}
}"#;

/// Mass times distance of the centre of mass [kg m], and inertia about the joint [kg m^2]: 3 %
/// more than the model has.
const MOMENT: f64 = 0.618;
const INERTIA: f64 = 0.2266;

/// What a sensor shows whose factor repeats, by a fifth, with `n` waves a turn and a phase: of all
/// of the torque, or of what the drive carries beside its own friction.
fn rippled(n: f64, phase: f64, of_load: bool) -> [MeasuredLog; 2] {
    let torque = |[q, qd, qdd]: [f64; 3]| {
        let load = INERTIA * qdd + 9.81 * MOMENT * q.cos();
        let friction = 0.154 * qd + 0.41 * qd.signum();
        let factor = 1.0 + 0.2 * f64::sin(n * q + phase);
        if of_load { load * factor + friction } else { (load + friction) * factor }
    };
    [1_u32, 2].map(|seed| {
        let along = |t: f64| {
            let terms = [(0.45, 1.0), (0.2, 3.0), (0.1, 4.0)];
            let [q, qd, qdd] = waves(&terms, 1.3 * f64::from(seed), t);
            [q - 1.0, qd, qdd]
        };
        log(&along, &torque, u64::from(seed), 0.02)
    })
}

/// 1.2 rad are less than a wave of 6.3, 3.7 and 3.1 rad.
#[test]
fn factors_that_repeat_have_their_names_on_less_than_a_wave() {
    let of_all = ("torque_ripple at rod", false);
    let of_load = ("transmission_error at rod", true);
    for (n, phase, (name, is_of_load)) in
        [(1.0, 0.6, of_all), (2.0, 2.1, of_all), (1.7, 0.6, of_load), (2.0, 2.1, of_load)]
    {
        let (found, candidates) = diagnosed(PENDULUM, rippled(n, phase, is_of_load));
        let names = found.effects.iter().map(|one| candidates[one.candidate].name());
        assert_eq!(names.collect::<Vec<_>>(), [name], "{n}");
        let value = |name: &str| {
            let mut own = found.effects[0].parameters.iter();
            own.find(|one| one.name == name).expect("a parameter of a ripple")
        };
        let [a, b, waves] = ["a", "b", "n"].map(value);
        let std = a.std.max(b.std);
        assert!((a.value.hypot(b.value) - 0.2).abs() < 3.0 * std && std < 0.04, "{a:?} {b:?}");
        assert!((waves.value - n).abs() < 3.0 * waves.std && waves.std < 0.3, "{waves:?}");
    }
}
