//! Parameters from logs: read, conditioned behind the filter that noise asks for, estimated,
//! judged, and simulated again.

mod clock;
mod conditions;
mod estimation;
mod forward;
mod loads;
mod logs;
mod long;
mod prior;
mod statics;
mod statics_file;
mod two_stage;

use crate::error::{Cause, Error};
use crate::logs::{LogSource, Logs};
use crate::observer::{Observer, Stage, Watched};
use crate::robot_file::{EffectUse, RobotFile, Treatment};
pub use conditions::{Conditions, FilterChoice};
use denavit_codegen::model::Robot;
use denavit_codegen::regressor::RegressorOptions;
use denavit_codegen::regressor::functions::modelled;
use denavit_identify::Identification;
use denavit_identify::estimate::{Errors, Method, Options, SlowRows};
use denavit_measure::log::LogRemark;
use denavit_plants::UpdatedModel;
use denavit_plants::effect::{AddedLaw, ApartEffects};
use denavit_plants::regression::{CoulombLaw, RegressionModel};
use estimation::Estimation;
use forward::Again;
pub use forward::{Controlled, NotMoved, SimulationGap};
use logs::Read;
pub use long::{LongLog, LongPlan, PieceRows, identify_long};
pub use statics::{StaticsFound, identify_statics};
pub use statics_file::{STATICS_FORMAT, statics_schema};
pub use two_stage::{TwoStageFound, identify_two_stage};

/// How parameters are identified.
#[derive(Clone, Debug)]
pub struct IdentifyOptions {
    /// Which parameters of joints are found beside those of bodies; those that the model has if
    /// nothing is said.
    pub with: Option<RegressorOptions>,
    /// Parameters that are kept before others, where relations leave a choice.
    pub keep: Vec<String>,
    /// How parameters are estimated.
    pub method: Method,
    /// How standard errors are found.
    pub errors: Errors,
    /// Which rows are left out near velocity reversals.
    pub slow: SlowRows,
    /// How Coulomb friction depends on velocity.
    pub friction: CoulombLaw,
    /// How logs are conditioned.
    pub conditions: Conditions,
    /// Logs of the same motion without its noise, for [`Method::Instrumental`], sample by sample.
    pub instruments: Vec<LogSource>,
    /// What drove the robot: logs are simulated again in closed loop.
    pub controller: Option<Controlled>,
    /// Without a controller, logs are simulated again in windows of this length \[s\].
    pub window_s: f64,
    /// Whether the standard deviations that the model states are knowledge.
    pub uses_prior: bool,
    /// The step of the encoders \[rad, m\], where it cannot be seen in the logs.
    pub resolution: Option<f64>,
}

impl Default for IdentifyOptions {
    fn default() -> Self {
        Self {
            with: None,
            keep: Vec::new(),
            method: Method::Weighted,
            errors: Errors::default(),
            slow: SlowRows::default(),
            friction: CoulombLaw::default(),
            conditions: Conditions::default(),
            instruments: Vec::new(),
            controller: None,
            window_s: 0.2,
            uses_prior: false,
            resolution: None,
        }
    }
}

/// What was identified.
#[derive(Debug)]
pub struct Identified {
    /// The robot, without laws beside its equations.
    pub robot: Robot,
    /// Base parameters and their columns.
    pub model: RegressionModel,
    /// What was found of them.
    pub found: Identification,
    /// The model with what was found.
    pub updated: Result<UpdatedModel, denavit_plants::Error>,
    /// What was noticed of logs, each with its file.
    pub remarks: Vec<(String, LogRemark)>,
    /// What became of the model's effects.
    pub effects: Vec<EffectUse>,
    /// The logs simulated again, where that is possible.
    pub simulated: Option<SimulationGap>,
    /// Whether the observer stopped the work: filters may be higher than noise asks for, and logs
    /// not simulated again.
    pub is_stopped: bool,
}

/// What work on logs has in common.
#[derive(Clone, Copy)]
struct Work<'a> {
    logs: &'a Logs,
    options: &'a IdentifyOptions,
    robot: &'a Robot,
    /// Effects that the model has beside its equations.
    laws: &'a [AddedLaw],
    model: &'a RegressionModel,
}

impl Work<'_> {
    /// How many files are read.
    fn files(self) -> usize {
        let Self { logs, options, .. } = self;
        logs.train.len() + options.instruments.len() + logs.held_out.len()
    }
}

/// What becomes of laws beside the equations.
const TAKEN_OUT: Treatment = Treatment {
    name: "taken_out",
    words: "a law beside the equations of the bodies: taken out of the logs with the values of the \
            model",
};

/// Identifies base parameters, with standard errors, from logs of motion and torque.
///
/// # Errors
/// All that is wrong with the logs, or why they do not suit the robot or the options.
pub fn identify(
    file: &RobotFile,
    logs: &Logs,
    options: &IdentifyOptions,
    observer: &mut dyn Observer,
) -> Result<Identified, Error> {
    let mut watched = Watched::new(observer);
    let model = regression(&file.apart.robot, options)?;
    let head = Head::new(file, logs, options, &model, &mut watched)?;
    head.answered(file, &mut watched)
}

