//! Exact aliases, against what mechanics says of them.

use super::robots::load as robot;
use denavit_codegen::alias::{ExactAliases, Named};
use denavit_codegen::effect;
use denavit_codegen::model::Robot;

fn parameters(robot: &Robot, effect: &str, at: &str) -> Vec<String> {
    let aliases = ExactAliases::new(robot, effect::catalogue()).expect("a regressor");
    aliases.of_parameters(Named { effect, at })
}

/// PUMA: the first axis is vertical and fixed. It is the y axis of the frame of
/// its link, which standard rows turn by alpha behind the joint.
#[test]
fn rotors_at_the_first_axes_are_inertia_of_their_links_and_others_are_not() {
    let puma = robot("puma560");
    let joints: Vec<String> =
        puma.joints().map(|(link, _)| puma.links[link].name.clone()).collect();
    // Rotors are parameters of the model's own: without them only inertia can stand for one.
    let terms = denavit_codegen::model::Terms { rotor: false, ..puma.terms };
    let bare = Robot { terms, ..puma.clone() };
    let first = parameters(&bare, "rotor_inertia", &joints[0]);
    assert_eq!(first, [format!("Iyy_{}", joints[0])]);
    // The second axis is perpendicular to the first and stays so: moments about it are felt there
    // alone. The third is parallel to it.
    let second = parameters(&bare, "rotor_inertia", &joints[1]);
    assert!(!second.is_empty() && second.iter().all(|name| name.ends_with(&joints[1])));
    for joint in &joints[2..] {
        assert_eq!(parameters(&bare, "rotor_inertia", joint), [""; 0], "{joint}");
    }
}

/// What a link carries is matter of the link: all ten parameters, or a point of it.
#[test]
fn a_payload_is_an_alias_of_its_link() {
    let puma = robot("puma560");
    let last = puma.links.values().last().expect("a link").name.clone();
    for effect in ["payload", "payload_point", "link_parameters"] {
        let found = parameters(&puma, effect, &last);
        assert!(found.contains(&format!("m_{last}")) || found.contains(&format!("mx_{last}")));
        assert!(found.iter().all(|name| name.ends_with(&last)), "{found:?}");
    }
    let aliases = ExactAliases::new(&puma, effect::catalogue()).expect("a regressor");
    let at = |effect| Named { effect, at: &last };
    assert!(aliases.are_alike(at("payload"), at("link_parameters")));
    assert!(!aliases.are_alike(at("viscous"), at("quadratic_drag")));
    // Friction that the model has is its own parameter; what it has not is none.
    assert_eq!(parameters(&puma, "coulomb", &last), [format!("fc_{last}")]);
    assert_eq!(parameters(&puma, "quadratic_drag", &last), [""; 0]);
    assert_eq!(parameters(&puma, "stribeck", &last), [""; 0]);
}

/// Where an axis that slides is vertical, weight is a constant force; where it is horizontal, an
/// offset is nothing that a body does.
#[test]
fn an_offset_is_weight_where_gravity_is_constant_along_an_axis() {
    let model = |gravity: &str, drives: &str| {
        let text = format!(
            r#"{{"format": "denavit-model/1", "name": "lift", "convention": "standard",
            "gravity": {gravity}, "links": [{{"name": "cage",
            "joint": {{"type": "prismatic", "theta": 0, "d": 0, "a": 0, "alpha": 0}},
            "body": {{"mass": 2, "com": [0, 0, 0], "inertia": {{"xx": 1, "yy": 1, "zz": 1,
            "xy": 0, "xz": 0, "yz": 0}}, "about": "com"}}}}], "drives": {drives}}}"#
        );
        denavit_codegen::model::read("lift", text.as_bytes()).expect("a model")
    };
    let (up, along) = ("[0, 0, -9.81]", "[0, -9.81, 0]");
    let rotor = r#"{"cage": {"rotor_inertia": 0.1, "viscous": 3}}"#;
    // m (qdd + g): the offset alone is not m g, since the same m is in m qdd; with a rotor, which
    // is in nothing but that, it is.
    assert_eq!(parameters(&model(up, "{}"), "torque_offset", "cage"), [""; 0]);
    let both = parameters(&model(up, rotor), "torque_offset", "cage");
    assert_eq!(both, ["m_cage", "Ia_cage"]);
    assert_eq!(parameters(&model(along, rotor), "torque_offset", "cage"), [""; 0]);
    // A gain scales everything, as all parameters together do.
    assert_eq!(parameters(&model(up, "{}"), "torque_gain", "cage"), ["m_cage"]);
    let all = parameters(&model(up, rotor), "torque_gain", "cage");
    assert_eq!(all, ["m_cage", "fv_cage", "Ia_cage"]);
}

/// What scales one torque alone leaves those that the same bodies make elsewhere.
#[test]
fn the_gain_of_one_joint_of_an_arm_is_nothing_that_bodies_do() {
    let arm = robot("planar_2r");
    let [first, last] = [0, 1].map(|k| {
        let (link, _) = arm.joints().nth(k).expect("two joints");
        arm.links[link].name.clone()
    });
    assert_eq!(parameters(&arm, "torque_gain", &first), [""; 0]);
    assert_eq!(parameters(&arm, "torque_gain", &last), [""; 0]);
    // A term that is left out is no body's.
    let terms = denavit_codegen::model::Terms { coriolis: false, ..arm.terms };
    assert_eq!(parameters(&Robot { terms, ..arm }, "coriolis", "model"), [""; 0]);
}
