//! From rows and numbers to the text of a model file.

use crate::exact::written;
use crate::fault::{clip, listed};
use crate::json::Json;
use crate::layout::{Layout, PlacedRow};
use crate::names::identifier;
use crate::tree::{Motion, Tree, TreeBody, TreeContact, TreeDrive, TreeJoint};
use denavit_codegen::model::{FORMAT, Unphysical};
use denavit_codegen::number::Rational;
use num_traits::{Signed, Zero};

/// The name of the strength of gravity.
const GRAVITY: &str = "g";

/// The text of the model file.
pub(crate) fn text(tree: &Tree, layout: &Layout) -> String {
    let mut notes = tree.notes.clone();
    if !layout.changed.is_empty() {
        let changed: Vec<String> =
            layout.changed.iter().map(|(from, to)| format!("{from} as {to}")).collect();
        notes.push(format!(
            "names are letters, digits and underscores, each once: {}",
            listed(&changed)
        ));
    }
    let mut file = vec![
        ("format", Json::text(FORMAT)),
        ("name", Json::text(identifier(&tree.name))),
        ("description", Json::text(clip(&tree.description))),
        ("assumptions", Json::List(notes.into_iter().map(Json::Text).collect())),
        ("convention", Json::text("modified")),
    ];
    gravity(tree, &mut file);
    if tree.floats {
        file.push(("base", Json::text("floating")));
    }
    let rows = layout.rows.iter().enumerate();
    let links = rows.map(|(at, row)| link(tree, row, at.checked_sub(1).map(|at| &layout.rows[at])));
    file.push(("links", Json::List(links.collect())));
    let drives: Vec<(String, Json)> =
        layout.rows.iter().filter_map(|row| drive(tree, row)).collect();
    if !drives.is_empty() {
        file.push(("drives", Json::Named(drives)));
    }
    let contacts: Vec<Json> = tree.contacts.iter().map(|point| contact(layout, point)).collect();
    if !contacts.is_empty() {
        file.push(("contacts", Json::List(contacts)));
    }
    Json::Object(file).file()
}

