//! f and B of the thesis's double pendulum, from its equations, as the demo shows them.

use super::super::decompose::Found;
use super::super::failure::Failure;
use super::{Written, write};
use denavit::fundamental::{Basis, DEFAULT_MEMORY_BYTES, Expansion};
use denavit::model::equations;
use denavit::shipped;
use serde::Serialize;
use std::io::Write;
use std::path::Path;

/// The equations: A.79 and A.80 of the thesis.
const EQUATIONS: &str = "double_pendulum_drives";

/// What became of them.
#[derive(Serialize)]
pub(super) struct Decomposed {
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

impl Decomposed {
    /// Decomposes them in the basis of A.86, eliminates B, and sets it all.
    pub(super) fn new(directory: &Path) -> Result<Self, Failure> {
        let shipped = shipped::find_equations(EQUATIONS).expect("it is shipped");
        let given = equations::read(EQUATIONS, shipped.text.as_bytes()).map_err(Failure::Model)?;
        let memory_bytes = DEFAULT_MEMORY_BYTES;
        let mut expansion = Expansion { memory_bytes, progress: &mut |_| {} };
        let mut found = Found::of_equations(Box::new(given), Some(Basis::Product), &mut expansion)?;
        found.eliminate(&[])?;
        let what = "f, B and base parameters as LaTeX".to_owned();
        let file =
            write(directory, &format!("{EQUATIONS}_decomposition.tex"), &found.latex()?, what)?;
        let decomposition = found.decomposition();
        Ok(Self {
            equations: EQUATIONS,
            functions: decomposition.functions.len(),
            shape: decomposition.shape(),
            entries: decomposition.nonzeros(),
            rank: found.rank().unwrap_or(0),
            file,
        })
    }

    pub(super) fn write(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let Self { equations, functions, shape: (rows, columns), entries, rank, file } = self;
        writeln!(out, "\n{equations}: equations A.79 and A.80 of the thesis, decomposed")?;
        writeln!(
            out,
            "{functions} fundamental functions; B is {rows} x {columns} with {entries} entries, \
             and leaves {rank} base parameters"
        )?;
        writeln!(out, "wrote {} ({} kB): {}", file.file, file.bytes.div_ceil(1000), file.what)?;
        Ok(())
    }
}
