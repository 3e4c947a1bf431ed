//! Reports as one HTML page that needs nothing from elsewhere: no network, no fonts, no files.
//!
//! Formulas are MathML; curves and runs are drawn by scripts that the page carries, other pictures
//! are SVG. All text is escaped by the template engine, data are JSON in elements that no browser
//! runs, and the page forbids itself whatever is not of its frame: scripts and styles are allowed
//! by their hashes.

mod chart;
mod data;
mod formula;
mod frame;
mod replay;
mod table;
mod units;

pub use chart::{Chart, ChartCurve, Look, Panel};
pub(crate) use data::{Brief, base64, with_decimals, with_digits};
pub use formula::{FormulaError, mathml};
pub use replay::{Mark, Replay};
pub(crate) use replay::{Scene, SceneMark, Slider};
pub use table::{Cell, Heading, HtmlTable, Row};
pub(crate) use units::{unit, with_units};

use serde::Serialize;

/// A report.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Page {
    /// What it is about.
    pub title: String,
    /// The answer in one sentence, if there is one.
    pub verdict: Option<VerdictLine>,
    /// The answer, in a paragraph.
    pub lead: String,
    /// What it was made of: version, hash of the model, files, seed.
    pub facts: Vec<Fact>,
    /// The rest.
    pub sections: Vec<Section>,
    /// Whether it loads itself again when the server that it is from says so.
    pub watches: bool,
}

/// The answer in one sentence.
#[derive(Clone, Debug, Serialize)]
pub struct VerdictLine {
    /// How good it is.
    pub grade: Grade,
    /// The sentence.
    pub text: String,
}

/// How good an answer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Grade {
    /// As wished.
    Good,
    /// With something to be looked at.
    Fair,
    /// Not to be believed, or broken.
    Bad,
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
    /// Curves.
    Chart(Chart),
    /// A run in three dimensions.
    Replay(Replay),
    /// Parts of which one is seen at a time.
    Tabs {
        /// These.
        tabs: Vec<Tab>,
    },
    /// What is seen when it is asked for.
    Folded {
        /// What is asked for.
        summary: String,
        /// No tabs, and nothing folded.
        parts: Vec<Part>,
    },
}

/// One of several parts.
#[derive(Clone, Debug, Serialize)]
pub struct Tab {
    /// What a reader clicks on.
    pub name: String,
    /// No tabs, and nothing folded.
    pub parts: Vec<Part>,
}

impl Page {
    /// The page as text.
    pub fn render(&self) -> String {
        frame::filled(self)
    }

    /// The page with paragraphs as `written`.
    #[must_use]
    pub fn rewritten(mut self, written: impl Fn(&str) -> String) -> Self {
        fn rewrite(parts: &mut [Part], written: &dyn Fn(&str) -> String) {
            for part in parts {
                match part {
                    Part::Paragraph { text } => *text = written(text),
                    Part::Folded { parts, .. } => rewrite(parts, written),
                    Part::Tabs { tabs } => {
                        tabs.iter_mut().for_each(|tab| rewrite(&mut tab.parts, written));
                    }
                    _ => {}
                }
            }
        }
        let sections = self.sections.iter_mut();
        sections.for_each(|section| rewrite(&mut section.parts, &written));
        self
    }

    /// Whether a part is among what is shown.
    fn has(&self, is: impl Fn(&Part) -> bool) -> bool {
        self.sections.iter().flat_map(|section| &section.parts).any(|part| match part {
            Part::Tabs { tabs } => tabs.iter().flat_map(|tab| &tab.parts).any(&is),
            Part::Folded { parts, .. } => parts.iter().any(&is),
            part => is(part),
        })
    }
}
