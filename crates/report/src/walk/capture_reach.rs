//! The capture points from which so many steps are enough, over the foot (Koolen 2012).

use crate::svg::Svg;

/// Reaches to be drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CaptureReach<'a> {
    /// What it is of.
    pub(crate) title: &'a str,
    /// What is to be read from it.
    pub(crate) subtitle: &'a str,
    /// The sole, forward from the ankle \[m\].
    pub(crate) sole_m: [f64; 2],
    /// For 0, 1, .. steps the reach backward and forward \[m\].
    pub(crate) reach_m: &'a [[f64; 2]],
    /// That of any number of steps \[m\].
    pub(crate) limit_m: [f64; 2],
    /// Places of a capture point, each with a word \[m\].
    pub(crate) marks: &'a [(f64, String)],
}

/// Size of the picture, without its rows, and of a row [px].
const WIDTH: f64 = 640.0;
const TOP: f64 = 84.0;
const BOTTOM: f64 = 96.0;
const ROW: f64 = 34.0;
/// Left and right end of the scale [px].
const ENDS: [f64; 2] = [96.0, 610.0];

const SMALL: &str = "font-size=\"11\" fill=\"#555\"";
const COLOURS: [&str; 5] = ["#2b7a4b", "#5a9e4b", "#9bb84a", "#d9a441", "#d9773f"];

impl CaptureReach<'_> {
    /// The picture, as SVG.
    pub(crate) fn draw(&self) -> String {
        let rows = self.reach_m.len() as f64 + 1.0;
        let height = TOP + rows * ROW + BOTTOM;
        let mut svg = Svg::new([WIDTH, height], self.title);
        svg.label([24.0, 34.0], "start", "font-size=\"18\" fill=\"#222\"", self.title);
        svg.label([24.0, 56.0], "start", "font-size=\"12\" fill=\"#666\"", self.subtitle);
        let ground = TOP + rows * ROW;
        let all = self.marks.iter().map(|(place, _)| *place).chain(self.limit_m).chain(self.sole_m);
        let far = all.filter(|x| x.is_finite()).fold(1e-3_f64, |far, x| far.max(x.abs()));
        let [left, right] = ENDS;
        let x = |place: f64| 0.5 * (left + right) + 0.5 * (right - left) * place / (1.05 * far);
        for (row, reach) in self.reach_m.iter().chain([&self.limit_m]).enumerate() {
            let top = TOP + row as f64 * ROW;
            let is_limit = row == self.reach_m.len();
            let fill = if is_limit { "#b9b9b4" } else { COLOURS[row.min(COLOURS.len() - 1)] };
            bar(&mut svg, [x(reach[0]), x(reach[1])], [top + 5.0, top + ROW - 5.0], fill);
            let word = match row {
                _ if is_limit => "any number".to_owned(),
                0 => "no step".to_owned(),
                1 => "1 step".to_owned(),
                steps => format!("{steps} steps"),
            };
            svg.label([left - 8.0, top + 0.5 * ROW + 4.0], "end", SMALL, &word);
            for (end, anchor, off) in [(reach[0], "end", -4.0), (reach[1], "start", 4.0)] {
                let text = format!("{:.0}", 1e3 * end).replace('-', "\u{2212}");
                svg.label([x(end) + off, top + 0.5 * ROW + 4.0], anchor, SMALL, &text);
            }
        }
        self.ground(&mut svg, &x, ground);
        svg.finish()
    }

    /// The sole, its ankle, and the capture points.
    fn ground(&self, svg: &mut Svg, x: &dyn Fn(f64) -> f64, ground: f64) {
        let sole = self.sole_m.map(x);
        bar(svg, sole, [ground + 22.0, ground + 30.0], "#444");
        let ankle = x(0.0);
        svg.line(
            &[[ankle, TOP], [ankle, ground + 22.0]],
            "stroke=\"#999\" stroke-dasharray=\"3 3\"",
        );
        let at = [0.5 * (sole[0] + sole[1]), ground + 46.0];
        svg.label(at, "middle", SMALL, "sole; numbers are mm from its ankle, forward to the right");
        for (place, word) in self.marks.iter().filter(|(place, _)| place.is_finite()) {
            svg.line(&[[x(*place), TOP], [x(*place), ground + 56.0]], "stroke=\"#1f4fb4\"");
            svg.label([x(*place), ground + 70.0], "middle", SMALL, word);
        }
    }
}

fn bar(svg: &mut Svg, [left, right]: [f64; 2], [top, bottom]: [f64; 2], fill: &str) {
    let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
    svg.polygon(&corners, &format!("fill=\"{fill}\" fill-opacity=\"0.85\""));
}
