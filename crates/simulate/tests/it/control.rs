//! Control by scenario: limits of torque, torques and references from logs.

use super::assert_near;
use denavit_plants::shipped;
use denavit_simulate::scenario::{self, RunScheme, Scenario};
use denavit_simulate::{Log, Run, Stop};

/// 2 kg on a rail, whose motor gives 3 N at most.
const CART: &str = r#"{"format": "denavit-model/1", "name": "cart", "convention": "standard",
 "gravity": [0, 0, 0], "links": [{"name": "cart", "joint": {"type": "prismatic"},
 "limits": {"torque": [-3, 3]},
 "body": {"mass": 2, "com": [0, 0, 0], "inertia": {"xx": 1, "yy": 1, "zz": 1}, "about": "com"}}]}"#;

const SCHEMES: [RunScheme; 2] = [RunScheme::Event, RunScheme::TimeStepping];

fn open(text: &str, log: &str, scheme: RunScheme) -> Scenario {
    let load = |name: &str| match name {
        "cart.json" => Ok(CART.as_bytes().to_vec()),
        "run.csv" => Ok(log.as_bytes().to_vec()),
        name => shipped::find(name).map(|m| m.text.as_bytes().to_vec()).ok_or("none".to_owned()),
    };
    let read = scenario::read("test.json", text.as_bytes(), &load);
    let mut scenario = read.unwrap_or_else(|error| panic!("{error}"));
    scenario.scheme = scheme;
    scenario
}

fn run(text: &str, log: &str, scheme: RunScheme) -> Run {
    let run = open(text, log, scheme).run().unwrap();
    assert_eq!(run.stop, Stop::End);
    run
}

fn cart(control: &str, more: &str) -> String {
    format!(
        r#"{{"format": "denavit-scenario/1", "name": "cart", "model": "cart.json",
 "duration_s": 2, "control": {{{control}}}{more}}}"#
    )
}

/// As long as the motor gives all it can, x = F t^2 / (2 m).
#[test]
fn a_saturated_drive_accelerates_by_its_limit() {
    let far = r#""saturates": true, "joints": {"cart": {"kp": 1e4, "kd": 10, "reference": 100}}"#;
    for scheme in SCHEMES {
        let run = run(&cart(far, ""), "", scheme);
        for row in run.log.rows().skip(1) {
            assert_near(row[1], 0.75 * row[0] * row[0], 1e-9);
            assert_near(row[2], 1.5 * row[0], 1e-9);
        }
        let torque = run.log.column("tau_cmd_cart").unwrap();
        assert!(torque.iter().all(|torque| *torque == 3.0), "{scheme:?}");
    }
}

/// Where the limit is left and met again, time stepping with damping taken implicitly keeps it too.
#[test]
fn a_limit_is_never_exceeded() {
    let near = r#""saturates": true, "joints": {"cart": {"kp": 200, "kd": 40,
 "reference": {"cubic": {"times": [0, 0.5, 1, 1.5, 2], "values": [0, 0.06, -0.04, 0.08, 0]}}}}"#;
    for scheme in SCHEMES {
        let text = cart(near, r#", "log_period_s": 0.001"#);
        let run = run(&text, "", scheme);
        let torque = run.log.column("tau_cmd_cart").unwrap();
        assert!(torque.iter().all(|torque| torque.abs() <= 3.0), "{scheme:?}");
        let at_limit = torque.iter().filter(|torque| torque.abs() == 3.0).count();
        assert!(at_limit > 50 && at_limit + 50 < torque.len(), "{scheme:?}: {at_limit}");
    }
}

/// The torques that a sampled controller gave move the robot as it did.
#[test]
fn torques_from_a_log_repeat_the_run() {
    let arm = |control: &str| {
        format!(
            r#"{{"format": "denavit-scenario/1", "name": "arm", "model": "planar_2r",
 "duration_s": 1, "initial": {{"q": {{"link1": -1}}}}, "control": {{{control}}},
 "integrator": {{"relative": 1e-11, "absolute": 1e-12}}}}"#
        )
    };
    let first = arm(r#""period_s": 0.01, "compensation": "gravity", "joints": {
 "link1": {"kp": 60, "kd": 6, "reference": {"cosine": {"times": [0, 1], "values": [-1, 0.5]}}},
 "link2": {"kp": 40, "kd": 4, "reference": 0.4}}"#);
    let torque = |joint: &str| {
        format!(
            r#""{joint}": {{"feed_forward": {{"log": {{"file": "run.csv",
 "column": "tau_cmd_{joint}", "between": "hold"}}}}}}"#
        )
    };
    let second = arm(&format!(r#""joints": {{{}, {}}}"#, torque("link1"), torque("link2")));
    for scheme in SCHEMES {
        let driven = run(&first, "", scheme);
        let again = run(&second, &driven.log.to_csv(), scheme);
        for joint in 0..2 {
            assert_near(again.end.q[joint], driven.end.q[joint], 1e-8);
        }
        assert!((driven.end.q[0] + 1.0).abs() > 0.5, "it moved");
    }
}

/// A log as reference: a spline through its samples, or lines between them.
#[test]
fn a_reference_may_come_from_a_log() {
    let times = (0..=20).map(|k| f64::from(k) / 10.0);
    let log = Log {
        header: Vec::new(),
        columns: ["t", "ref_cart"].map(str::to_owned).to_vec(),
        values: times.flat_map(|t| [t, 0.2 * (2.0 * t).sin()]).collect(),
    };
    let csv = log.to_csv();
    let setpoint = |between: &str, t_s: f64| {
        let control = format!(
            r#""joints": {{"cart": {{"kp": 1, "reference": {{"log": {{"file": "run.csv",
 "column": "ref_cart"{between}}}}}}}}}"#
        );
        open(&cart(&control, ""), &csv, RunScheme::Event).control.setpoint(0, t_s).unwrap()
    };
    let smooth = setpoint("", 1.05);
    assert_near(smooth.position, 0.2 * 2.1_f64.sin(), 1e-5);
    assert_near(smooth.rate, 0.4 * 2.1_f64.cos(), 1e-3);
    let lines = setpoint(r#", "between": "linear""#, 1.05);
    let ends = [2.0_f64, 2.2].map(|angle| 0.2 * angle.sin());
    assert_near(lines.position, 0.5 * (ends[0] + ends[1]), 1e-15);
    assert_near(lines.rate, (ends[1] - ends[0]) / 0.1, 1e-12);
    let held = setpoint(r#", "between": "hold""#, 1.05);
    assert_eq!((held.position, held.rate), (ends[0], 0.0));
    assert_eq!(setpoint(r#", "between": "linear""#, 9.0).rate, 0.0, "it rests after its end");
}
