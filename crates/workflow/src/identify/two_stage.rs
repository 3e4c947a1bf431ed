//! Springs and motors first, then the load (thesis 3.3.2).

use super::estimation::updated;
use super::loads::conditioned;
use super::{IdentifyOptions, regression};
use crate::error::{Cause, Error};
use crate::logs::Logs;
use crate::observer::{Observer, Stage, Watched};
use crate::robot_file::RobotFile;
use denavit_codegen::model::{self, Robot};
use denavit_codegen::regressor::RegressorOptions;
use denavit_codegen::regressor::functions::modelled;
use denavit_elastic::{Estimate, TwoStage, TwoStageOptions, two_stage};
use denavit_identify::estimate::{
    Consistent, IdentifiedParameter, JointResidual, Validation, consistent, parameters, validate,
};
use denavit_measure::condition::{Conditioning, Filter};
use denavit_measure::log::{LogRemark, MeasuredLog};
use denavit_numerics::short;
use denavit_plants::model_text::{NewValue, with_values};
use denavit_plants::plant_of;
use denavit_plants::regression::{ModelParameter, RegressionModel};

/// What was found.
#[derive(Debug)]
pub struct TwoStageFound {
    /// The robot.
    pub robot: Robot,
    /// Base parameters of the load and their columns.
    pub model: RegressionModel,
    /// Both stages.
    pub stages: TwoStage,
    /// Base parameters of the load.
    pub parameters: Vec<IdentifiedParameter>,
    /// The bodies nearest to the load.
    pub bodies: Consistent,
    /// The residual of the load in the log of the estimate.
    pub train: Validation,
    /// The same in those that judge.
    pub validate: Option<Validation>,
    /// Whether a log that judges is the one of the estimate.
    pub is_searched_again: bool,
    /// What was noticed.
    pub remarks: Vec<String>,
    /// The text of the model file.
    source: String,
}

/// Identifies springs and motors of series elastic drives from one log with `motor_JOINT` and
/// `tau_cmd_JOINT`, then the load with what the springs pass on.
///
/// # Errors
/// All that is wrong with the logs, or why they do not suit the robot.
pub fn identify_two_stage(
    file: RobotFile,
    logs: &Logs,
    options: &IdentifyOptions,
    observer: &mut dyn Observer,
) -> Result<TwoStageFound, Error> {
    let mut watched = Watched::new(observer);
    let [searched] = &logs.train[..] else { return Err(Cause::OneLog.into()) };
    let robot = file.whole.clone();
    let (_, source) = file.without_laws()?;
    // inertias of rotors are known here (thesis 3.3.1)
    let asked = options.with.unwrap_or_else(|| modelled(&robot));
    let columns = RegressorOptions { rotor: false, ..asked };
    let options = IdentifyOptions { with: Some(columns), ..options.clone() };
    let model = regression(&robot, &options)?;
    let stopped = || Error::from(Cause::Stopped);
    watched.begins(Stage::ReadingLogs).then_some(()).ok_or_else(stopped)?;
    let log = logs.measured(searched, &robot, &model)?;
    watched.begins(Stage::Estimating).then_some(()).ok_or_else(stopped)?;
    let plant = plant_of(&robot, &[]).map_err(|error| Cause::Plant(robot.name.clone(), error))?;
    let plant = plant.model();
    let conditions = |log: &MeasuredLog| options.conditions.of(log.step_s, log.samples(), 0);
    let of_load = conditions(&log);
    // springs are stiff: the first stage takes what the sampling rate allows
    let tenth = Filter { order: 4, cutoff_hz: 0.1 / log.step_s };
    let of_springs = Conditioning { filter: Some(tenth), decimation: 1, ..of_load };
    let how = TwoStageOptions { of_springs, of_load, slow: options.slow };
    let stages = two_stage(plant, &model, &log, &how)
        .map_err(|error| Cause::Identify(log.file.clone(), error))?;
    let parameters = parameters(&model, &stages.load);
    let bodies = consistent(&model, &stages.load);
    let mut remarks = named(&log);
    let own = conditioned(plant, &log, &stages.springs, &of_load)?;
    let mut held_out = Vec::new();
    let mut is_searched_again = false;
    for judging in &logs.held_out {
        let log = logs.measured(judging, &robot, &model)?;
        let new = named(&log).into_iter().filter(|one| !remarks.contains(one));
        remarks.extend(new.collect::<Vec<String>>());
        let loads = conditioned(plant, &log, &stages.springs, &conditions(&log))?;
        if own.shares_a_part(&loads) {
            is_searched_again = true;
            let same = LogRemark::SameAs { other: own.file.clone() };
            remarks.push(format!("{}: {same}", log.file));
        }
        held_out.push(loads);
    }
    let phi = stages.load.solution.phi.as_slice();
    let train = validate(&model, phi, &[own]);
    let validate = (!held_out.is_empty()).then(|| validate(&model, phi, &held_out));
    remarks.extend(moved(&stages));
    Ok(TwoStageFound {
        robot,
        model,
        stages,
        parameters,
        bodies,
        train,
        validate,
        is_searched_again,
        remarks,
        source,
    })
}

fn named(log: &MeasuredLog) -> Vec<String> {
    log.remarks.iter().map(|remark| format!("{}: {remark}", log.file)).collect()
}

/// What is said of friction below 0: the model gets none.
fn moved(stages: &TwoStage) -> Vec<String> {
    let all = stages.springs.iter().flat_map(|spring| {
        [("Viscous", spring.viscous), ("Coulomb", spring.coulomb)].map(|one| (spring, one))
    });
    all.filter(|(_, (_, estimate))| estimate.value < 0.0)
        .map(|(spring, (what, Estimate { value, std }))| {
            format!(
                "{what} friction of the motor of {} comes out as {} +- {std:.1e}, which no motor \
                 has: a model file gets 0, without a deviation.",
                spring.joint,
                short(value)
            )
        })
        .collect()
}

impl TwoStageFound {
    /// Whether the load explains torques that judge it.
    pub fn is_good(&self) -> bool {
        let explains = self.validate.as_ref().is_none_or(|held_out| held_out.relative < 1.0);
        explains && !self.is_searched_again
    }

    /// The residual of a joint over its torque in the logs that judge.
    pub fn left_of(&self, joint: &str) -> Option<f64> {
        let held_out = self.validate.as_ref()?;
        let is_own = |one: &&JointResidual| one.name == joint;
        held_out.joints.iter().find(is_own).map(|one| one.relative)
    }

    /// The text of the model file with the springs, and with the bodies nearest to the load.
    ///
    /// # Errors
    /// If what was found makes no model.
    pub fn updated(&self) -> Result<String, Error> {
        let Self { robot, model, source, .. } = self;
        let (bodies, listed) = (&self.bodies, &self.parameters);
        let updated = updated(robot, model, bodies, listed, source).map_err(Cause::Update)?;
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
        let text = with_values(&updated.text, &new)
            .ok_or_else(|| Cause::Update(denavit_plants::Error::no_place(&robot.name)))?;
        model::read("the identified model", text.as_bytes()).map_err(Cause::Model)?;
        Ok(text)
    }
}
