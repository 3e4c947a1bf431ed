//! The law of an effect that was found, over what it depends on, with the points that were
//! measured.

use super::super::html::{Chart, ChartCurve, Look, Panel};
use super::super::percent;
use denavit_diagnose::{LawCurve, Quantity};

/// Points that are drawn at most.
const POINTS: usize = 1200;

const TALL: u32 = 260;

/// A share that is as good as all of a law.
const WHOLE: f64 = 0.9;

/// Measured torques less all other terms, and the law.
pub(super) fn law_chart(title: &str, group: &'static str, curve: &LawCurve) -> Chart {
    let (word, turning, sliding) = match curve.over {
        Quantity::Velocity => ("velocity", "velocity [rad/s]", "velocity [m/s]"),
        Quantity::Position => ("position", "position [rad]", "position [m]"),
        Quantity::Load => ("load", "torque of rigid bodies [N m]", "force of rigid bodies [N]"),
        Quantity::Acceleration => {
            ("acceleration", "acceleration [rad/s^2]", "acceleration [m/s^2]")
        }
        Quantity::Time => ("time", "time [s]", "time [s]"),
    };
    let label = if curve.slides { sliding } else { turning };
    let torque = if curve.slides { "force [N]" } else { "torque [N m]" };
    let mut rows: Vec<usize> = (0..curve.x.len()).collect();
    let stride = rows.len().div_ceil(POINTS).max(1);
    rows = rows.into_iter().step_by(stride).collect();
    rows.sort_by(|&a, &b| curve.x[a].total_cmp(&curve.x[b]));
    let pick = |list: &[f64]| rows.iter().map(|&row| list[row]).collect::<Vec<f64>>();
    let curves = vec![
        ChartCurve::new("measured less all other terms", Look::Points, pick(&curve.measured)),
        ChartCurve::new("the law", Look::Law, pick(&curve.law)),
    ];
    let thinned = if stride > 1 { format!(" One in {stride} samples.") } else { String::new() };
    let mut caption = format!("Held-out logs, all through one filter.{thinned}");
    if curve.explained < WHOLE {
        caption += &format!(
            " The law depends on more than {word}: on several quantities, or on the past. A \
             function of {word} alone is {} of it.",
            percent(curve.explained.max(0.0))
        );
    }
    Chart {
        name: format!("{title} at {} against {word}", curve.at.replace('_', " ")),
        caption,
        group,
        over: [word, label],
        x: pick(&curve.x),
        panels: vec![Panel::new(torque, TALL, curves)],
        windows: Vec::new(),
    }
}
