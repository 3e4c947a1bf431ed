//! What entries of a file become: parameters in their order, or expressions.

use super::{fixture, robot_of};
use denavit_codegen::expr::text::print;
use denavit_codegen::model::{
    BodyEntry, EffectPlace, JointEntry, Parameter, Robot, Role, TorqueSide,
};
use denavit_codegen::number::{integer, ratio};

fn crane() -> Robot {
    let text = std::fs::read_to_string(fixture("broken/base.json")).expect("the base");
    robot_of("base.json", &text)
}

fn parameter<'r>(robot: &'r Robot, name: &str) -> &'r Parameter {
    &robot.parameters[robot.find_parameter(name).expect("a parameter")]
}

#[test]
fn parameters_come_as_constants_unknowns_bodies_and_joints() {
    let robot = crane();
    let names: Vec<&str> = robot.parameters.values().map(|p| p.name.as_str()).collect();
    let body = |link: &str| {
        ["m", "cx", "cy", "cz", "Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz"]
            .map(|prefix| format!("{prefix}_{link}"))
    };
    let mut expected: Vec<String> = ["g", "boom", "reach", "load"].map(str::to_owned).into();
    expected.extend(body("column"));
    // the arm's centre of mass is written in constants along x: it is no parameter
    expected.extend(body("arm").into_iter().filter(|name| name != "cx_arm"));
    expected.extend(["fv_column"].map(str::to_owned));
    expected.extend(
        ["fv", "fc", "Ia", "N", "k", "rm", "rl", "kr", "qr", "ks", "qs"]
            .map(|prefix| format!("{prefix}_arm")),
    );
    assert_eq!(names, expected);
}

#[test]
fn numbers_are_defaults_and_names_are_expressions() {
    let robot = crane();
    let value = |name: &str| {
        let default = parameter(&robot, name).default.expect("a value");
        robot.dag.as_constant(default).cloned().expect("a number")
    };
    assert_eq!(value("g"), ratio(981, 100));
    assert_eq!(value("reach"), integer(3), "2*boom, evaluated");
    assert_eq!(value("m_column"), integer(30));
    assert_eq!(value("Ixy_column"), integer(0), "an entry that is left out is 0 by default");
    assert_eq!(value("Ia_arm"), ratio(1, 10_000));
    let arm = &robot.links[robot.find_link("arm").expect("a link")];
    let com = arm.body.expect("a body").com;
    assert_eq!(print(&robot.dag, com[0]), "-boom/2");
    assert_eq!(robot.dag.as_symbol(com[1]).expect("a symbol").name, "cy_arm");
    // the hook's body is written in an unknown: what is not written is exactly 0
    let hook = robot.links[robot.find_link("hook").expect("a link")].body.expect("a body");
    assert_eq!(robot.dag.as_symbol(hook.mass).expect("a symbol").name, "load");
    assert_eq!(hook.inertia, [robot.dag.zero(); 6]);
    let slide = &robot.links[robot.find_link("slide").expect("a link")];
    assert!(slide.body.is_none(), "a link without body is massless");
    assert_eq!(robot.dag.as_constant(slide.joint.d), Some(&ratio(1, 10)));
}

#[test]
fn roles_units_and_known_sides_are_stated() {
    let robot = crane();
    let arm = robot.find_link("arm").expect("a link");
    let mass = parameter(&robot, "m_arm");
    assert_eq!(mass.role, Role::Body(arm, BodyEntry::Mass));
    assert!(!mass.known);
    let std = mass.std.and_then(|std| robot.dag.as_constant(std).cloned());
    assert_eq!(std, Some(ratio(1, 2)));
    let known: Vec<&str> = robot
        .parameters
        .values()
        .filter(|p| p.known && p.role != Role::Constant)
        .map(|p| p.name.as_str())
        .collect();
    assert_eq!(known, ["N_arm", "rm_arm", "rl_arm", "qr_arm", "qs_arm"]);
    let unit = |name: &str| parameter(&robot, name).unit.clone().expect("a unit").to_string();
    assert_eq!(parameter(&robot, "k_arm").role, Role::Joint(arm, JointEntry::SeriesStiffness));
    assert_eq!(
        ["k_arm", "kr_arm", "fv_arm", "Izz_arm", "load"].map(unit),
        ["N/m", "N m/rad", "N m s/rad", "kg m^2", "kg"]
    );
    assert_eq!(robot.torque_side, TorqueSide::Joint);
    assert!(robot.terms.gravity && !robot.terms.coriolis, "the file lists two terms");
}

