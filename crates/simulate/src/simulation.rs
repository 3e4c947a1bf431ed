//! How a run is made: all that is said of it beside the plant, its control and its start.

use super::contact::Friction;
use super::drive::{DriveModelling, STICTION_RATE};
use super::integrate::Method;
use super::measure::Measurement;
use super::push::Push;
use super::settle::{Scuffing, Touching};

/// How a run is made.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// When it ends \[s\].
    pub end_s: f64,
    /// The method of integration.
    pub method: Method,
    /// How drives are modelled.
    pub drives: DriveModelling,
    /// Below this rate of a joint Coulomb friction is a steep line through 0 [rad/s, m/s].
    pub stiction_rate: f64,
    /// What a sampled controller sees.
    pub measurement: Measurement,
    /// Seed of the measurement's noise.
    pub seed: u64,
    /// Friction of all contacts.
    pub friction: Friction,
    /// Laws of impacts.
    pub touching: Touching,
    /// What pushes from outside.
    pub pushes: Vec<Push>,
    /// Errors of closed contacts decay at this rate [1/s].
    pub drift_rate: f64,
    /// Period of the log's rows \[s\].
    pub log_period_s: f64,
    /// Whether rows of the event-driven scheme have accelerations, too: columns `qdd_JOINT`.
    pub logs_accelerations: bool,
    /// More events end the run.
    pub max_events: usize,
    /// More evaluations of the equations of motion end the run; of time stepping sweeps and pivots
    /// of its contact problems count too.
    pub max_evaluations: usize,
}

impl Default for Simulation {
    fn default() -> Self {
        Self {
            end_s: 1.0,
            method: Method::default(),
            drives: DriveModelling::default(),
            stiction_rate: STICTION_RATE,
            measurement: Measurement::default(),
            seed: 0,
            friction: Friction::NoSlip,
            touching: Touching {
                restitution: 0.0,
                rest_speed: 1e-4,
                fallback_friction: None,
                scuffing: Scuffing::Counts,
            },
            pushes: Vec::new(),
            drift_rate: 50.0,
            log_period_s: 0.01,
            logs_accelerations: false,
            max_events: 100_000,
            max_evaluations: 50_000_000,
        }
    }
}
