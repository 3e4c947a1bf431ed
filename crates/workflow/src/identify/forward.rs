//! Logs simulated again, with the model as it was and with what was found.

use super::conditions::Conditions;
use super::logs::Read;
use crate::error::{Cause, Error};
use crate::files::Files;
use crate::mistaken::FileKind;
use crate::observer::{Stage, Watched};
use denavit_codegen::model::Robot;
use denavit_measure::condition::Conditioned;
use denavit_numerics::short;
use denavit_plants::{UpdatedModel, plant_of, shipped};
use denavit_replay::{
    ErrorKind, Forward, ForwardKind, MotionLog, Windows, closed_loop, in_windows, simulated_log,
};
use denavit_simulate::scenario::{Controller, read_controller};
use std::fmt;
use std::path::Path;

/// The controller of a robot, with the model that it had.
#[derive(Clone, Debug)]
pub struct Controlled {
    controller: Controller,
    robot: Robot,
}

impl Controlled {
    /// Reads what drove a robot: a controller file, or a shipped controller.
    ///
    /// # Errors
    /// All that is wrong with it, or why it is not read.
    pub fn read(files: &Files, path: &Path, robot: &Robot) -> Result<Self, Error> {
        let name = path.display().to_string();
        let bytes = files.bytes_or_shipped(
            path,
            "controller",
            shipped::CONTROLLERS,
            FileKind::Controller,
        )?;
        let plant =
            plant_of(robot, &[]).map_err(|error| Cause::Plant(robot.name.clone(), error))?;
        let load = |file: &str| files.beside(path, file);
        let controller = read_controller(&name, &bytes, plant.model(), &load);
        let controller = controller.map_err(Cause::Scenario)?;
        Ok(Self { controller, robot: robot.clone() })
    }

    /// The logs of the estimate as a model would have given them, conditioned as they are.
    pub(super) fn instruments(
        &self,
        found: &Robot,
        read: &Read,
        conditions: &Conditions,
    ) -> Result<Vec<Conditioned>, Error> {
        let plant = |robot: &Robot| {
            let failed = |error| Cause::Plant(robot.name.clone(), error);
            plant_of(robot, &[]).map_err(failed)
        };
        let (mut plant, mut believed) = (plant(found)?, plant(&self.robot)?);
        let names: Vec<String> =
            plant.model().joints.iter().map(|joint| joint.name.clone()).collect();
        let mut one = |log: &MotionLog| {
            let failed = |error| Cause::Replay(log.file.clone(), error);
            let believed = Some(believed.as_mut());
            let simulated = simulated_log(plant.as_mut(), believed, &self.controller, log);
            let simulated = simulated.map_err(failed)?;
            let how = conditions.of(log.step_s, simulated.samples(), 0);
            let failed = |error| Cause::Condition(log.file.clone(), error);
            Ok(Conditioned::new(simulated, &names, &how).map_err(failed)?)
        };
        read.whole.iter().map(&mut one).collect()
    }
}

/// Why a model was not moved.
#[derive(Clone, Debug)]
pub enum NotMoved {
    /// What was found makes no model.
    Update(denavit_plants::Error),
    /// A model has no plant.
    Plant(denavit_plants::Error),
    /// A log cannot be simulated; holds its file.
    Forward(String, denavit_replay::Error),
    /// The observer stopped the work before.
    Stopped,
}

impl fmt::Display for NotMoved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Update(error) => write!(f, "{error}"),
            Self::Plant(error) => write!(f, "{error}"),
            Self::Forward(file, error) => write!(f, "{file}: {error}"),
            Self::Stopped => write!(f, "stopped before"),
        }
    }
}

/// Logs simulated with the values that the model had, and with those that were found.
#[derive(Debug)]
pub struct SimulationGap {
    /// With the values that the model had.
    pub before: Result<Forward, NotMoved>,
    /// With those that were found.
    pub after: Result<Forward, NotMoved>,
}

