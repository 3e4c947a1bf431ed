//! `denavit identify --two-stage`: springs and motors first, then the load (thesis 3.3.2).

mod json;
mod loads;

use super::super::progress::Progress;
use super::{Arguments, IdentifyFailure, logs, page, text};
use crate::cli::Answer;
use crate::cli::base::regressor_options;
use crate::cli::failure::Failure;
use crate::cli::json::write_json;
use crate::cli::outputs::{check_outputs, on_stdout, say_written, write_whole};
use denavit::identify::estimate::{
    Consistent, IdentifiedParameter, JointResidual, Validation, consistent, parameters, validate,
};
use denavit::identify::two_stage::{Estimate, TwoStage, TwoStageOptions, two_stage};
use denavit::identify::{NewValue, UpdateError, updated_model, updated_text};
use denavit::measure::condition::{Conditioning, Filter};
use denavit::measure::log::{LogRemark, MeasuredLog};
use denavit::model::{self, Robot};
use denavit::plants::plant_of;
use denavit::plants::regression::{ModelParameter, RegressionModel};
use denavit::regressor::RegressorOptions;
use denavit::report::{Align, Table, TorquePicture, TwoStagePage, percent, short, torque_picture};
use std::io::Write;

/// What was found.
struct Found<'a> {
    model: &'a RegressionModel,
    stages: TwoStage,
    parameters: Vec<IdentifiedParameter>,
    /// The bodies nearest to the load.
    bodies: Consistent,
    /// What the load leaves of the torques of the log, and of those for validation.
    train: Validation,
    validate: Option<Validation>,
    /// Whether a log for validation is the one of the estimate.
    is_searched_again: bool,
    remarks: Vec<String>,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [arguments.output.as_ref(), arguments.svg.as_ref(), arguments.html.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    check_outputs(&outputs)?;
    let [path] = &arguments.train[..] else { return Err(IdentifyFailure::OneLog.into()) };
    let given = arguments.model_apart()?;
    let robot = given.whole.clone();
    let (_, source) = given.without_laws()?;
    // inertias of rotors are known here (thesis 3.3.1)
    let asked = regressor_options(&robot, &arguments.with)?;
    let options = RegressorOptions { rotor: false, ..asked };
    let mut model = RegressionModel::new(&robot, options, &arguments.keep)
        .map_err(|error| IdentifyFailure::Regression(Box::new(error)))?;
    model.law = arguments.friction;
    let progress = Progress::new();
    progress.show("reading the log");
    let log = logs::measured(arguments, &robot, &model, path)?;
    progress.show("estimating springs, then the load");
    let found = Found::new(arguments, &robot, &model, &log)?;
    progress.clear();
    if let Some(path) = &arguments.output {
        write_whole(path, found.updated(&robot, &source)?.as_bytes())?;
    }
    if let Some(path) = &arguments.svg {
        write_whole(path, found.picture().as_bytes())?;
    }
    if let Some(path) = &arguments.html {
        write_whole(path, found.page(arguments, &robot)?.as_bytes())?;
    }
    match (is_answered, arguments.json) {
        (true, _) => {}
        (_, true) => write_json(out, &found.json())?,
        (_, false) => {
            found.write(out)?;
            say_written(out, &outputs)?;
        }
    }
    let explains = found.validate.as_ref().is_none_or(|held_out| held_out.relative < 1.0);
    Ok(if explains && !found.is_searched_again { Answer::Done } else { Answer::Negative })
}

