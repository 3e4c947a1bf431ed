//! From the bytes of a scenario file to a scenario.

use super::fault::{Cause, Fault, ScenarioError};
use super::gait::gait;
use super::options;
use super::place::{Places, line_and_column};
use super::reader::{Fields, Node, Report};
use super::reference::{self, Logs};
use super::start::find_start_faults;
use super::stepping;
use super::{FORMAT, Scenario};
use crate::plants::{Cradle, Override, Plant, PlantModel, plant_of};
use crate::simulate::audit::Tolerances;
use crate::simulate::control::{Compensation, Control, Feedback, JointControl};
use crate::simulate::ground::Ground;
use crate::simulate::state::State;
use denavit_codegen::expr::text::nearest;
use denavit_codegen::model::{self, Robot};
use serde_json::Value;

/// Reads a model by what a scenario calls it: a shipped name, or a path beside the scenario. The
/// error is a sentence.
pub type Loader<'a> = dyn Fn(&str) -> Result<Vec<u8>, String> + 'a;

const KEYS: &[&str] = &[
    "format",
    "name",
    "description",
    "source",
    "assumptions",
    "model",
    "cradle_balls",
    "parameters",
    "duration_s",
    "initial",
    "control",
    "drives",
    "measurement",
    "seed",
    "gait",
    "scheme",
    "time_stepping",
    "contact",
    "integrator",
    "log_period_s",
    "limits",
    "tolerances",
];

/// Reads a scenario file from its bytes. `file` is its name, for messages alone.
pub fn read(file: &str, source: &[u8], load: &Loader<'_>) -> Result<Scenario, ScenarioError> {
    let error = |faults, omitted| ScenarioError { file: file.to_owned(), faults, omitted };
    let text = String::from_utf8_lossy(source);
    let root: Value = match serde_json::from_str(&text) {
        Ok(root) => root,
        Err(failure) => {
            let said = failure.to_string();
            let said = said.split(" at line ").next().unwrap_or_default().to_owned();
            let fault = Fault {
                pointer: String::new(),
                line: failure.line(),
                column: failure.column().max(1),
                cause: Cause::Syntax(said),
            };
            return Err(error(vec![fault], 0));
        }
    };
    let mut report = Report::default();
    let places = Places::new(&text);
    for (pointer, key) in &places.duplicates {
        report.push(pointer, Cause::DuplicateKey(key.clone()));
    }
    let scenario = scenario(&Node { value: &root, pointer: String::new() }, load, &mut report);
    match scenario {
        Some(scenario) if report.faults.is_empty() => Ok(scenario),
        _ => {
            let mut faults: Vec<(usize, Fault)> = report
                .faults
                .into_iter()
                .map(|(pointer, cause)| {
                    let start = places.find(&text, &pointer).2;
                    let (line, column) = line_and_column(&text, start);
                    (start, Fault { pointer, line, column, cause })
                })
                .collect();
            faults.sort_by_key(|(start, _)| *start);
            let faults = faults.into_iter().map(|(_, fault)| fault).collect();
            Err(error(faults, report.omitted))
        }
    }
}

fn scenario(root: &Node<'_>, load: &Loader<'_>, report: &mut Report) -> Option<Scenario> {
    let fields = root.fields(KEYS, report)?;
    if let Some(tag) = fields.require("format", report)
        && let Some(found) = tag.text(report)
        && found != FORMAT
    {
        report.push(&tag.pointer, Cause::WrongFormat(found.to_owned()));
    }
    let text = |key: &str, report: &mut Report| {
        fields.get(key).and_then(|node| node.text(report)).unwrap_or_default().to_owned()
    };
    let (name, description) = (text("name", report), text("description", report));
    let mut simulation = options::simulation(&fields, report);
    let tolerances = options::tolerances(&fields, Tolerances::default(), report);
    let scheme = stepping::scheme(&fields, report);
    let (stepping, stepping_tolerances) = stepping::stepping(&fields, report);
    let mut plant = plant(&fields, load, report)?;
    let mut control = control(&fields, plant.model(), &mut Logs::new(load), report);
    let posture = gait(&fields, plant.as_mut(), &mut control, report);
    let initial = initial(&fields, plant.as_mut(), posture, report);
    simulation.end_s += initial.t_s;
    let mut scenario = Scenario {
        name,
        description,
        plant,
        control,
        initial,
        simulation,
        tolerances,
        scheme,
        stepping,
        stepping_tolerances,
    };
    if report.faults.is_empty() {
        find_start_faults(&mut scenario, report);
    }
    Some(scenario)
}

