//! Scenario files: a robot, where it starts, what drives it, and how it is simulated.
//!
//! `"format": "denavit-scenario/1"`, described in docs/reference/scenario.md and by the schema that
//! `denavit schema scenario` prints. All faults of a file are found in one run.

mod controller;
mod fault;
mod gait;
mod limits;
mod options;
mod pushes;
mod ranges;
mod read;
mod reader;
mod reference;
mod start;
mod stepping;
mod trajectory;

pub use controller::{CONTROLLER_FORMAT, Controller, controller_schema, read_controller};
pub use fault::{Cause, ScenarioError};
pub use gait::{GaitPlanner, PlannedGait};
pub use limits::{Exceeded, Limited};
pub use ranges::Range;
pub use read::{Loader, read, read_planned};
pub use reader::{FieldsNumbers, NodeNumbers, Report, check_format};
pub use trajectory::{TRAJECTORY_FORMAT, Trajectory, read_trajectory, trajectory_schema};

use super::audit::Tolerances;
use super::breakdown::{Breakdown, Stop};
use super::control::Control;
use super::log_origin::{MODEL_HASH, PARAMETERS, hash_text, parameters_text};
use super::measured_log::measured_log;
use super::run::{EventKind, Run, Told, simulate_told};
use super::simulation::Simulation;
use super::state::State;
use super::time_stepping::{Scheme, StepSolver, Stepping, simulate_by_steps_told};
use denavit_plants::{Override, Plant};
use start::Origin;

/// The tag of a scenario file.
pub const FORMAT: &str = "denavit-scenario/1";

/// The JSON Schema (draft 2020-12) of a scenario file: its form, not its content.
pub fn schema() -> &'static str {
    include_str!("schema.json")
}

/// The scheme that makes a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RunScheme {
    /// Smooth motion from event to event.
    #[default]
    Event,
    /// Steps that take contacts into account.
    TimeStepping,
}

impl RunScheme {
    /// What files and logs call them, in the order of the enum.
    pub const WORDS: [&'static str; 2] = ["event", "time_stepping"];

    /// What files and logs call it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Event => Self::WORDS[0],
            Self::TimeStepping => Self::WORDS[1],
        }
    }
}

/// A scenario, ready to run.
pub struct Scenario {
    origin: Origin,
    /// Its name.
    pub name: String,
    /// What it shows.
    pub description: String,
    /// The robot.
    pub plant: Box<dyn Plant>,
    /// Values in place of those of its model, which the plant has.
    pub parameters: Vec<Override>,
    /// The largest speed of each joint, where its model states one [rad/s, m/s].
    pub speed_limits: Vec<Option<f64>>,
    /// Effects of its model on what is logged, with their places: no run has them.
    of_logs: Vec<String>,
    /// What drives it.
    pub control: Control,
    /// Where it starts.
    pub initial: State,
    /// How it is simulated.
    pub simulation: Simulation,
    /// What the audits of the event-driven scheme may miss.
    pub tolerances: Tolerances,
    /// The scheme that makes the run.
    pub scheme: RunScheme,
    /// How steps are made.
    pub stepping: Stepping,
    /// What the audits of time stepping may miss.
    pub stepping_tolerances: Tolerances,
    /// The noise of torques in a log as instruments write it [N m, N]; none writes the run as it
    /// is.
    pub logged_torque_noise: Option<f64>,
}

impl Scenario {
    /// What no run of it has, in words.
    pub fn notes(&self) -> Vec<String> {
        let note = |effect: &String| {
            format!("remark: effect {effect} acts on what is logged: the run is without it")
        };
        self.of_logs.iter().map(note).collect()
    }

    /// Runs it by its scheme; the log's header says what it was made of.
    pub fn run(&mut self) -> Result<Run, ScenarioError> {
        self.run_told(&mut |_| true)
    }

    /// As [`run`](Self::run), heard by somebody.
    ///
    /// # Errors
    /// As of [`run`](Self::run).
    pub fn run_told(&mut self, told: &mut Told<'_>) -> Result<Run, ScenarioError> {
        let plant = self.plant.as_mut();
        let (control, initial, simulation) = (&self.control, &self.initial, &self.simulation);
        let run = match self.scheme {
            RunScheme::Event => simulate_told(plant, control, initial, simulation, told),
            RunScheme::TimeStepping => {
                let stepping = &self.stepping;
                simulate_by_steps_told(plant, control, initial, simulation, stepping, told)
            }
        };
        let mut run = run.map_err(|error| self.origin.place(error))?;
        run.log.header = self.header(&run);
        if let Some(noise) = self.logged_torque_noise {
            let Simulation { measurement, seed, log_period_s, .. } = &self.simulation;
            let is_sampled = self.control.period_s == Some(*log_period_s);
            run.log = measured_log(&run.log, measurement, noise, is_sampled, *seed);
        }
        Ok(run)
    }

