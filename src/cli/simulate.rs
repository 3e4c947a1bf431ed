//! `denavit simulate`: run a scenario.

use super::Answer;
use super::failure::Failure;
use super::files::{load_beside, read_file, write_whole};
use super::json::write_json;
use clap::Args;
use denavit::shipped;
use denavit::simulate::scenario::{self, Scenario};
use denavit::simulate::{Run, Stop};
use serde_json::json as value;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Simulate a scenario: a robot, its start, its control, the ground
///
/// Every run is audited: energy, momentum across impacts, penetration, complementarity, adhesion,
/// and the zero moment point from forces against that from momentum. A run that breaks a tolerance,
/// or that ends otherwise than at its end, exits with 1.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  denavit simulate bouncing_ball -o ball.csv")]
pub(crate) struct Arguments {
    /// The path of a scenario file, or the name of a shipped scenario
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// Where the log goes, as CSV; - is standard output (and no summary)
    #[arg(short, long, value_name = "LOG")]
    output: Option<PathBuf>,
    /// The summary as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let mut scenario = open(&arguments.scenario)?;
    let started = Instant::now();
    let run = scenario.run().map_err(|error| Failure::Start(shown(&arguments.scenario), error))?;
    let took = started.elapsed();
    let broken = run.audit.broken(&scenario.tolerances);
    if let Some(path) = &arguments.output {
        write_whole(path, run.log.to_csv().as_bytes())?;
    }
    match (&arguments.output, arguments.json) {
        (Some(path), _) if path.as_os_str() == "-" => {}
        (_, true) => write_json(out, &summary(&scenario, &run, &broken))?,
        (_, false) => print(out, &scenario, &run, &broken, took)?,
    }
    let good = run.stop == Stop::End && broken.is_empty();
    Ok(if good { Answer::Done } else { Answer::Negative })
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}

fn open(path: &Path) -> Result<Scenario, Failure> {
    let name = shown(path);
    let file = path.metadata().is_ok_and(|metadata| metadata.is_file());
    let bytes = match shipped::find_scenario(&name).filter(|_| !file) {
        Some(shipped) => shipped.text.as_bytes().to_vec(),
        None => read_file(path)?,
    };
    let load = |model: &str| load_beside(path, model);
    scenario::read(&name, &bytes, &load).map_err(Failure::Scenario)
}

fn summary(
    scenario: &Scenario,
    run: &Run,
    broken: &[(&'static str, f64, f64)],
) -> serde_json::Value {
    let (audit, cost) = (&run.audit, &run.statistics);
    value!({
        "scenario": scenario.name,
        "model": scenario.plant.model().name,
        "stop": run.stop.word(),
        "message": run.stop.to_string(),
        "end_s": run.end.t_s,
        "events": run.events.len(),
        "steps": cost.steps,
        "rejected": cost.rejected,
        "evaluations": cost.evaluations,
        "audit": {
            "energy_j": audit.energy_j,
            "momentum_ns": audit.momentum_ns,
            "impact_gain_j": audit.impact_gain_j,
            "penetration_m": audit.penetration_m,
            "complementarity_nm": audit.complementarity_nm,
            "adhesion_n": audit.adhesion_n,
            "separation_m_s": audit.separation_m_s,
            "friction_demand": audit.friction_demand,
            "zmp_m": audit.zmp_m,
            "zmp_margin_m": finite(audit.zmp_margin_m),
            "force_n": audit.force_n,
            "torque": audit.torque,
        },
        "broken": broken.iter().map(|(law, _, _)| *law).collect::<Vec<_>>(),
    })
}

fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

fn print(
    out: &mut dyn Write,
    scenario: &Scenario,
    run: &Run,
    broken: &[(&'static str, f64, f64)],
    took: Duration,
) -> Result<(), Failure> {
    writeln!(out, "{}: {} at {:.6} s", scenario.name, run.stop, run.end.t_s)?;
    let simulated = run.end.t_s - scenario.initial.t_s;
    let speed = simulated / took.as_secs_f64().max(1e-9);
    let cost = &run.statistics;
    writeln!(
        out,
        "{} events, {} steps ({} rejected), {} evaluations, {speed:.1} times real time",
        run.events.len(),
        cost.steps,
        cost.rejected,
        cost.evaluations,
    )?;
    writeln!(out)?;
    let audit = &run.audit;
    let mut rows = vec![
        ("energy balance [J]", audit.energy_j),
        ("momentum across impacts [N s]", audit.momentum_ns),
        ("penetration [m]", audit.penetration_m),
        ("complementarity [N m]", audit.complementarity_nm),
        ("adhesion [N]", audit.adhesion_n),
        ("speed of closed contacts [m/s]", audit.separation_m_s),
        ("forces against momentum [N]", audit.force_n),
        ("zero moment point against momentum [m]", audit.zmp_m),
        ("friction demand", audit.friction_demand),
        ("largest torque [N m, N]", audit.torque),
    ];
    if audit.zmp_margin_m.is_finite() {
        rows.push(("margin of the zero moment point [m]", audit.zmp_margin_m));
    }
    for (law, worst) in rows {
        writeln!(out, "{law:<40} {worst:>10.3e}")?;
    }
    for (law, found, allowed) in broken {
        writeln!(out, "broken: {law}: {found:.3e}, and {allowed:.0e} is tolerated")?;
    }
    Ok(())
}
