//! The picture of an estimate as data come in (thesis figures 3.5, 3.7, 3.9): each parameter
//! against its end, in its own standard errors, and the condition of what it is computed from.

use super::super::svg::Svg;
use super::axes::{Axes, Scale, TICK};
use super::{COLOURS, GREY, HEADING, SCALE, SIDE, WIDTH};
use denavit_identify::estimate::{Convergence, IdentifiedParameter};

const TALL: f64 = 180.0;
/// Standard errors that the scale holds: what is further away at first is cut.
const SHOWN: f64 = 20.0;

/// SVG of how the parameters came about. The same estimate gives the same bytes.
pub(crate) fn convergence_picture(
    title: &str,
    parameters: &[IdentifiedParameter],
    points: &[Convergence],
) -> String {
    let top = 50.0;
    let mut svg = Svg::new([WIDTH, top + 2.0 * (TALL + 62.0)], title);
    svg.label([SIDE, 30.0], "start", HEADING, title);
    let times: Vec<f64> = points.iter().map(|point| point.time_s).collect();
    let (first, last) =
        (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(1.0));
    let x = Scale::exactly(first, last.max(first + 1e-9), 10.0);
    let size = [WIDTH - 2.0 * SIDE - SCALE - 10.0, TALL];
    let curves = parameters.iter().enumerate().filter_map(|(place, one)| {
        let std = one.std.filter(|std| *std > 0.0)?;
        let off =
            |point: &Convergence| ((point.values[place] - one.value) / std).clamp(-SHOWN, SHOWN);
        Some(points.iter().map(off).collect::<Vec<f64>>())
    });
    let curves: Vec<Vec<f64>> = curves.collect();
    let values = Axes {
        corner: [SIDE + SCALE, top],
        size,
        x,
        y: Scale::around(curves.iter().flatten().copied(), 4.0),
    };
    values.draw(&mut svg, false);
    values.name_y(&mut svg, "standard errors from the end");
    for (place, curve) in curves.iter().enumerate() {
        let colour = COLOURS[place % COLOURS.len()];
        values.curve(&mut svg, &times, curve, &format!("stroke=\"{colour}\" stroke-width=\"1\""));
    }
    let logarithms = |of: fn(&Convergence) -> f64| {
        points.iter().map(|point| of(point).log10()).collect::<Vec<f64>>()
    };
    let plain = logarithms(|point| point.condition);
    let scaled = logarithms(|point| point.scaled_condition);
    let condition = Axes {
        corner: [SIDE + SCALE, top + TALL + 40.0],
        size,
        x,
        y: Scale::around(plain.iter().chain(&scaled).copied(), 4.0),
    };
    condition.draw(&mut svg, true);
    condition.name_y(&mut svg, "log10 of condition");
    condition.curve(&mut svg, &times, &plain, GREY);
    let blue = format!("stroke=\"{}\" stroke-width=\"1.6\"", COLOURS[0]);
    condition.curve(&mut svg, &times, &scaled, &blue);
    let legend = [("as measured", GREY), ("columns scaled", blue.as_str())];
    let right = SIDE + SCALE + size[0];
    super::draw_legend(&mut svg, [right, condition.corner[1] - 10.0], &legend);
    svg.label([right, condition.corner[1] + TALL + 32.0], "end", TICK, "time of measurement [s]");
    svg.finish()
}
