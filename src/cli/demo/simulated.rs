//! Robots in motion: TUlip's step of the thesis, and a walking biped by both schemes.

use super::super::failure::Failure;
use super::super::files::load_beside;
use super::{Written, write};
use denavit::report::drawn_run;
use denavit::report::{Align, Table};
use denavit::shipped;
use denavit::simulate::Stop;
use denavit::simulate::scenario::RunScheme;
use denavit::walk;
use serde::Serialize;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

/// Scenario, scheme, and how much of it is run \[s\].
const RUNS: [(&str, RunScheme, f64); 3] = [
    ("tulip_step", RunScheme::TimeStepping, 7.4),
    ("planar_biped_limit_cycle_gait", RunScheme::TimeStepping, 2.7),
    ("planar_biped_limit_cycle_gait", RunScheme::Event, 2.7),
];

/// What became of a run.
#[derive(Serialize)]
pub(super) struct Simulated {
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

impl Simulated {
    /// Makes all runs, with the log and the picture of each.
    pub(super) fn all(directory: &Path) -> Result<Vec<Self>, Failure> {
        RUNS.iter().map(|run| Self::new(run, directory)).collect()
    }

    fn new(
        &(name, scheme, duration_s): &(&'static str, RunScheme, f64),
        directory: &Path,
    ) -> Result<Self, Failure> {
        let shipped = shipped::find_scenario(name).expect("it is shipped");
        let load = |model: &str| load_beside(Path::new(""), model);
        let read = walk::read_scenario(name, shipped.text.as_bytes(), &load);
        let mut scenario = read.map_err(Failure::Scenario)?;
        scenario.scheme = scheme;
        scenario.simulation.end_s = scenario.initial.t_s + duration_s;
        let started = Instant::now();
        let run = scenario.run().map_err(Failure::Scenario)?;
        let seconds = started.elapsed().as_secs_f64();
        let broken = scenario.broken(&run).into_iter().map(|(law, _, _)| law).collect();
        let file = |ending: &str| format!("{name}_{}.{ending}", scheme.word());
        let csv = write(directory, &file("csv"), &run.log.to_csv(), "log of the run".to_owned())?;
        let drawn = drawn_run(&mut scenario, &run, None);
        let svg = write(directory, &file("svg"), &drawn, "picture of the run".to_owned())?;
        let audit = &run.audit;
        Ok(Self {
            scenario: name,
            scheme: scheme.word(),
            stop: run.stop.word(),
            simulated_s: run.end.t_s - scenario.initial.t_s,
            seconds,
            steps: run.statistics.steps,
            energy_j: audit.energy_j,
            penetration_m: audit.penetration_m,
            zmp_m: audit.zmp_m,
            friction_total: audit.friction_total,
            largest_torque: audit.torque,
            broken,
            files: vec![csv, svg],
        })
    }

    /// Whether it reached its end within all tolerances.
    pub(super) fn passed(&self) -> bool {
        self.stop == Stop::End.word() && self.broken.is_empty()
    }
}

/// The runs and their audits as a table, and the files.
pub(super) fn write_all(runs: &[Simulated], out: &mut dyn Write) -> Result<(), Failure> {
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
    writeln!(
        out,
        "\nsimulations, audited: what energy, contacts and the zero moment point are off by, \
         friction\ndemand of all contacts, largest torque\n{table}"
    )?;
    for file in runs.iter().flat_map(|run| &run.files) {
        writeln!(out, "wrote {} ({} kB): {}", file.file, file.bytes.div_ceil(1000), file.what)?;
    }
    Ok(())
}
