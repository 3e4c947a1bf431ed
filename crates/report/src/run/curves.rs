//! The curves of a run that a reader looks into: joints with references and torques, and forces of
//! the ground.

use super::{RunPicture, Windowed, force_curves, shown_joints};
use crate::html::{Chart, ChartCurve, Look, Panel};
use denavit_plants::PlantModel;
use denavit_simulate::Log;

/// Joints that are shown, at most.
const MOST: usize = 24;

/// Charts of a run, with one zoom.
pub(crate) fn run_charts(model: &PlantModel, log: &Log) -> Vec<Chart> {
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
        let [position, torque] = if joint.slides { ["m", "N"] } else { ["rad", "N m"] };
        let mut curves = vec![ChartCurve::new("position", Look::Measured, joint.position)];
        let wanted = joint.reference;
        curves.extend(wanted.map(|one| ChartCurve::new("reference", Look::Computed, one)));
        let mut panels = vec![Panel::new(format!("position [{position}]"), 130, curves)];
        panels.extend(joint.torque.map(|values| {
            let curve = ChartCurve::new("torque of the motor", Look::Residual, values);
            Panel::new(format!("torque [{torque}]"), 80, vec![curve])
        }));
        charts.push(chart(joint.name.replace('_', " "), panels));
    }
    let forces = force_curves(model, &shown);
    if !forces.is_empty() {
        let curve = |(name, values): (String, Vec<f64>)| {
            ChartCurve::new(name.replace('_', " "), Look::Palette, values)
        };
        let panel = Panel::new("force [N]", 150, forces.into_iter().map(curve).collect());
        charts.push(chart("Normal force of the ground".to_owned(), vec![panel]));
    }
    charts.into_iter().filter(|chart| chart.x.len() > 1).map(Chart::thinned).collect()
}
