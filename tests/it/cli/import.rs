//! Descriptions of other formats, from the command line and back.

use super::{Directory, Run, answer, json, run_in};
use std::fs;

const GANTRY: &str = include_str!("../../../crates/import/tests/robots/gantry.urdf");

/// A directory with a robot's URDF in it.
fn with_robot() -> Directory {
    let directory = Directory::new("import");
    fs::write(directory.path.join("gantry.urdf"), GANTRY).expect("a file");
    directory
}

fn run(directory: &Directory, arguments: &[&str]) -> Run {
    run_in(&directory.path, arguments)
}

#[test]
fn a_urdf_becomes_a_model_and_its_values_go_back() {
    let directory = with_robot();
    let imported = run(&directory, &["import", "gantry.urdf", "-o", "gantry.json"]);
    assert_eq!(imported.code, Some(0), "{}", imported.stderr);
    assert!(imported.stderr.contains("note: angles within rounding"), "{}", imported.stderr);
    let read = |name: &str| fs::read_to_string(directory.path.join(name)).expect("a file");
    let changed = read("gantry.json").replace("\"mass\": 4.5", "\"mass\": 4.75");
    fs::write(directory.path.join("gantry.json"), changed).expect("a file");
    let back = ["export", "gantry.json", "--into", "gantry.urdf", "-o", "changed.urdf"];
    assert_eq!(run(&directory, &back).code, Some(0));
    assert_eq!(read("changed.urdf"), GANTRY.replace("value=\"4.5\"", "value=\"4.75\""));
    // the user's own file is an input, which no output replaces
    let over = ["export", "gantry.json", "--into", "gantry.urdf", "-o", "gantry.urdf"];
    assert_eq!(run(&directory, &over).code, Some(2));
    assert_eq!(read("gantry.urdf"), GANTRY);
}

#[test]
fn commands_read_a_urdf_as_a_model() {
    let directory = with_robot();
    let shown = run(&directory, &["inspect", "gantry.urdf"]);
    assert_eq!(shown.code, Some(0), "{}", shown.stderr);
    assert!(shown.stdout.contains("degrees of freedom: 3"));
    assert!(shown.stderr.starts_with("note: gantry.urdf: "));
}

#[test]
fn faults_of_a_urdf_are_answered_like_those_of_a_model() {
    let directory = Directory::new("import");
    let wrong = GANTRY.replace("type=\"continuous\"", "type=\"spherical\"");
    fs::write(directory.path.join("wrong.urdf"), wrong).expect("a file");
    for command in [&["inspect", "wrong.urdf"][..], &["import", "wrong.urdf", "-o", "m.json"]] {
        let run = run(&directory, command);
        assert_eq!(run.code, Some(2));
        assert!(run.stderr.starts_with("wrong.urdf:47:"), "{}", run.stderr);
        assert!(run.stderr.contains("hint: it is one of revolute"), "{}", run.stderr);
    }
    assert_eq!(directory.files(), ["wrong.urdf"], "nothing half written");
    let run = run(&directory, &["inspect", "wrong.urdf", "--json"]);
    let faults: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(faults["faults"][0]["line"], 47);
}

#[test]
fn mjcf_includes_files_of_its_own_folder_alone() {
    let directory = Directory::new("import");
    let robot = |file: &str| {
        format!(
            "<mujoco><include file=\"{file}\"/><worldbody><body name=\"b\"><joint name=\"j\"/>\
             <geom size=\"0.1\"/></body></worldbody></mujoco>"
        )
    };
    fs::create_dir(directory.path.join("parts")).expect("a folder");
    fs::create_dir(directory.path.join("inner")).expect("a folder");
    let defaults = "<mujoco><default><joint damping=\"3\"/></default></mujoco>";
    fs::write(directory.path.join("parts/defaults.xml"), defaults).expect("a file");
    fs::write(directory.path.join("robot.xml"), robot("parts/defaults.xml")).expect("a file");
    let imported = run(&directory, &["import", "robot.xml"]);
    assert!(imported.stdout.contains("\"damping\": 3"), "{}", imported.stdout);
    for outside in ["../parts/defaults.xml", "/etc/hostname", "none.xml"] {
        fs::write(directory.path.join("inner/robot.xml"), robot(outside)).expect("a file");
        let imported = run(&directory, &["import", "inner/robot.xml"]);
        assert_eq!(imported.code, Some(2), "{outside}");
        assert!(imported.stderr.contains("is not included"), "{}", imported.stderr);
    }
}

