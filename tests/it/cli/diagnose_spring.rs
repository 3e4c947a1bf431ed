//! A plain law is not hidden by a richer one that has it as a special case.

use super::{Directory, run_in};
use serde_json::{Value, json};
use std::fs;

fn body(mass: f64, com: [f64; 3], [x, y]: [f64; 2]) -> Value {
    json!({"mass": mass, "com": com, "inertia": {"xx": x, "yy": y, "zz": y}, "about": "com"})
}

/// An arm of two joints, and effects in it.
fn arm(effects: Value) -> Value {
    json!({
        "format": "denavit-model/1",
        "name": "rig",
        "convention": "modified",
        "gravity": [0, 0, "-g"],
        "constants": {"g": {"value": 9.81, "unit": "m/s^2"}},
        "links": [
            {"name": "pan", "joint": {"type": "revolute", "d": 0.3},
             "limits": {"position": [-2, 2], "velocity": 4, "torque": [-50, 50]},
             "body": body(3.0, [0.1, 0.02, 0.0], [0.01, 0.03])},
            {"name": "tilt", "joint": {"type": "revolute", "a": 0.25, "alpha": "pi/2"},
             "limits": {"position": [-1.5, 1.5], "velocity": 5, "torque": [-20, 20]},
             "body": body(1.1, [0.12, 0.0, 0.01], [0.002, 0.01])},
        ],
        "drives": {
            "pan": {"viscous": 0.2, "coulomb": 0.3},
            "tilt": {"viscous": 0.1, "coulomb": 0.2},
        },
        "effects": effects,
    })
}

fn scenario(seed: u64, motion: &str) -> Value {
    json!({
        "format": "denavit-scenario/1",
        "name": motion,
        "model": "robot.json",
        "duration_s": 20,
        "initial": {"on_reference": true},
        "drives": "model",
        "stiction_rate": 0.0005,
        "control": {
            "period_s": 0.002,
            "trajectory": format!("{motion}_motion.json"),
            "joints": {"pan": {"kp": 800, "kd": 60}, "tilt": {"kp": 300, "kd": 20}},
        },
        "measurement": {"resolution": 0.0001, "logged": true, "torque_noise": 0.02},
        "seed": seed,
        "integrator": {"relative": 1e-6, "absolute": 1e-7},
        "tolerances": {"energy_j": 0.001},
        "log_period_s": 0.002,
    })
}

/// Of a slow motion, which a hysteresis without friction explains as well: it has the spring in it.
/// From the places where its search begins a spring gains a twelfth less than at its best, which
/// once kept it from being weighed.
#[test]
fn a_spring_is_not_named_a_hysteresis_without_friction() {
    let directory = Directory::new("diagnose_spring");
    let write = |name: &str, value: &Value| {
        fs::write(directory.path.join(name), value.to_string()).unwrap();
    };
    let spring =
        json!([{"effect": "spring", "at": {"link": "tilt"}, "parameters": {"k": 2, "q_0": 0.1}}]);
    write("rig.json", &arm(json!([])));
    write("robot.json", &arm(spring));
    for (seed, motion) in [(1, "train"), (2, "validate")] {
        let (number, trajectory) = (seed.to_string(), format!("{motion}_motion.json"));
        write(&format!("{motion}.json"), &scenario(seed, motion));
        let search = ["--starts", "2", "--evaluations", "100", "--seed", &number];
        let words = [&["excite", "rig.json", "-o", &trajectory][..], &search].concat();
        assert_eq!(run_in(&directory.path, &words).code, Some(0));
        let (file, log) = (format!("{motion}.json"), format!("{motion}.csv"));
        let run = run_in(&directory.path, &["simulate", &file, "-o", &log]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
    }
    let words = ["diagnose", "rig.json", "--train", "train.csv", "--validate", "validate.csv"];
    let run = run_in(&directory.path, &[&words[..], &["--json"]].concat());
    let json: Value = serde_json::from_str(&run.stdout).expect(&run.stderr);
    let effects = json["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1, "{effects:?}");
    assert_eq!((&effects[0]["effect"], &effects[0]["at"]), (&json!("spring"), &json!("tilt")));
    for (name, true_value) in [("k", 2.0), ("q_0", 0.1)] {
        let found = &effects[0]["parameters"][name];
        let [value, std] = ["value", "std"].map(|key| found[key].as_f64().unwrap());
        assert!((value - true_value).abs() < 3.0 * std, "{name}: {value} +- {std}");
    }
}
