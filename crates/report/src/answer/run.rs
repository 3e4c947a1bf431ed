//! A run as text, as JSON and as a picture.

use super::run_joints;
use crate::run::{RunPicture, figure_at, run_picture};
use denavit_simulate::Run;
use denavit_simulate::scenario::{RunScheme, Scenario};
use serde_json::json as value;
use std::fmt::{self, Write};
use std::time::Duration;

/// The picture of a run.
pub fn drawn_run(scenario: &mut Scenario, run: &Run, window_s: Option<[f64; 2]>) -> String {
    let title = scenario.name.replace('_', " ");
    let subtitle = format!(
        "{}, {}: {} at {:.3} s",
        scenario.plant.model().name,
        scheme_text(scenario),
        run.stop,
        run.end.t_s
    );
    let picture = RunPicture { title: &title, subtitle: &subtitle, log: &run.log, window_s };
    run_picture(scenario.plant.as_mut(), &picture)
}

/// The robot at the row of a run that is nearest to a time, as SVG; the whole run without a time.
pub fn drawn_at(scenario: &mut Scenario, run: &Run, t_s: Option<f64>) -> String {
    let Some(t_s) = t_s else { return drawn_run(scenario, run, None) };
    let title = scenario.name.replace('_', " ");
    figure_at(scenario.plant.as_mut(), &run.log, &title, t_s)
}

/// A part of a run that is drawn, as two times.
///
/// # Errors
/// How they are written.
pub fn window_of(text: &str) -> Result<[f64; 2], String> {
    let numbers = text.split_once(',').and_then(|(from, to)| {
        Some([from.trim().parse::<f64>().ok()?, to.trim().parse::<f64>().ok()?])
    });
    match numbers {
        Some([from, to]) if from < to => Ok([from, to]),
        _ => Err("two times in seconds, as 1.6,3.2".to_owned()),
    }
}

pub(super) fn scheme_text(scenario: &Scenario) -> String {
    match scenario.scheme {
        RunScheme::Event => "from event to event".to_owned(),
        RunScheme::TimeStepping => format!("by steps of {} s", scenario.stepping.step_s),
    }
}

/// A run with the tolerances that it broke (law, found, allowed), as JSON.
pub fn run_json(
    scenario: &Scenario,
    run: &Run,
    broken: &[(&'static str, f64, f64)],
) -> serde_json::Value {
    let (audit, cost) = (&run.audit, &run.statistics);
    value!({
        "scenario": scenario.name,
        "model": scenario.plant.model().name,
        "scheme": scenario.scheme.word(),
        "stop": run.stop.word(),
        "message": run.stop.to_string(),
        "hint": scenario.hint(&run.stop),
        "note": scenario.note(run),
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
            "cone_n": audit.cone_n,
            "friction_angle_rad": audit.friction_angle_rad,
            "friction_demand": audit.friction_demand,
            "friction_total": audit.friction_total,
            "zmp_m": audit.zmp_m,
            "zmp_margin_m": finite(audit.zmp_margin_m),
            "force_n": audit.force_n,
            "torque": audit.torque,
        },
        "joints": run_joints::joints(scenario, run),
        "exceeded": run_joints::exceeded(scenario, run),
        "broken": broken.iter().map(|(law, _, _)| *law).collect::<Vec<_>>(),
    })
}

fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

/// The same as text; `took` is the time that it took.
pub fn run_text(
    scenario: &Scenario,
    run: &Run,
    broken: &[(&'static str, f64, f64)],
    took: Duration,
) -> String {
    let mut out = String::new();
    write(&mut out, scenario, run, broken, took).expect("text has room");
    out
}

fn write(
    out: &mut String,
    scenario: &Scenario,
    run: &Run,
    broken: &[(&'static str, f64, f64)],
    took: Duration,
) -> fmt::Result {
    let scheme = scheme_text(scenario);
    writeln!(out, "{}, {scheme}: {} at {:.6} s", scenario.name, run.stop, run.end.t_s)?;
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
    if let Some(hint) = scenario.hint(&run.stop) {
        writeln!(out, "hint: {hint}")?;
    }
    if let Some(note) = scenario.note(run) {
        writeln!(out, "note: {note}")?;
    }
    writeln!(out)?;
    for (_, law, worst) in run.audit.listed(scenario.plant.model()) {
        writeln!(out, "{law:<40} {worst:>10.3e}")?;
    }
    if broken.is_empty() {
        writeln!(out, "all laws hold within their tolerances")?;
    }
    for (law, found, allowed) in broken {
        writeln!(out, "broken: {law}: {found:.3e}, and {allowed:.0e} is tolerated")?;
    }
    if let Some(hint) = scenario.broken_hint(broken) {
        writeln!(out, "hint: {hint}")?;
    }
    run_joints::write(out, scenario, run)
}
