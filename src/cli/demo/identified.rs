//! Parameters from the log of a simulated experiment (thesis 3.3.3): encoders with steps, torques
//! with noise, against the values that the simulated leg has.

use super::super::failure::Failure;
use super::super::files::load_beside;
use super::super::identify;
use super::super::progress::Progress;
use super::{Written, write};
use denavit::shipped;
use denavit::walk;
use serde::Serialize;
use std::io::Write;
use std::path::Path;

const SCENARIO: &str = "tulip_leg_identification";
const MODEL: &str = "tulip_leg_table34";

/// Faster than the leg moves, and slower than most of the noise \[Hz\].
const CUTOFF_HZ: f64 = 10.0;

/// Of as many intervals of 95 % some miss; more than this share does not.
const MOST_MISSED: f64 = 0.2;

/// What became of the experiment.
#[derive(Serialize)]
pub(super) struct Identified {
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

impl Identified {
    /// Simulates the experiment, identifies from its log alone, and compares.
    pub(super) fn new(seed: u64, directory: &Path, progress: &Progress) -> Result<Self, Failure> {
        progress.show("simulating an experiment");
        let shipped = shipped::find_scenario(SCENARIO).expect("it is shipped");
        let load = |model: &str| load_beside(Path::new(""), model);
        let read = walk::read_scenario(SCENARIO, shipped.text.as_bytes(), &load);
        let mut scenario = read.map_err(Failure::Scenario)?;
        scenario.simulation.seed = seed;
        let run = scenario.run().map_err(Failure::Scenario)?;
        let name = format!("{SCENARIO}.csv");
        let what = "log of the experiment: noisy, with encoder steps".to_owned();
        let log = write(directory, &name, &run.log.to_csv(), what)?;
        let (found, page) = identify::of_log(MODEL, (directory.join(&name), CUTOFF_HZ), progress)?;
        let what = "what was identified from it, as a page".to_owned();
        let page = write(directory, &format!("{SCENARIO}.html"), &page, what)?;
        let is_within = |one: &&denavit::identify::estimate::IdentifiedParameter| {
            let distance = one.model_value.map(|truth| (one.value - truth).abs());
            distance.zip(one.interval).is_some_and(|(distance, half)| distance <= half)
        };
        Ok(Self {
            scenario: SCENARIO,
            model: MODEL,
            parameters: found.parameters.len(),
            within_interval: found.parameters.iter().filter(is_within).count(),
            residual: found.train.relative,
            condition: found.estimate.solution.condition,
            files: vec![log, page],
        })
    }

    /// Whether so many intervals hold the truth as intervals of 95 % do.
    pub(super) fn passed(&self) -> bool {
        let missed = self.parameters - self.within_interval;
        missed as f64 <= MOST_MISSED * self.parameters as f64
    }

    pub(super) fn write(&self, out: &mut dyn Write) -> Result<(), Failure> {
        writeln!(
            out,
            "\nidentification of {} from a simulated log: {} of {} true values within their 95 % \
             intervals;\n{:.1} % of the torques left, condition {:.0}",
            self.model,
            self.within_interval,
            self.parameters,
            100.0 * self.residual,
            self.condition
        )?;
        for file in &self.files {
            writeln!(out, "wrote {} ({} kB): {}", file.file, file.bytes.div_ceil(1000), file.what)?;
        }
        Ok(())
    }
}