/// Logs that are to be simulated again.
#[derive(Clone, Copy)]
pub(super) struct Again<'a> {
    pub(super) controlled: Option<&'a Controlled>,
    pub(super) logs: &'a [MotionLog],
    pub(super) window_s: f64,
}

impl Again<'_> {
    /// With the values that the model had, and with those that were found.
    pub(super) fn gap(
        self,
        robot: &Robot,
        updated: &Result<UpdatedModel, denavit_plants::Error>,
        watched: &mut Watched<'_>,
    ) -> SimulationGap {
        let before =
            self.moved(robot, None, &mut |share| watched.share(Stage::SimulatingLogs, 0.5 * share));
        let after = match updated {
            Ok(updated) => self.moved(&updated.robot, Some(robot), &mut |share| {
                watched.share(Stage::SimulatingLogs, 0.5 + 0.5 * share)
            }),
            Err(error) => Err(NotMoved::Update(error.clone())),
        };
        SimulationGap { before, after }
    }

    /// All logs, one after the other. `goes_on` hears the share that is done.
    fn moved(
        self,
        robot: &Robot,
        believed: Option<&Robot>,
        goes_on: &mut dyn FnMut(f64) -> bool,
    ) -> Result<Forward, NotMoved> {
        let plant = |robot: &Robot| plant_of(robot, &[]).map_err(NotMoved::Plant);
        let (mut plant, mut believed) = (plant(robot)?, believed.map(plant).transpose()?);
        let mut joined: Option<Forward> = None;
        for (done, log) in self.logs.iter().enumerate() {
            if !goes_on(done as f64 / self.logs.len() as f64) {
                return Err(NotMoved::Stopped);
            }
            let made = match self.controlled {
                Some(Controlled { controller, .. }) => {
                    closed_loop(plant.as_mut(), believed.as_deref_mut(), controller, log)
                }
                None => {
                    let windows = Windows { length_s: self.window_s, ..Windows::default() };
                    in_windows(plant.as_mut(), log, windows)
                }
            };
            let made = made.map_err(|error| NotMoved::Forward(log.file.clone(), error))?;
            match &mut joined {
                Some(joined) => joined.append(made),
                None => joined = Some(made),
            }
        }
        Ok(joined.expect("there is a log"))
    }
}

impl SimulationGap {
    /// A controller that does not fit its log is the user's fault, and no result.
    pub(super) fn check(&self) -> Result<(), Error> {
        match &self.after {
            Err(NotMoved::Forward(file, error)) if error.kind() != ErrorKind::BrokeOff => {
                Err(Cause::Replay(file.clone(), error.clone()).into())
            }
            Ok(_) | Err(NotMoved::Forward(..)) => Ok(()),
            Err(NotMoved::Plant(_) | NotMoved::Update(_) | NotMoved::Stopped) => Ok(()),
        }
    }

    /// What was made, if anything.
    pub fn kind(&self) -> Option<ForwardKind> {
        let made = self.after.as_ref().or(self.before.as_ref());
        made.ok().map(|forward| forward.kind)
    }

    /// How logs were simulated, as part of a sentence.
    pub fn method(&self) -> String {
        match self.kind() {
            None => "not simulated again".to_owned(),
            Some(ForwardKind::ClosedLoop) => {
                "simulated again under the controller, from the first state".to_owned()
            }
            Some(ForwardKind::Windows { count, length_s }) => format!(
                "simulated again in {count} windows of {} s, from measured states under measured \
                 torques",
                short(length_s)
            ),
        }
    }

    /// What kept models from being simulated.
    pub fn reasons(&self) -> Vec<String> {
        let [before, after] =
            [("before", &self.before), ("after", &self.after)].map(|(when, made)| {
                made.as_ref().err().map(|reason| format!("simulation, {when}: {reason}"))
            });
        before.into_iter().chain(after).collect()
    }
}
