//! A model as `denavit` understands its file.

mod faults;
mod json;
mod text;

pub use faults::{faults_json, robot_faults_json};

use super::text_of;
use crate::{Table, Values};
use denavit_codegen::model::Robot;
use serde_json::Value;

/// A robot as tables: tree, rows, masses, drives, contacts, assumptions.
pub fn model_text(robot: &Robot) -> String {
    text_of(|out| text::write(out, robot, &mut Values::new(robot)))
}

/// The rows of a robot as a table.
pub(crate) fn model_rows(robot: &Robot) -> Table {
    text::link_table(robot, &mut Values::new(robot))
}

/// The numbers of a robot beside its rows, each table with what it shows.
pub(crate) fn model_tables(robot: &Robot) -> Vec<(&'static str, Table)> {
    text::tables(robot, &mut Values::new(robot))
}

/// The row of a link in one line.
pub(crate) fn model_row(robot: &Robot, name: &str) -> String {
    let mut values = Values::new(robot);
    let Some(id) = robot.find_link(name) else { return name.to_owned() };
    let link = &robot.links[id];
    let [a, alpha, d, theta] = text::row_entries(&values, &link.joint);
    let kind = text::kind_name(link.joint.kind);
    let mass = link.body.as_ref().map(|body| values.show(body.mass));
    let mass = mass.map_or_else(String::new, |mass| format!(", mass {mass} kg"));
    format!("{name}: {kind}, a = {a}, alpha = {alpha}, d = {d}, theta = {theta}{mass}")
}

/// A robot as JSON. Values are numbers; a value that the file does not give is null.
pub fn model_json(robot: &Robot) -> Value {
    json::robot(robot, &mut Values::new(robot))
}
