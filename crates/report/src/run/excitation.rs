//! The picture of an excitation: each joint with its limits (thesis figure 3.3), and the condition
//! number over the iterations of every start.

use super::super::svg::Svg;
use super::axes::{Axes, Scale, TICK};
use super::{APART, BLUE, COLOURS, HEADING, SCALE, SIDE, WANTED, WIDTH, draw_legend};
use denavit_excite::{Excited, JointUse};
use denavit_plants::trajectory::{Reference, Setpoint};

/// What a picture of an excitation is about.
#[derive(Clone, Copy, Debug)]
pub struct ExcitationPicture<'a> {
    /// First line.
    pub title: &'a str,
    /// Second line, smaller.
    pub subtitle: &'a str,
    /// What was found.
    pub excited: &'a Excited,
}

const TALL: f64 = 104.0;
const SHORT: f64 = 52.0;
const HISTORY: f64 = 170.0;
const BLOCK: f64 = 30.0 + TALL + 2.0 * (SHORT + APART) + 40.0;
/// Points of a curve.
const POINTS: usize = 800;
const LIMIT: &str = "stroke=\"#d62728\" stroke-width=\"1\" stroke-dasharray=\"2 3\"";
const GREY: &str = "stroke=\"#5a6472\" stroke-width=\"1.2\"";

/// SVG of an excitation. The same excitation gives the same bytes.
pub fn excitation_picture(picture: &ExcitationPicture<'_>) -> String {
    let excited = picture.excited;
    let moving = excited.model.moving();
    let rows = moving.len().div_ceil(2);
    let top = 74.0;
    let height = top + rows as f64 * BLOCK + HISTORY + 76.0;
    let mut svg = Svg::new([WIDTH, height], picture.title);
    let style = "font-size=\"20\" font-weight=\"bold\" fill=\"#222\"";
    svg.label([SIDE, 34.0], "start", style, picture.title);
    svg.label([SIDE, 55.0], "start", "font-size=\"13\" fill=\"#555\"", picture.subtitle);
    let half = 0.5 * (WIDTH - 2.0 * SIDE);
    let references = excited.references();
    let uses = &excited.found().ended.limits.joints;
    for (place, &joint) in moving.iter().enumerate() {
        let left = SIDE + (place % 2) as f64 * half + SCALE;
        let corner = [left, top + (place / 2) as f64 * BLOCK];
        let duration = excited.space.duration_s();
        let curves = curves(&references[joint], duration);
        joint_diagrams(&mut svg, &curves, &uses[joint], corner, half - SCALE - 10.0);
    }
    let corner = [SIDE + SCALE, top + rows as f64 * BLOCK];
    history(&mut svg, excited, corner, WIDTH - 2.0 * SIDE - SCALE - 10.0);
    svg.finish()
}

/// Times, positions, rates and accelerations of a lap.
fn curves(reference: &Reference, duration_s: f64) -> [Vec<f64>; 4] {
    let times: Vec<f64> =
        (0..=POINTS).map(|k| (duration_s * k as f64 / POINTS as f64).min(duration_s)).collect();
    let points: Vec<Setpoint> = times.iter().map(|t_s| reference.at(*t_s)).collect();
    let of = |entry: fn(&Setpoint) -> f64| points.iter().map(entry).collect();
    [times, of(|p| p.position), of(|p| p.rate), of(|p| p.acceleration)]
}

fn joint_diagrams(
    svg: &mut Svg,
    [times, position, rate, acceleration]: &[Vec<f64>; 4],
    joint: &JointUse,
    corner: [f64; 2],
    width: f64,
) {
    svg.label([corner[0], corner[1] + 14.0], "start", HEADING, &joint.name.replace('_', " "));
    let unit = if joint.slides { "m" } else { "rad" };
    let units = [unit.to_owned(), format!("{unit}/s"), format!("{unit}/s\u{b2}")];
    let end = times.last().copied().unwrap_or(1.0);
    let mut y = corner[1] + 24.0;
    let all = [
        (position, &joint.position, TALL, BLUE),
        (rate, &joint.velocity, SHORT, GREY),
        (acceleration, &joint.acceleration, SHORT, GREY),
    ];
    for (index, ((values, extremes, tall, style), unit)) in all.into_iter().zip(&units).enumerate()
    {
        let limits = extremes.map_or([f64::NAN; 2], |extremes| extremes.limits);
        let axes = Axes {
            corner: [corner[0], y],
            size: [width, tall],
            x: Scale::exactly(0.0, end, 8.0),
            y: Scale::around(
                values.iter().copied().chain(limits),
                if tall > SHORT { 4.0 } else { 2.0 },
            ),
        };
        axes.draw(svg, index == 2);
        axes.name_y(svg, unit);
        for limit in limits.into_iter().filter(|limit| limit.is_finite()) {
            axes.curve(svg, &[0.0, end], &[limit, limit], LIMIT);
        }
        axes.curve(svg, times, values, style);
        y += tall + APART;
    }
    let legend = [("position", BLUE), ("its derivatives", GREY), ("limits", LIMIT)];
    draw_legend(svg, [corner[0] + width, corner[1] + 14.0], &legend);
    svg.label([corner[0] + width, y - APART + 32.0], "end", TICK, "time [s]");
}

/// log10 of the condition number of every iterate.
fn history(svg: &mut Svg, excited: &Excited, corner: [f64; 2], width: f64) {
    svg.label([corner[0], corner[1] + 14.0], "start", HEADING, "condition number over iterations");
    let of = |start: &denavit_excite::StartReport| -> Vec<f64> {
        start.iterates.iter().map(|iterate| iterate.condition.log10()).collect()
    };
    let all: Vec<Vec<f64>> = excited.starts.iter().map(of).collect();
    let most = all.iter().map(Vec::len).max().unwrap_or(1).max(2);
    let axes = Axes {
        corner: [corner[0], corner[1] + 24.0],
        size: [width, HISTORY],
        x: Scale::exactly(0.0, (most - 1) as f64, 10.0),
        y: Scale::around(all.iter().flatten().copied(), 4.0),
    };
    axes.draw(svg, true);
    axes.name_y(svg, "log10 of the condition");
    let xs: Vec<f64> = (0..most).map(|iterate| iterate as f64).collect();
    for (index, values) in all.iter().enumerate().filter(|(index, _)| *index != excited.best) {
        let colour = COLOURS[index % COLOURS.len()];
        let style = format!("stroke=\"{colour}\" stroke-width=\"1\" stroke-opacity=\"0.5\"");
        axes.curve(svg, &xs, values, &style);
    }
    axes.curve(svg, &xs, &all[excited.best], WANTED);
    let legend = [("taken", WANTED), ("other starts", GREY)];
    draw_legend(svg, [corner[0] + width, corner[1] + 14.0], &legend);
    svg.label([corner[0] + width, axes.corner[1] + HISTORY + 32.0], "end", TICK, "iteration");
}
