//! What becomes of the parts of an MJCF: against plain composition and masses computed by hand.

use crate::evaluated::{called, frame, imported, moved, off, times, turned};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::Robot;
use denavit_import::{Options, import, nothing_included};
use std::f64::consts::PI;

const HOPPER: &str = include_str!("../robots/hopper.xml");
const Y: [f64; 3] = [0.0, 1.0, 0.0];

fn hopper() -> Robot {
    imported(HOPPER, &Options::default())
}

fn value(robot: &Robot, name: &str) -> f64 {
    let parameter = robot.find_parameter(name).unwrap_or_else(|| panic!("{name}"));
    let default = robot.parameters[parameter].default.expect("a value");
    denavit_codegen::program::constant_values(&robot.dag, &[default])[0]
}

#[test]
fn frames_are_those_of_bodies() {
    let robot = hopper();
    let names: Vec<&str> =
        robot.joints().map(|(link, _)| robot.links[link].name.as_str()).collect();
    assert_eq!(names, ["root_z", "root_pitch", "hip", "knee", "bend"]);
    let q = [0.2, 0.3, -0.4, 0.5, 0.6];
    let about = |pos: [f64; 3], axis, angle| {
        times(&times(&moved(pos), &turned(axis, angle)), &moved(pos.map(|x| -x)))
    };
    let torso =
        times(&moved([0.0, 0.0, 1.2]), &about([0.0, 0.0, 0.1], Y, q[1] - 10.0 * PI / 180.0));
    assert!(off(&frame(&robot, &q, "torso"), &torso) < 1e-14);
    let thigh = times(&moved([0.0, 0.1, -0.3]), &turned([0.0, 0.0, 1.0], PI / 6.0));
    let thigh = times(&times(&torso, &thigh), &about([0.0, 0.0, 0.05], Y, q[2]));
    assert!(off(&frame(&robot, &q, "thigh"), &thigh) < 1e-14);
    // the quaternion (0.8, 0, 0.6, 0) turns about y
    let shin = times(&moved([0.1, 0.0, -0.4]), &turned(Y, 2.0 * 0.6_f64.atan2(0.8)));
    let shin = times(&times(&thigh, &shin), &turned([0.0, 1.0, 0.2], q[3]));
    assert!(off(&frame(&robot, &q, "shin"), &shin) < 1e-14);
    let antenna = times(&moved([0.0, 0.0, 0.1]), &turned(Y, PI / 2.0));
    let antenna = times(&times(&torso, &antenna), &moved([0.5, 0.0, 0.0]));
    let antenna = times(&antenna, &turned([0.0, 0.0, 1.0], q[4]));
    let own = if robot.find_link("antenna").is_some() { "antenna" } else { "bend" };
    assert!(off(&frame(&robot, &q, own), &antenna) < 1e-14);
}

#[test]
fn masses_are_those_of_shapes() {
    let robot = hopper();
    let box_mass = 500.0 * 8.0 * 0.1 * 0.2 * 0.3;
    assert!((value(&robot, "m_torso") - (box_mass + 1.5)).abs() < 1e-12);
    let height = 0.4 * 1.5 / (box_mass + 1.5);
    assert!((value(&robot, "cz_torso") - height).abs() < 1e-14);
    let about = box_mass * (0.04 + 0.01) / 3.0 + 0.4 * 1.5 * 0.01;
    assert!((value(&robot, "Izz_torso") - about).abs() < 1e-13);
    let (r, h) = (0.04_f64, 0.17_f64.sqrt());
    let capsule = 500.0 * PI * (r * r * h + 4.0 / 3.0 * r * r * r);
    assert!((value(&robot, "m_thigh") - capsule).abs() < 1e-12);
    let own = if robot.find_link("antenna").is_some() { "antenna" } else { "bend" };
    let cylinder = 500.0 * PI * 0.01 * 0.01 * 0.4;
    assert!((value(&robot, &format!("Izz_{own}")) - cylinder * 0.00005).abs() < 1e-14);
    // an inertial of its own counts, whatever its mesh weighs
    assert_eq!(value(&robot, "m_shin"), 2.0);
    let (c, s) = (0.96 / 1.04, 0.4 / 1.04);
    let yy = 0.02 * c * c + 0.004 * s * s;
    assert!((value(&robot, "Iyy_shin") - yy).abs() < 1e-15);
}

#[test]
fn joints_have_what_defaults_and_they_say() {
    let robot = hopper();
    assert_eq!(value(&robot, "Ia_hip"), 0.02);
    assert_eq!(value(&robot, "fc_hip"), 0.3);
    assert_eq!(value(&robot, "ks_hip"), 20.0);
    assert!((value(&robot, "qs_hip") - 15.0 * PI / 180.0).abs() < 1e-16);
    assert!(robot.find_parameter("fv_root_z").is_none(), "0 is no damping");
    let knee = robot.links[robot.find_link("knee").expect("the joint")].limits;
    let ends = knee.position.expect("a range");
    let ends = denavit_codegen::program::constant_values(&robot.dag, &ends);
    assert!((ends[0] + PI / 3.0).abs() < 1e-15 && (ends[1] - PI / 2.0).abs() < 1e-15);
    assert!(robot.links[robot.find_link("root_pitch").expect("it")].limits.position.is_none());
}

