//! `denavit walk design`: gait files in, scenarios out, and gaits that cannot be.

use super::{Directory, json, run_in};
use serde_json::Value;
use std::fs;

fn designed(directory: &Directory, arguments: &[&str]) -> String {
    let run = run_in(&directory.path, &[&["walk", "design"], arguments].concat());
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{arguments:?}");
    run.stdout
}

/// What is written is walked; a shorter run than that of the shipped gait says as much.
#[test]
fn a_designed_scenario_is_simulated() {
    let directory = Directory::new("walk_design");
    let said = designed(
        &directory,
        &["planar_biped_primitives", "-o", "walk.json", "--trajectory", "t.json", "--svg", "g.svg"],
    );
    for part in [
        "step length",
        "0.1000 m",
        "step time",
        "4.0000 s",
        "mean speed",
        "0.0250 m/s",
        "largest residual of inverse kinematics",
        "least static margin",
        "95.0 mm",
        "landed at 3.200 s",
        "wrote walk.json",
        "wrote t.json",
        "wrote g.svg",
    ] {
        assert!(said.contains(part), "{part}:\n{said}");
    }
    let read = |file: &str| fs::read_to_string(directory.path.join(file)).unwrap();
    let text = read("walk.json");
    let mut scenario: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(scenario["format"], "denavit-scenario/1");
    assert_eq!(scenario["duration_s"], 80.0);
    scenario["duration_s"] = 8.0.into();
    fs::write(directory.path.join("short.json"), scenario.to_string()).unwrap();
    let run = run_in(&directory.path, &["simulate", "short.json"]);
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{}", run.stdout);
    // the trajectory alone, with gains, is the same control
    let trajectory: Value = serde_json::from_str(&read("t.json")).unwrap();
    assert_eq!((&trajectory["periodic"], &trajectory["duration_s"]), (&true.into(), &8.0.into()));
    for joint in scenario["control"]["joints"].as_object_mut().unwrap().values_mut() {
        joint.as_object_mut().unwrap().remove("reference");
    }
    scenario["control"]["trajectory"] = "t.json".into();
    fs::write(directory.path.join("followed.json"), scenario.to_string()).unwrap();
    let run = run_in(&directory.path, &["simulate", "followed.json"]);
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{}", run.stdout);
    let svg = read("g.svg");
    assert!(svg.contains("joint angles") && svg.matches("<circle").count() == 30, "{svg}");
    // the same gait gives the same bytes
    designed(&directory, &["planar_biped_primitives", "-o", "again.json"]);
    assert_eq!(text, read("again.json"));
}

#[test]
fn the_answer_has_every_knot_as_json() {
    let answer = json(&["walk", "design", "planar_biped_primitives", "--json"]);
    assert_eq!(answer["kind"], "walking primitives");
    assert_eq!(answer["step_length_m"], 0.1);
    let knots = answer["knots"].as_array().unwrap();
    assert_eq!(knots.iter().filter(|knot| knot["solved"] == true).count(), 5);
    assert!(knots.iter().all(|knot| knot["residual"].as_f64().unwrap() < 1e-3));
    assert!(answer["residual"].as_f64().unwrap() < 1e-10);
    assert!(answer["static_margin_m_at"].as_str().unwrap().starts_with("landed at"));
    let answer = json(&["walk", "design", "planar_biped_inverted_pendulum", "--json"]);
    assert_eq!(answer["kind"], "linear inverted pendulum");
    assert!(answer["zmp_margin_m"].as_f64().unwrap() > 0.01);
    assert!(answer["knots"].as_array().unwrap().len() > 300);
}

/// Torques of the plan are part of the scenario; values in place of the model's are, too.
#[test]
fn a_walk_in_space_is_designed() {
    let directory = Directory::new("walk_design_space");
    let text = denavit::shipped::find_gait("tulip_walk").unwrap().text;
    let soft =
        text.replace("\"model\"", "\"parameters\": {\"ks_left_ankle_x\": 250},\n  \"model\"");
    fs::write(directory.path.join("gait.json"), soft).unwrap();
    let said = designed(&directory, &["gait.json", "-o", "walk.json", "--trajectory", "t.json"]);
    assert!(said.contains("divergent component of motion for tulip"), "{said}");
    let read = |file: &str| -> Value {
        serde_json::from_str(&fs::read_to_string(directory.path.join(file)).unwrap()).unwrap()
    };
    let mut scenario = read("walk.json");
    assert_eq!(scenario["parameters"], serde_json::json!({"ks_left_ankle_x": 250.0}));
    assert_eq!(scenario["contact"], serde_json::json!({"friction": 0.8}));
    assert_eq!(read("t.json")["joints"].as_object().unwrap().len(), 12);
    let joints = scenario["control"]["joints"].as_object().unwrap();
    assert!(joints.values().all(|law| law["feed_forward"]["cubic"]["times"].is_array()));
    assert_eq!(joints.len(), 12);
    scenario["duration_s"] = 2.0.into();
    fs::write(directory.path.join("short.json"), scenario.to_string()).unwrap();
    for scheme in ["event", "time-stepping"] {
        let run = run_in(&directory.path, &["simulate", "short.json", "--scheme", scheme]);
        assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{}", run.stdout);
    }
}

