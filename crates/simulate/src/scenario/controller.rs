//! Control: the part `control` of a scenario, and files that are it (`"denavit-controller/1"`).

use super::fault::{Cause, ScenarioError};
use super::ranges::{self, Range};
use super::read::{Loader, joint};
use super::reader::{FieldsNumbers, NodeNumbers, Report, check_format};
use super::reference::{self, Logs};
use super::trajectory::read_trajectory;
use crate::control::{Compensation, Control, Damped, Feedback, JointControl};
use denavit_codegen::model::json::Value;
use denavit_codegen::model::{Fields, Node, read_document};
use denavit_plants::PlantModel;
use serde_json::json;

/// The tag of a controller file.
pub const CONTROLLER_FORMAT: &str = "denavit-controller/1";

const KEYS: &[&str] = &[
    "format",
    "name",
    "description",
    "source",
    "compensation",
    "feedback",
    "saturates",
    "period_s",
    "trajectory",
    "joints",
];

/// A law of control by itself: what a robot had when a log was made.
#[derive(Clone, Debug, PartialEq)]
pub struct Controller {
    /// Its name; empty if the file says none.
    pub name: String,
    /// The law.
    pub control: Control,
    /// Which joints it names. One of these without a reference follows that of a log, `ref_JOINT`.
    pub controlled: Vec<bool>,
}

/// Reads a controller file from its bytes. `file` is its name, for messages alone; `model` is the
/// robot that is controlled, and `load` reads what references refer to.
pub fn read_controller(
    file: &str,
    source: &[u8],
    model: &PlantModel,
    load: &Loader<'_>,
) -> Result<Controller, ScenarioError> {
    read_document(file, source, |root, report| {
        let fields = &root.fields(KEYS, report)?;
        check_format(fields, CONTROLLER_FORMAT, report);
        Some(controller(fields, model, &mut Logs::new(load), report))
    })
}

/// The control of a scenario: an object, or a string that is the name of its file.
pub(super) fn control(
    fields: &Fields<'_>,
    model: &PlantModel,
    logs: &mut Logs<'_>,
    report: &mut Report,
) -> Control {
    let passive = || Control::passive(model.joints.len());
    let Some(node) = fields.get("control") else { return passive() };
    let Value::Text(file) = &node.0.value else {
        let given = node.fields(KEYS, report);
        return given.map_or_else(passive, |given| {
            if given.get("format").is_some() {
                check_format(&given, CONTROLLER_FORMAT, report);
            }
            controller(&given, model, logs, report).control
        });
    };
    let read = match logs.load(file) {
        Ok(bytes) => read_controller(file, &bytes, model, logs.loader())
            .map_err(|error| Cause::Controller(error.to_string())),
        Err(reason) => Err(Cause::File(file.clone().into_owned(), reason)),
    };
    match read {
        Ok(read) => read.control,
        Err(cause) => {
            report.push(node.at(), cause);
            passive()
        }
    }
}

fn controller(
    given: &Fields<'_>,
    model: &PlantModel,
    logs: &mut Logs<'_>,
    report: &mut Report,
) -> Controller {
    let mut control = Control::passive(model.joints.len());
    let mut controlled = vec![false; model.joints.len()];
    for key in ["description", "source"] {
        given.get(key).and_then(|node| node.text(report));
    }
    let name = given.get("name").and_then(|node| node.text(report)).unwrap_or_default().to_owned();
    let words = &["none", "gravity", "computed_torque"];
    let meanings = [Compensation::None, Compensation::Gravity, Compensation::ComputedTorque];
    let word = given.get("compensation");
    control.compensation =
        word.and_then(|node| node.choice(words, &meanings, report)).unwrap_or_default();
    let word = given.get("feedback");
    let meanings = [Feedback::Joint, Feedback::Motor];
    control.feedback = word
        .and_then(|node| node.choice(&["joint", "motor"], &meanings, report))
        .unwrap_or_default();
    control.saturates = given.flag("saturates", report);
    if given.get("period_s").is_some() {
        control.period_s = Some(given.number("period_s", ranges::SAMPLE_PERIOD_S, 1e-3, report));
    }
    if let Some(node) = given.get("trajectory") {
        follow(&mut control, node, model, logs, report);
    }
    if let Some(joints) = given.get("joints").and_then(|node| node.members(report)) {
        for (name, node) in joints.all() {
            let Some(index) = joint(model, name, node, report) else { continue };
            if !model.joints[index].drivable {
                report.push(node.at(), Cause::Undrivable(name.to_owned()));
            }
            controlled[index] = true;
            let followed = control.joints[index].reference.take();
            if let Some(own) = joint_control(node, followed, logs, report) {
                control.joints[index] = own;
            }
        }
    }
    for (controlled, joint) in controlled.iter_mut().zip(&control.joints) {
        *controlled |= joint.reference.is_some();
    }
    Controller { name, control, controlled }
}

const JOINT_KEYS: &[&str] = &["kp", "kd", "damps", "reference", "feed_forward", "gain_factor"];

/// The control of one joint, which follows `followed` if it has no reference of its own.
fn joint_control(
    node: Node<'_>,
    followed: Option<denavit_plants::trajectory::Reference>,
    logs: &mut Logs<'_>,
    report: &mut Report,
) -> Option<JointControl> {
    let own = node.fields(JOINT_KEYS, report)?;
    let mut follow = |key: &str| own.get(key).and_then(|n| reference::read(n, logs, report));
    let [reference, feed_forward, gain_factor] =
        ["reference", "feed_forward", "gain_factor"].map(&mut follow);
    let meanings = [Damped::Error, Damped::Rate];
    let word = own.get("damps").and_then(|n| n.choice(&["error", "rate"], &meanings, report));
    Some(JointControl {
        reference: reference.or(followed),
        stiffness: own.number("kp", Range::GAIN, 0.0, report),
        damping: own.number("kd", Range::GAIN, 0.0, report),
        damped: word.unwrap_or_default(),
        gain_factor,
        feed_forward,
    })
}

/// Joints follow a trajectory file, unless they have references of their own.
fn follow(
    control: &mut Control,
    node: Node<'_>,
    model: &PlantModel,
    logs: &Logs<'_>,
    report: &mut Report,
) {
    let Some(file) = node.text(report) else { return };
    let bytes = match logs.load(file) {
        Ok(bytes) => bytes,
        Err(reason) => {
            report.push(node.at(), Cause::File(file.to_owned(), reason));
            return;
        }
    };
    let trajectory = match read_trajectory(file, &bytes, logs.loader()) {
        Ok(trajectory) => trajectory,
        Err(error) => {
            report.push(node.at(), Cause::Trajectory(error.to_string()));
            return;
        }
    };
    for (name, reference) in &trajectory.joints {
        if let Some(index) = joint(model, name, node, report) {
            match model.joints[index].drivable {
                true => control.joints[index].reference = Some(trajectory.repeated(reference)),
                false => report.push(node.at(), Cause::Undrivable(name.clone())),
            }
        }
    }
}

/// The JSON Schema (draft 2020-12) of a controller file: its form, not its content.
pub fn controller_schema() -> String {
    let scenario: serde_json::Value =
        serde_json::from_str(super::schema()).expect("our schema is JSON");
    let mut schema = scenario["$defs"]["control"].clone();
    schema["$schema"] = scenario["$schema"].clone();
    schema["title"] = "denavit controller".into();
    schema["$defs"] = json!({ "reference": scenario["$defs"]["reference"] });
    schema["required"] = json!(["format"]);
    serde_json::to_string_pretty(&schema).expect("a value is JSON")
}
