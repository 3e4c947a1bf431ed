//! f and B of the thesis's double pendulum, from its equations, as the demo shows them.

use super::{Document, Written};
use denavit::emit::latex::decomposition_document;
use denavit::fundamental::{Basis, DEFAULT_MEMORY_BYTES, Expansion};
use denavit::model::equations;
use denavit::regressor::{Decomposed, DecomposedError, Theta};
use denavit::shipped;
use serde::Serialize;
use std::fmt;

/// The equations: A.79 and A.80 of the thesis.
const EQUATIONS: &str = "double_pendulum_drives";

/// What became of them.
#[derive(Debug, Serialize)]
pub struct DecomposedOutcome {
    equations: &'static str,
    functions: usize,
    /// Rows and columns of B.
    shape: (usize, usize),
    /// Entries of B.
    entries: usize,
    /// Base parameters.
    rank: usize,
    file: Written,
}

impl DecomposedOutcome {
    /// Decomposes them in the basis of A.86, eliminates B, and sets it all in a document, which
    /// `write` takes to a file.
    pub fn new<E: From<DecomposedError>>(
        mut write: impl FnMut(Document) -> Result<Written, E>,
    ) -> Result<Self, E> {
        let shipped = shipped::find_equations(EQUATIONS).expect("it is shipped");
        let given = equations::read(EQUATIONS, shipped.text.as_bytes()).expect("it is right");
        let memory_bytes = DEFAULT_MEMORY_BYTES;
        let mut expansion = Expansion { memory_bytes, progress: &mut |_| {} };
        let mut found = Decomposed::of_equations(given, Some(Basis::Product), &mut expansion)?;
        found.eliminate(&[])?;
        let file = write(Document {
            name: format!("{EQUATIONS}_decomposition.tex"),
            text: decomposition_document(&found).expect("it is short"),
            what: "f, B and base parameters as LaTeX".to_owned(),
        })?;
        let decomposition = &found.decomposition;
        Ok(Self {
            equations: EQUATIONS,
            functions: decomposition.functions.len(),
            shape: decomposition.shape(),
            entries: decomposition.nonzeros(),
            rank: found.theta.as_ref().map_or(0, Theta::rank),
            file,
        })
    }
}

impl fmt::Display for DecomposedOutcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { equations, functions, shape: (rows, columns), entries, rank, file } = self;
        writeln!(f, "\n{equations}: equations A.79 and A.80 of the thesis, decomposed")?;
        writeln!(
            f,
            "{functions} fundamental functions; B is {rows} x {columns} with {entries} entries, \
             and leaves {rank} base parameters"
        )?;
        writeln!(f, "{file}")
    }
}
