//! Trajectory files, and scenarios that follow them.

use denavit_plants::trajectory::Setpoint;
use denavit_simulate::scenario::{self, read_trajectory, trajectory_schema};
use serde_json::{Value, json};

fn file() -> Value {
    json!({
        "format": "denavit-trajectory/1",
        "duration_s": 2.0,
        "periodic": true,
        "joints": {
            "link1": { "bezier": { "times": [0, 2], "values": [0.1, 0.1, 0.9, 0.1, 0.1] } },
            "link2": { "fourier": {
                "frequencies_rad_s": [1.0, 3.5], "sines": [0.2, 0.0], "cosines": [0.0, 0.1],
            }},
        },
    })
}

const NO_FILES: fn(&str) -> Result<Vec<u8>, String> = |_| Err("there is no other file".to_owned());

#[test]
fn schema_and_reader_agree() {
    let schema: Value = serde_json::from_str(&trajectory_schema()).expect("JSON");
    jsonschema::draft202012::meta::validate(&schema).expect("a schema of draft 2020-12");
    let validator = jsonschema::draft202012::new(&schema).expect("a schema");
    let changed = |key: &str, value: Value| {
        let mut file = file();
        file[key] = value;
        file
    };
    let mut without = file();
    without.as_object_mut().expect("an object").remove("duration_s");
    for (file, is_right) in [
        (file(), true),
        (changed("excitation", json!({"condition": 3})), true),
        (changed("duration_s", json!(0)), false),
        (changed("joints", json!({})), false),
        (changed("joints", json!({"link1": {"spline": 1}})), false),
        (changed("format", json!("denavit-scenario/1")), false),
        (changed("laps", json!(2)), false),
        (without, false),
    ] {
        assert_eq!(validator.is_valid(&file), is_right, "{file}");
        let read = read_trajectory("a.json", file.to_string().as_bytes(), &NO_FILES);
        assert_eq!(read.is_ok(), is_right, "{file}");
    }
}

#[test]
fn frequencies_of_ones_own_are_summed() {
    let read = read_trajectory("a.json", file().to_string().as_bytes(), &NO_FILES).expect("sound");
    let t_s = 0.7_f64;
    let Setpoint { position, rate, .. } = read.find("link2").expect("a joint").at(t_s);
    assert!((position - (0.2 * t_s.sin() + 0.1 * (3.5 * t_s).cos())).abs() < 1e-12);
    assert!((rate - (0.2 * t_s.cos() - 0.35 * (3.5 * t_s).sin())).abs() < 1e-12);
}

/// A scenario with this control, of the arm and the trajectory above.
fn scenario(control: Value, trajectory: &Value) -> Result<scenario::Scenario, String> {
    let text = json!({
        "format": "denavit-scenario/1",
        "model": "arm.json",
        "duration_s": 1,
        "control": control,
    });
    let arm_file = denavit_plants::shipped::find("planar_2r").expect("shipped").text;
    let load = |name: &str| match name {
        "arm.json" => Ok(arm_file.as_bytes().to_vec()),
        "a.json" => Ok(trajectory.to_string().into_bytes()),
        _ => Err("there is no such file".to_owned()),
    };
    let read = scenario::read("test.json", text.to_string().as_bytes(), &load);
    read.map_err(|error| error.to_string())
}

#[test]
fn joints_follow_a_trajectory_lap_after_lap_unless_they_have_references_of_their_own() {
    let gains = json!({"link1": {"kp": 10, "kd": 1}, "link2": {"kp": 10, "reference": 0.25}});
    let control = json!({"trajectory": "a.json", "joints": gains});
    let scenario = scenario(control, &file()).expect("sound");
    let at = |joint: usize, t_s: f64| scenario.control.setpoint(joint, t_s).expect("it follows");
    // the middle of a Bezier polynomial of degree 4: (1, 4, 6, 4, 1) / 16 of its controls
    let middle = (0.1 + 0.4 + 5.4 + 0.4 + 0.1) / 16.0;
    for lap in 0..3 {
        let position = at(0, 1.0 + 2.0 * f64::from(lap)).position;
        assert!((position - middle).abs() < 1e-12, "{position}");
    }
    assert_eq!(at(1, 0.7).position, 0.25);
    assert_eq!(scenario.control.joints[0].stiffness, 10.0);
}

#[test]
fn faults_of_a_trajectory_are_reported_where_the_scenario_names_it() {
    let control = json!({"trajectory": "a.json"});
    let mut other = file();
    other["joints"]["link9"] = json!(1.0);
    let said = scenario(control.clone(), &other).err().expect("the arm has no such joint");
    assert!(said.contains("/control/trajectory: no joint is called `link9`"), "{said}");
    let mut wrong = file();
    wrong["joints"]["link1"] = json!({"cubic": {"times": [0, 0], "values": [1, 2]}});
    let said = scenario(control, &wrong).err().expect("times must increase");
    assert!(said.contains("the trajectory is wrong") && said.contains("a.json:1:"), "{said}");
    assert!(said.contains("/joints/link1/cubic"), "{said}");
    let said = scenario(json!({"trajectory": "b.json"}), &file()).err().expect("no such file");
    assert!(said.contains("b.json: cannot be read"), "{said}");
}
