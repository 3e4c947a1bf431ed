//! What is remarked on: units, signs and copies that went wrong, and nothing of sound models.

use super::{robot_of, shipped_models};
use denavit_codegen::arena::Handle;
use denavit_codegen::effect;
use denavit_codegen::model::{LinkId, remarks};
use serde_json::{Value, json};

/// What is said of a model.
fn said(model: &Value) -> Vec<String> {
    let text = model.to_string();
    let robot = robot_of("arm.json", &text);
    let found = remarks(&robot, text.as_bytes());
    found.iter().map(|remark| format!("{}: {}", remark.pointer, remark.cause)).collect()
}

/// Two links of 0.4 and 0.3 m.
fn arm() -> Value {
    let body = json!({"mass": 2, "com": [-0.2, 0, 0], "about": "com",
        "inertia": {"xx": 0.01, "yy": 0.04, "zz": 0.04}});
    json!({
        "format": "denavit-model/1", "name": "arm", "convention": "standard",
        "gravity": [0, 0, "-g"], "constants": {"g": 9.81, "al": 0.5},
        "links": [
            {"name": "one", "joint": {"type": "revolute", "a": 0.4, "alpha": "pi/2"}, "body": body},
            {"name": "two", "joint": {"type": "revolute", "a": 0.3, "alpha": "al"}, "body": body},
        ],
    })
}

#[test]
fn sound_models_have_no_remark() {
    assert_eq!(said(&arm()), Vec::<String>::new());
    for (name, text) in shipped_models() {
        let robot = effect::read_model(&name, text.as_bytes(), &[]).unwrap();
        let found = remarks(&robot, text.as_bytes());
        assert!(found.is_empty(), "{name}: {}", found[0].message(&name));
    }
}

#[test]
fn degrees_are_remarked_on_with_file_place_and_way_out() {
    let text = arm().to_string().replace("\"pi/2\"", "90").replace("\"a\":0.4", "\n\"a\":0.4");
    let found = remarks(&robot_of("arm.json", &text), text.as_bytes());
    assert_eq!(found.len(), 1);
    assert_eq!(
        found[0].message("arm.json"),
        "arm.json:2:17: /links/0/joint/alpha: the angle 90 is more than a full turn\n  hint: \
         angles are in radians: 90 degrees are \"pi/2\""
    );
    let mut model = arm();
    model["links"][1]["joint"]["theta"] = json!("-2*pi");
    assert_eq!(said(&model), Vec::<String>::new());
    model["constants"]["al"] = json!(-45);
    assert_eq!(said(&model), ["/links/1/joint/alpha: the angle -45 is more than a full turn"]);
    // the generated joints of a base are no links of the file
    model["base"] = json!("floating");
    assert_eq!(said(&model).len(), 1);
    assert!(said(&model)[0].starts_with("/links/1/joint/alpha"));
}

#[test]
fn a_centre_of_mass_in_millimetres_is_remarked_on() {
    let mut model = arm();
    model["links"][1]["body"]["com"] = json!([-150, 0, 10]);
    assert_eq!(
        said(&model),
        ["/links/1/body/com: the centre of mass (-150, 0, 10) is farther out than the robot \
          reaches; its link has a length of 0.3"]
    );
    // a tool far out on a short flange
    model["links"][1]["joint"]["a"] = json!(0.02);
    model["links"][1]["body"]["com"] = json!([0.3, 0, 0]);
    assert_eq!(said(&model), Vec::<String>::new());
    // a length that is not given
    model["links"][1]["joint"]["a"] = json!(0);
    model["links"][1]["body"]["com"] = json!([300, 0, 0]);
    assert_eq!(said(&model), Vec::<String>::new());
    // a joint that slides as far as nobody says, and one that says
    model["links"][1]["joint"] = json!({"type": "prismatic", "d": 0.01});
    assert_eq!(said(&model), Vec::<String>::new());
    model["links"][1]["limits"] = json!({"position": [0, 40]});
    assert_eq!(said(&model), Vec::<String>::new());
    model["links"][1]["limits"] = json!({"position": [0, 2]});
    assert_eq!(said(&model).len(), 1);
}

