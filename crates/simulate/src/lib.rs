//! Simulation of robots on the ground.
//!
//! - [`simulate`]: smooth motion from event to event, with contacts, impacts and controllers
//! - [`simulate_varied`]: and what small changes of the initial state become
//! - [`scenario`]: files that say what is simulated
//! - [`contact`]: forces and impulses of contacts and their modes, decided by complementarity
//! - [`constraint_drift`]: how far joints come apart where they are explicit constraints
//! - [`Error`]: why a run does not begin, or a log is wrong
//! - [`time_stepping`]: the schemes that take contacts into account over whole steps

mod alighting;
mod audit;
mod breakdown;
pub mod constraint_drift;
pub mod contact;
mod control;
mod drive;
mod error;
mod event;
mod ground;
pub mod integrate;
mod joint_record;
mod laws;
mod log;
mod log_fault;
mod log_file;
mod log_origin;
mod measure;
mod measured_log;
mod motion;
mod planner;
mod push;
mod record;
mod run;
mod runner;
pub mod scenario;
mod settle;
mod simulation;
mod start;
mod state;
mod support;
pub mod time_stepping;
mod variation;

pub use audit::{Audit, Tolerances};
pub use breakdown::{Breakdown, Stop};
pub use control::{Compensation, Control, Damped, Feedback, JointControl};
pub use drive::{DriveModelling, STICTION_RATE};
pub use error::{Error, ErrorKind};
pub use joint_record::{JointRecord, Peak, TrackingError};
pub use log::Log;
pub use log_fault::{LogFault, LogFaults, PlacedLogFault};
pub use log_file::LogFile;
pub use log_origin::model_of_header;
pub use measure::Measurement;
pub use planner::{JointPlan, Planning, PlanningLaw, ReferencePlanner, Sensed};
pub use push::{LinkWrench, Push, Shove};
pub use run::{
    Event, EventKind, Run, Told, simulate, simulate_believing, simulate_told, simulate_varied,
};
pub use settle::{Scuffing, Touching};
pub use simulation::Simulation;
pub use state::State;
pub use support::{SupportForm, SupportPolygon};
