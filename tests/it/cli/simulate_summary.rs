//! `denavit simulate`: what it says of joints that follow something, and of limits.

use super::{Directory, Run, json, run_in};
use denavit::shipped;
use serde_json::{Value, json};
use std::fs;

/// The planar arm in a plane without gravity, with limits of its first joint.
fn write_arm(directory: &Directory, limits: Value) {
    let text = shipped::find("planar_2r").expect("a model").text;
    let mut arm: Value = serde_json::from_str(text).expect("JSON");
    arm["gravity"] = json!([0, 0, 0]);
    arm["links"][0]["limits"] = limits;
    fs::write(directory.path.join("arm.json"), arm.to_string()).expect("a file");
}

/// Runs the arm, whose first joint is to go to 1 rad, by both schemes.
fn runs(limits: Value, saturates: bool) -> [Value; 2] {
    let directory = Directory::new("summary");
    write_arm(&directory, limits);
    let law = |reference: f64| json!({"kp": 40, "kd": 6, "reference": reference});
    let scenario = json!({"format": "denavit-scenario/1", "model": "arm.json", "duration_s": 2,
        "control": {"saturates": saturates, "joints": {"link1": law(1.0), "link2": law(0.0)}}});
    fs::write(directory.path.join("go.json"), scenario.to_string()).expect("a file");
    [&["--scheme", "event"][..], &["--scheme", "time-stepping", "--step", "0.0005"]].map(|scheme| {
        let words = [&["simulate", "go.json", "--json"], scheme].concat();
        let run = run_in(&directory.path, &words);
        assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
        serde_json::from_str(&run.stdout).expect("JSON")
    })
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn joints_that_follow_badly_are_reported() {
    for summary in runs(json!({"torque": [-0.5, 0.5]}), true) {
        let joint = &summary["joints"][0];
        assert_eq!((&joint["joint"], &joint["unit"]), (&json!("link1"), &json!("rad")));
        // at the start it is all the way off
        assert_eq!(
            (number(&joint["largest_error"]), &joint["largest_error_s"]),
            (1.0, &json!(0.0))
        );
        assert!(number(&joint["final_error"]) > 0.01, "{joint}");
        assert!(number(&joint["torque_limit_share"]) > 0.5, "{joint}");
        assert_eq!(summary["joints"][1]["torque_limit_share"], Value::Null);
        assert_eq!(summary["exceeded"], json!([]));
    }
}

#[test]
fn limits_that_a_run_went_beyond_are_reported() {
    for summary in runs(json!({"position": [-1, 0.5], "velocity": 0.25}), false) {
        let exceeded = summary["exceeded"].as_array().expect("a list");
        let named: Vec<[&str; 2]> = exceeded
            .iter()
            .map(|one| ["joint", "quantity"].map(|key| one[key].as_str().expect("a word")))
            .collect();
        assert_eq!(named, [["link1", "position"], ["link1", "speed"]]);
        for one in exceeded {
            let beyond = number(&one["worst"]) - number(&one["limit"]);
            assert!(beyond > 0.0 && beyond == number(&one["by"]), "{one}");
            assert!((0.0..=2.0).contains(&number(&one["at_s"])), "{one}");
        }
        let joint = &summary["joints"][0];
        assert!(number(&joint["final_error"]).abs() < 0.1, "{joint}");
    }
    // a limit that is wide enough is not
    for summary in runs(json!({"position": [-1, 3], "velocity": 50}), false) {
        assert_eq!(summary["exceeded"], json!([]));
    }
}

#[test]
fn the_text_says_the_same() {
    let directory = Directory::new("summary-text");
    write_arm(&directory, json!({"position": [-1, 0.5], "torque": [-9, 9]}));
    let scenario = json!({"format": "denavit-scenario/1", "model": "arm.json", "duration_s": 2,
        "control": {"joints": {"link1": {"kp": 40, "kd": 6, "reference": 1}}}});
    fs::write(directory.path.join("go.json"), scenario.to_string()).expect("a file");
    let Run { stdout, .. } = run_in(&directory.path, &["simulate", "go.json"]);
    for part in ["final error", "at torque limit", "1.000e0 rad", "0.000 s", " %"] {
        assert!(stdout.contains(part), "no `{part}` in:\n{stdout}");
    }
    assert!(stdout.contains("limit exceeded: link1: position"), "{stdout}");
    assert!(stdout.contains("beyond 0.5"), "{stdout}");
}

#[test]
fn a_run_without_control_has_nothing_to_follow() {
    let summary = json(&["simulate", "bouncing_ball", "--json"]);
    assert_eq!((&summary["joints"], &summary["exceeded"]), (&json!([]), &json!([])));
}

#[test]
fn a_model_in_place_of_a_scenario_is_recognised() {
    let directory = Directory::new("model-for-scenario");
    write_arm(&directory, json!({}));
    for model in ["arm.json", "planar_2r", "models/planar_2r.json"] {
        fs::create_dir_all(directory.path.join("models")).expect("a directory");
        let text = shipped::find("planar_2r").expect("a model").text;
        fs::write(directory.path.join("models/planar_2r.json"), text).expect("a file");
        let run = run_in(&directory.path, &["simulate", model]);
        assert_eq!(run.code, Some(2), "{}", run.stdout);
        let said = format!("{model}: this is a model");
        assert!(run.stderr.starts_with(&said), "{}", run.stderr);
        // what the hint says runs
        let (start, end) = (run.stderr.find("{\"format\""), run.stderr.find("} lets"));
        let scenario = &run.stderr[start.expect("a scenario")..=end.expect("its end")];
        fs::write(directory.path.join("go.json"), scenario).expect("a file");
        let run = run_in(&directory.path, &["simulate", "go.json"]);
        assert_eq!(run.code, Some(0), "{scenario}: {}", run.stderr);
    }
}

#[test]
fn a_duration_out_of_range_is_that_fault_and_no_other() {
    let directory = Directory::new("duration");
    for (duration, period) in [("-1", ""), ("1e9", ""), ("-1", ", \"log_period_s\": 1e-6")] {
        let text = format!(
            "{{\"format\": \"denavit-scenario/1\", \"model\": \"planar_2r\", \
             \"duration_s\": {duration}{period}}}"
        );
        fs::write(directory.path.join("bad.json"), &text).expect("a file");
        let run = run_in(&directory.path, &["simulate", "bad.json"]);
        assert_eq!(run.code, Some(2), "{}", run.stdout);
        assert!(run.stderr.contains("/duration_s: the number must be from 0"), "{}", run.stderr);
        assert!(!run.stderr.contains("rows"), "{}", run.stderr);
    }
    // the number of rows is the fault of what is given
    let text = r#"{"format": "denavit-scenario/1", "model": "planar_2r", "duration_s": 99999}"#;
    fs::write(directory.path.join("bad.json"), text).expect("a file");
    let run = run_in(&directory.path, &["simulate", "bad.json"]);
    assert!(run.stderr.contains("/duration_s: the log would have more than"), "{}", run.stderr);
}
