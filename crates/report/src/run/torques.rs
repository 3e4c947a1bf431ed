//! Pictures of validations, joint by joint, with what is left: torques that were measured and those
//! that a model computes (thesis figures 3.8, 3.10), and motions that were measured and simulated.

use super::super::svg::Svg;
use super::axes::{Axes, Scale, TICK};
use super::{APART, BLUE, GREY, HEADING, SCALE, SIDE, TORQUE, WANTED, WIDTH, draw_legend};
use denavit_identify::estimate::Validation;
use denavit_replay::{Compared, Forward};

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
const BLOCK: f64 = 30.0 + TALL + APART + TORQUE + 36.0;

const FORCES: &str = "N m, N";

/// Samples that a picture shows, at most.
const DRAWN: usize = 1500;

/// A signal of a joint: two diagrams.
struct Signal {
    title: String,
    /// Name of the signal, its unit, and the curve that was not measured.
    words: [&'static str; 3],
    /// Time, measured, computed.
    drawn: Vec<[f64; 3]>,
}

/// SVG of torques. The same torques give the same bytes.
pub fn torque_picture(picture: &TorquePicture<'_>) -> String {
    let signals = picture.validation.joints.iter().map(|joint| Signal {
        title: format!("{}: {}", spaced(&joint.name), left(joint.relative)),
        words: ["torque", FORCES, "computed"],
        drawn: joint.drawn.clone(),
    });
    signals_picture([picture.title, picture.subtitle], &signals.collect::<Vec<_>>())
}

/// SVG of a log that was simulated again: positions, and torques where they are compared.
pub fn motion_picture(title: &str, subtitle: &str, forward: &Forward) -> String {
    let stride = forward.t_s.len().div_ceil(DRAWN).max(1);
    let signal = |joint: &str, [word, unit]: [&'static str; 2], compared: &Compared| {
        let pairs = compared.measured.iter().zip(&compared.simulated);
        let rows = forward.t_s.iter().zip(pairs).step_by(stride);
        Signal {
            title: format!("{}: {}", spaced(joint), left(compared.relative)),
            words: [word, unit, "simulated"],
            drawn: rows.map(|(t, (measured, simulated))| [*t, *measured, *simulated]).collect(),
        }
    };
    let mut signals = Vec::new();
    for joint in &forward.joints {
        signals.push(signal(&joint.name, ["position", "rad, m"], &joint.position));
        let torque = joint.torque.as_ref();
        signals.extend(torque.map(|torque| signal(&joint.name, ["torque", FORCES], torque)));
    }
    signals_picture([title, subtitle], &signals)
}

fn spaced(name: &str) -> String {
    name.replace('_', " ")
}

fn left(relative: f64) -> String {
    format!("{:.2} % left", 100.0 * relative)
}

fn signals_picture([title, subtitle]: [&str; 2], signals: &[Signal]) -> String {
    let top = 74.0;
    let height = top + signals.len() as f64 * BLOCK + 12.0;
    let mut svg = Svg::new([WIDTH, height], title);
    let style = "font-size=\"20\" font-weight=\"bold\" fill=\"#222\"";
    svg.label([SIDE, 34.0], "start", style, title);
    svg.label([SIDE, 55.0], "start", "font-size=\"13\" fill=\"#555\"", subtitle);
    for (index, signal) in signals.iter().enumerate() {
        let corner = [SIDE + SCALE, top + index as f64 * BLOCK];
        diagrams(&mut svg, signal, corner, WIDTH - 2.0 * SIDE - SCALE - 10.0);
    }
    svg.finish()
}

fn diagrams(svg: &mut Svg, signal: &Signal, corner: [f64; 2], width: f64) {
    // Logs follow each other; their times do not, so a step back begins a new curve.
    let mut times: Vec<f64> = Vec::new();
    let mut shift = 0.0;
    for pair in signal.drawn.windows(2) {
        times.push(pair[0][0] + shift);
        if pair[1][0] < pair[0][0] {
            shift += pair[0][0] - pair[1][0];
        }
    }
    times.extend(signal.drawn.last().map(|last| last[0] + shift));
    let column = |entry: usize| signal.drawn.iter().map(|row| row[entry]).collect::<Vec<f64>>();
    let (measured, computed) = (column(1), column(2));
    let residual: Vec<f64> = measured.iter().zip(&computed).map(|(a, b)| a - b).collect();
    let (first, last) =
        (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(1.0));
    let x = Scale::exactly(first, last.max(first + 1e-9), 10.0);
    svg.label([corner[0], corner[1] + 14.0], "start", HEADING, &signal.title);
    let torques = Axes {
        corner: [corner[0], corner[1] + 24.0],
        size: [width, TALL],
        x,
        y: Scale::around(measured.iter().chain(&computed).copied(), 4.0),
    };
    torques.draw(svg, false);
    let [word, unit, other] = signal.words;
    torques.name_y(svg, &format!("{word} [{unit}]"));
    torques.curve(svg, &times, &measured, BLUE);
    torques.curve(svg, &times, &computed, WANTED);
    let left = Axes {
        corner: [corner[0], corner[1] + 24.0 + TALL + APART],
        size: [width, TORQUE],
        x,
        y: Scale::around(residual.iter().copied(), 2.0),
    };
    left.draw(svg, true);
    left.name_y(svg, &format!("residual [{unit}]"));
    left.curve(svg, &times, &residual, GREY);
    let legend = [("measured", BLUE), (other, WANTED), ("residual", GREY)];
    draw_legend(svg, [corner[0] + width, corner[1] + 14.0], &legend);
    svg.label([corner[0] + width, left.corner[1] + TORQUE + 32.0], "end", TICK, "time [s]");
}
