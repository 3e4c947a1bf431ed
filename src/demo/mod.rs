//! What `denavit demo` derives, runs, checks and hides, with how it is shown.
//!
//! - [`RobotOutcome`]: one of the [`ROBOTS`] derived, emitted, set, drawn, counted and checked
//! - [`DecomposedOutcome`]: the thesis's double pendulum as f and B
//! - [`DemoRun`]: robots in motion; [`Simulated`]: what became of them
//! - [`Experiment`]: a log to identify from; [`IdentifiedOutcome`]: how the truth compares
//! - [`Hidden`]: an effect that a seed draws; [`DiagnosedOutcome`]: whether it was found
//!
//! Files go through whoever calls: a [`Document`] becomes [`Written`].

mod checks;
mod compiled;
mod counts;
mod decomposed;
mod document;
mod experiment;
mod hidden;
mod robots;
mod simulated;
mod states;

pub use compiled::{Compiled, ROBOTS};
pub use decomposed::DecomposedOutcome;
pub use document::{Document, Written};
pub use experiment::{Experiment, IdentifiedOutcome};
pub use hidden::{DiagnosedOutcome, Hidden};
pub use robots::{RobotError, RobotOutcome};
pub use simulated::{DemoRun, Simulated, SimulatedRuns};

/// The file of a shipped model, trajectory or log.
fn referred(name: &str) -> Result<Vec<u8>, String> {
    let shipped = denavit::shipped::find_referred(name);
    shipped.map(|file| file.text.as_bytes().to_vec()).ok_or_else(|| "it is not shipped".to_owned())
}
