//! The picture of a validation: torques that were measured and those that a model computes, joint
//! by joint (thesis figures 3.8, 3.10), and what is left.

use super::super::svg::Svg;
use super::axes::{Axes, Scale, TICK};
use super::{BLUE, GREY, HEADING, SCALE, SIDE, TORQUE, WANTED, WIDTH, draw_legend};
use crate::identify::estimate::{JointResidual, Validation};

/// What a picture of torques is about.
#[derive(Clone, Copy, Debug)]
pub struct TorquePicture<'a> {
    /// First line.
    pub title: &'a str,
    /// Second line, smaller.
    pub subtitle: &'a str,
    /// The torques.
    pub validation: &'a Validation,
}

const TALL: f64 = 130.0;
const BLOCK: f64 = 30.0 + TALL + 10.0 + TORQUE + 36.0;

/// SVG of torques. The same torques give the same bytes.
pub fn torque_picture(picture: &TorquePicture<'_>) -> String {
    let joints = &picture.validation.joints;
    let top = 74.0;
    let height = top + joints.len() as f64 * BLOCK + 12.0;
    let mut svg = Svg::new([WIDTH, height], picture.title);
    let style = "font-size=\"20\" font-weight=\"bold\" fill=\"#222\"";
    svg.label([SIDE, 34.0], "start", style, picture.title);
    svg.label([SIDE, 55.0], "start", "font-size=\"13\" fill=\"#555\"", picture.subtitle);
    for (index, joint) in joints.iter().enumerate() {
        let corner = [SIDE + SCALE, top + index as f64 * BLOCK];
        diagrams(&mut svg, joint, corner, WIDTH - 2.0 * SIDE - SCALE - 10.0);
    }
    svg.finish()
}

fn diagrams(svg: &mut Svg, joint: &JointResidual, corner: [f64; 2], width: f64) {
    // Logs follow each other; their times do not, so a step back begins a new curve.
    let mut times: Vec<f64> = Vec::new();
    let mut shift = 0.0;
    for pair in joint.drawn.windows(2) {
        times.push(pair[0][0] + shift);
        if pair[1][0] < pair[0][0] {
            shift += pair[0][0] - pair[1][0];
        }
    }
    times.extend(joint.drawn.last().map(|last| last[0] + shift));
    let column = |entry: usize| joint.drawn.iter().map(|row| row[entry]).collect::<Vec<f64>>();
    let (measured, computed) = (column(1), column(2));
    let residual: Vec<f64> = measured.iter().zip(&computed).map(|(a, b)| a - b).collect();
    let (first, last) =
        (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(1.0));
    let x = Scale::exactly(first, last.max(first + 1e-9), 10.0);
    let title = format!("{}: {:.2} % left", joint.name.replace('_', " "), 100.0 * joint.relative);
    svg.label([corner[0], corner[1] + 14.0], "start", HEADING, &title);
    let torques = Axes {
        corner: [corner[0], corner[1] + 24.0],
        size: [width, TALL],
        x,
        y: Scale::around(measured.iter().chain(&computed).copied(), 4.0),
    };
    torques.draw(svg, false);
    torques.name_y(svg, "torque");
    torques.curve(svg, &times, &measured, BLUE);
    torques.curve(svg, &times, &computed, WANTED);
    let left = Axes {
        corner: [corner[0], corner[1] + 34.0 + TALL],
        size: [width, TORQUE],
        x,
        y: Scale::around(residual.iter().copied(), 2.0),
    };
    left.draw(svg, true);
    left.name_y(svg, "residual");
    left.curve(svg, &times, &residual, GREY);
    let legend = [("measured", BLUE), ("computed", WANTED), ("residual", GREY)];
    draw_legend(svg, [corner[0] + width, corner[1] + 14.0], &legend);
    svg.label([corner[0] + width, left.corner[1] + TORQUE + 32.0], "end", TICK, "time [s]");
}
