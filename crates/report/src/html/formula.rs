//! Formulas as MathML, which browsers show by themselves.

use pulldown_latex::config::{DisplayMode, RenderConfig};
use pulldown_latex::event::{Content, Dimension, DimensionUnit, Event};
use pulldown_latex::{Parser, ParserError, Storage, push_mathml};
use std::fmt;

/// A space between words.
const SPACE_EM: f32 = 0.33;

/// Why a formula is not written as MathML.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FormulaError {
    /// The formula.
    pub latex: String,
    /// What is wrong with it.
    pub cause: String,
}

impl fmt::Display for FormulaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the formula {} cannot be read: {}", self.latex, self.cause)
    }
}

impl std::error::Error for FormulaError {}

/// A formula in LaTeX (without dollar signs) as a `<math>` element, on a line of its own if
/// `display` says so.
pub fn mathml(latex: &str, display: bool) -> Result<String, FormulaError> {
    let failed = |cause: String| FormulaError { latex: latex.to_owned(), cause };
    let storage = Storage::new();
    // the writer would put an error into the page
    let events = Parser::new(latex, &storage)
        .collect::<Result<Vec<Event<'_>>, ParserError>>()
        .map_err(|error| failed(error.to_string()))?;
    // its reader makes an entity of a space, which its writer escapes
    let width = Some(Dimension::new(SPACE_EM, DimensionUnit::Em));
    let events = events.into_iter().map(|event| match event {
        Event::Content(Content::Text("&nbsp;")) => {
            Event::Space { width, height: None, depth: None }
        }
        other => other,
    });
    let events = events.map(Ok::<_, ParserError>);
    let display_mode = if display { DisplayMode::Block } else { DisplayMode::Inline };
    let config = RenderConfig { display_mode, ..RenderConfig::default() };
    let mut text = String::new();
    push_mathml(&mut text, events, config).map_err(|error| failed(error.to_string()))?;
    Ok(text)
}
