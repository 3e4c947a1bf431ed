//! Values back into descriptions, and whole descriptions of models.

use crate::evaluated::{Random, called, imported};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::{self, Robot};
use denavit_import::{Format, Mimic, Options, export, export_into, import, nothing_included};

const GANTRY: &str = include_str!("../robots/gantry.urdf");

fn gantry() -> String {
    let found = import("g.urdf", GANTRY.as_bytes(), &Options::default(), &mut nothing_included);
    found.unwrap_or_else(|error| panic!("{error}")).model
}

fn read(text: &str) -> Robot {
    model::read("m.json", text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

fn into(robot: &Robot) -> String {
    export_into(robot, "g.urdf", GANTRY.as_bytes()).unwrap_or_else(|error| panic!("{error}")).text
}

#[test]
fn values_that_have_not_changed_leave_every_byte() {
    assert_eq!(into(&read(&gantry())), GANTRY);
}

#[test]
fn values_alone_change() {
    let changed = gantry()
        .replace("\"mass\": 4.5", "\"mass\": 4.75")
        .replace("\"xx\": 0.02,", "\"xx\": 0.0225,")
        .replace("\"viscous\": 12.5", "\"viscous\": 13.25");
    let found = into(&read(&changed));
    let wanted = GANTRY
        .replace("<mass value=\"4.5\"/>", "<mass value=\"4.75\"/>")
        // the inertial frame is turned by a quarter about z
        .replace("ixx=\"0.03\" iyy=\"0.02\"", "ixx=\"0.03\" iyy=\"0.0225\"")
        .replace("damping=\"12.5\"", "damping=\"13.25\"");
    assert_eq!(found, wanted);
    // and come back as they were written
    let again = import("g.urdf", found.as_bytes(), &Options::default(), &mut nothing_included);
    assert_eq!(read(&again.expect("a model").model).hash, read(&changed).hash);
}

#[test]
fn effects_that_a_description_cannot_have_are_said() {
    let model = gantry();
    let link = read(&model).links.values().nth(1).expect("a link").name.clone();
    let added = format!(
        r#""effects": [{{"effect": "viscous", "at": {{"link": "{link}"}},
        "parameters": {{"fv": 1}}}}], "links""#
    );
    let robot = read(&model.replacen("\"links\"", &added, 1));
    let found = export_into(&robot, "g.urdf", GANTRY.as_bytes());
    let notes = found.unwrap_or_else(|error| panic!("{error}")).notes;
    assert_eq!(notes, export(&robot, Format::Mjcf).expect("a description").notes);
    assert!(notes.len() == 1 && notes[0].starts_with("effects are left out: "), "{notes:?}");
}

#[test]
fn values_of_locked_joints_go_back_too() {
    let follows = "<mimic joint=\"swing\"/><axis xyz=\"0 0 1\"/>";
    let text = GANTRY.replace("<axis xyz=\"0 1 0\"/>", follows);
    let options = Options { mimic: Mimic::Lock, ..Options::default() };
    let found = import("g.urdf", text.as_bytes(), &options, &mut nothing_included);
    let model = found.unwrap_or_else(|error| panic!("{error}")).model;
    let back = |model: &str| {
        let found = export_into(&read(model), "g.urdf", text.as_bytes());
        found.unwrap_or_else(|error| panic!("{error}")).text
    };
    assert_eq!(back(&model), text);
    let changed = model.replace("\"mass\": 0.7", "\"mass\": 0.75");
    assert_eq!(back(&changed), text.replace("value=\"0.7\"", "value=\"0.75\""));
}

#[test]
fn what_was_not_there_is_added() {
    let changed = gantry().replace("\"swing\": {}", "\"swing\": {\"viscous\": 0.5}");
    assert_ne!(changed, gantry(), "the joint has a drive");
    assert!(into(&read(&changed)).contains("<dynamics damping=\"0.5\"/></joint>"));
}

/// Torques of two models in the same states, joints by name.
fn compare(a: &Robot, b: &Robot) {
    let mut random = Random(3);
    let n = a.degrees_of_freedom();
    assert_eq!(n, b.degrees_of_freedom());
    for _ in 0..5 {
        let mut state = || (0..n).map(|_| random.next()).collect::<Vec<f64>>();
        let (q, qd, qdd) = (state(), state(), state());
        let torques = |robot| called(robot, FunctionName::InverseDynamics, &[&q, &qd, &qdd]);
        for (a, b) in torques(a).iter().zip(torques(b)) {
            assert!((a - b).abs() < 1e-12 * (1.0 + a.abs()), "{a} and {b}");
        }
    }
}

#[test]
fn a_whole_urdf_is_the_same_robot() {
    let robot = read(&gantry());
    let text = export(&robot, Format::Urdf).expect("a URDF").text;
    compare(&robot, &imported(&text, &Options::default()));
}

#[test]
fn a_whole_mjcf_is_the_same_robot_with_its_springs() {
    let hopper = include_str!("../robots/hopper.xml");
    let robot = imported(hopper, &Options::default());
    let exported = export(&robot, Format::Mjcf).expect("an MJCF");
    assert!(exported.notes.is_empty(), "{:?}", exported.notes);
    compare(&robot, &imported(&exported.text, &Options::default()));
    let gantry = read(&gantry());
    let exported = export(&gantry, Format::Mjcf).expect("an MJCF");
    compare(&gantry, &imported(&exported.text, &Options::default()));
}

#[test]
fn both_conventions_are_written() {
    let standard = r#"{
      "format": "denavit-model/1", "name": "arm", "convention": "standard",
      "gravity": [0, 0, -9.81],
      "links": [
        {"name": "one", "joint": {"type": "revolute", "a": 0.1, "alpha": "pi/2", "d": 0.3},
         "body": {"mass": 2, "com": [0.1, 0.2, 0.3],
                  "inertia": {"xx": 0.1, "yy": 0.2, "zz": 0.25}, "about": "com"}},
        {"name": "two", "joint": {"type": "prismatic", "a": 0.2, "alpha": 0.3, "theta": 0.4},
         "body": {"mass": 1, "com": [0, 0.1, 0],
                  "inertia": {"xx": 0.2, "yy": 0.2, "zz": 0.2, "xy": 0.01}, "about": "origin"}},
        {"name": "tip", "joint": {"type": "fixed", "d": 0.1},
         "body": {"mass": 1, "com": [0, 0, 0],
                  "inertia": {"xx": 0.1, "yy": 0.1, "zz": 0.1}, "about": "com"}}],
      "drives": {"one": {"gear_ratio": -50, "rotor_inertia": 1e-4, "viscous": 1e-3,
                         "coulomb": 0.01}}}"#;
    let robot = read(standard);
    let exported = export(&robot, Format::Urdf).expect("a URDF");
    assert!(exported.notes.is_empty(), "{:?}", exported.notes);
    compare(&robot, &imported(&exported.text, &Options::default()));
    let exported = export(&robot, Format::Mjcf).expect("an MJCF");
    compare(&robot, &imported(&exported.text, &Options::default()));
}

#[test]
fn what_a_urdf_cannot_say_is_reported() {
    let text = gantry().replace("[0, 0, \"-g\"]", "[0, \"g\", 0]");
    let exported = export(&read(&text), Format::Urdf).expect("a URDF");
    assert!(exported.notes[0].contains("gravity"));
    let text = gantry().replace("\"swing\": {}", "\"swing\": {\"offset\": 3}");
    let exported = export(&read(&text), Format::Urdf).expect("a URDF");
    assert!(exported.notes[0].contains("constant torques") && exported.notes[0].contains("swing"));
}