#[test]
fn gravity_upwards_is_remarked_on_where_there_is_ground() {
    let mut model = arm();
    model["gravity"] = json!([0, 0, "g"]);
    // an arm may hang from a ceiling
    assert_eq!(said(&model), Vec::<String>::new());
    let upwards = ["/gravity: gravity points away from the ground"];
    for (key, value) in [
        ("base", json!("floating")),
        ("ground", json!({})),
        ("contacts", json!([{"name": "tip", "link": "two", "position": [0, 0, 0]}])),
    ] {
        let mut standing = model.clone();
        standing[key] = value;
        assert_eq!(said(&standing), upwards, "{key}");
        standing["gravity"] = json!([0, 0, "-g"]);
        assert_eq!(said(&standing), Vec::<String>::new(), "{key}");
    }
    // down is where the ground is
    model["gravity"] = json!([0, "g", 0]);
    model["ground"] = json!({"normal": [0, -1, 0]});
    assert_eq!(said(&model), Vec::<String>::new());
    model["ground"] = json!({"normal": [0, 1, 0]});
    assert_eq!(said(&model), upwards);
}

#[test]
fn bodies_that_no_choice_of_missing_entries_makes_possible_are_remarked_on() {
    let with = |body: Value| {
        let mut model = arm();
        model["links"][0]["body"] = body;
        said(&model)
    };
    let none = "/links/0/body: no body has this inertia, whatever the missing entries are: ";
    for (body, why) in [
        (
            json!({"about": "com", "inertia": {"xx": 0.1, "yy": 0.1, "zz": 0.3}}),
            "Izz = 0.3 > Ixx + Iyy = 0.2",
        ),
        (
            json!({"mass": 1, "about": "com", "inertia": {"zz": 0.1, "xy": -0.06}}),
            "2 |Ixy| = 0.12 > Izz = 0.1",
        ),
        (
            json!({"mass": 1, "about": "com", "inertia": {"xx": 0.1, "yy": 0.4, "xy": 0.21}}),
            "Ixy^2 = 0.0441 > Ixx Iyy = 0.04",
        ),
        (
            json!({"mass": 2, "about": "origin", "com": [-0.2, 0, 0], "inertia": {"zz": 0.01}}),
            "Izz = 0.01 about the origin < m r^2 = 0.08",
        ),
    ] {
        assert_eq!(with(body), [format!("{none}{why}")]);
    }
    for body in [
        // thin rods and plates
        json!({"about": "com", "inertia": {"xx": 0, "yy": 0.1, "zz": 0.1}}),
        json!({"about": "com", "inertia": {"xx": 0.1, "yy": 0.1, "zz": 0.2}}),
        json!({"mass": 1, "about": "com", "inertia": {"zz": 0.1, "xy": 0.05}}),
        json!({"mass": 2, "about": "origin", "com": [-0.2, 0, 0], "inertia": {"zz": 0.08}}),
        // the origin says nothing of a tensor about the centre of mass
        json!({"mass": 2, "about": "com", "com": [-0.2, 0, 0], "inertia": {"zz": 0.01}}),
        json!({"com": [1, 2, 3]}),
        json!({"about": "com", "inertia": {"xx": {"known": false}, "yy": 0.1, "zz": 0.3}}),
    ] {
        assert_eq!(with(body.clone()), Vec::<String>::new(), "{body}");
    }
}

/// In the user's own unknowns, what a body leaves out is written as 0 and not asked about.
#[test]
fn planar_bodies_in_own_unknowns_have_no_remark() {
    let mut model = arm();
    model["unknowns"] = json!({"m": {"value": 2}, "I": {"value": 0.1}});
    model["links"][0]["body"] = json!({"mass": "m", "about": "com", "inertia": {"zz": "I"}});
    assert_eq!(said(&model), Vec::<String>::new());
    // the sum of several bodies may lie anywhere
    model["unknowns"]["c"] = json!({"value": -50});
    model["links"][0]["body"]["com"] = json!(["c", 0, 0]);
    assert_eq!(said(&model), Vec::<String>::new());
}

#[test]
fn links_are_pointed_at_as_they_stand_in_the_file() {
    for (name, text) in shipped_models() {
        let robot = robot_of(&name, &text);
        let file: Value = serde_json::from_str(&text).unwrap();
        let mut found = 0;
        for index in 0..robot.links.len() {
            let id = LinkId::from_index(index);
            let Some(pointer) = robot.pointer(id) else { continue };
            assert_eq!(file.pointer(&pointer).unwrap()["name"], robot.links[id].name, "{name}");
            found += 1;
        }
        assert_eq!(Some(found), file["links"].as_array().map(Vec::len), "{name}");
    }
}
