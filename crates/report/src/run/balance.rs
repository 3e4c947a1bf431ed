//! Points of balance over time, with the edges of the support polygon (thesis figures 4.4 to 4.7).

use super::axes::{Axes, Scale, TICK};
use crate::svg::Svg;

/// A curve of a picture of balance.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BalanceCurve {
    /// Its name.
    pub(crate) name: &'static str,
    /// Its colour, as SVG says it.
    pub(crate) colour: &'static str,
    /// A value at each time; what is not finite is a gap.
    pub(crate) values: Vec<f64>,
}

/// Points of balance over time.
#[derive(Clone, Debug)]
pub(crate) struct BalancePicture<'a> {
    /// What it is of.
    pub(crate) title: &'a str,
    /// What is to be read from it.
    pub(crate) subtitle: &'a str,
    /// What is drawn upwards, with its unit.
    pub(crate) unit: &'a str,
    /// \[s\].
    pub(crate) times: &'a [f64],
    /// What is drawn.
    pub(crate) curves: &'a [BalanceCurve],
    /// The lower and the upper edge of what carries the robot: a band that may shrink to a line,
    /// or to nothing.
    pub(crate) band: Option<[Vec<f64>; 2]>,
}

const SIZE: [f64; 2] = [860.0, 420.0];

impl BalancePicture<'_> {
    /// The picture, as SVG.
    pub(crate) fn draw(&self) -> String {
        let mut svg = Svg::new(SIZE, self.title);
        svg.label([24.0, 34.0], "start", "font-size=\"18\" fill=\"#222\"", self.title);
        svg.label([24.0, 56.0], "start", "font-size=\"12\" fill=\"#666\"", self.subtitle);
        let edges = self.band.iter().flatten().flatten().copied();
        let values = self.curves.iter().flat_map(|curve| curve.values.iter().copied());
        let y = Scale::around(values.chain(edges), 6.0);
        let ends = [self.times.first(), self.times.last()].map(|end| end.copied().unwrap_or(0.0));
        let x = Scale::exactly(ends[0], ends[1].max(ends[0] + 1e-9), 8.0);
        let axes = Axes { corner: [86.0, 92.0], size: [740.0, 270.0], x, y };
        axes.draw(&mut svg, true);
        axes.name_y(&mut svg, self.unit);
        svg.label([456.0, 398.0], "middle", TICK, "time [s]");
        for edge in self.band.iter().flatten() {
            axes.curve(&mut svg, self.times, edge, "stroke=\"#444\" stroke-width=\"2\"");
        }
        for curve in self.curves {
            let style = format!("stroke=\"{}\" stroke-width=\"1.6\"", curve.colour);
            axes.curve(&mut svg, self.times, &curve.values, &style);
        }
        let mut left = 86.0;
        let edges = self.band.is_some().then_some(("edges of the support polygon", "#444"));
        let names = self.curves.iter().map(|curve| (curve.name, curve.colour)).chain(edges);
        for (name, colour) in names {
            svg.line(
                &[[left, 78.0], [left + 22.0, 78.0]],
                &format!("stroke=\"{colour}\" stroke-width=\"2\""),
            );
            svg.label([left + 28.0, 82.0], "start", TICK, &name.replace('_', " "));
            left += 52.0 + 6.4 * name.len() as f64;
        }
        svg.finish()
    }
}
