//! A value over two others, as coloured cells.

use crate::svg::Svg;

/// Cells with their scales.
#[derive(Clone, Debug)]
pub(crate) struct HeatMap<'a> {
    /// What it is of.
    pub(crate) title: &'a str,
    /// What is to be read from it.
    pub(crate) subtitle: &'a str,
    /// Names of the axes, to the right and upwards, each with the values of its cells.
    pub(crate) axes: [(&'a str, &'a [f64]); 2],
    /// Row after row from below, left to right: a share from 0 to 1 of the colours, with what is
    /// written into the cell. None is a cell without an answer.
    pub(crate) cells: &'a [(Option<f64>, String)],
    /// What the colours mean: of 0 and of 1.
    pub(crate) meaning: [&'a str; 2],
}

const SIZE: [f64; 2] = [760.0, 560.0];
const CORNER: [f64; 2] = [110.0, 92.0];
const FIELD: [f64; 2] = [610.0, 380.0];
const SMALL: &str = "font-size=\"11\" fill=\"#555\"";
/// Cells lower than this have no room for text [px].
const ROOM: f64 = 14.0;
/// More marks on a scale are too many.
const MARKS: usize = 12;

impl HeatMap<'_> {
    /// The picture, as SVG.
    pub(crate) fn draw(&self) -> String {
        let mut svg = Svg::new(SIZE, self.title);
        svg.label([24.0, 34.0], "start", "font-size=\"18\" fill=\"#222\"", self.title);
        svg.label([24.0, 56.0], "start", "font-size=\"12\" fill=\"#666\"", self.subtitle);
        let [columns, rows] = [0, 1].map(|axis| self.axes[axis].1.len().max(1));
        let cell = [FIELD[0] / columns as f64, FIELD[1] / rows as f64];
        for (index, (share, text)) in self.cells.iter().enumerate().take(columns * rows) {
            let (column, row) = (index % columns, index / columns);
            let left = CORNER[0] + column as f64 * cell[0];
            let top = CORNER[1] + (rows - 1 - row) as f64 * cell[1];
            let [right, bottom] = [left + cell[0], top + cell[1]];
            let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
            let fill = share.map_or_else(|| "#999999".to_owned(), colour);
            svg.polygon(&corners, &format!("fill=\"{fill}\" stroke=\"#fff\" stroke-width=\"0.5\""));
            if cell[1] >= ROOM && !text.is_empty() {
                let dark = share.is_none_or(|share| share > 0.55);
                let style = if dark {
                    "font-size=\"10\" fill=\"#fff\""
                } else {
                    "font-size=\"10\" fill=\"#222\""
                };
                svg.label([left + 0.5 * cell[0], top + 0.5 * cell[1] + 4.0], "middle", style, text);
            }
        }
        self.scales(&mut svg, cell);
        let [low, high] = self.meaning;
        let key = format!("pale: {low}; dark: {high}");
        svg.label([CORNER[0], SIZE[1] - 14.0], "start", SMALL, &key);
        svg.finish()
    }

    fn scales(&self, svg: &mut Svg, cell: [f64; 2]) {
        for (axis, (name, values)) in self.axes.into_iter().enumerate() {
            let every = values.len().div_ceil(MARKS).max(1);
            for (index, value) in values.iter().enumerate().step_by(every) {
                let text = denavit_numerics::short(*value);
                let middle = (index as f64 + 0.5) * cell[axis];
                if axis == 0 {
                    let at = [CORNER[0] + middle, CORNER[1] + FIELD[1] + 16.0];
                    svg.label(at, "middle", SMALL, &text);
                } else {
                    let at = [CORNER[0] - 8.0, CORNER[1] + FIELD[1] - middle + 4.0];
                    svg.label(at, "end", SMALL, &text);
                }
            }
            let [left, top] = CORNER;
            if axis == 0 {
                let at = [left + 0.5 * FIELD[0], top + FIELD[1] + 38.0];
                svg.label(at, "middle", SMALL, name);
            } else {
                let at = [24.0, top + 0.5 * FIELD[1]];
                let turned = format!("{SMALL} transform=\"rotate(-90 {} {})\"", at[0], at[1]);
                svg.label(at, "middle", &turned, name);
            }
        }
    }
}

/// From pale to dark blue.
fn colour(share: f64) -> String {
    let share = share.clamp(0.0, 1.0);
    let ends = [[232.0, 241.0, 250.0], [12.0, 60.0, 120.0]];
    let [r, g, b] = [0, 1, 2].map(|i| {
        let value: f64 = ends[0][i] + share * (ends[1][i] - ends[0][i]);
        value.round() as u8
    });
    format!("#{r:02x}{g:02x}{b:02x}")
}
