//! Picture of a diagnosis: torques that were measured, those of two models, and what both leave.

use super::super::svg::Svg;
use super::axes::{Axes, Scale, TICK};
use super::{BLUE, GREY, HEADING, SCALE, SIDE, TORQUE, WANTED, WIDTH, draw_legend};
use denavit_diagnose::Curve;

const TALL: f64 = 150.0;
const BLOCK: f64 = 30.0 + TALL + 34.0 + TORQUE + 40.0;
const RED: &str = "stroke=\"#d62728\" stroke-width=\"1.1\"";

/// The time that is shown of a log \[s\].
const WINDOW_S: f64 = 4.0;

/// SVG of a joint each: measured torque with what the nominal model and the model with effects
/// compute, and below what they leave, where the nominal model leaves most.
pub(crate) fn diagnosis_picture(title: &str, shown: &[(&str, &Curve)]) -> String {
    let top = 54.0;
    let height = top + shown.len() as f64 * BLOCK + 12.0;
    let mut svg = Svg::new([WIDTH, height], title);
    let style = "font-size=\"20\" font-weight=\"bold\" fill=\"#222\"";
    svg.label([SIDE, 34.0], "start", style, title);
    for (index, (joint, curve)) in shown.iter().enumerate() {
        let corner = [SIDE + SCALE, top + index as f64 * BLOCK];
        block(&mut svg, joint, curve, corner);
    }
    svg.finish()
}

fn block(svg: &mut Svg, joint: &str, curve: &Curve, corner: [f64; 2]) {
    let width = WIDTH - 2.0 * SIDE - SCALE - 10.0;
    let rows = window(curve);
    let times = &curve.t_s[rows.clone()];
    let measured = &curve.measured[rows.clone()];
    let [before, after] = [&curve.before, &curve.after].map(|left| &left[rows.clone()]);
    let computed = |left: &[f64]| -> Vec<f64> {
        measured.iter().zip(left).map(|(torque, left)| torque - left).collect()
    };
    let (nominal, corrected) = (computed(before), computed(after));
    let (first, last) =
        (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(1.0));
    let x = Scale::exactly(first, last.max(first + 1e-9), 10.0);
    let title = format!("{}, {}", joint.replace('_', " "), curve.file);
    svg.label([corner[0], corner[1] + 14.0], "start", HEADING, &title);
    let legend = [("measured", BLUE), ("nominal model", RED), ("with the effects", WANTED)];
    draw_legend(svg, [corner[0] + width, corner[1] + 14.0], &legend);
    let all = measured.iter().chain(&nominal).chain(&corrected);
    let torques = Axes {
        corner: [corner[0], corner[1] + 24.0],
        size: [width, TALL],
        x,
        y: Scale::around(all.copied(), 4.0),
    };
    torques.draw(svg, false);
    torques.name_y(svg, "torque [N m, N]");
    torques.curve(svg, times, measured, BLUE);
    torques.curve(svg, times, &nominal, RED);
    torques.curve(svg, times, &corrected, WANTED);
    let below = corner[1] + 24.0 + TALL + 30.0;
    let left = Axes {
        corner: [corner[0], below],
        size: [width, TORQUE],
        x,
        y: Scale::around(before.iter().chain(after).copied(), 2.0),
    };
    left.draw(svg, true);
    left.name_y(svg, "residual [N m, N]");
    left.curve(svg, times, before, RED);
    left.curve(svg, times, after, GREY);
    let legend = [("residual before", RED), ("residual with the effects", GREY)];
    draw_legend(svg, [corner[0] + width, below - 6.0], &legend);
    svg.label([corner[0] + width, below + TORQUE + 32.0], "end", TICK, "time [s]");
}

/// The rows of the window in which the nominal model leaves most.
fn window(curve: &Curve) -> std::ops::Range<usize> {
    let count = curve.t_s.len();
    let step_s = match curve.t_s.first().zip(curve.t_s.last()) {
        Some((first, last)) if count > 1 => (last - first) / (count - 1) as f64,
        _ => return 0..count,
    };
    let length = ((WINDOW_S / step_s.max(1e-9)) as usize).clamp(2, count);
    let squares: Vec<f64> = curve.before.iter().map(|left| left * left).collect();
    let mut sum: f64 = squares[..length].iter().sum();
    let mut best = (0, sum);
    for start in 1..=count - length {
        sum += squares[start + length - 1] - squares[start - 1];
        if sum > best.1 {
            best = (start, sum);
        }
    }
    best.0..best.0 + length
}
