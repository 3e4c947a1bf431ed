//! Files of what was measured at rest (`"denavit-statics/1"`): weighings and held postures.

use denavit_codegen::expr::text::nearest;
use denavit_codegen::model::{Fields, Node, read_document};
use denavit_plants::regression::RegressionModel;
use denavit_simulate::scenario::{
    Cause, FieldsNumbers, NodeNumbers, Range, Report, ScenarioError, check_format,
};
use denavit_statics::{HoldingTorque, StaticMeasurement};
use serde_json::json;
use std::collections::BTreeSet;

/// The tag of a file of measurements at rest.
pub const STATICS_FORMAT: &str = "denavit-statics/1";

const KEYS: &[&str] = &["format", "name", "description", "source", "weighings", "postures"];

const MASS_KG: Range = Range { least: 0.0, most: 1e9 };
const DEVIATION: Range = Range { least: 1e-6, most: 1e9 };
const TORQUE: Range = Range { least: -1e12, most: 1e12 };
const POSITION: Range = Range { least: -1e9, most: 1e9 };

/// Reads a file of measurements at rest: weighings first, then postures. `file` is its name, for
/// messages alone.
pub(super) fn read_statics(
    file: &str,
    source: &[u8],
    model: &RegressionModel,
) -> Result<Vec<StaticMeasurement>, ScenarioError> {
    read_document(file, source, |root, report| {
        let fields = &root.fields(KEYS, report)?;
        check_format(fields, STATICS_FORMAT, report);
        for key in ["name", "description", "source"] {
            fields.get(key).and_then(|node| node.text(report));
        }
        let items = |key: &str, report: &mut Report| {
            fields.get(key).map_or_else(Vec::new, |node| node.items(report))
        };
        let mut all = Vec::new();
        for node in items("weighings", report) {
            all.extend(weighing(node, model, report));
        }
        for node in items("postures", report) {
            all.extend(posture(node, model, report));
        }
        Some(all)
    })
}

fn weighing(
    node: Node<'_>,
    model: &RegressionModel,
    report: &mut Report,
) -> Option<StaticMeasurement> {
    let fields = node.fields(&["links", "mass_kg", "std_kg"], report)?;
    let owners = model.standard.iter().filter_map(|one| one.owner.as_ref());
    let of_joints = model.joints.iter().map(|joint| joint.name.as_str());
    let known: BTreeSet<&str> = owners.map(|(link, _)| link.as_str()).chain(of_joints).collect();
    let mut links = Vec::new();
    for link in fields.require("links", report)?.items(report) {
        let Some(name) = link.text(report) else { continue };
        if !known.contains(name) {
            let near = nearest(name, known.iter().copied()).map(str::to_owned);
            report.push(link.at(), Cause::UnknownLink(name.to_owned(), near));
        }
        links.push(name.to_owned());
    }
    let mass_kg = fields.required_number("mass_kg", MASS_KG, report);
    let std_kg = fields.required_number("std_kg", DEVIATION, report);
    Some(StaticMeasurement::Weighing { links, mass_kg, std_kg })
}

fn posture(
    node: Node<'_>,
    model: &RegressionModel,
    report: &mut Report,
) -> Option<StaticMeasurement> {
    let fields = node.fields(&["q", "torques"], report)?;
    let given = fields.require("q", report)?.members(report)?;
    let mut q = Vec::new();
    for joint in &model.joints {
        match given.get(&joint.name) {
            Some(node) => q.push(node.number_in(POSITION, report).unwrap_or(0.0)),
            None => report.push(given.at(), Cause::NoPosition(joint.name.clone())),
        }
    }
    known_joints(&given, model, report);
    let given = fields.require("torques", report)?.members(report)?;
    known_joints(&given, model, report);
    let mut torques = Vec::new();
    for (joint, node) in given.all() {
        let Some(one) = node.fields(&["torque", "std"], report) else { continue };
        torques.push(HoldingTorque {
            joint: joint.to_owned(),
            torque: one.required_number("torque", TORQUE, report),
            std: one.required_number("std", DEVIATION, report),
        });
    }
    Some(StaticMeasurement::Posture { q, torques })
}

/// Notes keys that are no joints.
fn known_joints(given: &Fields<'_>, model: &RegressionModel, report: &mut Report) {
    for (name, node) in given.all() {
        if model.joints.iter().all(|joint| joint.name != name) {
            let names = model.joints.iter().map(|joint| joint.name.as_str());
            let near = nearest(name, names).map(str::to_owned);
            report.push(node.at(), Cause::UnknownJoint(name.to_owned(), near));
        }
    }
}

/// The JSON Schema (draft 2020-12) of a file of measurements at rest: its form, not its content.
pub fn statics_schema() -> String {
    let number =
        |range: Range| json!({"type": "number", "minimum": range.least, "maximum": range.most});
    let schema = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "denavit statics",
        "description": "What was measured of a robot at rest: weighings and held postures.",
        "type": "object",
        "properties": {
            "format": { "const": STATICS_FORMAT },
            "name": { "type": "string" },
            "description": { "type": "string" },
            "source": { "type": "string" },
            "weighings": { "type": "array", "items": {
                "type": "object",
                "properties": {
                    "links": { "type": "array", "items": { "type": "string" } },
                    "mass_kg": number(MASS_KG),
                    "std_kg": number(DEVIATION),
                },
                "required": ["links", "mass_kg", "std_kg"],
                "additionalProperties": false,
            } },
            "postures": { "type": "array", "items": {
                "type": "object",
                "properties": {
                    "q": { "type": "object", "additionalProperties": number(POSITION) },
                    "torques": { "type": "object", "additionalProperties": {
                        "type": "object",
                        "properties": { "torque": number(TORQUE), "std": number(DEVIATION) },
                        "required": ["torque", "std"],
                        "additionalProperties": false,
                    } },
                },
                "required": ["q", "torques"],
                "additionalProperties": false,
            } },
        },
        "required": ["format"],
        "additionalProperties": false,
    });
    serde_json::to_string_pretty(&schema).expect("a value is JSON")
}
