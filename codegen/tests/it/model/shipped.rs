//! The shipped robots against what their sources say.

use super::pose::{assert_near, pose, poses, value};
use super::{fixture, package, robot_of, shipped, shipped_models};
use denavit_codegen::model::{Base, Convention, JointKind, Robot, Side};

#[test]
fn every_shipped_model_is_in_order_and_says_where_it_comes_from() {
    let degrees_of_freedom = [
        ("double_pendulum", 2),
        ("emps", 1),
        ("iiwa", 7),
        ("panda", 7),
        ("planar_2r", 2),
        ("planar_3r", 3),
        ("planar_biped", 9),
        ("puma560", 6),
        ("rx90", 6),
        ("scara", 4),
        ("stanford", 6),
        ("tulip", 18),
        ("tulip_leg", 5),
        ("tulip_leg5", 5),
        ("tulip_leg6", 6),
        ("tulip_leg_table34", 5),
        ("tulip_one_torso", 18),
    ];
    let models = shipped_models();
    assert_eq!(models.len(), degrees_of_freedom.len());
    for ((name, text), (expected_name, expected)) in models.iter().zip(degrees_of_freedom) {
        let robot = robot_of(name, text);
        assert_eq!((robot.name.as_str(), name.as_str()), (expected_name, expected_name));
        assert_eq!(robot.degrees_of_freedom(), expected, "{name}");
        let says = [&robot.description, &robot.source];
        assert!(says.iter().all(|text| text.len() > 20), "{name} says too little");
        assert!(!robot.assumptions.is_empty(), "{name} states no assumption");
        for parameter in robot.parameters.values() {
            assert!(parameter.default.is_some(), "{name}: {} has no value", parameter.name);
            assert!(parameter.unit.is_some(), "{name}: {} has no unit", parameter.name);
        }
    }
    let general = std::fs::read_to_string(fixture("general_6r.json")).expect("the general arm");
    assert_eq!(robot_of("general_6r", &general).degrees_of_freedom(), 6);
}

#[test]
fn the_first_example_of_the_format_page_is_in_order() {
    let page = std::fs::read_to_string(package().join("../docs/reference/model-file.md"))
        .expect("the page");
    let example = page.split("```json").nth(1).and_then(|rest| rest.split("```").next());
    assert_eq!(robot_of("pendulum", example.expect("an example")).name, "pendulum");
}

/// A row of a table: a, quarter turns of alpha, d; lengths by name.
type Row = (&'static str, i32, &'static str);

#[test]
fn arms_have_the_tables_that_operation_counts_are_compared_on() {
    let tables: [(&str, &[Row]); 6] = [
        (
            "puma560",
            &[
                ("", 1, ""),
                ("a2", 0, ""),
                ("a3", -1, "d3"),
                ("", 1, "d4"),
                ("", -1, ""),
                ("", 0, ""),
            ],
        ),
        (
            "stanford",
            &[("", -1, ""), ("", 1, "d2"), ("", 0, ""), ("", -1, ""), ("", 1, ""), ("", 0, "")],
        ),
        ("scara", &[("a1", 0, ""), ("a2", 0, ""), ("", 0, ""), ("", 0, "")]),
        (
            "iiwa",
            &[
                ("", -1, ""),
                ("", 1, ""),
                ("", 1, "d3"),
                ("", -1, ""),
                ("", -1, "d5"),
                ("", 1, ""),
                ("", 0, ""),
            ],
        ),
        ("planar_3r", &[("l1", 0, ""), ("l2", 0, ""), ("l3", 0, "")]),
        (
            "tulip_leg6",
            &[
                ("", -1, ""),
                ("a8", -1, "d8"),
                ("a9", 0, "d9"),
                ("a10", 0, ""),
                ("a11", 1, ""),
                ("", 0, ""),
            ],
        ),
    ];
    for (name, rows) in tables {
        let robot = shipped(name);
        assert_eq!(robot.convention, Convention::Standard);
        assert_eq!(robot.links.len(), rows.len());
        for (link, (a, quarter_turns, d)) in robot.links.values().zip(rows) {
            let symbol = |expr| robot.dag.as_symbol(expr).map_or("", |symbol| symbol.name.as_str());
            assert_eq!(
                (symbol(link.joint.a), symbol(link.joint.d)),
                (*a, *d),
                "{name} {}",
                link.name
            );
            let alpha = value(&robot, link.joint.alpha, &[]);
            assert_eq!(alpha, f64::from(*quarter_turns) * std::f64::consts::FRAC_PI_2, "{name}");
        }
    }
}

