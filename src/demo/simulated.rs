//! Robots in motion: TUlip's step of the thesis, and a walking biped by both schemes.

use super::{Written, referred};
use denavit::report::{Align, Table};
use denavit::shipped;
use denavit::simulate::scenario::{RunScheme, Scenario, ScenarioError};
use denavit::simulate::{Run, Stop};
use denavit::walk;
use serde::Serialize;
use std::fmt;
use std::time::Instant;

/// Scenario, scheme, and how much of it is run \[s\].
const RUNS: [(&str, RunScheme, f64); 3] = [
    ("tulip_step", RunScheme::TimeStepping, 7.4),
    ("planar_biped_limit_cycle_gait", RunScheme::TimeStepping, 2.7),
    ("planar_biped_limit_cycle_gait", RunScheme::Event, 2.7),
];

/// A run of the demo.
pub struct DemoRun {
    /// What was run.
    pub scenario: Scenario,
    /// How it went.
    pub run: Run,
    name: &'static str,
    seconds: f64,
}

/// What became of a run.
#[derive(Debug, Serialize)]
pub struct Simulated {
    scenario: &'static str,
    scheme: &'static str,
    stop: &'static str,
    simulated_s: f64,
    seconds: f64,
    steps: usize,
    energy_j: f64,
    penetration_m: f64,
    zmp_m: f64,
    friction_total: f64,
    largest_torque: f64,
    /// Audits that missed more than is tolerated.
    broken: Vec<&'static str>,
    files: Vec<Written>,
}

impl DemoRun {
    /// Makes all runs. `finished` takes each with a name for its files.
    pub fn all<E: From<ScenarioError>>(
        mut finished: impl FnMut(&mut Self, &str) -> Result<Vec<Written>, E>,
    ) -> Result<Vec<Simulated>, E> {
        let one = |&(name, scheme, duration_s): &(&'static str, RunScheme, f64)| {
            let mut run = Self::new(name, scheme, duration_s)?;
            let files = finished(&mut run, &format!("{name}_{}", scheme.word()))?;
            Ok(run.outcome(files))
        };
        RUNS.iter().map(one).collect()
    }

    fn new(name: &'static str, scheme: RunScheme, duration_s: f64) -> Result<Self, ScenarioError> {
        let shipped = shipped::find_scenario(name).expect("it is shipped");
        let mut scenario = walk::read_scenario(name, shipped.text.as_bytes(), &referred)?;
        scenario.scheme = scheme;
        scenario.simulation.end_s = scenario.initial.t_s + duration_s;
        let started = Instant::now();
        let run = scenario.run()?;
        let seconds = started.elapsed().as_secs_f64();
        Ok(Self { scenario, run, name, seconds })
    }

    fn outcome(self, files: Vec<Written>) -> Simulated {
        let Self { scenario, run, name, seconds } = self;
        let audit = &run.audit;
        Simulated {
            scenario: name,
            scheme: scenario.scheme.word(),
            stop: run.stop.word(),
            simulated_s: run.end.t_s - scenario.initial.t_s,
            seconds,
            steps: run.statistics.steps,
            energy_j: audit.energy_j,
            penetration_m: audit.penetration_m,
            zmp_m: audit.zmp_m,
            friction_total: audit.friction_total,
            largest_torque: audit.torque,
            broken: scenario.broken(&run).into_iter().map(|(law, _, _)| law).collect(),
            files,
        }
    }
}

impl Simulated {
    /// Whether it reached its end within all tolerances.
    pub fn passed(&self) -> bool {
        self.stop == Stop::End.word() && self.broken.is_empty()
    }
}

/// The runs and their audits as a table, and the files.
pub struct SimulatedRuns<'a>(pub &'a [Simulated]);

impl fmt::Display for SimulatedRuns<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let table = table(self.0);
        writeln!(
            f,
            "\nsimulations, audited: what energy, contacts and the zero moment point are off by, \
             friction\ndemand of all contacts, largest torque\n{table}"
        )?;
        self.0.iter().flat_map(|run| &run.files).try_for_each(|file| writeln!(f, "{file}"))
    }
}

fn table(runs: &[Simulated]) -> Table {
    use Align::{Left, Right};
    let mut table = Table::new(&[
        ("", Left),
        ("simulated", Left),
        ("scheme", Left),
        ("s", Right),
        ("steps", Right),
        ("energy J", Right),
        ("depth m", Right),
        ("ZMP m", Right),
        ("friction", Right),
        ("N m", Right),
    ]);
    for run in runs {
        table.push(vec![
            if run.passed() { "ok" } else { "FAILED" }.to_owned(),
            run.scenario.to_owned(),
            run.scheme.to_owned(),
            format!("{:.1}", run.simulated_s),
            run.steps.to_string(),
            format!("{:.0e}", run.energy_j),
            format!("{:.0e}", run.penetration_m),
            format!("{:.0e}", run.zmp_m),
            format!("{:.2}", run.friction_total),
            format!("{:.0}", run.largest_torque),
        ]);
    }
    table
}