#[test]
fn a_sliding_joint_has_forces_where_a_turning_one_has_torques() {
    let robot = robot_of(
        "slide",
        r#"{"format": "denavit-model/1", "name": "slide", "convention": "standard",
            "gravity": [0, 0, 0], "links": [
            {"name": "direct", "joint": {"type": "prismatic"}},
            {"name": "geared", "joint": {"type": "prismatic", "spring": {"stiffness": 2}}}],
            "drives": {"direct": {"rotor_inertia": 3, "viscous": 1, "coulomb": 1},
                       "geared": {"gear_ratio": 200, "rotor_inertia": 3, "viscous": 1,
                                  "offset": 1}}}"#,
    );
    let units: Vec<(String, String)> = robot
        .parameters
        .values()
        .map(|p| (p.name.clone(), p.unit.clone().expect("a unit").to_string()))
        .collect();
    let expected = [
        ("fv_direct", "N s/m"),
        ("fc_direct", "N"),
        ("Ia_direct", "kg"),
        ("fv_geared", "N m s/rad"),
        ("Ia_geared", "kg m^2"),
        ("off_geared", "N"),
        ("N_geared", "rad/m"),
        ("ks_geared", "N/m"),
    ]
    .map(|(name, unit)| (name.to_owned(), unit.to_owned()));
    assert_eq!(units, expected);
}

#[test]
fn limits_points_and_effects_are_kept() {
    let robot = crane();
    let column = &robot.links[robot.find_link("column").expect("a link")];
    let texts = |ends: [_; 2]| ends.map(|end| print(&robot.dag, end));
    assert_eq!(texts(column.limits.position.expect("limits")), ["-pi", "pi"]);
    assert_eq!(texts(column.limits.torque.expect("limits")), ["-50", "80"]);
    assert_eq!(robot.contacts.len(), 1);
    assert_eq!(robot.bodies_that_must_not_touch.len(), 1);
    assert_eq!(robot.effects[0].at, EffectPlace::Link(robot.find_link("arm").expect("a link")));
    assert!(matches!(robot.effects[1].at, EffectPlace::Contact(_)));
    assert_eq!(robot.effects[2].at, EffectPlace::Model);
    let roll = robot.effects[2].parameters[0].value;
    assert_eq!(robot.dag.as_constant(roll), Some(&ratio(1, 100)));
}

#[test]
fn values_of_effects_may_state_how_sure_they_are() {
    let arm = |value: &str| {
        let text = format!(
            r#"{{"format": "denavit-model/1", "name": "arm", "convention": "standard",
                "gravity": [0, 0, -10], "links": [{{"name": "a", "joint": {{"type": "revolute"}}}}],
                "effects": [{{"effect": "viscous", "at": {{"link": "a"}},
                              "parameters": {{"fv": {value}}}}}]}}"#
        );
        denavit_codegen::effect::read_model("arm.json", text.as_bytes(), &[])
    };
    let robot = arm(r#"{"value": "1/2", "std": 0.25}"#).expect("a sound model");
    let own = robot.parameters.values().find(|one| one.name == "fv_viscous_a").expect("it");
    let number = |value: Option<_>| robot.dag.as_constant(value.expect("a number")).cloned();
    assert_eq!([own.default, own.std].map(number), [Some(ratio(1, 2)), Some(ratio(1, 4))]);
    for (value, said) in [
        (r#"{"value": 1, "std": -0.25}"#, "standard deviation"),
        (r#"{"std": 0.25}"#, "value"),
        (r#"{"value": 1, "known": true}"#, "known"),
    ] {
        let error = arm(value).expect_err(value).to_string();
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn the_hash_follows_the_content() {
    let text = std::fs::read_to_string(fixture("broken/base.json")).expect("the base");
    let reference = crane().hash;
    let spaced = text.replace("  ", "\t").replace("1e-4", "0.0001");
    assert_eq!(robot_of("base.json", &spaced).hash, reference);
    let heavier = text.replace("\"mass\": 30", "\"mass\": 31");
    assert_ne!(robot_of("base.json", &heavier).hash, reference);
}