#[test]
fn meshes_of_feet_are_read_from_one_folder_alone() {
    let directory = Directory::new("import");
    let robot = "<robot name=\"r\"><link name=\"base\"/><link name=\"foot\"><collision><geometry>\
        <mesh filename=\"package://walker/meshes/sole.obj\"/></geometry></collision></link>\
        <joint name=\"hip\" type=\"continuous\"><axis xyz=\"0 1 0\"/><parent link=\"base\"/>\
        <child link=\"foot\"/></joint></robot>";
    for folder in ["walker/urdf", "walker/meshes", "other"] {
        fs::create_dir_all(directory.path.join(folder)).expect("a folder");
    }
    fs::write(directory.path.join("walker/urdf/r.urdf"), robot).expect("a file");
    let sole = "v 1 1 0\nv 1 -1 0\nv -1 -1 0\nv -1 1 0\nv 0 0 1\n";
    fs::write(directory.path.join("walker/meshes/sole.obj"), sole).expect("a file");
    let import = |more: &[&str]| {
        let words = ["import", "walker/urdf/r.urdf", "--contacts", "foot"];
        run(&directory, &[&words[..], more].concat())
    };
    for folder in [".", "walker"] {
        let imported = import(&["--meshes", folder]);
        assert_eq!(imported.code, Some(0), "{}", imported.stderr);
        assert!(imported.stderr.contains("4 corners of"), "{}", imported.stderr);
        assert_eq!(imported.stdout.matches("\"link\": \"foot\"").count(), 4);
    }
    for folder in [&[][..], &["--meshes", "other"], &["--meshes", "none"]] {
        let refused = import(folder);
        assert_eq!(refused.code, Some(2));
        assert!(refused.stderr.contains("has no such file\n  hint: "), "{}", refused.stderr);
    }
    let refused = run(&directory, &["import", "walker/urdf/r.urdf", "--contacts", "foott"]);
    assert!(refused.stderr.contains("did you mean `foot`?"), "{}", refused.stderr);
}

#[test]
fn functions_are_evaluated_in_states() {
    let directory = Directory::new("evaluate");
    let states = "{\"states\": [{\"q\": [0.1, 0.2]}, {\"qdd\": [1, 0]}]}";
    fs::write(directory.path.join("states.json"), states).expect("a file");
    let call = |more: &[&str]| {
        let names = ["--functions", "inverse_dynamics,mass_matrix"];
        run(&directory, &[&["evaluate", "planar_2r"], &names[..], more].concat())
    };
    let found = call(&["--at", "states.json"]);
    let found: serde_json::Value = serde_json::from_str(&found.stdout).expect("JSON");
    let second = &found["states"][1];
    let mass = second["mass_matrix"]["mass_matrix"][0][0].as_f64().expect("a number");
    let still = json(&["evaluate", "planar_2r", "--functions", "inverse_dynamics"]);
    let torque =
        |state: &serde_json::Value| state["inverse_dynamics"]["tau"][0].as_f64().expect("a number");
    assert!((torque(second) - torque(&still["states"][0]) - mass).abs() < 1e-12);
    assert!(answer(&["evaluate", "--help"]).contains("states"));
    fs::write(directory.path.join("states.json"), "{\"states\": [{\"q\": [1]}]}").expect("a file");
    let refused = call(&["--at", "states.json"]);
    assert_eq!(refused.code, Some(2));
    assert!(refused.stderr.contains("`q` of state 1 has 1 numbers for 2 joints"));
}
