//! What a refusal and a certificate say of the model.

use super::{INERTIAL, base, tree};
use crate::robots::load;
use denavit_codegen::model;
use denavit_codegen::regressor::{
    BaseError, Certificate, ParameterGroup, RegressorOptions, base_parameters,
};
use serde_json::json;

fn arm(base: &str, second: serde_json::Value) -> model::Robot {
    let body = json!({"mass": 1, "com": [0, 0, 0], "about": "com",
        "inertia": {"xx": 1, "yy": 1, "zz": 1}});
    let file = json!({
        "format": "denavit-model/1", "name": "arm", "convention": "standard", "base": base,
        "gravity": [0, 0, "-g"], "constants": {"g": 9.81, "l": 0.5},
        "links": [
            {"name": "one", "joint": {"type": "revolute", "a": 1, "alpha": "pi/2"}, "body": body},
            {"name": "two", "joint": second, "body": body},
            {"name": "three", "joint": {"type": "revolute", "a": 1}, "body": body},
        ],
    });
    model::read("arm.json", &serde_json::to_vec(&file).unwrap()).unwrap()
}

#[test]
fn an_entry_without_exact_form_is_named_with_its_place_and_a_way_out() {
    let second = json!({"type": "revolute", "a": "1/(1 + l)"});
    let robot = arm("fixed", second.clone());
    let error = base_parameters(&robot, INERTIAL, &[]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "arm: /links/1/joint/a: a = 1/(l + 1) of link `two` has no exact form: division by a sum \
         or a sine: only products of symbols divide here\n  hint: declare what it says as a \
         constant of its own, or take the model's numbers for lengths, angles and gravity"
    );
    let BaseError::Inexact { entry, .. } = error else { panic!("{error}") };
    assert_eq!((entry.pointer.as_str(), entry.link.as_deref()), ("/links/1/joint/a", Some("two")));
    // the generated joints of a base are no links of the file
    let floating = base_parameters(&arm("floating", second), INERTIAL, &[]).unwrap_err();
    assert!(floating.to_string().starts_with("arm: /links/1/joint/a: "), "{floating}");
    // and the way out is one
    let numeric = model::bake_geometry(&robot).unwrap();
    assert!(base_parameters(&numeric, INERTIAL, &[]).is_ok());
}

#[test]
fn a_certificate_says_what_it_is_about() {
    use ParameterGroup::{Bodies, Friction, Offset, Rotor};
    let about = |name: &str, options: RegressorOptions| {
        let robot = load(name);
        Certificate::new(&robot, options, &base(&robot, options), false).about()
    };
    assert_eq!(about("puma560", INERTIAL), [Bodies]);
    let all = RegressorOptions { friction: true, rotor: true, offset: true, ..INERTIAL };
    assert_eq!(about("puma560", all), [Bodies, Friction, Rotor, Offset]);
    // asked for, but not there: the arm has no drives
    assert_eq!(about("planar_2r", RegressorOptions { only_modelled: true, ..all }), [Bodies]);
    // what was not added is matter, whatever its name is
    let robot = tree("plain", ["0", "0", "-g"], &[("revolute", "a0", "0", "0", None)]);
    let mut certificate = Certificate::new(&robot, INERTIAL, &base(&robot, INERTIAL), false);
    certificate.columns[0] = "fv_load".to_owned();
    assert_eq!(certificate.about(), [Bodies]);
}
