//! What logs could not have shown: a pendulum that hardly moves, and a joint on it that rests.

use super::{Directory, run_in};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;

const MASS: f64 = 2.0;
const TO_CENTRE_M: f64 = 0.3;
const G: f64 = 9.81;
const MOMENT: f64 = 0.05;
const SPEED_LIMIT: f64 = 6.0;

/// A pendulum in a vertical plane, with its numbers stated to 1 %; with a joint at its end that
/// carries nothing, if `has_tip`.
fn model(has_tip: bool) -> Value {
    let sure = |value: f64| json!({"value": value, "std": 0.01 * value.abs()});
    let mut model = json!({
        "format": "denavit-model/1",
        "name": "pendulum",
        "convention": "standard",
        "gravity": [0, -G, 0],
        "links": [{
            "name": "rod",
            "joint": {"type": "revolute", "a": 0.5},
            "limits": {"position": [-3, 3], "velocity": SPEED_LIMIT},
            "body": {
                "mass": sure(MASS),
                "com": [sure(TO_CENTRE_M - 0.5), 0, 0],
                "inertia": {"zz": sure(MOMENT)},
                "about": "com"
            }
        }]
    });
    if has_tip {
        let tip = json!({"name": "tip", "joint": {"type": "revolute"}});
        model["links"].as_array_mut().unwrap().push(tip);
    }
    model
}

/// 16 s at 500 Hz around 0.4 rad with so many times the usual reach; `more` is torque by rate.
fn log(reach: f64, seed: u64, more: impl Fn(f64) -> f64) -> String {
    let mut random = denavit::numerics::Random::new(seed);
    let mut text = String::from("t,q_rod,tau_rod,q_tip,tau_tip\n");
    for k in 0..8000 {
        let t = f64::from(k) * 0.002;
        let parts = [[0.5, 0.5, 0.3], [0.2, 1.1, 1.0], [0.1, 2.3, 2.0]];
        let sum = |of: &dyn Fn(f64, f64, f64) -> f64| {
            parts.iter().map(|[a, f, p]| of(reach * a, TAU * f, TAU * f * t + p)).sum::<f64>()
        };
        let q = 0.4 + sum(&|a, _, p| a * p.sin());
        let qd = sum(&|a, w, p| a * w * p.cos());
        let qdd = sum(&|a, w, p| -a * w * w * p.sin());
        let inertia = MOMENT + MASS * TO_CENTRE_M * TO_CENTRE_M;
        let tau = inertia * qdd + MASS * G * TO_CENTRE_M * q.cos() + more(qd);
        let steps = 2.0e5;
        let read = (q * steps).round() / steps;
        let [noise, of_tip] = [0.02 * random.normal(), 0.02 * random.normal()];
        writeln!(text, "{t:.3},{read:.8},{:.8},0,{of_tip:.8}", tau + noise).unwrap();
    }
    text
}

fn said(directory: &Directory, has_tip: bool, logs: [String; 2]) -> Value {
    let columns = if has_tip { 5 } else { 3 };
    let cut = |log: &String| -> String {
        let line = |line: &str| line.split(',').take(columns).collect::<Vec<&str>>().join(",");
        log.lines().map(line).collect::<Vec<String>>().join("\n")
    };
    let [train, held_out] = logs.each_ref().map(cut);
    let model = model(has_tip).to_string();
    for (name, text) in [("model.json", model), ("a.csv", train), ("b.csv", held_out)] {
        fs::write(directory.path.join(name), text).unwrap();
    }
    let words = ["diagnose", "model.json", "--train", "a.csv", "--validate", "b.csv", "--json"];
    let run = run_in(&directory.path, &[&words[..], &["--accept-suspicious"]].concat());
    serde_json::from_str(&run.stdout).expect(&run.stderr)
}

#[test]
fn joints_that_rest_or_hardly_move_let_nothing_be_told() {
    let directory = Directory::new("diagnose_rest");
    let plain = |reach: f64, has_tip: bool| {
        said(&directory, has_tip, [1, 2].map(|seed| log(reach, seed, |_| 0.0)))
    };
    let refused = |answer: &Value, why: &str| {
        assert_eq!(answer["verdict"], "cannot_tell", "{answer:#}");
        let reasons = answer["reasons"].to_string();
        assert!(reasons.contains("too little excitation") && reasons.contains(why), "{reasons}");
    };
    refused(&plain(1.0, true), "tip does not move");
    refused(&plain(0.02, false), "rod covers");
    let moved = plain(1.0, false);
    assert_eq!(moved["verdict"], "nothing_missing", "{moved:#}");
}

/// The least viscous friction that is said to be seen: three times as much is found, and a third of
/// it is not.
#[test]
fn what_is_said_to_be_visible_is_found_and_less_is_not() {
    let directory = Directory::new("diagnose_visible");
    let without = said(&directory, false, [1, 2].map(|seed| log(1.0, seed, |_| 0.0)));
    let visible = without["visible"].as_array().unwrap();
    let own = visible.iter().find(|one| one["effect"] == "viscous").expect("viscous friction");
    let least = own["least"].as_f64().unwrap();
    let named = |size: f64| {
        let answer =
            said(&directory, false, [1, 2].map(|seed| log(1.0, seed, |qd| size * least * qd)));
        let all = answer["effects"].as_array().unwrap().iter();
        all.map(|one| one["effect"].as_str().unwrap().to_owned()).collect::<Vec<String>>()
    };
    assert_eq!(named(3.0), ["viscous"]);
    assert_eq!(named(0.3), Vec::<String>::new());
}
