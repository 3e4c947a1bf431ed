//! Floquet multipliers in the unit circle (thesis figure 4.9).

use crate::svg::Svg;

/// Multipliers to be drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UnitCircle<'a> {
    /// What it is of.
    pub(crate) title: &'a str,
    /// What is to be read from it.
    pub(crate) subtitle: &'a str,
    /// Real and imaginary parts.
    pub(crate) multipliers: &'a [[f64; 2]],
}

/// Size of the picture, and place of the plane's origin [px].
const SIZE: [f64; 2] = [520.0, 560.0];
const ORIGIN: [f64; 2] = [260.0, 310.0];
/// Half the width of the plane [px].
const HALF: f64 = 215.0;

impl UnitCircle<'_> {
    /// The picture, as SVG.
    pub(crate) fn draw(&self) -> String {
        let mut svg = Svg::new(SIZE, self.title);
        svg.label([24.0, 34.0], "start", "font-size=\"18\" fill=\"#222\"", self.title);
        svg.label([24.0, 56.0], "start", "font-size=\"12\" fill=\"#666\"", self.subtitle);
        let largest =
            self.multipliers.iter().fold(1.0_f64, |most, [re, im]| most.max(re.hypot(*im)));
        let reach = 1.1 * largest;
        let place =
            |[re, im]: [f64; 2]| [ORIGIN[0] + HALF * re / reach, ORIGIN[1] - HALF * im / reach];
        for radius in [0.5, 1.0] {
            let style = if radius == 1.0 {
                "fill=\"none\" stroke=\"#444\" stroke-width=\"1.5\""
            } else {
                "fill=\"none\" stroke=\"#ddd\" stroke-width=\"1\""
            };
            svg.circle(ORIGIN, HALF * radius / reach, style);
        }
        let axis = "stroke=\"#bbb\" stroke-width=\"1\"";
        svg.line(&[place([-reach, 0.0]), place([reach, 0.0])], axis);
        svg.line(&[place([0.0, -reach]), place([0.0, reach])], axis);
        let small = "font-size=\"11\" fill=\"#555\"";
        for (at, text) in [([1.0, 0.0], "1"), ([-1.0, 0.0], "\u{2212}1")] {
            let [x, y] = place(at);
            svg.label([x + 5.0, y + 14.0], "start", small, text);
        }
        let [x, y] = place([0.0, 1.0]);
        svg.label([x + 5.0, y - 5.0], "start", small, "i");
        for &[re, im] in self.multipliers {
            let fill = if re.hypot(im) < 1.0 { "#1f6fb4" } else { "#c0392b" };
            let style = format!("fill=\"{fill}\" fill-opacity=\"0.75\" stroke=\"#fff\"");
            svg.circle(place([re, im]), 5.0, &style);
        }
        svg.finish()
    }
}
