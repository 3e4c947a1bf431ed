//! Reports as one HTML page that needs nothing from elsewhere: no network, no fonts, no files.
//!
//! Formulas are MathML, pictures are SVG, tables are sorted by a click on a heading. All text is
//! escaped by the template engine; the page forbids itself to load anything.

mod formula;

pub use formula::{FormulaError, mathml};

use minijinja::Environment;
use minijinja::value::Serde;
use serde::Serialize;

/// The frame of a page.
const TEMPLATE: &str = include_str!("../../templates/html/report.html.jinja");

/// The name by which the engine knows that text is escaped for HTML.
const NAME: &str = "report.html";

/// A report.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Page {
    /// What it is about.
    pub title: String,
    /// The answer, in a paragraph.
    pub lead: String,
    /// What it was made of: version, hash of the model, files, seed.
    pub facts: Vec<Fact>,
    /// The rest.
    pub sections: Vec<Section>,
}

/// One line of what a report was made of.
#[derive(Clone, Debug, Serialize)]
pub struct Fact {
    /// What.
    pub name: String,
    /// Its value.
    pub value: String,
}

/// A part with a heading.
#[derive(Clone, Debug, Serialize)]
pub struct Section {
    /// The heading.
    pub heading: String,
    /// What is below it.
    pub parts: Vec<Part>,
}

/// What a section is made of.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Part {
    /// Words.
    Paragraph {
        /// The words.
        text: String,
    },
    /// A formula on a line of its own.
    Formula {
        /// As [`mathml`] writes it.
        mathml: String,
    },
    /// A picture.
    Figure {
        /// An SVG document of this library.
        svg: String,
        /// What it shows.
        caption: String,
    },
    /// A table.
    Table(HtmlTable),
}

/// A table whose rows a reader can sort.
#[derive(Clone, Debug, Serialize)]
pub struct HtmlTable {
    /// What it shows.
    pub caption: String,
    /// Its columns.
    pub columns: Vec<Heading>,
    /// Its rows, each with a cell for every column.
    pub rows: Vec<Row>,
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
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The cells.
    pub cells: Vec<Cell>,
    /// Whether it stands out.
    pub is_marked: bool,
}

/// A cell of a table.
#[derive(Clone, Debug, Serialize)]
pub struct Cell {
    text: String,
    mathml: Option<String>,
    is_number: bool,
    order: Option<f64>,
}

impl Cell {
    /// Words.
    pub fn text(text: impl Into<String>) -> Self {
        Self { text: text.into(), mathml: None, is_number: false, order: None }
    }

    /// A number as it is shown; rows are sorted by its value.
    pub fn number(value: f64, shown: impl Into<String>) -> Self {
        let order = value.is_finite().then_some(value);
        Self { text: shown.into(), mathml: None, is_number: true, order }
    }

    /// A formula in LaTeX.
    pub fn formula(latex: &str) -> Result<Self, FormulaError> {
        let mathml = Some(mathml(latex, false)?);
        Ok(Self { text: String::new(), mathml, is_number: false, order: None })
    }
}

impl Page {
    /// The page as text.
    pub fn render(&self) -> String {
        let mut environment = Environment::new();
        environment.add_template(NAME, TEMPLATE).expect("the template is part of the library");
        let template = environment.get_template(NAME).expect("it was just added");
        template.render(Serde(self)).expect("the template asks for what a page has")
    }
}
