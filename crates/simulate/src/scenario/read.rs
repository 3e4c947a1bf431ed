//! From the bytes of a scenario file to a scenario.

use super::controller::control;
use super::fault::{Cause, ScenarioError};
use super::gait::{GaitPlanner, gait};
use super::limits::speed_limits;
use super::options;
use super::pushes::pushes;
use super::ranges;
use super::reader::{FieldsNumbers, NodeNumbers, Report, check_format};
use super::reference::Logs;
use super::start::{Origin, find_start_faults};
use super::stepping;
use super::{FORMAT, Scenario};
use crate::audit::Tolerances;
use crate::control::{Control, Feedback};
use crate::drive::DriveModelling;
use crate::ground::Ground;
use crate::simulation::Simulation;
use crate::state::State;
use denavit_codegen::effect::{self, Law};
use denavit_codegen::expr::text::nearest;
use denavit_codegen::model::json::Value;
use denavit_codegen::model::{self, AddedEffect, Fields, Node, Robot};
use denavit_plants::{Cradle, Override, Plant, PlantModel, plant_of};

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
    "stiction_rate",
    "measurement",
    "seed",
    "gait",
    "pushes",
    "scheme",
    "time_stepping",
    "contact",
    "integrator",
    "log_period_s",
    "limits",
    "tolerances",
];

/// Reads a scenario file without a gait from its bytes. `file` is its name, for messages alone.
pub fn read(file: &str, source: &[u8], load: &Loader<'_>) -> Result<Scenario, ScenarioError> {
    read_planned(file, source, load, None)
}

/// Reads a scenario file from its bytes, with what plans its gait.
pub fn read_planned(
    file: &str,
    source: &[u8],
    load: &Loader<'_>,
    planner: Option<&GaitPlanner<'_>>,
) -> Result<Scenario, ScenarioError> {
    let origin = Origin { file: file.to_owned(), source: source.to_vec() };
    model::read_document(file, source, |root, report| {
        let fields = root.fields(KEYS, report)?;
        let mut scenario = scenario(&fields, origin, load, planner, report)?;
        if report.is_empty() {
            find_start_faults(&mut scenario, root.0, report);
        }
        Some(scenario)
    })
}

fn scenario(
    fields: &Fields<'_>,
    origin: Origin,
    load: &Loader<'_>,
    planner: Option<&GaitPlanner<'_>>,
    report: &mut Report,
) -> Option<Scenario> {
    check_format(fields, FORMAT, report);
    let text = |key: &str, report: &mut Report| {
        fields.get(key).and_then(|node| node.text(report)).unwrap_or_default().to_owned()
    };
    let (name, description) = (text("name", report), text("description", report));
    let mut simulation = options::simulation(fields, report);
    let tolerances = options::tolerances(fields, Tolerances::of_method(simulation.method), report);
    let scheme = stepping::scheme(fields, report);
    let (stepping, stepping_tolerances) = stepping::stepping(fields, report);
    let RobotOfScenario { mut plant, parameters, speed_limits, of_logs } =
        plant(fields, load, report)?;
    let mut control = control(fields, plant.model(), &mut Logs::new(load), report);
    let posture = gait(fields, plant.as_mut(), planner, &mut control, report);
    let initial = initial(fields, plant.as_mut(), &control, posture, report);
    simulation.end_s += initial.t_s;
    let run_s = [initial.t_s, simulation.end_s];
    simulation.pushes = pushes(fields, plant.model(), run_s, report);
    find_idle(fields, plant.model(), &simulation, &control, report);
    Some(Scenario {
        origin,
        name,
        description,
        plant,
        parameters,
        speed_limits,
        of_logs,
        control,
        initial,
        simulation,
        tolerances,
        scheme,
        stepping,
        stepping_tolerances,
        logged_torque_noise: options::logged_torque_noise(fields, report),
    })
}

/// Notes what is given and would do nothing: gains that follow nothing, drives of a model that has
/// none.
fn find_idle(
    fields: &Fields<'_>,
    model: &PlantModel,
    simulation: &Simulation,
    control: &Control,
    report: &mut Report,
) {
    let mut has = |place: usize, any: bool, missing: &'static str| {
        if !any {
            report.push(place, Cause::NoEffect(missing));
        }
    };
    if let Some(measurement) = fields.get("measurement") {
        has(measurement.at(), control.period_s.is_some(), "`period_s` in `control`");
    }
    let drives = || model.joints.iter().filter_map(|joint| joint.drive);
    if let Some(rate) = fields.get("stiction_rate") {
        has(rate.at(), simulation.drives == DriveModelling::Model, "`\"drives\": \"model\"`");
    }
    if simulation.drives == DriveModelling::Model {
        has(fields.place("drives"), drives().next().is_some(), "drives in the model");
    }
    let given = |key: &str| match &fields.get("control")?.0.value {
        Value::Object(entries) => {
            entries.iter().find(|(known, _)| known == key).map(|(_, value)| value)
        }
        _ => None,
    };
    if let (Feedback::Motor, Some(value)) = (control.feedback, given("feedback")) {
        let elastic = simulation.drives == DriveModelling::Model
            && drives().any(|drive| drive.series_elastic.is_some());
        has(value.start, elastic, "series elastic drives and `\"drives\": \"model\"`");
    }
    if let (true, Some(value)) = (control.saturates, given("saturates")) {
        let limited = model.joints.iter().any(|joint| joint.torque_limits.is_some());
        has(value.start, limited, "torque limits in the model");
    }
    for (name, own) in given("joints").map_or(&[][..], |joints| joints.entries()) {
        let follows = |joint: usize| control.joints[joint].reference.is_some();
        if model.find_joint(name).is_none_or(follows) {
            continue;
        }
        let gains = own.entries().iter();
        let idle = ["kp", "kd", "damps", "gain_factor"];
        for (_, gain) in gains.filter(|(key, _)| idle.contains(&&**key)) {
            has(gain.start, false, "a `reference`");
        }
    }
}