const SIDES: [(&str, f64); 2] = [("right", -1.0), ("left", 1.0)];

#[test]
fn tulip_stands_straight_at_zero() {
    for model in ["tulip", "tulip_one_torso"] {
        let robot = shipped(model);
        assert_eq!(robot.base, Base::Floating);
        for (side, outward) in SIDES {
            // thesis table 3.1: hips at +-0.145, ankles 0.145 - 0.065 from the middle and
            // 0.34 + 0.035 + 0.275 + 0.275 + 0.01 below the top of the torso
            let expected = [
                ("hip_z", [0.0, 0.145 * outward, -0.34]),
                ("hip_x", [0.12, 0.145 * outward, -0.375]),
                ("hip_y", [0.12, 0.08 * outward, -0.65]),
                ("knee", [0.12, 0.08 * outward, -0.925]),
                ("ankle_y", [0.12, 0.08 * outward, -0.935]),
                ("ankle_x", [0.27, 0.08 * outward, -0.935]),
            ];
            for (joint, origin) in expected {
                let link = format!("{side}_{joint}");
                assert_near(pose(&robot, &link, &[]).origin, origin, &link);
            }
        }
        let frames = poses(&robot, &[]);
        // table 3.2; 2 (0.080 - 0.065) = 0.03 m remain between the feet
        for (side, outward) in SIDES {
            for (toe, x) in [("toe", 0.27), ("heel", 0.06)] {
                for (edge, y) in [("inner", 0.015), ("outer", 0.165)] {
                    let name = format!("{side}_{toe}_{edge}");
                    let contact =
                        robot.contacts.values().find(|c| c.name == name).expect("a contact");
                    let frame = pose(&robot, &robot.links[contact.link].name, &[]);
                    let point = contact.position.map(|entry| value(&robot, entry, &[]));
                    assert_near(frame.place(point), [x, y * outward, -0.935], &name);
                }
            }
        }
        assert_eq!(robot.contacts.len(), 8);
        assert_eq!(frames.len(), 6 + 2 * 7);
    }
}

/// Mass, centre of mass in the world at zero pose, moments of inertia in world axes.
fn body_in_world(robot: &Robot, link: &str) -> (f64, [f64; 3], [f64; 6]) {
    let body = robot.links[robot.find_link(link).expect("a link")].body.expect("a body");
    let frame = pose(robot, link, &[]);
    let com = frame.place(body.com.map(|entry| value(robot, entry, &[])));
    let tensor = frame.turn_tensor(body.inertia.map(|entry| value(robot, entry, &[])));
    (value(robot, body.mass, &[]), com, tensor)
}