    /// Changes the step of time stepping \[s\], and in proportion to it what its audits may miss.
    pub fn set_step_s(&mut self, step_s: f64) {
        self.stepping_tolerances = self.stepping_tolerances.scaled(step_s / self.stepping.step_s);
        self.stepping.step_s = step_s;
    }

    /// What may help where a run stopped.
    pub fn hint(&self, stop: &Stop) -> Option<&'static str> {
        match (self.scheme, stop, self.stepping.solver) {
            (RunScheme::Event, ..) | (_, Stop::Breakdown(Breakdown::SingularPose), _) => {
                stop.hint(self.simulation.friction)
            }
            (_, Stop::Breakdown(Breakdown::Contact(_)), StepSolver::Pivots { .. }) => {
                Some("`\"solver\": \"sweeps\"` in `time_stepping` keeps the cones")
            }
            (_, Stop::Breakdown(Breakdown::Contact(_)), StepSolver::Sweeps(_)) => {
                Some("more `sweeps`, or shorter steps, in `time_stepping`")
            }
            _ => None,
        }
    }

    /// What may help where a run missed these laws: fast turning is more than steps of first order
    /// follow.
    pub fn broken_hint(&self, broken: &[(&'static str, f64, f64)]) -> Option<&'static str> {
        if broken.is_empty() {
            return None;
        }
        Some(match self.scheme {
            RunScheme::Event => "a higher accuracy (`relative`, `absolute` in `integrator`)",
            RunScheme::TimeStepping if self.stepping.corrections == 0 => {
                "shorter steps (`scenario.step_s`), or `\"corrections\": 1` in `time_stepping`"
            }
            RunScheme::TimeStepping => "shorter steps (`scenario.step_s`)",
        })
    }

    /// What a reader of a run must know beside its audits: where the laws of contact did not say
    /// how a sole is loaded.
    pub fn note(&self, run: &Run) -> Option<String> {
        let first = run.events.iter().find(|event| event.kind == EventKind::LeastLoads)?;
        Some(format!(
            "at {:.6} s equally compliant points of a sliding sole found no loads; the least were \
             taken until contacts changed (docs/reference/scenario.md)",
            first.t_s
        ))
    }

    /// The laws that a run of this scenario missed by more than is tolerated: name, by how much,
    /// tolerance.
    pub fn broken(&self, run: &Run) -> Vec<(&'static str, f64, f64)> {
        run.audit.broken(match self.scheme {
            RunScheme::Event => &self.tolerances,
            RunScheme::TimeStepping => &self.stepping_tolerances,
        })
    }

    fn header(&self, run: &Run) -> Vec<(String, String)> {
        let model = self.plant.model();
        let mut header = vec![
            ("denavit", env!("CARGO_PKG_VERSION").to_owned()),
            ("scenario", self.name.clone()),
            ("model", model.name.clone()),
            (MODEL_HASH, hash_text(model.hash)),
        ];
        if !self.parameters.is_empty() {
            header.push((PARAMETERS, parameters_text(&self.parameters)));
        }
        header.extend([
            // whatever the model says of the logs of its robot
            ("torque_side", "joint".to_owned()),
            ("seed", self.simulation.seed.to_string()),
            ("scheme", self.scheme.word().to_owned()),
        ]);
        if self.scheme == RunScheme::TimeStepping {
            let method = match self.stepping.scheme {
                Scheme::MoreauMidpoint => "moreau",
                Scheme::Anitescu { .. } => "anitescu",
            };
            header.push(("method", method.to_owned()));
            header.push(("step_s", format!("{:e}", self.stepping.step_s)));
        }
        header.push(("stop", run.stop.word().to_owned()));
        header.extend(self.note(run).map(|note| ("note", note)));
        let mut header: Vec<(String, String)> =
            header.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        for (key, _, worst) in run.audit.listed(model) {
            header.extend(key.map(|key| (format!("audit_{key}"), format!("{worst:e}"))));
        }
        header
    }
}
