//! `denavit excite` as a user meets it.

use super::{Directory, run_in};
use serde_json::{Value, json};

const QUICK: [&str; 6] = ["--starts", "1", "--evaluations", "40", "--harmonics", "2"];

fn excite(directory: &Directory, more: &[&str]) -> super::Run {
    let words: Vec<&str> = ["excite"].iter().chain(more).copied().collect();
    run_in(&directory.path, &words)
}

#[test]
fn what_is_written_is_what_a_check_finds() {
    let directory = Directory::new("excite");
    let mut words = vec!["tulip_leg_table34", "--json", "-o", "leg.json", "--svg", "leg.svg"];
    words.extend(QUICK);
    let run = excite(&directory, &words);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let found: Value = serde_json::from_str(&run.stdout).expect("JSON");
    // what identification estimates: bodies and the friction that the model has
    let base = ["base", "tulip_leg_table34", "--with", "modelled", "--json"];
    let base: Value = serde_json::from_str(&run_in(&directory.path, &base).stdout).expect("JSON");
    assert_eq!(
        found["columns"].as_array().map(Vec::len),
        base["rank"].as_u64().map(|n| n as usize)
    );
    assert_eq!(directory.files(), ["leg.json", "leg.svg"]);
    let words = ["tulip_leg_table34", "--check", "leg.json", "--json"];
    let run = excite(&directory, &words);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let checked: Value = serde_json::from_str(&run.stdout).expect("JSON");
    let ratio = found["condition"].as_f64().expect("a number")
        / checked["condition"].as_f64().expect("a number");
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
    let picture = std::fs::read_to_string(directory.path.join("leg.svg")).expect("a picture");
    for text in ["hip z", "ankle y", "limits", "condition number over iterations"] {
        assert!(picture.contains(text), "{text}");
    }
}

#[test]
fn a_trajectory_outside_of_a_limit_is_told_and_exits_with_1() {
    let directory = Directory::new("excite");
    let joints = ["hip_z", "hip_x", "hip_y", "knee", "ankle_y"].map(|joint| {
        let offset = if joint == "knee" { 1.2 } else { 0.0 };
        format!(
            "\"{joint}\": {{\"fourier\": {{\"frequency_rad_s\": 3, \"offset\": {offset}, \
             \"sines\": [0.7], \"cosines\": [0]}}}}"
        )
    });
    let file = format!(
        "{{\"format\": \"denavit-trajectory/1\", \"duration_s\": 6, \"joints\": {{{}}}}}",
        joints.join(", ")
    );
    std::fs::write(directory.path.join("wide.json"), file).expect("a file");
    let run = excite(&directory, &["tulip_leg_table34", "--check", "wide.json"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    // 0.7 rad of 0.6 rad
    assert!(run.stdout.contains("116.7 %"), "{}", run.stdout);
    assert!(run.stdout.contains("outside of a limit"), "{}", run.stdout);
}

#[test]
fn bad_input_is_told_all_at_once_and_exits_with_2() {
    let directory = Directory::new("excite");
    let run = excite(&directory, &["planar_2r", "--duration-s", "-1", "--hold", "knee=0"]);
    assert_eq!(run.code, Some(2));
    for text in [
        "planar_2r: a duration of -1 s is not from 0.01 s to 10000 s",
        "planar_2r: --hold: no joint is called `knee`",
        "planar_2r: `link1` has no position limit",
        "hint: add `\"limits\": {\"position\": [-0.5, 0.5]}` to the link `link2` of the model",
    ] {
        assert!(run.stderr.contains(text), "{text} is not in\n{}", run.stderr);
    }
    assert!(directory.files().is_empty());
    for (words, text) in [
        (vec!["tulip_leg_table34", "--harmonics", "0"], "at least 1 harmonics"),
        (vec!["tulip_leg_table34", "--basis", "polynomial", "--degree", "2"], "moves and ends"),
        (vec!["tulip_leg_table34", "--basis", "free-fourier", "--harmonics", "2"], "moves and"),
        (vec!["tulip_leg_table34", "--starts", "0"], "at least 1 starts"),
        (vec!["tulip_leg_table34", "--evaluations", "0"], "at least 1 evaluations"),
        (vec!["tulip_leg_table34", "--evaluations", "1000000"], "at most 100000 evaluations"),
        (vec!["tulip_leg_table34", "--reach", "-1"], "--reach"),
        (vec!["tulip_leg_table34", "--hold", "knee=9"], "outside its position limits"),
        (vec!["tulip_leg_table34", "--check", "none.json"], "none.json: cannot be read"),
    ] {
        let run = excite(&directory, &words);
        assert_eq!(run.code, Some(2), "{words:?}: {}", run.stdout);
        assert!(run.stderr.contains(text), "{words:?}: {}", run.stderr);
    }
}

/// The PUMA's file has positions alone: rates are those of one sine a lap over the whole range.
#[test]
fn limits_that_the_model_lacks_are_chosen_and_said() {
    let directory = Directory::new("excite-puma");
    let words = ["puma560", "--starts", "1", "--evaluations", "20", "--harmonics", "2", "--json"];
    let run = excite(&directory, &words);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let found: Value = serde_json::from_str(&run.stdout).expect("JSON");
    let assumed = found["assumed_limits"].as_array().expect("a list");
    assert_eq!(assumed.len(), 12, "{assumed:?}");
    let range = 320.0_f64.to_radians();
    let waist = assumed.iter().find(|one| one["limit"] == "velocity").expect("a velocity");
    let velocity = waist["value"].as_f64().expect("a number");
    assert!((velocity - std::f64::consts::PI * range / 10.0).abs() < 1e-9, "{waist}");
    let told = excite(&directory, &["tulip_leg_table34", "--starts", "1", "--evaluations", "5"]);
    assert!(!told.stdout.contains("does not give"), "{}", told.stdout);
}

/// Neither what breaks a limit nor what shows nothing is written as a trajectory to be run.
#[test]
fn no_trajectory_is_written_that_cannot_be_run_or_shows_nothing() {
    let directory = Directory::new("excite-none");
    let cases = [
        ("planar_2r", json!({"position": [-1.5, 1.5], "torque": 1e-3}), "outside of a limit"),
        ("tulip_leg_table34", json!({"position": [-1, 1], "velocity": 1e-9}), "as good as"),
    ];
    for (model, limits, expected) in cases {
        let shipped = denavit::shipped::find(model).expect("shipped");
        let mut robot: Value = serde_json::from_str(shipped.text).expect("JSON");
        for link in robot["links"].as_array_mut().expect("links") {
            link["limits"] = limits.clone();
        }
        std::fs::write(directory.path.join("robot.json"), robot.to_string()).expect("written");
        for output in ["found.json", "-"] {
            let run = excite(&directory, &[&["robot.json", "-o", output], &QUICK[..]].concat());
            assert_eq!(run.code, Some(1), "{expected}: {}", run.stderr);
            assert!(run.stdout.contains(expected), "{expected}: {}", run.stdout);
            assert_eq!(directory.files(), ["robot.json"], "{expected}");
        }
    }
}
