//! A torque sensor that does not run true, on a joint that turns by less than one of its waves.

use super::motion::waves;
use super::one_joint::{diagnosed, log};

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

#[test]
fn a_ripple_has_its_name_on_less_than_a_wave() {
    // 1.2 rad of waves of 3.1 and 6.3 rad
    for (n, phase) in [(1.0, 0.6), (2.0, 2.1)] {
        let torque = |[q, qd, qdd]: [f64; 3]| {
            let own = INERTIA * qdd + 9.81 * MOMENT * q.cos() + 0.154 * qd + 0.41 * qd.signum();
            own * (1.0 + 0.2 * f64::sin(n * q + phase))
        };
        let logs = [1_u32, 2].map(|seed| {
            let along = |t: f64| {
                let terms = [(0.45, 1.0), (0.2, 3.0), (0.1, 4.0)];
                let [q, qd, qdd] = waves(&terms, 1.3 * f64::from(seed), t);
                [q - 1.0, qd, qdd]
            };
            log(&along, &torque, u64::from(seed), 0.02)
        });
        let (found, candidates) = diagnosed(PENDULUM, logs);
        let names = found.effects.iter().map(|one| candidates[one.candidate].name());
        assert_eq!(names.collect::<Vec<_>>(), ["torque_ripple at rod"], "{n}");
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
