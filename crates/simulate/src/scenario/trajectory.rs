//! Trajectory files: what joints follow, together, for some time (`"denavit-trajectory/1"`).

use super::fault::{Cause, ScenarioError};
use super::ranges;
use super::read::Loader;
use super::reader::{FieldsNumbers, Report, check_format};
use super::reference::{self, Logs};
use denavit_codegen::model::{Fields, read_document};
use denavit_plants::trajectory::{Part, Reference, Sequence};
use serde_json::{Value, json};

/// The tag of a trajectory file.
pub const TRAJECTORY_FORMAT: &str = "denavit-trajectory/1";

const KEYS: &[&str] =
    &["format", "name", "description", "model", "duration_s", "periodic", "joints", "excitation"];

/// What joints follow, together, for some time.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Its name.
    pub name: String,
    /// The model that it was made for, for readers; empty if the file says nothing.
    pub model: String,
    /// How long one lap is \[s\].
    pub duration_s: f64,
    /// Whether laps follow each other without end.
    pub periodic: bool,
    /// The reference of each joint, in the order of the file.
    pub joints: Vec<(String, Reference)>,
}

impl Trajectory {
    /// The reference of a joint of this trajectory as it is followed: lap after lap if it is
    /// periodic.
    pub fn repeated(&self, reference: &Reference) -> Reference {
        if !self.periodic {
            return reference.clone();
        }
        let part = Part { duration_s: self.duration_s, reference: reference.clone() };
        let sequence = Sequence::new(vec![part], true).map(Reference::Sequence);
        sequence.expect("the duration of a trajectory is positive")
    }

    /// The reference of a joint.
    pub fn find(&self, joint: &str) -> Option<&Reference> {
        self.joints.iter().find(|(name, _)| name == joint).map(|(_, reference)| reference)
    }
}

/// Reads a trajectory file from its bytes. `file` is its name, for messages alone; `load` reads
/// the logs that references follow.
pub fn read_trajectory(
    file: &str,
    source: &[u8],
    load: &Loader<'_>,
) -> Result<Trajectory, ScenarioError> {
    read_document(file, source, |root, report| {
        trajectory(&root.fields(KEYS, report)?, load, report)
    })
}

fn trajectory(fields: &Fields<'_>, load: &Loader<'_>, report: &mut Report) -> Option<Trajectory> {
    check_format(fields, TRAJECTORY_FORMAT, report);
    let text = |key: &str, report: &mut Report| {
        fields.get(key).and_then(|node| node.text(report)).unwrap_or_default().to_owned()
    };
    let (name, model) = (text("name", report), text("model", report));
    text("description", report);
    let duration_s = fields.required_number("duration_s", ranges::PART_S, report);
    let periodic = fields.flag("periodic", report);
    if let Some(remarks) = fields.get("excitation") {
        remarks.members(report);
    }
    let mut logs = Logs::new(load);
    let mut joints = Vec::new();
    if let Some(node) = fields.require("joints", report)
        && let Some(given) = node.members(report)
    {
        for (joint, node) in given.all() {
            let reference = reference::read(node, &mut logs, report);
            joints.extend(reference.map(|reference| (joint.to_owned(), reference)));
        }
        if given.all().next().is_none() {
            report.push(node.at(), Cause::NoJoints);
        }
    }
    Some(Trajectory { name, model, duration_s, periodic, joints })
}

/// The JSON Schema (draft 2020-12) of a trajectory file: its form, not its content.
pub fn trajectory_schema() -> String {
    let scenario: Value = serde_json::from_str(super::schema()).expect("our schema is JSON");
    let schema = json!({
        "$schema": scenario["$schema"],
        "title": "denavit trajectory",
        "description": "What joints follow, together, for some time.",
        "$defs": { "reference": scenario["$defs"]["reference"] },
        "type": "object",
        "properties": {
            "format": { "const": TRAJECTORY_FORMAT },
            "name": { "type": "string" },
            "description": { "type": "string" },
            "model": { "type": "string" },
            "duration_s": {
                "type": "number", "minimum": ranges::PART_S.least, "maximum": ranges::PART_S.most,
            },
            "periodic": { "type": "boolean" },
            "joints": {
                "type": "object",
                "minProperties": 1,
                "additionalProperties": { "$ref": "#/$defs/reference" },
            },
            "excitation": { "type": "object" },
        },
        "required": ["format", "duration_s", "joints"],
        "additionalProperties": false,
    });
    serde_json::to_string_pretty(&schema).expect("a value is JSON")
}
