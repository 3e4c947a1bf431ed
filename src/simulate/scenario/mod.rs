//! Scenario files: a robot, where it starts, what drives it, and how it is simulated.
//!
//! `"format": "denavit-scenario/1"`, described in docs/scenario.md and by the schema that
//! `denavit schema scenario` prints. All faults of a file are found in one run.

mod fault;
mod options;
mod place;
mod read;
mod reader;
mod reference;

pub use fault::{Cause, Fault, ScenarioError};
pub use read::{Loader, read};

use super::audit::Tolerances;
use super::control::Control;
use super::run::{Run, Simulation, simulate};
use super::start::StartError;
use super::state::State;
use crate::plants::Plant;

/// The tag of a scenario file.
pub const FORMAT: &str = "denavit-scenario/1";

/// The JSON Schema (draft 2020-12) of a scenario file: its form, not its content.
pub fn schema() -> &'static str {
    include_str!("schema.json")
}

/// A scenario, ready to run.
pub struct Scenario {
    /// Its name.
    pub name: String,
    /// What it shows.
    pub description: String,
    /// The robot.
    pub plant: Box<dyn Plant>,
    /// What drives it.
    pub control: Control,
    /// Where it starts.
    pub initial: State,
    /// How it is simulated.
    pub simulation: Simulation,
    /// What the audits may miss.
    pub tolerances: Tolerances,
}

impl Scenario {
    /// Runs it by the event-driven scheme; the log's header says what it was made of.
    pub fn run(&mut self) -> Result<Run, StartError> {
        let mut run =
            simulate(self.plant.as_mut(), &self.control, &self.initial, &self.simulation)?;
        let model = self.plant.model();
        run.log.header = vec![
            ("denavit".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("scenario".to_owned(), self.name.clone()),
            ("model".to_owned(), model.name.clone()),
            ("model_hash".to_owned(), format!("{:016x}", model.hash)),
            ("seed".to_owned(), self.simulation.seed.to_string()),
            ("scheme".to_owned(), "event".to_owned()),
            ("stop".to_owned(), run.stop.word().to_owned()),
        ];
        let audit = &run.audit;
        let figures = [
            ("energy_j", audit.energy_j),
            ("momentum_ns", audit.momentum_ns),
            ("penetration_m", audit.penetration_m),
            ("complementarity_nm", audit.complementarity_nm),
            ("adhesion_n", audit.adhesion_n),
            ("zmp_m", audit.zmp_m),
            ("force_n", audit.force_n),
            ("friction_demand", audit.friction_demand),
        ];
        let lines = figures.map(|(name, value)| (format!("audit_{name}"), format!("{value:e}")));
        run.log.header.extend(lines);
        Ok(run)
    }
}
