//! The regressor and the base parameters against tables, closed forms and other formulations.

mod closed_forms;
mod counts;
mod files;
mod joint_basis;
mod laws;
mod messages;
mod oracle;

use denavit_codegen::model::{self, Robot};
use denavit_codegen::regressor::{BaseParameters, RegressorOptions, base_parameters};
use serde_json::{Value, json};

/// The rigid robot: nothing in the joints.
fn rigid(mut robot: Robot) -> Robot {
    for link in robot.links.values_mut() {
        (link.drive, link.joint.spring, link.joint.damping) = (None, None, None);
    }
    robot
}

const INERTIAL: RegressorOptions = RegressorOptions {
    friction: false,
    rotor: false,
    offset: false,
    only_modelled: false,
    unknowns: denavit_codegen::regressor::Unknowns::Parameters,
};

fn base(robot: &Robot, options: RegressorOptions) -> BaseParameters {
    base_parameters(robot, options, &[]).unwrap_or_else(|error| panic!("{}: {error}", robot.name))
}

/// Type, a, alpha, d, parent.
type Row<'a> = (&'a str, &'a str, &'a str, &'a str, Option<usize>);

/// A robot of such rows, standard convention, with full inertias.
fn tree(name: &str, gravity: [&str; 3], rows: &[Row<'_>]) -> Robot {
    let mut constants = serde_json::Map::new();
    let mut links = Vec::new();
    for (index, (kind, a, alpha, d, parent)) in rows.iter().enumerate() {
        for text in [a, alpha, d] {
            let is_name = text.starts_with(char::is_alphabetic)
                && text.chars().all(char::is_alphanumeric)
                && *text != "pi";
            if is_name {
                let unit = if text.starts_with("al") { "rad" } else { "m" };
                constants.insert((*text).to_owned(), json!({"value": 0.5, "unit": unit}));
            }
        }
        let mut link = json!({
            "name": format!("l{index}"),
            "joint": {"type": kind, "a": a, "alpha": alpha, "d": d},
            "body": {"mass": 1, "com": [0, 0, 0], "inertia": {"xx": 1, "yy": 1, "zz": 1}},
        });
        link["body"]["about"] = json!("com");
        link["parent"] = match parent {
            Some(parent) => json!(format!("l{parent}")),
            None => json!("base"),
        };
        links.push(link);
    }
    for component in gravity {
        let component = component.trim_start_matches('-');
        if component.chars().next().is_some_and(char::is_alphabetic) {
            constants.insert(component.to_owned(), json!({"value": 9.81, "unit": "m/s^2"}));
        }
    }
    let file: Value = json!({
        "format": "denavit-model/1",
        "name": name,
        "description": "of the tests",
        "source": "made up",
        "convention": "standard",
        "gravity": gravity,
        "constants": constants,
        "links": links,
    });
    let text = serde_json::to_vec(&file).unwrap();
    model::read(name, &text).unwrap_or_else(|error| panic!("{error}"))
}
