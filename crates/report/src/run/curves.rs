//! The curves of a run that a reader looks into: joints with references and torques, and forces of
//! the ground.

use super::beside::{at_times, place_of};
use super::figures::has_ground;
use super::{JointCurves, RunPicture, Windowed, force_curves, shown_joints};
use crate::html::{Chart, ChartCurve, Look, Panel};
use denavit_plants::PlantModel;
use denavit_simulate::Log;
use denavit_workflow::LogBeside;

/// Joints that are shown, at most.
const MOST: usize = 24;

/// Charts of a run, with one zoom; with what a log has of the same joints.
pub(crate) fn run_charts(model: &PlantModel, log: &Log, beside: Option<&LogBeside>) -> Vec<Chart> {
    let picture = RunPicture { title: "", subtitle: "", log, window_s: None };
    let shown = Windowed::new(&picture);
    let chart = |name: String, panels: Vec<Panel>| Chart {
        name,
        caption: String::new(),
        group: "run",
        over: ["time [s]", "time [s]"],
        x: shown.times.clone(),
        panels,
        windows: Vec::new(),
    };
    let mut charts: Vec<Chart> = Vec::new();
    for joint in shown_joints(model, &shown, MOST) {
        let measured = beside.and_then(|log| Some((log, place_of(model, &joint.name)?)));
        let name = joint.name.replace('_', " ");
        let panels = match measured {
            Some((log, place)) => both(joint, &shown.times, log, place),
            None => alone(joint),
        };
        charts.push(chart(name, panels));
    }
    let forces = force_curves(model, &shown);
    if !forces.is_empty() {
        let curve = |(name, values): (String, Vec<f64>)| {
            ChartCurve::new(name.replace('_', " "), Look::Palette, values)
        };
        let panel = Panel::new("force [N]", 150, forces.into_iter().map(curve).collect());
        // without weight bodies meet each other, and no ground
        let whose = if has_ground(model) { "of the ground" } else { "between bodies" };
        charts.push(chart(format!("Normal force {whose}"), vec![panel]));
    }
    charts.into_iter().filter(|chart| chart.x.len() > 1).map(Chart::thinned).collect()
}

fn units(slides: bool) -> [&'static str; 2] {
    if slides { ["m", "N"] } else { ["rad", "N m"] }
}

/// The curves of a joint.
fn alone(joint: JointCurves) -> Vec<Panel> {
    let [position, torque] = units(joint.slides);
    let mut curves = vec![ChartCurve::new("position", Look::Measured, joint.position)];
    let wanted = joint.reference;
    curves.extend(wanted.map(|one| ChartCurve::new("reference", Look::Computed, one)));
    let mut panels = vec![Panel::new(format!("position [{position}]"), 130, curves)];
    panels.extend(joint.torque.map(|values| {
        let curve = ChartCurve::new("torque of the motor", Look::Residual, values);
        Panel::new(format!("torque [{torque}]"), 80, vec![curve])
    }));
    panels
}

/// The curves of a joint, with those that a log has of it.
fn both(joint: JointCurves, times: &[f64], log: &LogBeside, place: usize) -> Vec<Panel> {
    let [position, torque] = units(joint.slides);
    let measured = at_times(log, &log.q[place], times);
    let pairs = joint.position.iter().zip(&measured);
    let off: Vec<f64> = pairs.map(|(simulated, measured)| simulated - measured).collect();
    let curve = |simulated: Vec<f64>, measured: Vec<f64>| {
        vec![
            ChartCurve::new("measured", Look::Measured, measured),
            ChartCurve::new("simulated", Look::Computed, simulated),
        ]
    };
    let off = vec![ChartCurve::new("simulated less measured", Look::Residual, off)];
    let mut panels = vec![
        Panel::new(format!("position [{position}]"), 130, curve(joint.position, measured)),
        Panel::new(format!("difference [{position}]"), 100, off),
    ];
    let signals = joint.torque.zip(log.torque[place].as_deref());
    panels.extend(signals.map(|(simulated, measured)| {
        let measured = at_times(log, measured, times);
        Panel::new(format!("torque [{torque}]"), 80, curve(simulated, measured))
    }));
    panels
}
