//! `denavit identify --two-stage`: springs and motors first, then the load (thesis 3.3.2).

use super::json::{ConsistentJson, ParameterJson};
use super::{Arguments, IdentifyFailure, logs, text};
use crate::cli::Answer;
use crate::cli::base::regressor_options;
use crate::cli::failure::Failure;

use crate::cli::json::write_json;
use crate::cli::outputs::{check_outputs, on_stdout, write_whole};
use denavit::identify::condition::Filter;
use denavit::identify::estimate::{Consistent, IdentifiedParameter, consistent, parameters};
use denavit::identify::two_stage::{Estimate, Spring, TwoStage, TwoStageOptions, two_stage};
use denavit::identify::{NewValue, UpdateError, updated_model, updated_text};
use denavit::model::{self, Robot};
use denavit::plants::plant_of;
use denavit::plants::regression::{ModelParameter, RegressionModel};
use denavit::regressor::RegressorOptions;
use denavit::report::{Align, Table, short};
use serde::Serialize;
use std::io::Write;

/// What was found.
struct Found<'a> {
    model: &'a RegressionModel,
    stages: TwoStage,
    parameters: Vec<IdentifiedParameter>,
    /// The bodies nearest to the load.
    bodies: Consistent,
    remarks: Vec<String>,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [arguments.output.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    check_outputs(&outputs)?;
    let [path] = &arguments.train[..] else { return Err(IdentifyFailure::OneLog.into()) };
    let model = arguments.model_apart()?;
    let robot = model.whole.clone();
    let (_, source) = model.without_laws()?;
    // inertias of rotors are known here (thesis 3.3.1)
    let asked = regressor_options(&robot, &arguments.with)?;
    let options = RegressorOptions { rotor: false, ..asked };
    let mut model = RegressionModel::new(&robot, options, &arguments.keep)
        .map_err(|error| IdentifyFailure::Regression(Box::new(error)))?;
    model.law = arguments.friction;
    let plant =
        plant_of(&robot, &[]).map_err(|error| IdentifyFailure::Plant(robot.name.clone(), error))?;
    let log = logs::measured(arguments, &robot, &model, path)?;
    let remarks = log.remarks.iter().map(|remark| format!("{}: {remark}", log.file)).collect();
    let of_load = arguments.conditions.of(log.step_s, log.samples(), 0);
    // springs are stiff: the first stage takes what the rate of sampling allows
    let tenth = Filter { order: 4, cutoff_hz: 0.1 / log.step_s };
    let of_springs = denavit::identify::condition::Conditioning {
        filter: Some(tenth),
        decimation: 1,
        ..of_load
    };
    let how = TwoStageOptions { of_springs, of_load, slow: arguments.skip_slow };
    let stages = two_stage(plant.model(), &model, &log, &how)
        .map_err(|error| IdentifyFailure::TwoStage(log.file.clone(), error))?;
    let parameters = parameters(&model, &stages.load);
    let standard: Vec<f64> = model.standard.iter().map(|one| one.value.unwrap_or(0.0)).collect();
    let bodies = consistent(&model, &stages.load, &standard);
    let mut found = Found { model: &model, stages, parameters, bodies, remarks };
    let moved = found.moved();
    found.remarks.extend(moved);
    if let Some(path) = &arguments.output {
        write_whole(path, found.updated(&robot, &source)?.as_bytes())?;
    }
    match (is_answered, arguments.json) {
        (true, _) => {}
        (_, true) => write_json(out, &found.json())?,
        (_, false) => found.write(out)?,
    }
    Ok(Answer::Done)
}