/// A gait file that says what cannot be, in place of a part of a shipped one.
fn refused(directory: &Directory, name: &str, own: &str, other: &str) -> String {
    let text = denavit::shipped::find_gait(name).unwrap().text;
    assert!(text.contains(own), "{own}");
    fs::write(directory.path.join("gait.json"), text.replacen(own, other, 1)).unwrap();
    let run = run_in(&directory.path, &["walk", "design", "gait.json", "-o", "walk.json"]);
    assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""), "{other}");
    assert!(!directory.path.join("walk.json").exists());
    assert!(run.stderr.contains("gait.json") && run.stderr.contains("hint"), "{}", run.stderr);
    run.stderr
}

#[test]
fn gaits_that_cannot_be_are_named() {
    let directory = Directory::new("walk_design_refused");
    let (primitives, pendulum) = ("planar_biped_primitives", "planar_biped_inverted_pendulum");
    for ((name, own, other), parts) in [
        (
            (primitives, "\"hip_height_m\": 0.54", "\"hip_height_m\": 0.7"),
            ["`both feet` at 0.000 s", "out of reach", "residual of"],
        ),
        (
            (primitives, "\"center_of_mass_m\": 0.05,", "\"center_of_mass_m\": 0.16,"),
            ["`forward` at 2.400 s", "10.0 mm outside the support polygon", "centre of mass"],
        ),
        (
            (primitives, "\"swing_foot_m\": [0.1, 0]", "\"swing_foot_m\": [0.2, 0]"),
            ["`landed`", "[0.2, 0] m", "[0.1, 0] m"],
        ),
        (
            (pendulum, "\"double_support_s\": 0.2", "\"double_support_s\": 0.9"),
            ["phases overlap", "0.9 s of double support", "a step of 0.8 s"],
        ),
        (
            (pendulum, "\"step_length_m\": 0.1", "\"step_length_m\": 0.9"),
            ["`step 1", "out of reach", "residual of"],
        ),
        (
            (pendulum, "\"lift_m\": 0.03", "\"lift_m\": -0.03, \"lift\": 1"),
            ["/inverted_pendulum/lift_m", "the number must be from 0 to 10", "`lift`"],
        ),
        (
            (primitives, "\"model\": \"planar_biped\"", "\"model\": \"tulip\""),
            ["planar robots with two legs", "plane that it moves in", "hint"],
        ),
        (
            ("tulip_walk", "\"center_of_mass_height_m\": 0.65", "\"center_of_mass_height_m\": 0.6"),
            ["`step 1, swing` at", "needs `left_ankle_y` at -0.80", "its limits are -0.8 and 0.8"],
        ),
        (
            ("tulip_walk", "\"step_s\": 0.8", "\"step_s\": 0.8, \"step_width_m\": 0.1"),
            ["`start` at 0.000 s", "a foot is on the other one", "hint"],
        ),
        (
            (
                "tulip_walk",
                "\"model\": \"tulip\"",
                "\"model\": \"tulip\", \"parameters\": {\"ks_left_ankle\": 1}",
            ),
            ["gait.json", "the model has no parameter `ks_left_ankle`", "hint"],
        ),
        (
            ("tulip_walk", "\"model\": \"tulip\"", "\"model\": \"planar_biped\""),
            ["robots in space with two legs", "freedom to move in space", "hint"],
        ),
        (
            (primitives, "\"model\": \"planar_biped\"", "\"model\": \"planar_bipde\""),
            ["planar_bipde", "`planar_biped` is a shipped model", "hint"],
        ),
    ] {
        let said = refused(&directory, name, own, other);
        for part in parts {
            assert!(said.contains(part), "{part}:\n{said}");
        }
    }
    let run = run_in(&directory.path, &["walk", "design", "planar_biped_primitive"]);
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("`planar_biped_primitives` is a shipped gait"), "{}", run.stderr);
}

#[test]
fn the_schema_of_gaits_is_printed() {
    let schema = json(&["schema", "gait"]);
    assert_eq!(schema["title"], "denavit gait");
    assert_eq!(schema, json(&["schema", "denavit-gait/1", "--json"]));
}