/// The robot of a scenario.
struct RobotOfScenario {
    plant: Box<dyn Plant>,
    /// Values in place of its model's.
    parameters: Vec<Override>,
    /// Of its joints.
    speed_limits: Vec<Option<f64>>,
    /// Effects of its model on what is logged, with their places.
    of_logs: Vec<String>,
}

fn plant(fields: &Fields<'_>, load: &Loader<'_>, report: &mut Report) -> Option<RobotOfScenario> {
    if let Some(balls) = fields.get("cradle_balls") {
        if fields.get("model").is_some() {
            report.push(balls.at(), Cause::TwoRobots);
        }
        if let Some(parameters) = fields.get("parameters") {
            report.push(parameters.at(), Cause::NoEffect("a `model`"));
        }
        let balls = fields.count("cradle_balls", ranges::CRADLE_BALLS, 2, report);
        let plant = Box::new(Cradle::new(balls));
        return Some(RobotOfScenario {
            plant,
            parameters: Vec::new(),
            speed_limits: Vec::new(),
            of_logs: Vec::new(),
        });
    }
    let node = fields.require("model", report)?;
    let name = node.text(report)?;
    let robot: Robot = match load(name) {
        Ok(bytes) => match effect::read_model(name, &bytes, &[]) {
            Ok(robot) => robot,
            Err(error) => {
                report.push(node.at(), Cause::Model(error.to_string()));
                return None;
            }
        },
        Err(reason) => {
            report.push(node.at(), Cause::File(name.to_owned(), reason));
            return None;
        }
    };
    let mut overrides = Vec::new();
    if let Some(parameters) = fields.get("parameters").and_then(|node| node.members(report)) {
        for (parameter, node) in parameters.all() {
            if robot.find_parameter(parameter).is_none() {
                let names = robot.parameters.values().map(|parameter| parameter.name.as_str());
                let meant = nearest(parameter, names).map(str::to_owned);
                let error = denavit_plants::Error::unknown_parameter(parameter.to_owned(), meant);
                report.push(node.at(), Cause::Plant(error));
            } else if let Some(value) = node.finite(report) {
                overrides.push(Override { parameter: parameter.to_owned(), value });
            }
        }
    }
    let made = plant_of(&robot, &overrides);
    let place = if overrides.is_empty() { node.at() } else { fields.place("parameters") };
    let plant = made.map_err(|error| report.push(place, Cause::Plant(error))).ok()?;
    Some(RobotOfScenario {
        plant,
        parameters: overrides,
        speed_limits: speed_limits(&robot),
        of_logs: of_logs(&robot),
    })
}

/// The effects of a robot that change what is logged, and not how it moves.
fn of_logs(robot: &Robot) -> Vec<String> {
    let is_of_logs = |one: &&AddedEffect| {
        effect::find(&one.effect).is_some_and(|own| matches!(own.law, Law::Measured(_)))
    };
    let name =
        |one: &AddedEffect| format!("`{}` at {}", one.effect, effect::place_name(robot, one.at));
    robot.effects.iter().filter(is_of_logs).map(name).collect()
}

/// The joint that a key names.
pub(super) fn joint(
    model: &PlantModel,
    name: &str,
    node: Node<'_>,
    report: &mut Report,
) -> Option<usize> {
    let found = model.find_joint(name);
    if found.is_none() {
        let names = model.joints.iter().map(|joint| joint.name.as_str());
        let meant = nearest(name, names).map(str::to_owned);
        report.push(node.at(), Cause::UnknownJoint(name.to_owned(), meant));
    }
    found
}

fn initial(
    fields: &Fields<'_>,
    plant: &mut dyn Plant,
    control: &Control,
    posture: Option<Vec<f64>>,
    report: &mut Report,
) -> State {
    let model = plant.model().clone();
    let mut state = State::resting(posture.unwrap_or_else(|| vec![0.0; model.joints.len()]));
    let known = &["t_s", "q", "qd", "on_reference", "on_ground"];
    let Some(given) = fields.get("initial").and_then(|node| node.fields(known, report)) else {
        return state;
    };
    state.t_s = given.number("t_s", ranges::START_S, 0.0, report);
    if given.flag("on_reference", report) {
        for index in 0..model.joints.len() {
            if let Some(setpoint) = control.setpoint(index, state.t_s) {
                (state.q[index], state.qd[index]) = (setpoint.position, setpoint.rate);
            }
        }
    }
    for (key, values) in [("q", &mut state.q), ("qd", &mut state.qd)] {
        let Some(joints) = given.get(key).and_then(|node| node.members(report)) else { continue };
        for (name, node) in joints.all() {
            if let Some(index) = joint(&model, name, node, report)
                && let Some(value) = node.number_in(ranges::COORDINATE, report)
            {
                values[index] = value;
            }
        }
    }
    if given.flag("on_ground", report) && !put_on_ground(plant, &mut state) {
        report.push(given.place("on_ground"), Cause::NoPlacing);
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
