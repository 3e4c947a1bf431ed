//! A diagram: a rectangle with scales, a grid, and curves.

use super::super::camera::Vec2;
use super::super::svg::{Svg, number};
use denavit_numerics::{Span, envelope};

/// Decimals of a mark, at most: longer ones have a power of ten, so that they do not reach into the
/// name of the axis.
const LONGEST: usize = 3;

/// Pixels of a span in which a signal may go up and down too fast to be seen.
const SPAN: f64 = 2.0;

/// The numbers of a scale: a range whose ends are marks, or that is cut where the data end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Distance of the marks.
    step: f64,
    decimals: usize,
}

impl Scale {
    /// A scale with about `marks` round marks that holds all finite values, rounded outwards.
    pub(super) fn around(values: impl Iterator<Item = f64>, marks: f64) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.filter(|value| value.is_finite()) {
            low = low.min(value);
            high = high.max(value);
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        // a value that rests is drawn in the middle, not as its rounding
        let least = (1e-6 * low.abs().max(high.abs())).max(1e-9);
        if high - low < least {
            let half = (0.5 * low.abs()).max(0.5);
            (low, high) = (low - half, high + half);
        }
        let scale = Self::exactly(low, high, marks);
        let down = (low / scale.step + 1e-9).floor() * scale.step;
        let up = (high / scale.step - 1e-9).ceil() * scale.step;
        Self { low: down, high: up, ..scale }
    }

    /// A scale from `low` to `high` with about so many round marks.
    pub(super) fn exactly(low: f64, high: f64, marks: f64) -> Self {
        let rough = ((high - low) / marks).max(1e-12);
        let power = 10.0_f64.powi(rough.log10().floor() as i32);
        let step = [1.0, 2.0, 5.0].into_iter().find(|m| m * power >= rough * 0.999);
        let step = step.unwrap_or(10.0) * power;
        let decimals = (-(step * 1.0001).log10().floor()).clamp(0.0, 9.0) as usize;
        Self { low, high, step, decimals }
    }

    fn marks(&self) -> impl Iterator<Item = f64> + '_ {
        let first = (self.low / self.step - 1e-6).ceil();
        let last = (self.high / self.step + 1e-6).floor();
        let count = (last - first).clamp(0.0, 50.0) as usize;
        (0..=count).map(move |index| (first + index as f64) * self.step)
    }

    fn text(&self, value: f64) -> String {
        let text = format!("{value:.*}", self.decimals);
        let is_zero = text.trim_matches(['-', '0', '.']).is_empty();
        let text = match (self.decimals > LONGEST, text.parse::<f64>()) {
            (true, Ok(_)) if is_zero => "0".to_owned(),
            (true, Ok(rounded)) => format!("{rounded:e}"),
            _ if is_zero => text.trim_start_matches('-').to_owned(),
            _ => text,
        };
        text.replace('-', "\u{2212}")
    }

    /// Where a value stands, from 0 to 1.
    fn share(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }
}

/// The rectangle of a diagram.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    /// Upper left corner and size [px].
    pub(super) corner: Vec2,
    pub(super) size: Vec2,
    pub(super) x: Scale,
    pub(super) y: Scale,
}

/// Styles of text.
pub(super) const TICK: &str = "font-size=\"11\" fill=\"#555\"";
const GRID: &str = "stroke=\"#e6e6e3\" stroke-width=\"1\"";
const FRAME: &str = "stroke=\"#9a9a96\" stroke-width=\"1\"";

impl Axes {
    fn place(&self, [x, y]: [f64; 2]) -> Vec2 {
        let ([left, top], [wide, tall]) = (self.corner, self.size);
        [left + wide * self.x.share(x), top + tall * (1.0 - self.y.share(y))]
    }

    /// Grid, marks of the left scale, and, where `names_x`, those of the lower one.
    pub(super) fn draw(&self, svg: &mut Svg, names_x: bool) {
        let ([left, top], [wide, tall]) = (self.corner, self.size);
        for mark in self.x.marks() {
            let [x, _] = self.place([mark, self.y.low]);
            svg.line(&[[x, top], [x, top + tall]], GRID);
            if names_x {
                svg.label([x, top + tall + 16.0], "middle", TICK, &self.x.text(mark));
            }
        }
        for mark in self.y.marks() {
            let [_, y] = self.place([self.x.low, mark]);
            svg.line(&[[left, y], [left + wide, y]], GRID);
            svg.label([left - 7.0, y + 4.0], "end", TICK, &self.y.text(mark));
        }
        svg.line(&[[left, top], [left, top + tall], [left + wide, top + tall]], FRAME);
    }

    /// A curve through (x, y); what is not finite is a gap.
    pub(super) fn curve(&self, svg: &mut Svg, xs: &[f64], ys: &[f64], style: &str) {
        let (low, high) = (self.x.low - 1e-9, self.x.high + 1e-9);
        let points = xs.iter().zip(ys).filter(|(x, _)| (low..=high).contains(*x));
        let mut piece: Vec<Vec2> = Vec::new();
        for (x, y) in points {
            if y.is_finite() {
                piece.push(self.place([*x, *y]));
            } else {
                self.piece(svg, &piece, style);
                piece.clear();
            }
        }
        self.piece(svg, &piece, style);
    }

    fn piece(&self, svg: &mut Svg, points: &[Vec2], style: &str) {
        if points.len() < 2 {
            return;
        }
        let heights: Vec<f64> = points.iter().map(|point| point[1]).collect();
        let spans = self.size[0] / SPAN;
        match envelope(&heights, spans as usize).filter(|_| points.len() as f64 > spans) {
            Some(spans) => band(svg, points, &spans, style),
            None => svg.line(&simplified(&thinned(points)), style),
        }
    }

