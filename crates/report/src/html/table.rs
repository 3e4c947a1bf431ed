//! Tables of pages.

use super::units::unit;
use super::{FormulaError, mathml};
use serde::{Serialize, Serializer};

/// A table whose rows a reader can sort. A column in which no row says anything is not shown.
#[derive(Clone, Debug)]
pub struct HtmlTable {
    /// What it shows.
    pub caption: String,
    /// Its columns.
    pub columns: Vec<Heading>,
    /// Its rows, each with a cell for every column.
    pub rows: Vec<Row>,
}

/// What is shown of a table.
#[derive(Serialize)]
struct Shown<'t> {
    caption: &'t str,
    columns: Vec<&'t Heading>,
    rows: Vec<ShownRow<'t>>,
}

#[derive(Serialize)]
struct ShownRow<'t> {
    cells: Vec<&'t Cell>,
    is_marked: bool,
}

impl Serialize for HtmlTable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let says = |at: &usize| {
            self.rows.iter().filter_map(|row| row.cells.get(*at)).any(|cell| !cell.is_empty())
        };
        let kept: Vec<usize> =
            (0..self.columns.len()).filter(|at| self.rows.is_empty() || says(at)).collect();
        let shown = Shown {
            caption: &self.caption,
            columns: kept.iter().map(|&at| &self.columns[at]).collect(),
            rows: self.rows.iter().map(|row| row.shown(&kept)).collect(),
        };
        shown.serialize(serializer)
    }
}

/// The head of a column.
#[derive(Clone, Debug, Serialize)]
pub struct Heading {
    /// The words.
    pub heading: String,
    /// Whether its cells are numbers.
    pub is_number: bool,
}

/// A row of a table.
#[derive(Clone, Debug)]
pub struct Row {
    /// The cells.
    pub cells: Vec<Cell>,
    /// Whether it stands out.
    pub is_marked: bool,
}

impl Row {
    fn shown(&self, kept: &[usize]) -> ShownRow<'_> {
        let cells = kept.iter().filter_map(|&at| self.cells.get(at)).collect();
        ShownRow { cells, is_marked: self.is_marked }
    }
}

/// A cell of a table.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Cell {
    text: String,
    mathml: Option<String>,
    is_number: bool,
    /// Whether its words may take several lines.
    is_prose: bool,
    /// Whether the formula is seen only when it is asked for.
    is_folded: bool,
    order: Option<f64>,
    bars: Option<Bars>,
    href: Option<String>,
}

/// Bars below each other, each of a share of the longest.
#[derive(Clone, Debug, Serialize)]
struct Bars {
    /// Lengths, of 100.
    lengths: Vec<f64>,
    /// Height of all.
    height: usize,
}

/// Height of a bar with its distance to the next.
const BAR: usize = 8;

impl Cell {
    /// Words.
    pub fn text(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    /// Whether it shows nothing.
    fn is_empty(&self) -> bool {
        self.text.is_empty() && self.mathml.is_none() && self.bars.is_none()
    }

    /// Words that lead to another page.
    pub(crate) fn link(text: &str, href: &str) -> Self {
        Self { href: Some(href.to_owned()), ..Self::text(text) }
    }

    /// A unit as files write it: `kg m^2`.
    pub fn unit(text: &str) -> Self {
        Self::text(unit(text))
    }

    /// Words that may take several lines.
    pub fn prose(text: impl Into<String>) -> Self {
        Self { text: text.into(), is_prose: true, ..Self::default() }
    }

    /// A number as it is shown; rows are sorted by its value.
    pub fn number(value: f64, shown: impl Into<String>) -> Self {
        let order = value.is_finite().then_some(value);
        Self { text: shown.into(), is_number: true, order, ..Self::default() }
    }

    /// A formula in LaTeX.
    pub fn formula(latex: &str) -> Result<Self, FormulaError> {
        Ok(Self { mathml: Some(mathml(latex, false)?), ..Self::default() })
    }

    /// A formula in LaTeX that a reader unfolds below these words.
    pub fn folded(words: impl Into<String>, latex: &str) -> Result<Self, FormulaError> {
        Ok(Self { text: words.into(), is_folded: true, ..Self::formula(latex)? })
    }

    /// Bars of these sizes; the longest there may be stands for `longest`. `words` say the same.
    pub fn bars(sizes: &[f64], longest: f64, words: impl Into<String>) -> Self {
        let share = |size: &f64| match longest > 0.0 && size.is_finite() {
            true => (1000.0 * size / longest).round().clamp(0.0, 1000.0) / 10.0,
            false => 0.0,
        };
        let lengths: Vec<f64> = sizes.iter().map(share).collect();
        let bars = Bars { height: BAR * lengths.len(), lengths };
        Self { text: words.into(), bars: Some(bars), ..Self::default() }
    }
}
