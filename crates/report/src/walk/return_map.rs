//! States on a section after each cycle, on their way to the fixed point (thesis figure 4.8).

use crate::svg::Svg;

/// Returns to be drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReturnMapPicture<'a> {
    /// What it is of.
    pub(crate) title: &'a str,
    /// What is to be read from it.
    pub(crate) subtitle: &'a str,
    /// What is to the right and upwards, with units.
    pub(crate) axes: [&'a str; 2],
    /// Deviations from the fixed point: at the start, and after each cycle.
    pub(crate) points: &'a [[f64; 2]],
}

/// Size of the picture, and place of the fixed point [px].
const SIZE: [f64; 2] = [560.0, 600.0];
const ORIGIN: [f64; 2] = [280.0, 320.0];
/// Half the width of the plane [px].
const HALF: f64 = 220.0;
/// Points nearer to the one before have no number of their own [px].
const ROOM: f64 = 14.0;

impl ReturnMapPicture<'_> {
    /// The picture, as SVG.
    pub(crate) fn draw(&self) -> String {
        let mut svg = Svg::new(SIZE, self.title);
        svg.label([24.0, 34.0], "start", "font-size=\"18\" fill=\"#222\"", self.title);
        svg.label([24.0, 56.0], "start", "font-size=\"12\" fill=\"#666\"", self.subtitle);
        let finite = self.points.iter().flatten().filter(|x| x.is_finite());
        let reach = 1.1 * finite.fold(1e-12_f64, |most, x| most.max(x.abs()));
        let place = |[x, y]: [f64; 2]| [ORIGIN[0] + HALF * x / reach, ORIGIN[1] - HALF * y / reach];
        let (axis, small) =
            ("stroke=\"#bbb\" stroke-width=\"1\"", "font-size=\"11\" fill=\"#555\"");
        svg.line(&[place([-reach, 0.0]), place([reach, 0.0])], axis);
        svg.line(&[place([0.0, -reach]), place([0.0, reach])], axis);
        svg.label([SIZE[0] - 24.0, ORIGIN[1] + HALF + 34.0], "end", small, self.axes[0]);
        svg.label([24.0, ORIGIN[1] - HALF - 12.0], "start", small, self.axes[1]);
        for mark in [-1.0, 1.0] {
            let value = mark * reach / 1.1;
            let text = denavit_numerics::short(value);
            let [x, y] = place([value, 0.0]);
            svg.label([x, y + 16.0], "middle", small, &text);
            let [x, y] = place([0.0, value]);
            svg.label([x - 6.0, y + 4.0], "end", small, &text);
        }
        let path: Vec<[f64; 2]> = self.points.iter().map(|point| place(*point)).collect();
        svg.line(&path, "stroke=\"#1f6fb4\" stroke-opacity=\"0.4\"");
        let mut numbered: Option<[f64; 2]> = None;
        for (index, &[x, y]) in path.iter().enumerate() {
            svg.circle([x, y], 4.0, "fill=\"#1f6fb4\" fill-opacity=\"0.8\" stroke=\"#fff\"");
            if numbered.is_none_or(|[u, v]| (x - u).hypot(y - v) > ROOM) {
                svg.label([x + 6.0, y - 6.0], "start", small, &index.to_string());
                numbered = Some([x, y]);
            }
        }
        svg.circle(ORIGIN, 6.0, "fill=\"none\" stroke=\"#c0392b\" stroke-width=\"1.5\"");
        svg.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::ReturnMapPicture;

    #[test]
    fn every_return_is_drawn_and_no_attribute_stands_twice() {
        let points = [[0.1, -0.1], [-0.05, 0.04], [0.0, 0.01], [0.0, 0.0]];
        let picture =
            ReturnMapPicture { title: "t", subtitle: "s", axes: ["a", "b"], points: &points };
        let svg = picture.draw();
        assert_eq!(svg.matches("<circle").count(), points.len() + 1);
        for tag in svg.split('<') {
            let tag = tag.split('>').next().unwrap_or_default();
            for attribute in [" fill=", " stroke=", " cx="] {
                assert!(tag.matches(attribute).count() <= 1, "{tag}");
            }
        }
    }
}