#[test]
fn tulips_bodies_are_those_of_the_printed_tables() {
    let robot = shipped("tulip");
    // joint, mass, centre of mass for the left leg at zero pose, moments (tables 3.1 and 3.3)
    let rows: [(&str, f64, [f64; 3], [f64; 3]); 7] = [
        ("torso", 8.594, [0.099, 0.098, -0.34 + 0.225], [0.27217, 0.20518, 0.07047]),
        ("hip_z", 0.614, [0.054, 0.145, -0.34 - 0.007], [0.00002, 0.00095, 0.00056]),
        ("hip_x", 0.614, [0.054, 0.145, -0.34 - 0.007], [0.00002, 0.00095, 0.00056]),
        ("hip_y", 2.141, [0.12 + 0.054, 0.08 + 0.03, -0.375 - 0.082], [0.01467, 0.01134, 0.00148]),
        ("knee", 0.315, [0.12, 0.08 + 0.021, -0.65 - 0.131], [0.00396, 0.00368, 0.00009]),
        ("ankle_y", 0.001, [0.12, 0.08, -0.925 - 0.05], [0.00001, 0.00001, 0.00001]),
        (
            "ankle_x",
            0.366,
            [0.12 + 0.087, 0.08 + 0.068, -0.935 - 0.005],
            [0.0004, 0.00157, 0.00205],
        ),
    ];
    for (side, outward) in SIDES {
        for (joint, mass, [x, y, z], [ixx, iyy, izz]) in rows {
            let link = format!("{side}_{joint}");
            let (found_mass, com, tensor) = body_in_world(&robot, &link);
            assert_eq!(found_mass, mass, "{link}");
            assert_near(com, [x, y * outward, z], &link);
            assert_near(tensor, [ixx, iyy, izz, 0.0, 0.0, 0.0], &link);
        }
    }
}

fn total_mass(robot: &Robot) -> f64 {
    robot.links.values().filter_map(|link| link.body).map(|b| value(robot, b.mass, &[])).sum()
}

#[test]
fn the_walkers_weigh_what_their_sources_add_up_to() {
    for (model, mass) in [("tulip", 25.29), ("tulip_one_torso", 16.696), ("planar_biped", 25.29)] {
        assert_near([total_mass(&shipped(model))], [mass], model);
    }
    let (_, com, tensor) = body_in_world(&shipped("tulip_one_torso"), "base_pitch");
    assert_near(com, [0.099, 0.0, -0.115], "the torso");
    assert_near(tensor, [0.27217, 0.20518, 0.07047, 0.0, 0.0, 0.0], "the torso");
}

#[test]
fn the_ankle_of_tulip_is_passive_sideways_and_has_a_return_spring_forwards() {
    let robot = shipped("tulip");
    for (side, _) in SIDES {
        let roll = &robot.links[robot.find_link(&format!("{side}_ankle_x")).expect("a link")];
        assert!(roll.drive.is_none());
        let spring = roll.joint.spring.expect("a spring");
        assert_eq!(value(&robot, spring.stiffness, &[]), 300.0);
        assert_eq!(value(&robot, roll.joint.damping.expect("damping"), &[]), 5.0);
        let pitch = &robot.links[robot.find_link(&format!("{side}_ankle_y")).expect("a link")];
        let back = pitch.drive.and_then(|drive| drive.return_spring).expect("a return spring");
        assert_eq!(back.side, Side::Above);
        let stiffness = robot.dag.as_symbol(back.stiffness).expect("a parameter");
        assert_eq!(stiffness.name, format!("kr_{side}_ankle_y"));
    }
    let driven = robot.links.values().filter(|link| link.drive.is_some()).count();
    assert_eq!(driven, 10, "ten joints of TUlip have motors (thesis 2.3.2)");
}

#[test]
fn the_generated_base_moves_up_forward_left_and_turns_yaw_roll_pitch() {
    let robot = shipped("tulip");
    let q = [("q_base_z", 0.3), ("q_base_x", 0.5), ("q_base_y", -0.7)];
    let frame = pose(&robot, "base_pitch", &q);
    assert_near(frame.origin, [0.5, -0.7, 0.3], "the base");
    assert_near(frame.rotation[0], [1.0, 0.0, 0.0], "x is forward");
    assert_near(frame.rotation[2], [0.0, 0.0, 1.0], "z is up");
    let (s, c) = 0.4f64.sin_cos();
    for (joint, x, z) in [
        ("q_base_yaw", [c, s, 0.0], [0.0, 0.0, 1.0]),
        ("q_base_roll", [1.0, 0.0, 0.0], [0.0, -s, c]),
        ("q_base_pitch", [c, 0.0, -s], [s, 0.0, c]),
    ] {
        let frame = pose(&robot, "base_pitch", &[(joint, 0.4)]);
        assert_near(frame.turn([1.0, 0.0, 0.0]), x, joint);
        assert_near(frame.turn([0.0, 0.0, 1.0]), z, joint);
    }
}

