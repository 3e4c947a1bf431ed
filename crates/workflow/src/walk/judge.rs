//! Balance along a run of a scenario, or along a log.

use crate::error::{Cause, Error};
use crate::files::Files;
use denavit_codegen::model::Robot;
use denavit_plants::{ErrorKind, PlantModel, plant_of};
use denavit_simulate::scenario::{RunScheme, Scenario};
use denavit_walk::balance::{Course, Grid, course_of_log, course_on_grid};
use std::path::Path;

/// A judged robot: its name, its description, and what was found.
#[derive(Debug)]
pub struct Judged {
    /// The scenario, or the file of the log.
    pub name: String,
    /// The robot.
    pub model: PlantModel,
    /// What was found at each instant.
    pub course: Course,
    /// What its reader must know beside.
    pub notes: Vec<String>,
}

/// How a run is judged.
#[derive(Clone, Copy, Debug, Default)]
pub struct JudgeOptions {
    /// Distance of the instants that are looked at \[s\]; 0.0005 without it, more of runs over
    /// 100 s.
    pub period_s: Option<f64>,
    /// Whether the whole run is judged, and not one cycle of the gait.
    pub whole: bool,
}

/// Distance of instants where nobody asks for another one \[s\].
const PERIOD_S: f64 = 5e-4;

/// Judges the run of a scenario, from event to event.
///
/// # Errors
/// If the robot does not walk, or the run cannot be judged.
pub fn judge_run(scenario: &mut Scenario, options: &JudgeOptions) -> Result<Judged, Error> {
    let grid = options.period_s.map_or(Grid::From(PERIOD_S), Grid::Every);
    let course = course_on_grid(scenario, grid, options.whole)
        .map_err(|error| Cause::Walk(scenario.name.clone(), error.to_string()))?;
    let mut notes = Vec::new();
    if scenario.scheme == RunScheme::TimeStepping {
        notes.push("judged from event to event, though the scenario is one of steps".to_owned());
    }
    let chosen =
        course.period_s.filter(|period_s| grid == Grid::From(PERIOD_S) && *period_s > PERIOD_S);
    notes.extend(chosen.map(|period_s| {
        format!(
            "the run is long: an instant every {period_s} s; `options.period_s={PERIOD_S}` \
                 takes more"
        )
    }));
    let model = scenario.plant.model().clone();
    Ok(Judged { name: scenario.name.clone(), model, course, notes })
}

/// Judges a log of a robot.
///
/// # Errors
/// All that is wrong with the log, or why it does not suit the robot.
pub fn judge_log(robot: &Robot, log: &Path, files: &Files) -> Result<Judged, Error> {
    let name = log.display().to_string();
    let file = files.log(log)?;
    let parameters = file.parameters(&robot.name, robot.hash).map_err(Cause::Log)?;
    let mut plant = plant_of(robot, &parameters).map_err(|error| {
        match error.parameter().filter(|_| error.kind() == ErrorKind::UnknownParameter) {
            Some(parameter) => Cause::Log(file.unknown_parameter(parameter)),
            None => Cause::Walk(robot.name.clone(), error.to_string()),
        }
    })?;
    let course =
        course_of_log(plant.as_mut(), &file).map_err(|error| match error.log_faults() {
            Some(faults) => Cause::Log(faults.clone().into()),
            None => Cause::Walk(name.clone(), error.to_string()),
        })?;
    let model = plant.model().clone();
    let mut notes = Vec::new();
    if !parameters.is_empty() {
        let all = parameters.iter().map(|one| format!("{} = {}", one.parameter, one.value));
        notes.push(format!("by the log's header {}", all.collect::<Vec<_>>().join(", ")));
    }
    Ok(Judged { name, model, course, notes })
}
