//! Runs of scenarios.

use crate::error::{Cause, Error};
use crate::observer::{Observer, Progress, Stage, Watched};
use denavit_simulate::Run;
use denavit_simulate::scenario::Scenario;

/// A step is this share of a run before anybody hears of it: most are shorter than a look.
const HEARD_SHARE: f64 = 0.002;

/// Runs a scenario. A run that its observer stops ends there: its `stop` is `Stop::Watcher`.
///
/// # Errors
/// Where the scenario cannot be simulated as it is.
pub fn simulate(scenario: &mut Scenario, observer: &mut dyn Observer) -> Result<Run, Error> {
    let mut watched = Watched::new(observer);
    let mut heard = 0.0;
    watched.begins(Stage::Simulating);
    let mut told = |share: f64| {
        if share - heard >= HEARD_SHARE {
            heard = share;
            let (stage, share) = (Stage::Simulating, Some(share));
            watched.progress(&Progress { stage, share, ..Progress::default() });
        }
        !watched.is_stopped
    };
    Ok(scenario.run_told(&mut told).map_err(Cause::Scenario)?)
}

/// A step of time stepping, as text \[s\].
///
/// # Errors
/// What is wrong with it.
pub fn step_of(text: &str) -> Result<f64, String> {
    let step: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (1e-9..=1.0).contains(&step) { Ok(step) } else { Err("not from 1e-9 to 1 s".to_owned()) }
}