#[test]
fn balls_and_free_bodies_are_three_and_six_joints() {
    let text = "<mujoco><worldbody><body name=\"b\"><freejoint name=\"f\"/><geom size=\"0.1\"/>\
                <body name=\"c\" pos=\"0 0 1\">\
                <joint name=\"ball\" type=\"ball\"/><geom size=\"0.1\"/></body>\
                </body></worldbody></mujoco>";
    let robot = imported(text, &Options::default());
    assert_eq!(robot.degrees_of_freedom(), 9);
    assert_eq!(robot.base, denavit_codegen::model::Base::Floating);
    let mass = called(&robot, FunctionName::MassMatrix, &[&[0.0; 9]]);
    let sphere = 1000.0 * 4.0 / 3.0 * PI * 0.001;
    assert!((mass[0] - 2.0 * sphere).abs() < 1e-12);
    assert!((mass[9 * 8 + 8] - 0.4 * sphere * 0.01).abs() < 1e-14);
}

#[test]
fn what_is_no_tree_is_refused_by_name() {
    let said = |text: &str| {
        let text = text.replace("</mujoco>", "") + "</mujoco>";
        let refused = import("h.xml", text.as_bytes(), &Options::default(), &mut nothing_included);
        refused.expect_err("a fault").to_string()
    };
    let with = |more: &str| said(&HOPPER.replace("</worldbody>", &format!("</worldbody>{more}")));
    let equality = "<equality><connect name=\"loop\" body1=\"shin\" anchor=\"0 0 0\"/></equality>";
    assert!(with(equality).contains("equality constraint `loop` (connect) closes a loop"));
    let tendon = "<tendon><fixed name=\"t\" stiffness=\"3\">\
                  <joint joint=\"hip\" coef=\"1\"/></fixed></tendon>";
    assert!(with(tendon).contains("the tendon `t` has stiffness"));
    let mesh = HOPPER
        .replace("<inertial pos", "<site pos")
        .replace("type=\"mesh\"", "type=\"mesh\" size=\"1\"");
    assert!(said(&mesh).contains("mass of body `shin` is that of a mesh"));
    assert!(
        said(&HOPPER.replace("type=\"slide\"", "type=\"ball\" stiffness=\"1\""))
            .contains("three hinges")
    );
    let replicate = HOPPER.replace("<frame ", "<replicate count=\"3\"/><frame ");
    assert!(said(&replicate).contains("<replicate> is not read"));
}

#[test]
fn what_a_model_has_not_is_left_out_with_a_note() {
    let text = "<mujoco><option density=\"1.2\" viscosity=\"0\"/>\
                <default><general biastype=\"affine\"/></default><worldbody><body name=\"arm\">\
                <joint name=\"j\"/><geom size=\"0.1\"/></body></worldbody><actuator>\
                <position name=\"servo\" joint=\"j\" kp=\"10\"/><motor name=\"plain\" joint=\"j\"/>\
                <general joint=\"j\" biasprm=\"0 -1 0\"/>\
                <general name=\"passes\" joint=\"j\" biastype=\"none\"/>\
                <adhesion name=\"sucker\" body=\"arm\"/></actuator></mujoco>";
    let found = import("a.xml", text.as_bytes(), &Options::default(), &mut nothing_included);
    let notes = found.expect("a tree").notes;
    let of = |word: &str| notes.iter().find(|note| note.contains(word)).expect(word);
    assert!(of("fluid").contains("`density`") && !of("fluid").contains("viscosity"), "{notes:?}");
    let gains = of("controller file");
    assert!(gains.contains("`servo`, `j`, `sucker`"), "{notes:?}");
    assert!(!gains.contains("plain") && !gains.contains("passes"), "{notes:?}");
}

/// MuJoCo's own reading: sizes that a geom does not give are those of its class.
#[test]
fn a_geom_keeps_the_sizes_of_its_class_behind_its_own() {
    let mass = |class: &str, size: &str| {
        let text = format!(
            "<mujoco><default>{class}</default><worldbody><body name=\"arm\"><joint name=\"arm\"/>\
             <geom type=\"capsule\" size=\"{size}\"/></body></worldbody></mujoco>"
        );
        value(&imported(&text, &Options::default()), "m_arm")
    };
    let whole = mass("", "0.05 0.3");
    assert_eq!(mass("<geom size=\"0.1 0.3\"/>", "0.05"), whole);
    assert_eq!(mass("<geom size=\"0.1 0.7\"/>", "0.05 0.3"), whole);
}