#[test]
fn the_base_in_modified_convention_moves_the_same_way() {
    for (base, links) in [("floating", 6), ("planar_floating", 3)] {
        let text = |convention: &str| {
            format!(
                r#"{{"format": "denavit-model/1", "name": "brick", "convention": "{convention}",
                    "gravity": [0, 0, -9.81], "base": "{base}",
                    "links": [{{"name": "leg", "joint": {{"type": "revolute"}}}}]}}"#
            )
        };
        let q = [("q_base_z", 0.3), ("q_base_x", 0.5), ("q_base_y", 0.2), ("q_base_yaw", 0.7)];
        let q = [&q[..], &[("q_base_roll", -0.4), ("q_base_pitch", 0.9)]].concat();
        let standard = pose(&robot_of("s", &text("standard")), "base_pitch", &q);
        let robot = robot_of("m", &text("modified"));
        assert_eq!(robot.links.len(), links + 1);
        let modified = pose(&robot, "base_pitch", &q);
        assert_near(modified.origin, standard.origin, base);
        assert_near(modified.turn([1.0, 0.0, 0.0]), standard.turn([1.0, 0.0, 0.0]), base);
        // the floating base's modified frame lacks the last quarter turn: its z is the pitch axis
        let left = if base == "floating" { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
        assert_near(modified.turn([0.0, 0.0, 1.0]), standard.turn(left), base);
    }
}

#[test]
fn the_planar_biped_stands_straight_at_zero_and_bends_its_knees_backwards() {
    let robot = shipped("planar_biped");
    let hip = [("q_base_x", 0.2), ("q_base_z", 0.6)];
    let base = pose(&robot, "base_pitch", &hip);
    assert_near(
        base.place([0.196_869_273_06, 0.0, 0.0]),
        [0.2, 0.0, 0.6 + 0.196_869_273_06],
        "x is up",
    );
    for (contact, x) in [("right_heel", 0.14), ("left_toe", 0.35)] {
        let point = robot.contacts.values().find(|c| c.name == contact).expect("a contact");
        let frame = pose(&robot, &robot.links[point.link].name, &hip);
        let position = point.position.map(|entry| value(&robot, entry, &[]));
        assert_near(frame.place(position), [x, 0.0, 0.6 - 0.275 - 0.275 - 0.05], contact);
    }
    let bent = pose(&robot, "right_knee", &[("q_right_knee", 0.5)]).origin;
    assert!(bent[0] < -0.1 && bent[1].abs() < 1e-12, "the shin goes back: {bent:?}");
    // the lumped torso of the walking study: 2 x 8.594 kg 0.225 m above the hip, 4 x 0.614 kg in it
    let com = 2.0 * 8.594 * 0.225 / 19.644;
    let inertia = 2.0 * 0.20518
        + 4.0 * 0.00095
        + 2.0 * 8.594 * (0.225 - com) * (0.225 - com)
        + 4.0 * 0.614 * com * com;
    let torso = robot.links[robot.find_link("base_pitch").expect("the base")].body.expect("a body");
    assert!((value(&robot, torso.com[0], &[]) - com).abs() < 1e-11);
    assert!((value(&robot, torso.inertia[2], &[]) - inertia).abs() < 1e-11);
}

#[test]
fn the_panda_stands_as_its_maker_draws_it() {
    // frame 7 at zero: 0.088 m forward, 0.333 + 0.316 + 0.384 m up, z down
    let frame = pose(&shipped("panda"), "joint7", &[]);
    assert_near(frame.origin, [0.088, 0.0, 1.033], "the wrist");
    assert_near(frame.turn([0.0, 0.0, 1.0]), [0.0, 0.0, -1.0], "z");
}