/// A constant where gravity acts along an axis, numbers elsewhere.
fn gravity(tree: &Tree, file: &mut Vec<(&'static str, Json)>) {
    let along: Vec<usize> = (0..3).filter(|&axis| !tree.gravity[axis].is_zero()).collect();
    if let [axis] = along[..] {
        let strength = &tree.gravity[axis];
        let value = Json::scalar(written(&strength.abs()));
        let constant =
            vec![("value", value), ("unit", Json::text("m/s^2")), ("doc", Json::text("gravity"))];
        let entries = (0..3).map(|k| match k == axis {
            true if strength.is_negative() => Json::text(format!("-{GRAVITY}")),
            true => Json::text(GRAVITY),
            false => Json::Raw("0".to_owned()),
        });
        file.push(("gravity", Json::List(entries.collect())));
        file.push(("constants", Json::Named(vec![(GRAVITY.to_owned(), Json::Object(constant))])));
    } else {
        file.push(("gravity", numbers(&tree.gravity)));
    }
}

fn numbers(values: &[Rational]) -> Json {
    Json::List(values.iter().map(|value| Json::scalar(written(value))).collect())
}

fn link(tree: &Tree, row: &PlacedRow, before: Option<&PlacedRow>) -> Json {
    let mut link = vec![("name", Json::text(&row.name))];
    let follows = row.parent.as_ref() == before.map(|row| &row.name);
    if !follows {
        link.push(("parent", Json::text(row.parent.as_deref().unwrap_or("base"))));
    }
    let moving = row.joint_of.and_then(|link| tree.links[link].joint.as_ref());
    link.push(("joint", joint(row, moving)));
    if let Some(moving) = moving {
        let limits = limits(moving);
        if !limits.is_empty() {
            link.push(("limits", Json::Object(limits)));
        }
    }
    if let Some(found) = row.body_of.and_then(|link| tree.links[link].body.as_ref()) {
        link.push(("body", body(found)));
    }
    Json::Object(link)
}

fn joint(row: &PlacedRow, moving: Option<&TreeJoint>) -> Json {
    let kind = match moving.map(|joint| joint.motion) {
        None => "fixed",
        Some(Motion::Turns) => "revolute",
        Some(Motion::Slides) => "prismatic",
    };
    let mut joint = vec![("type", Json::text(kind))];
    let made = &row.row;
    let entries = [
        ("a", written(&made.a)),
        ("alpha", made.alpha.text()),
        ("d", written(&made.d)),
        ("theta", made.theta.text()),
    ];
    let given = entries.into_iter().filter(|(_, text)| text != "0");
    joint.extend(given.map(|(key, text)| (key, Json::scalar(text))));
    if let Some(moving) = moving {
        let drive = &moving.drive;
        if let Some(stiffness) = &drive.stiffness {
            let mut spring = vec![("stiffness", Json::scalar(stiffness.clone()))];
            let angle = drive.spring_angle.iter();
            spring.extend(angle.map(|angle| ("angle", Json::scalar(angle.clone()))));
            joint.push(("spring", Json::Object(spring)));
        }
        if let Some(viscous) = drive.viscous.as_ref().filter(|_| !has_drive(drive)) {
            joint.push(("damping", Json::scalar(viscous.clone())));
        }
    }
    Json::Object(joint)
}

fn limits(joint: &TreeJoint) -> Vec<(&'static str, Json)> {
    let limits = &joint.limits;
    let range = |ends: &[String; 2]| Json::List(ends.iter().cloned().map(Json::scalar).collect());
    let mut found = Vec::new();
    found.extend(limits.position.as_ref().map(|ends| ("position", range(ends))));
    found.extend(limits.velocity.clone().map(|speed| ("velocity", Json::scalar(speed))));
    found.extend(limits.torque.as_ref().map(|ends| ("torque", range(ends))));
    found
}

fn body(body: &TreeBody) -> Json {
    let keys = ["xx", "yy", "zz", "xy", "xz", "yz"];
    let entries = keys.into_iter().zip(&body.inertia).enumerate();
    let given = entries.filter(|(at, (_, value))| *at < 3 || !value.is_zero());
    let inertia = given.map(|(_, (key, value))| (key, Json::scalar(written(value)))).collect();
    let mut found = vec![
        ("mass", Json::scalar(written(&body.mass))),
        ("com", numbers(&body.com)),
        ("inertia", Json::Object(inertia)),
        ("about", Json::text("com")),
    ];
    let why = |fault: &Unphysical| format!("As the description has it: {fault}.");
    let accepted = body.fault.iter().map(why);
    found.extend(accepted.map(|why| ("accept_triangle_violation", Json::text(why))));
    Json::Object(found)
}

fn has_drive(drive: &TreeDrive) -> bool {
    drive.is_driven
        || drive.gear_ratio.is_some()
        || drive.rotor_inertia.is_some()
        || drive.coulomb.is_some()
}

fn drive(tree: &Tree, row: &PlacedRow) -> Option<(String, Json)> {
    let joint = tree.links[row.joint_of?].joint.as_ref()?;
    let drive = &joint.drive;
    if !has_drive(drive) {
        return None;
    }
    let entries = [
        ("gear_ratio", &drive.gear_ratio),
        ("rotor_inertia", &drive.rotor_inertia),
        ("viscous", &drive.viscous),
        ("coulomb", &drive.coulomb),
    ];
    let given = entries
        .into_iter()
        .filter_map(|(key, text)| text.clone().map(|text| (key, Json::scalar(text))));
    Some((row.name.clone(), Json::Object(given.collect())))
}

fn contact(layout: &Layout, point: &TreeContact) -> Json {
    let frame = layout.frames[point.link].as_deref().unwrap_or("base");
    Json::Object(vec![
        ("name", Json::text(&point.name)),
        ("link", Json::text(frame)),
        ("position", numbers(&point.at)),
    ])
}