fn plant(fields: &Fields<'_>, load: &Loader<'_>, report: &mut Report) -> Option<Box<dyn Plant>> {
    if fields.get("cradle_balls").is_some() {
        let balls = fields.count("cradle_balls", 2, report);
        return Some(Box::new(Cradle::new(balls.clamp(2, 8))));
    }
    let node = fields.require("model", report)?;
    let name = node.text(report)?;
    let robot: Robot = match load(name) {
        Ok(bytes) => match model::read(name, &bytes) {
            Ok(robot) => robot,
            Err(error) => {
                report.push(&node.pointer, Cause::Model(error.to_string()));
                return None;
            }
        },
        Err(reason) => {
            report.push(&node.pointer, Cause::File(name.to_owned(), reason));
            return None;
        }
    };
    let mut overrides = Vec::new();
    if let Some(parameters) = fields.get("parameters").and_then(|node| node.members(report)) {
        for (parameter, node) in parameters.all() {
            if robot.find_parameter(parameter).is_none() {
                let names = robot.parameters.values().map(|parameter| parameter.name.as_str());
                let meant = nearest(parameter, names).map(str::to_owned);
                let error =
                    crate::plants::PlantError::UnknownParameter(parameter.to_owned(), meant);
                report.push(&node.pointer, Cause::Plant(error));
            } else if let Some(value) = node.number(report) {
                overrides.push(Override { parameter: parameter.to_owned(), value });
            }
        }
    }
    let made = plant_of(&robot, &overrides);
    made.map_err(|error| report.push(&node.pointer, Cause::Plant(error))).ok()
}

/// The joint that a key names.
fn joint(model: &PlantModel, name: &str, node: &Node<'_>, report: &mut Report) -> Option<usize> {
    let found = model.find_joint(name);
    if found.is_none() {
        let names = model.joints.iter().map(|joint| joint.name.as_str());
        let meant = nearest(name, names).map(str::to_owned);
        report.push(&node.pointer, Cause::UnknownJoint(name.to_owned(), meant));
    }
    found
}

fn control(
    fields: &Fields<'_>,
    model: &PlantModel,
    logs: &mut Logs<'_>,
    report: &mut Report,
) -> Control {
    let mut control = Control::passive(model.joints.len());
    let known = &["compensation", "feedback", "saturates", "period_s", "joints"];
    let Some(given) = fields.get("control").and_then(|node| node.fields(known, report)) else {
        return control;
    };
    let words = &["none", "gravity", "computed_torque"];
    let meanings = [Compensation::None, Compensation::Gravity, Compensation::ComputedTorque];
    let word = given.get("compensation");
    control.compensation =
        word.and_then(|node| node.word(words, &meanings, report)).unwrap_or_default();
    let word = given.get("feedback");
    let meanings = [Feedback::Joint, Feedback::Motor];
    control.feedback =
        word.and_then(|node| node.word(&["joint", "motor"], &meanings, report)).unwrap_or_default();
    control.saturates = given.flag("saturates", report);
    if given.get("period_s").is_some() {
        control.period_s = Some(given.positive("period_s", 1e-3, report));
    }
    if let Some(joints) = given.get("joints").and_then(|node| node.members(report)) {
        for (name, node) in joints.all() {
            let Some(index) = joint(model, name, &node, report) else { continue };
            if !model.joints[index].drivable {
                report.push(&node.pointer, Cause::Undrivable(name.to_owned()));
            }
            let known = &["kp", "kd", "reference", "feed_forward", "gain_factor"];
            let Some(own) = node.fields(known, report) else { continue };
            let mut follow =
                |key: &str| own.get(key).and_then(|n| reference::read(&n, logs, report));
            let [reference, feed_forward, gain_factor] =
                ["reference", "feed_forward", "gain_factor"].map(&mut follow);
            control.joints[index] = JointControl {
                reference,
                stiffness: own.not_negative("kp", 0.0, report),
                damping: own.not_negative("kd", 0.0, report),
                gain_factor,
                feed_forward,
            };
        }
    }
    control
}

fn initial(
    fields: &Fields<'_>,
    plant: &mut dyn Plant,
    posture: Option<Vec<f64>>,
    report: &mut Report,
) -> State {
    let model = plant.model().clone();
    let mut state = State::resting(posture.unwrap_or_else(|| vec![0.0; model.joints.len()]));
    let known = &["t_s", "q", "qd", "on_ground"];
    let Some(given) = fields.get("initial").and_then(|node| node.fields(known, report)) else {
        return state;
    };
    state.t_s = given.number("t_s", 0.0, report);
    for (key, values) in [("q", &mut state.q), ("qd", &mut state.qd)] {
        let Some(joints) = given.get(key).and_then(|node| node.members(report)) else { continue };
        for (name, node) in joints.all() {
            if let Some(index) = joint(&model, name, &node, report)
                && let Some(value) = node.number(report)
            {
                values[index] = value;
            }
        }
    }
    if given.flag("on_ground", report) && !put_on_ground(plant, &mut state) {
        report.push(&format!("{}/on_ground", given.pointer), Cause::NoPlacing);
    }
    state
}

/// Moves the base vertically until the lowest contact point touches.
fn put_on_ground(plant: &mut dyn Plant, state: &mut State) -> bool {
    let model = plant.model();
    let ground = Ground::new(model);
    let (height, points) = (model.find_joint("base_z"), model.contacts.len());
    let Some(height) = height.filter(|_| points > 0 && ground.normal()[2] > 1e-3) else {
        return false;
    };
    let mut positions = vec![0.0; 3 * points];
    // the second pass takes out the rounding of the first
    for _ in 0..2 {
        plant.contact_positions(&state.q, &mut positions);
        let gaps = positions.chunks_exact(3).map(|position| ground.gap(position));
        state.q[height] -= gaps.fold(f64::INFINITY, f64::min) / ground.normal()[2];
    }
    true
}