impl<'a> Found<'a> {
    /// Both stages, and what they leave.
    fn new(
        arguments: &Arguments,
        robot: &Robot,
        model: &'a RegressionModel,
        log: &MeasuredLog,
    ) -> Result<Self, Failure> {
        let plant = plant_of(robot, &[])
            .map_err(|error| IdentifyFailure::Plant(robot.name.clone(), error))?;
        let plant = plant.model();
        let conditions = |log: &MeasuredLog| arguments.conditions.of(log.step_s, log.samples(), 0);
        let of_load = conditions(log);
        // springs are stiff: the first stage takes what the rate of sampling allows
        let tenth = Filter { order: 4, cutoff_hz: 0.1 / log.step_s };
        let of_springs = Conditioning { filter: Some(tenth), decimation: 1, ..of_load };
        let how = TwoStageOptions { of_springs, of_load, slow: arguments.skip_slow };
        let stages = two_stage(plant, model, log, &how)
            .map_err(|error| IdentifyFailure::TwoStage(log.file.clone(), error))?;
        let parameters = parameters(model, &stages.load);
        let standard: Vec<f64> =
            model.standard.iter().map(|one| one.value.unwrap_or(0.0)).collect();
        let bodies = consistent(model, &stages.load, &standard);
        let named = |log: &MeasuredLog| {
            let said = |remark: &LogRemark| format!("{}: {remark}", log.file);
            log.remarks.iter().map(said).collect::<Vec<String>>()
        };
        let mut remarks = named(log);
        let own = loads::conditioned(plant, log, &stages.springs, &of_load)?;
        let mut held_out = Vec::new();
        let mut is_searched_again = false;
        for path in &arguments.validate {
            let log = logs::measured(arguments, robot, model, path)?;
            let new: Vec<String> =
                named(&log).into_iter().filter(|one| !remarks.contains(one)).collect();
            remarks.extend(new);
            let loads = loads::conditioned(plant, &log, &stages.springs, &conditions(&log))?;
            if own.overlaps(&loads) {
                is_searched_again = true;
                let same = LogRemark::SameAs { other: own.file.clone() };
                remarks.push(format!("{}: {same}", log.file));
            }
            held_out.push(loads);
        }
        let phi = stages.load.solution.phi.as_slice();
        let train = validate(model, phi, &[own]);
        let validate = (!held_out.is_empty()).then(|| validate(model, phi, &held_out));
        let mut found =
            Self { model, stages, parameters, bodies, train, validate, is_searched_again, remarks };
        let moved = found.moved();
        found.remarks.extend(moved);
        Ok(found)
    }

    /// What is left of a joint's torque in the logs for validation.
    fn left_of(&self, joint: &str) -> Option<f64> {
        let held_out = self.validate.as_ref()?;
        let is_own = |one: &&JointResidual| one.name == joint;
        held_out.joints.iter().find(is_own).map(|one| one.relative)
    }

    fn picture(&self) -> String {
        let picture = TorquePicture {
            title: &self.model.model.replace('_', " "),
            subtitle: match self.validate {
                Some(_) => "torques on the loads, of the logs for validation",
                None => "torques on the loads, of the log that the estimate is from",
            },
            validation: self.validate.as_ref().unwrap_or(&self.train),
        };
        torque_picture(&picture)
    }

    fn page(&self, arguments: &Arguments, robot: &Robot) -> Result<String, Failure> {
        let page = TwoStagePage {
            model: &robot.name,
            facts: &page::facts(arguments, robot),
            remarks: &self.remarks,
            springs: &self.stages.springs,
            parameters: &self.parameters,
            train: &self.train,
            validate: self.validate.as_ref(),
            distance: self.bodies.distance,
        };
        Ok(page.page().map_err(IdentifyFailure::Formula)?.render())
    }
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
        let mut table = columns(&["joint", "torque", "residual", "left of other logs"]);
        for (joint, [missed, size]) in self.model.joints.iter().zip(&self.stages.residuals) {
            let other = self.left_of(&joint.name).map(percent).unwrap_or_default();
            table.push(vec![joint.name.clone(), short(*size), short(*missed), other]);
        }
        write!(out, "{}", table.without_empty_columns())?;
        text::write_nearest(out, self.bodies.distance)
    }
}

fn columns(names: &[&str]) -> Table {
    let is_text = ["joint", "", "unit"];
    let align = |name: &str| if is_text.contains(&name) { Align::Left } else { Align::Right };
    let columns: Vec<(&str, Align)> = names.iter().map(|name| (*name, align(name))).collect();
    Table::new(&columns)
}
