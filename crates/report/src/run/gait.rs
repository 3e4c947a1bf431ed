//! Joint angles of a planned gait over time, with its postures marked (thesis figure 4.2).

use super::axes::{Axes, Scale, TICK};
use super::{COLOURS, HEADING};
use crate::svg::Svg;

/// What a joint does.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GaitCurve {
    /// The joint.
    pub(crate) name: String,
    /// A position at each time [rad, m].
    pub(crate) values: Vec<f64>,
}

/// Joint angles of a planned gait.
#[derive(Clone, Debug)]
pub(crate) struct GaitPicture<'a> {
    /// What it is of.
    pub(crate) title: &'a str,
    /// What is to be read from it.
    pub(crate) subtitle: &'a str,
    /// \[s\].
    pub(crate) times_s: &'a [f64],
    /// What joints do; those of a leg are drawn together, by their names `right_..` and `left_..`.
    pub(crate) curves: &'a [GaitCurve],
    /// Postures: where in `times_s` each is.
    pub(crate) postures: &'a [usize],
}

const WIDTH: f64 = 860.0;
const LEFT: f64 = 86.0;
const PLOT: [f64; 2] = [740.0, 210.0];
const BLOCK: f64 = 290.0;
const SIDES: [(&str, &str); 2] = [("right_", "right leg"), ("left_", "left leg")];

impl GaitPicture<'_> {
    /// The picture, as SVG.
    pub(crate) fn draw(&self) -> String {
        let groups = self.groups();
        let height = 84.0 + BLOCK * groups.len() as f64;
        let mut svg = Svg::new([WIDTH, height], self.title);
        svg.label([24.0, 34.0], "start", "font-size=\"18\" fill=\"#222\"", self.title);
        svg.label([24.0, 56.0], "start", "font-size=\"12\" fill=\"#666\"", self.subtitle);
        for (index, (name, curves)) in groups.iter().enumerate() {
            self.diagram(&mut svg, 84.0 + BLOCK * index as f64, name, curves);
        }
        svg.finish()
    }

    /// The joints of each leg, then all others.
    fn groups(&self) -> Vec<(&'static str, Vec<&GaitCurve>)> {
        let side = |curve: &GaitCurve| SIDES.iter().position(|(s, _)| curve.name.starts_with(s));
        let names = SIDES.iter().map(|(_, name)| *name).chain(["other joints"]);
        let groups = names.enumerate().map(|(index, name)| {
            let own = self.curves.iter().filter(|c| side(c).unwrap_or(SIDES.len()) == index);
            (name, own.collect::<Vec<_>>())
        });
        groups.filter(|(_, curves)| !curves.is_empty()).collect()
    }

    fn diagram(&self, svg: &mut Svg, top: f64, name: &str, curves: &[&GaitCurve]) {
        svg.label([LEFT, top + 12.0], "start", HEADING, name);
        let values = curves.iter().flat_map(|curve| curve.values.iter().copied());
        let ends = [self.times_s.first(), self.times_s.last()];
        let [start, end] = ends.map(|end| end.copied().unwrap_or(0.0));
        let axes = Axes {
            corner: [LEFT, top + 24.0],
            size: PLOT,
            x: Scale::exactly(start, end.max(start + 1e-9), 10.0),
            y: Scale::around(values, 5.0),
        };
        axes.draw(svg, true);
        axes.name_y(svg, "joint angle [rad]");
        svg.label([LEFT + 0.5 * PLOT[0], top + PLOT[1] + 58.0], "middle", TICK, "time [s]");
        for posture in self.postures {
            let Some(t_s) = self.times_s.get(*posture) else { continue };
            let line = "stroke=\"#b9b9b4\" stroke-width=\"1\" stroke-dasharray=\"3 3\"";
            axes.curve(svg, &[*t_s; 2], &[axes.y.low, axes.y.high], line);
        }
        let mut left = LEFT + 90.0;
        for (index, curve) in curves.iter().enumerate() {
            let colour = COLOURS[index % COLOURS.len()];
            let style = format!("stroke=\"{colour}\" stroke-width=\"1.6\"");
            axes.curve(svg, self.times_s, &curve.values, &style);
            for posture in self.postures {
                let at = self.times_s.get(*posture).zip(curve.values.get(*posture));
                if let Some((t_s, value)) = at {
                    axes.mark(svg, [*t_s, *value], &format!("fill=\"{colour}\""));
                }
            }
            svg.line(&[[left, top + 8.0], [left + 22.0, top + 8.0]], &style);
            let text = curve.name.replace('_', " ");
            svg.label([left + 28.0, top + 12.0], "start", TICK, &text);
            left += 52.0 + 6.4 * text.len() as f64;
        }
    }
}