impl Found<'_> {
    /// The model's file with the springs, and with the bodies nearest to the load.
    fn updated(&self, robot: &Robot, source: &str) -> Result<String, Failure> {
        let model = self.model;
        let both = (&self.bodies, &self.parameters[..]);
        let updated = updated_model(robot, model, both, source).map_err(IdentifyFailure::Update)?;
        let mut named = Vec::new();
        for spring in &self.stages.springs {
            let values = [("k", spring.stiffness), ("fv", spring.viscous), ("fc", spring.coulomb)];
            for (prefix, estimate) in values {
                let parameter = ModelParameter {
                    name: format!("{prefix}_{}", spring.joint),
                    role: None,
                    link: Some(spring.joint.clone()),
                    value: 0.0,
                    std: None,
                    is_positive: true,
                };
                named.push((parameter, estimate));
            }
        }
        let new: Vec<NewValue<'_>> = named
            .iter()
            .map(|(parameter, estimate)| NewValue {
                parameter,
                value: estimate.value.max(0.0),
                // a deviation is that of the estimate, which is not what is written
                std: Some(estimate.std).filter(|std| *std > 0.0 && estimate.value >= 0.0),
            })
            .collect();
        let text = updated_text(&updated.text, &new)
            .ok_or_else(|| IdentifyFailure::Update(UpdateError::NoPlace(robot.name.clone())))?;
        model::read("the identified model", text.as_bytes()).map_err(Failure::Model)?;
        Ok(text)
    }

    /// What is said of friction below 0: the model gets none.
    fn moved(&self) -> Vec<String> {
        let all = self.stages.springs.iter().flat_map(|spring| {
            [("Viscous", spring.viscous), ("Coulomb", spring.coulomb)].map(|one| (spring, one))
        });
        all.filter(|(_, (_, estimate))| estimate.value < 0.0)
            .map(|(spring, (what, Estimate { value, std }))| {
                format!(
                    "{what} friction of the motor of {} comes out as {} +- {std:.1e}, which no \
                     motor has: a model file gets 0, without a deviation.",
                    spring.joint,
                    short(value)
                )
            })
            .collect()
    }

    fn write(&self, out: &mut dyn Write) -> Result<(), Failure> {
        for remark in &self.remarks {
            writeln!(out, "{remark}")?;
        }
        if !self.remarks.is_empty() {
            writeln!(out)?;
        }
        writeln!(out, "{}: springs and motors, then the load\n", self.model.model)?;
        let mut table = columns(&["joint", "", "value", "std", "unit", "equation misses"]);
        for spring in &self.stages.springs {
            let rows = [
                ("stiffness", spring.stiffness, "N/m"),
                ("viscous", spring.viscous, "N m s/rad"),
                ("Coulomb", spring.coulomb, "N m"),
                ("motor's zero", spring.motor_zero, "rad"),
            ];
            for (at, (what, Estimate { value, std }, unit)) in rows.into_iter().enumerate() {
                let missed = match at {
                    0 => format!("{:.2} %", 100.0 * spring.residual / spring.torque.max(1e-300)),
                    _ => String::new(),
                };
                let joint = if at == 0 { spring.joint.clone() } else { String::new() };
                let (what, unit) = (what.to_owned(), unit.to_owned());
                table.push(vec![joint, what, short(value), format!("{std:.1e}"), unit, missed]);
            }
        }
        writeln!(out, "{table}")?;
        writeln!(out, "{}", text::parameter_table(&self.parameters))?;
        let mut table = columns(&["joint", "torque", "residual"]);
        for (joint, [missed, size]) in self.model.joints.iter().zip(&self.stages.residuals) {
            table.push(vec![joint.name.clone(), short(*size), short(*missed)]);
        }
        write!(out, "{table}")?;
        text::write_nearest(out, self.bodies.distance)
    }

    fn json(&self) -> TwoStageJson<'_> {
        let residuals = self.model.joints.iter().zip(&self.stages.residuals);
        TwoStageJson {
            model: &self.model.model,
            springs: self.stages.springs.iter().map(SpringJson::new).collect(),
            parameters: self.parameters.iter().map(ParameterJson::new).collect(),
            residual: residuals
                .map(|(joint, &[residual_rms, torque_rms])| ResidualJson {
                    joint: &joint.name,
                    torque_rms,
                    residual_rms,
                })
                .collect(),
            consistent: ConsistentJson::new(self.model, &self.bodies),
            remarks: &self.remarks,
        }
    }
}

fn columns(names: &[&str]) -> Table {
    let is_text = ["joint", "", "unit"];
    let align = |name: &str| if is_text.contains(&name) { Align::Left } else { Align::Right };
    let columns: Vec<(&str, Align)> = names.iter().map(|name| (*name, align(name))).collect();
    Table::new(&columns)
}

#[derive(Serialize)]
struct TwoStageJson<'a> {
    model: &'a str,
    springs: Vec<SpringJson<'a>>,
    parameters: Vec<ParameterJson<'a>>,
    residual: Vec<ResidualJson<'a>>,
    /// theta0 of the nearest bodies that exist, and how far they are.
    consistent: ConsistentJson<'a>,
    remarks: &'a [String],
}

#[derive(Serialize)]
struct SpringJson<'a> {
    joint: &'a str,
    stiffness: EstimateJson,
    viscous: EstimateJson,
    coulomb: EstimateJson,
    /// The force of the spring where both encoders read 0.
    preload: EstimateJson,
    /// The motor's reading where the spring is relaxed and the joint reads 0.
    motor_zero: EstimateJson,
    /// Roots of the mean square of what the motor's equation misses, and of its torque \[N m\].
    residual_rms: f64,
    torque_rms: f64,
}

#[derive(Serialize)]
struct EstimateJson {
    value: f64,
    std: f64,
    unit: &'static str,
}

#[derive(Serialize)]
struct ResidualJson<'a> {
    joint: &'a str,
    torque_rms: f64,
    residual_rms: f64,
}

impl<'a> SpringJson<'a> {
    fn new(spring: &'a Spring) -> Self {
        let of = |Estimate { value, std }, unit| EstimateJson { value, std, unit };
        Self {
            joint: &spring.joint,
            stiffness: of(spring.stiffness, "N/m"),
            viscous: of(spring.viscous, "N m s/rad"),
            coulomb: of(spring.coulomb, "N m"),
            preload: of(spring.preload, "N"),
            motor_zero: of(spring.motor_zero, "rad"),
            residual_rms: spring.residual,
            torque_rms: spring.torque,
        }
    }
}
