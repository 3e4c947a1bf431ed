//! Logs that are no text, as tables of the columns that the project has names for.

use denavit_logs::{Column, Error, Found, Opening, open};
use denavit_simulate::Log;
use std::collections::BTreeSet;
use std::fs::File;
use std::path::Path;

/// What the project calls a column.
fn name(column: &Column) -> &str {
    column.known.as_ref().map_or(&column.name, |known| &known.name)
}

/// Reads the columns that one name stands for. Where topics have clocks of their own, rows are
/// those of the one with the most of them.
pub(crate) fn known_columns(path: &Path, file: File) -> Result<Log, Error> {
    let log = open(path, Some(file), &Opening::default())?;
    let names: BTreeSet<&str> = log.columns.iter().map(name).collect();
    let place = |name: &str| match log.find(name) {
        Found::At(place) => Some((name.to_owned(), place)),
        Found::Several(_) | Found::Nowhere => None,
    };
    let (columns, places): (Vec<String>, Vec<usize>) = names.into_iter().filter_map(place).unzip();
    let header = log.header.clone();
    let table = log.read(&places, &[])?;
    let row = |row: usize| table.columns.iter().map(move |column| column[row]);
    let values = (0..table.rows()).flat_map(row).collect();
    Ok(Log { header, columns, values })
}