#[test]
fn the_rx90_is_the_same_arm_in_standard_form() {
    let text = r#"{"format": "denavit-model/1", "name": "rx90_standard", "convention": "standard",
        "gravity": [0, 0, -9.81], "links": [
        {"name": "j1", "joint": {"type": "revolute", "alpha": "pi/2"}},
        {"name": "j2", "joint": {"type": "revolute", "a": 0.45}},
        {"name": "j3", "joint": {"type": "revolute", "alpha": "-pi/2"}},
        {"name": "j4", "joint": {"type": "revolute", "alpha": "pi/2", "d": 0.45}},
        {"name": "j5", "joint": {"type": "revolute", "alpha": "-pi/2"}},
        {"name": "j6", "joint": {"type": "revolute"}}]}"#;
    let q = [
        ("q_j1", 0.3),
        ("q_j2", -1.1),
        ("q_j3", 0.7),
        ("q_j4", 2.0),
        ("q_j5", 0.4),
        ("q_j6", -0.9),
    ];
    let modified = shipped("rx90");
    assert_eq!(modified.convention, Convention::Modified);
    let (found, expected) = (pose(&modified, "j6", &q), pose(&robot_of("rx90", text), "j6", &q));
    assert_near(found.origin, expected.origin, "the wrist");
    for row in 0..3 {
        assert_near(found.rotation[row], expected.rotation[row], "the hand");
    }
}

#[test]
fn pumas_motor_side_data_give_the_known_joint_side_values() {
    let robot = shipped("puma560");
    // rotor inertia, viscous and Coulomb friction referred to the joint
    let expected = [
        [0.784029969, 5.801821768, 27.2358285],
        [2.324814845, 9.496868642, 13.58469],
        [0.576873332, 3.98042599, 7.0892316],
        [0.190790626, 0.41164523, 1.28501516],
        [0.170706292, 0.427283021, 1.0428835],
        [0.194064506, 0.215823253, 0.805203],
    ];
    for (link, expected) in robot.links.values().zip(expected) {
        let drive = link.drive.expect("a motor");
        let of = |entry: Option<_>| value(&robot, entry.expect("an entry"), &[]);
        let ratio = of(drive.gear_ratio);
        let found = [
            ratio * ratio * of(drive.rotor_inertia),
            ratio * ratio * of(drive.viscous),
            ratio.abs() * of(drive.coulomb),
        ];
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-8 * expected, "{}: {found}", link.name);
        }
    }
}

#[test]
fn the_double_pendulum_is_written_in_the_symbols_of_the_thesis() {
    let robot = shipped("double_pendulum");
    let names: Vec<&str> = robot.parameters.values().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["l1", "l2", "g", "m1", "c1", "I1", "m2", "c2", "I2"]);
    let zero = robot.dag.zero();
    for (index, link) in robot.links.values().enumerate() {
        let body = link.body.expect("a body");
        let symbol = |expr| robot.dag.as_symbol(expr).map(|symbol| symbol.name.clone());
        assert_eq!(symbol(body.mass), Some(format!("m{}", index + 1)));
        assert_eq!(symbol(body.inertia[2]), Some(format!("I{}", index + 1)));
        let rest = [&body.com[1..], &body.inertia[..2], &body.inertia[3..]].concat();
        assert!(rest.iter().all(|&entry| entry == zero), "everything else is exactly 0");
    }
    // c1 - l1 with the shipped values
    let first = robot.links.values().next().and_then(|link| link.body).expect("a body");
    assert!((value(&robot, first.com[0], &[]) - (0.28 - 0.5)).abs() < 1e-15);
    let down = robot.gravity.map(|entry| value(&robot, entry, &[]));
    assert_eq!(down, [0.0, -9.81, 0.0]);
    assert!(robot.links.values().all(|link| link.joint.kind == JointKind::Revolute));
}
