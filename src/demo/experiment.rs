//! Parameters from the log of a simulated experiment (thesis 3.3.3): encoders with steps, torques
//! with noise, against the values that the simulated leg has.

use super::{Document, Written, referred};
use denavit::identify::Identification;
use denavit::identify::estimate::IdentifiedParameter;
use denavit::shipped;
use denavit::simulate::scenario::ScenarioError;
use denavit::walk;
use serde::Serialize;
use std::fmt;

const SCENARIO: &str = "tulip_leg_identification";
const MODEL: &str = "tulip_leg_table34";

/// Of as many intervals of 95 % some miss; more than this share does not.
const MOST_MISSED: f64 = 0.2;

/// The experiment: which model it is about, and how its log is read.
pub struct Experiment;

impl Experiment {
    /// The model whose values are the truth.
    pub const MODEL: &str = MODEL;

    /// Faster than the leg moves, and slower than most of the noise \[Hz\].
    pub const CUTOFF_HZ: f64 = 10.0;

    /// The log, with the noise of a seed.
    pub fn log(seed: u64) -> Result<Document, ScenarioError> {
        let shipped = shipped::find_scenario(SCENARIO).expect("it is shipped");
        let mut scenario = walk::read_scenario(SCENARIO, shipped.text.as_bytes(), &referred)?;
        scenario.simulation.seed = seed;
        let text = scenario.run()?.log.to_csv();
        let what = "log of the experiment: noisy, with encoder steps".to_owned();
        Ok(Document { name: format!("{SCENARIO}.csv"), text, what })
    }

    /// A page of what was identified.
    pub fn page(text: String) -> Document {
        let what = "what was identified from it, as a page".to_owned();
        Document { name: format!("{SCENARIO}.html"), text, what }
    }
}

/// What became of the experiment.
#[derive(Debug, Serialize)]
pub struct IdentifiedOutcome {
    scenario: &'static str,
    model: &'static str,
    parameters: usize,
    /// Parameters whose true value is within the interval of 95 %.
    within_interval: usize,
    /// The share of the torques that is left.
    residual: f64,
    condition: f64,
    files: Vec<Written>,
}

impl IdentifiedOutcome {
    /// Compares what was identified with the truth.
    pub fn new(found: &Identification, files: Vec<Written>) -> Self {
        let is_within = |one: &&IdentifiedParameter| {
            let distance = one.model_value.map(|truth| (one.value - truth).abs());
            distance.zip(one.interval).is_some_and(|(distance, half)| distance <= half)
        };
        Self {
            scenario: SCENARIO,
            model: MODEL,
            parameters: found.parameters.len(),
            within_interval: found.parameters.iter().filter(is_within).count(),
            residual: found.train.relative,
            condition: found.estimate.solution.condition,
            files,
        }
    }

    /// Whether so many intervals hold the truth as intervals of 95 % do.
    pub fn passed(&self) -> bool {
        let missed = self.parameters - self.within_interval;
        missed as f64 <= MOST_MISSED * self.parameters as f64
    }
}

impl fmt::Display for IdentifiedOutcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "\nidentification of {} from a simulated log: {} of {} true values within their 95 % \
             intervals;\n{:.1} % of the torques left, condition {:.0}",
            self.model,
            self.within_interval,
            self.parameters,
            100.0 * self.residual,
            self.condition
        )?;
        self.files.iter().try_for_each(|file| writeln!(f, "{file}"))
    }
}
