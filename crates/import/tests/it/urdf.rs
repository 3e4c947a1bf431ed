//! What becomes of the parts of a URDF.

use crate::evaluated::{frame, imported, off, origin};
use denavit_codegen::model::{self, JointKind, Robot};
use denavit_import::{Mimic, Options, import, nothing_included};

const GANTRY: &str = include_str!("../robots/gantry.urdf");

fn model_text(text: &str, options: &Options) -> (String, Vec<String>) {
    let found = import("gantry.urdf", text.as_bytes(), options, &mut nothing_included);
    let found = found.unwrap_or_else(|error| panic!("{error}"));
    (found.model, found.notes)
}

fn names(robot: &Robot) -> Vec<&str> {
    robot.links.values().map(|link| link.name.as_str()).collect()
}

#[test]
fn rows_are_exact_and_bodies_keep_their_numbers() {
    let (text, notes) = model_text(GANTRY, &Options::default());
    for part in [
        "\"theta\": \"-pi/2 + atan2(2, 1)\"",
        "atan2(sqrt(5), 2)",
        "\"xy\": -0.001,",
        "\"limits\": {\"position\": [-1, 1.5], \"velocity\": 2, \"torque\": [-300, 300]}",
        "\"slide\": {\"viscous\": 12.5, \"coulomb\": 3}",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    let said = notes.join("\n");
    for part in ["1.5707963 of carriage", "1.5708 of ankle", "rounded at 17 digits: `arm-1`"] {
        assert!(said.contains(part), "{part} in {said}");
    }
    let robot = model::read("m.json", text.as_bytes()).expect("a model");
    assert!(names(&robot).contains(&"arm_1") && names(&robot).contains(&"foot"));
    assert_eq!(robot.degrees_of_freedom(), 3);
    let ankle = &robot.links[robot.find_link("ankle").expect("the joint")];
    assert!(ankle.drive.is_none(), "a joint without effort has no motor");
    assert!(ankle.limits.velocity.is_none(), "0 is no speed");
    let swing = &robot.links[robot.find_link("swing").expect("the joint")];
    assert!(swing.drive.is_some() && swing.limits.position.is_none());
}

#[test]
fn panda_like_chains_have_a_row_for_each_joint() {
    // z axes and quarter turns: the table of the textbook, and no other row
    let mut text = String::from("<robot name=\"r\"><link name=\"l0\"/>");
    for (at, (xyz, roll)) in
        [("0 0 0.333", "0"), ("0 0 0", "-1.57079632679"), ("0 -0.316 0", "1.57079632679")]
            .into_iter()
            .enumerate()
    {
        text.push_str(&format!(
            "<link name=\"l{own}\"/><joint name=\"j{own}\" type=\"revolute\">\
             <parent link=\"l{at}\"/>\
             <child link=\"l{own}\"/><origin xyz=\"{xyz}\" rpy=\"{roll} 0 0\"/>\
             <axis xyz=\"0 0 1\"/></joint>",
            own = at + 1
        ));
    }
    let robot = imported(&(text + "</robot>"), &Options::default());
    assert_eq!(names(&robot), ["j1", "j2", "j3"]);
}

#[test]
fn the_tip_takes_the_chain_and_what_is_fixed_to_it() {
    let options = Options { tip: Some("tool".to_owned()), ..Options::default() };
    let (text, notes) = model_text(GANTRY, &options);
    let robot = model::read("m.json", text.as_bytes()).expect("a model");
    assert!(!names(&robot).contains(&"foot") && names(&robot).contains(&"tool"));
    assert!(notes.iter().any(|note| note.contains("`ankle`")), "{notes:?}");
}

#[test]
fn contact_points_are_the_lower_corners_of_boxes() {
    let options = Options { contacts: vec!["foot".to_owned()], ..Options::default() };
    let (text, _) = model_text(GANTRY, &options);
    let robot = model::read("m.json", text.as_bytes()).expect("a model");
    assert_eq!(robot.contacts.len(), 4);
    // the foot is turned by the ankle's origin: which side is low is decided in the world
    let foot = frame(&robot, &[0.0; 3], "foot");
    assert!(foot.iter().flatten().all(|x| x.is_finite()));
    let refused = import(
        "g.urdf",
        GANTRY.as_bytes(),
        &Options { contacts: vec!["tool".to_owned()], ..Options::default() },
        &mut nothing_included,
    );
    let said = refused.expect_err("no shape").to_string();
    assert!(said.contains("no collision shape"), "{said}");
}

#[test]
fn joints_that_follow_are_refused_locked_or_free() {
    let text = GANTRY.replace(
        "<safety_controller k_velocity=\"10\"/>",
        "<mimic joint=\"swing\" multiplier=\"2\" offset=\"0.25\"/>",
    );
    let refused = import("g.urdf", text.as_bytes(), &Options::default(), &mut nothing_included);
    let said = refused.expect_err("it follows").to_string();
    assert!(
        said.contains("joint `ankle` follows `swing`") && said.contains("options.mimic"),
        "{said}"
    );
    let locked = imported(&text, &Options { mimic: Mimic::Lock, ..Options::default() });
    assert_eq!(locked.degrees_of_freedom(), 2);
    let free = imported(&text, &Options { mimic: Mimic::Free, ..Options::default() });
    let q = [0.1, 0.2, 0.25];
    let held = frame(&locked, &q[..2], "foot");
    assert!(off(&held, &frame(&free, &q, "foot")) < 1e-14);
}

#[test]
fn planar_and_floating_joints_are_slides_and_turns() {
    let with = |kind: &str| {
        format!(
            "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/>\
             <joint name=\"j\" type=\"{kind}\">\
             <origin xyz=\"1 2 3\" rpy=\"0.1 0.2 0.3\"/><axis xyz=\"0 0 1\"/><parent link=\"a\"/>\
             <child link=\"b\"/></joint></robot>"
        )
    };
    let floating = imported(&with("floating"), &Options::default());
    let moving = |robot: &Robot| -> Vec<String> {
        let moves = |kind| kind != JointKind::Fixed;
        let links = robot.links.values().filter(|link| moves(link.joint.kind));
        links.map(|link| link.name.clone()).collect()
    };
    assert_eq!(moving(&floating), ["j_x", "j_y", "j_z", "j_yaw", "j_pitch", "j_roll"]);
    let q = [0.1, -0.2, 0.3, 0.4, 0.5, 0.6];
    let own = origin([0.1, -0.2, 0.3], [0.6, 0.5, 0.4]);
    let wanted = crate::evaluated::times(&origin([1.0, 2.0, 3.0], [0.1, 0.2, 0.3]), &own);
    let name = if floating.find_link("b").is_some() { "b" } else { "j_roll" };
    assert!(off(&frame(&floating, &q, name), &wanted) < 1e-14);
    let planar = imported(&with("planar"), &Options::default());
    assert_eq!(moving(&planar), ["j_x", "j_y", "j_yaw"]);
}

#[test]
fn bodies_that_none_is_are_joined_where_they_are_fixed() {
    let text = GANTRY.replace(
        "<link name=\"tool\"/>",
        "<link name=\"tool\"><inertial><mass value=\"0\"/><inertia ixx=\"0.001\" iyy=\"0.001\" \
         izz=\"0.001\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>",
    );
    let (model, notes) = model_text(&text, &Options::default());
    assert!(notes.iter().any(|note| note.contains("joined") && note.contains("tool")));
    assert!(model::read("m.json", model.as_bytes()).is_ok());
}
