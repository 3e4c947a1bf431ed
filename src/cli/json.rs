//! JSON answers.

use super::failure::Failure;
use serde::Serialize;
use std::io::Write;

/// Writes an answer.
pub(crate) fn write_json(out: &mut dyn Write, value: &impl Serialize) -> Result<(), Failure> {
    serde_json::to_writer_pretty(&mut *out, value)?;
    Ok(writeln!(out)?)
}