/// Logs that were identified, before they are simulated again: of a long log its head.
struct Head<'a> {
    estimation: Estimation<'a>,
    read: Read,
    how: Options,
    found: Identification,
    updated: Result<UpdatedModel, denavit_plants::Error>,
    /// Which logs for validation say the same as others.
    same: Vec<(String, LogRemark)>,
}

impl<'a> Head<'a> {
    fn new(
        file: &'a RobotFile,
        logs: &'a Logs,
        options: &'a IdentifyOptions,
        model: &'a RegressionModel,
        watched: &mut Watched<'_>,
    ) -> Result<Self, Error> {
        let ApartEffects { robot, laws, .. } = &file.apart;
        let work = Work { logs, options, robot, laws, model };
        let estimation = Estimation { work, own: &file.own, source: &file.source };
        let mut read = estimation.read_first(watched)?;
        let same = read.same();
        let how = options.estimate(model, read.position_noise.clone())?;
        if how.method == Method::Instrumental && read.instruments.is_empty() {
            let controller = options.controller.as_ref().ok_or(Cause::NoInstruments)?;
            let first = Options { method: Method::Weighted, ..how.clone() };
            let updated = estimation.found(&read, &first)?.1.map_err(Cause::Update)?;
            if !watched.begins(Stage::SimulatingInstruments) {
                return Err(Cause::Stopped.into());
            }
            read.instruments =
                controller.instruments(&updated.robot, &read, &options.conditions)?;
        }
        let (read, (found, updated)) = estimation.unbiased(read, &how, watched)?;
        let is_sure = found.misread.iter().any(|one| one.is_sure);
        if is_sure && !logs.accepts_suspicious {
            return Err(Cause::Misread(found.misread).into());
        }
        Ok(Self { estimation, read, how, found, updated, same })
    }

    /// The answer, with logs simulated again.
    fn answered(self, file: &RobotFile, watched: &mut Watched<'_>) -> Result<Identified, Error> {
        let Self { estimation, read, found, updated, same, .. } = self;
        let Work { options, robot, model, .. } = estimation.work;
        let simulates = !read.motions.is_empty() && watched.begins(Stage::SimulatingLogs);
        let simulated = simulates.then(|| {
            let controlled = options.controller.as_ref();
            let again = Again { controlled, logs: &read.motions, window_s: options.window_s };
            again.gap(&file.whole, &updated, watched)
        });
        if let (Some(gap), true) = (&simulated, options.controller.is_some()) {
            gap.check()?;
        }
        let (mut remarks, effects) = (read.into_remarks(), file.uses(TAKEN_OUT));
        let is_new = |one: &(String, LogRemark)| !remarks.contains(one);
        remarks.extend(same.into_iter().filter(is_new).collect::<Vec<_>>());
        let (is_stopped, robot, model) = (watched.is_stopped, robot.clone(), model.clone());
        Ok(Identified { robot, model, found, updated, remarks, effects, simulated, is_stopped })
    }
}

/// Base parameters and their columns.
fn regression(robot: &Robot, options: &IdentifyOptions) -> Result<RegressionModel, Error> {
    let columns = options.with.unwrap_or_else(|| modelled(robot));
    let model = RegressionModel::new(robot, columns, &options.keep);
    let mut model = model.map_err(Cause::Regression)?;
    model.law = options.friction;
    Ok(model)
}

impl IdentifyOptions {
    fn estimate(&self, model: &RegressionModel, noise: Vec<f64>) -> Result<Options, Error> {
        let prior = if self.uses_prior { prior::prior(model) } else { Vec::new() };
        if self.uses_prior && prior.is_empty() {
            return Err(Cause::NoPrior(model.model.clone()).into());
        }
        Ok(Options {
            method: self.method,
            errors: self.errors,
            prior,
            position_noise: noise,
            slow: self.slow,
        })
    }
}

impl Identified {
    /// Whether the answer can be used: it explains torques that judge it, no column seems to be
    /// another one than it is taken for (unless logs are taken as they are, `accepts_suspicious`),
    /// and bodies of the identified values exist.
    pub fn is_good(&self, accepts_suspicious: bool) -> bool {
        let found = &self.found;
        let judged = found.validate.as_ref().unwrap_or(&found.train);
        let is_doubted = found.is_noise() || !found.misread.is_empty() || found.is_of_other_robot();
        let is_doubted = is_doubted && !accepts_suspicious || found.is_of_no_bodies();
        let is_same =
            |(_, remark): &(String, LogRemark)| matches!(remark, LogRemark::SameAs { .. });
        let explains = !self.remarks.iter().any(is_same)
            && judged.relative < 1.0
            && found.unexplained.is_empty()
            && found.contradicting_logs.is_empty();
        explains && !is_doubted
    }
}
