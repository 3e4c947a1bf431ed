//! What the compiler finds, as text for people, as JSON, Markdown and LaTeX.
//!
//! - [`model_text`], [`model_json`]: a model as its file says it; [`faults_json`]: what is wrong
//!   with the file
//! - [`equations_text`], [`equations_json`]: equations of motion
//! - [`BaseReport`], [`GivenBaseReport`]: base parameters of a model, of given equations
//! - [`DecompositionTexts`]: f and B of either
//! - [`counts_text`], [`counts_json`]: what functions cost
//! - [`evaluated_json`]: functions as numbers
//! - [`sources_text`], [`sources_json`]: what was emitted
//! - [`verdict_text`], [`verdict_json`]: what the check of a certificate found
//! - [`ShippedKind`]: what is shipped, as a list
//!
//! Documents of JSON are values that serialise, keys in their order.

mod base;
mod counts;
mod decomposition;
mod elimination;
mod equations;
mod equations_json;
mod evaluated;
mod model;
mod shipped;
mod sources;
mod verdict;

pub use base::{BaseReport, GivenBaseReport};
pub use counts::{counts_json, counts_text};
pub use decomposition::DecompositionTexts;
pub use equations::equations_text;
pub use equations_json::equations_json;
pub use evaluated::evaluated_json;
pub use model::{faults_json, model_json, model_text, robot_faults_json};
pub(crate) use model::{model_row, model_rows, model_tables};
pub use shipped::{ShippedFile, ShippedKind, shipped_table};
pub use sources::{sources_json, sources_text};
pub use verdict::{verdict_json, verdict_text};

use serde::Serialize;
use std::fmt;

/// Expressions of more nodes than this, all of a document together, are written with
/// intermediates.
const PLAIN_NODES: u64 = 200;

/// A name of the text's own for an expression.
#[derive(Debug, Serialize)]
struct Intermediate {
    name: String,
    expression: String,
}

fn intermediates(bindings: Vec<(String, String)>) -> Vec<Intermediate> {
    let named = bindings.into_iter();
    named.map(|(name, expression)| Intermediate { name, expression }).collect()
}

/// What is written to a text.
fn text_of(write: impl FnOnce(&mut String) -> fmt::Result) -> String {
    let mut text = String::new();
    write(&mut text).expect("a string takes every text");
    text
}