    /// A dot at a place.
    pub(super) fn mark(&self, svg: &mut Svg, at: [f64; 2], style: &str) {
        if at.iter().all(|entry| entry.is_finite()) {
            svg.circle(self.place(at), 3.2, style);
        }
    }

    /// A name at the left of the scale, written upwards.
    pub(super) fn name_y(&self, svg: &mut Svg, text: &str) {
        let [x, y] = [self.corner[0] - 46.0, self.corner[1] + 0.5 * self.size[1]];
        let turned = format!("{TICK} transform=\"rotate(-90 {} {})\"", number(x), number(y));
        svg.label([x, y], "middle", &turned, text);
    }
}

/// What a curve is between that goes up and down faster than is seen.
fn band(svg: &mut Svg, points: &[Vec2], spans: &[Span], style: &str) {
    let middle = |span: &Span| {
        let [first, last] = [span.rows.start, span.rows.end - 1].map(|row| points[row][0]);
        0.5 * (first + last)
    };
    let edge = |end: usize| spans.iter().map(move |span| [middle(span), span.ends[end]]);
    let [low, high] = [0, 1].map(|end| simplified(&edge(end).collect::<Vec<Vec2>>()));
    // the colour of the line
    let colour = style.split("stroke=\"").nth(1).and_then(|rest| rest.split('"').next());
    let fill = format!("fill=\"{}\" fill-opacity=\"0.35\"", colour.unwrap_or("#5a6472"));
    let outline: Vec<Vec2> = low.iter().copied().chain(high.iter().rev().copied()).collect();
    svg.polygon(&outline, &fill);
    for edge in [low, high] {
        svg.line(&edge, &format!("{style} stroke-opacity=\"0.7\""));
    }
}

/// The points without those that a picture cannot show: of each pixel's column the first, the
/// lowest, the highest and the last.
fn thinned(points: &[Vec2]) -> Vec<Vec2> {
    let mut kept = Vec::new();
    let mut start = 0;
    while start < points.len() {
        let column = points[start][0].floor();
        let length = points[start..].iter().take_while(|p| p[0].floor() == column).count().max(1);
        let bucket = &points[start..start + length];
        if length <= 4 {
            kept.extend_from_slice(bucket);
        } else {
            let by_height = |a: &usize, b: &usize| bucket[*a][1].total_cmp(&bucket[*b][1]);
            let low = (0..length).min_by(by_height).unwrap_or(0);
            let high = (0..length).max_by(by_height).unwrap_or(0);
            let mut chosen = [0, low, high, length - 1];
            chosen.sort_unstable();
            kept.extend(chosen.map(|index| bucket[index]));
        }
        start += length;
    }
    kept
}

/// Half the width of a hair [px].
const HAIR: f64 = 0.1;

/// The points without those that lie on the line between others (Ramer 1972, Douglas, Peucker
/// 1973).
fn simplified(points: &[Vec2]) -> Vec<Vec2> {
    let mut keeps = vec![false; points.len()];
    let mut pending = vec![(0, points.len().saturating_sub(1))];
    while let Some((start, end)) = pending.pop() {
        (keeps[start], keeps[end]) = (true, true);
        let ([ax, ay], [bx, by]) = (points[start], points[end]);
        let (along, size) = ([bx - ax, by - ay], (bx - ax).hypot(by - ay).max(1e-9));
        let off = |k: &usize| {
            let arm = [points[*k][0] - ax, points[*k][1] - ay];
            (arm[0] * along[1] - arm[1] * along[0]).abs() / size
        };
        let farthest = (start + 1..end).max_by(|a, b| off(a).total_cmp(&off(b)));
        if let Some(farthest) = farthest.filter(|k| off(k) > HAIR) {
            pending.extend([(start, farthest), (farthest, end)]);
        }
    }
    points.iter().zip(keeps).filter(|(_, keep)| *keep).map(|(point, _)| *point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round_and_hold_their_values() {
        let scale = Scale::around([-0.37, 0.81, f64::NAN].into_iter(), 4.0);
        assert_eq!((scale.step, scale.decimals), (0.5, 1));
        let small = Scale::around([-4e-5, 9e-5].into_iter(), 3.0);
        let marks: Vec<String> = small.marks().map(|mark| small.text(mark)).collect();
        assert_eq!(marks, ["\u{2212}5e\u{2212}5", "0", "5e\u{2212}5", "1e\u{2212}4"]);
        assert_eq!((scale.low, scale.high), (-0.5, 1.0));
        let marks: Vec<String> = scale.marks().map(|mark| scale.text(mark)).collect();
        assert_eq!(marks, ["\u{2212}0.5", "0.0", "0.5", "1.0"]);
        let resting = Scale::around([2.0, 2.0 + 1e-12].into_iter(), 4.0);
        assert!(resting.low < 1.5 && resting.high > 2.5);
    }

    #[test]
    fn straight_lines_are_their_corners() {
        let points: Vec<Vec2> = (0..100).map(|k| [k as f64, (k as f64 - 40.0).abs()]).collect();
        assert_eq!(simplified(&points), [[0.0, 40.0], [40.0, 0.0], [99.0, 59.0]]);
        assert_eq!(simplified(&points[..2]).len(), 2);
    }

    #[test]
    fn a_thousand_points_in_a_pixel_are_four() {
        let points: Vec<Vec2> = (0..1000).map(|k| [k as f64 * 1e-3, (k % 7) as f64]).collect();
        let kept = thinned(&points);
        assert_eq!(kept.len(), 4);
        assert!(kept.iter().any(|p| p[1] == 6.0) && kept.iter().any(|p| p[1] == 0.0));
    }
}
