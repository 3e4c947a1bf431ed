//! Logs as text: streamed, only the columns that are wanted.

use super::error::Error;
use super::fault::{FileFault, of_io};
use super::remark::FileRemark;
use super::source::{Column, Log, Rows, Tables};
use super::table::{Places, Table};
use std::io::{BufRead, Read};
use std::ops::Range;

/// Faults of one kind that are listed; more would say nothing new.
const MAX_LISTED: usize = 5;

/// Bytes of a line; a source without ends of lines must not fill the memory.
pub(crate) const LONGEST_LINE: u64 = 1 << 20;

/// Rows of a batch.
const BATCH: usize = 1 << 14;

/// The first lines of a log: what it says of itself, and the names of its columns.
#[derive(Clone, Debug, Default, PartialEq)]
struct Head {
    /// Name and value of lines `# name: value`.
    header: Vec<(String, String)>,
    columns: Vec<String>,
    separator: char,
    /// Lines that have been read.
    lines: usize,
}

/// A log of text, after the names of its columns.
struct Text<R> {
    lines: Lines<R>,
    head: Head,
}

impl<R: BufRead> Rows for Text<R> {
    fn read(mut self: Box<Self>, places: &[usize], _: &[usize]) -> Result<Table, Vec<FileFault>> {
        Ok(read_rows(&mut self.lines, &self.head, places, 0..usize::MAX)?.0)
    }

    fn batches<'a>(self: Box<Self>, places: &[usize]) -> Result<Tables<'a>, Vec<FileFault>>
    where
        Self: 'a,
    {
        let (mut text, places, mut is_at_end) = (*self, places.to_vec(), false);
        let mut rows = 0;
        Ok(Box::new(std::iter::from_fn(move || {
            if is_at_end {
                return None;
            }
            let read = read_rows(&mut text.lines, &text.head, &places, rows..rows + BATCH);
            rows += BATCH;
            is_at_end = read.as_ref().map_or(true, |(_, is_at_end)| *is_at_end);
            Some(read.map(|(table, _)| table))
        })))
    }
}

/// Opens a log of text: lines `# name: value`, the names of the columns, rows of numbers between
/// commas, semicolons or tabs.
///
/// # Errors
/// There are no names of columns, or the source cannot be read.
pub fn open_csv<'a>(source: impl BufRead + 'a) -> Result<Log<'a>, Error> {
    let mut lines = Lines::new(source);
    let head = read_head(&mut lines)?;
    let column = |name: &String| Column { name: name.clone(), known: None };
    Ok(Log {
        header: head.header.clone(),
        columns: head.columns.iter().map(column).collect(),
        rows: Box::new(Text { lines, head }),
    })
}

/// Lines of a source, without their ends.
struct Lines<R> {
    source: R,
    buffer: Vec<u8>,
    number: usize,
}

impl<R: BufRead> Lines<R> {
    fn new(source: R) -> Self {
        Self { source, buffer: Vec::new(), number: 0 }
    }

    /// The next line with its number, and whether it has an end; none at the end.
    fn next(&mut self) -> Result<Option<(usize, &str, bool)>, FileFault> {
        self.buffer.clear();
        let mut source = (&mut self.source).take(LONGEST_LINE);
        let read = source.read_until(b'\n', &mut self.buffer).map_err(|error| of_io(&error))?;
        if read == 0 {
            return Ok(None);
        }
        self.number += 1;
        let is_whole = self.buffer.last() == Some(&b'\n');
        if read as u64 == LONGEST_LINE && !is_whole {
            return Err(FileFault::LongLine { line: self.number });
        }
        let line = std::str::from_utf8(&self.buffer)
            .map_err(|_| FileFault::NotUtf8 { line: self.number })?;
        let line = if self.number == 1 { line.trim_start_matches('\u{feff}') } else { line };
        Ok(Some((self.number, line.trim(), is_whole)))
    }
}

/// Reads up to the names of the columns.
fn read_head<R: BufRead>(lines: &mut Lines<R>) -> Result<Head, Vec<FileFault>> {
    let mut head = Head { separator: ',', ..Head::default() };
    while let Some((number, line, _)) = lines.next().map_err(|fault| vec![fault])? {
        head.lines = number;
        if line.is_empty() {
            continue;
        }
        if let Some(said) = line.strip_prefix('#') {
            let (name, value) = said.split_once(':').unwrap_or((said, ""));
            head.header.push((name.trim().to_owned(), value.trim().to_owned()));
            continue;
        }
        let separators = [',', ';', '\t'];
        head.separator = separators.into_iter().find(|&one| line.contains(one)).unwrap_or(',');
        let names = line.split(head.separator).map(|name| name.trim().trim_matches('"').to_owned());
        head.columns = names.collect();
        let mut faults = Vec::new();
        for (place, column) in head.columns.iter().enumerate() {
            if head.columns[..place].contains(column) {
                faults.push(FileFault::RepeatedColumn { column: column.clone() });
            }
        }
        return if faults.is_empty() { Ok(head) } else { Err(faults) };
    }
    Err(vec![FileFault::NoColumns])
}

/// Reads the columns of `places` of these rows, which are the next ones, and says whether there are
/// no more.
fn read_rows<R: BufRead>(
    lines: &mut Lines<R>,
    head: &Head,
    places: &[usize],
    of: Range<usize>,
) -> Result<(Table, bool), Vec<FileFault>> {
    // Where the cell of each column of the file goes.
    let mut targets = vec![Vec::new(); head.columns.len()];
    for (target, &place) in places.iter().enumerate() {
        targets[place].push(target);
    }
    let mut table = Table { columns: vec![Vec::new(); places.len()], ..Table::default() };
    let mut runs = Vec::new();
    let mut faults = Vec::new();
    let mut before = 0;
    let mut is_at_end = false;
    while table.rows() < of.len() {
        let Some((number, line, is_whole)) = lines.next().map_err(|fault| vec![fault])? else {
            is_at_end = true;
            break;
        };
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let row = table.rows();
        if !is_whole && of.start + row > 0 {
            table.remarks.push(FileRemark::CutLine { line: number });
            is_at_end = true;
            break;
        }
        if before + 1 != number || row == 0 {
            runs.push((row, number));
        }
        before = number;
        let mut found = 0;
        for (cell, text) in line.split(head.separator).enumerate() {
            found += 1;
            for &target in targets.get(cell).map_or(&[][..], Vec::as_slice) {
                let value = parse(text.trim()).unwrap_or_else(|| {
                    if faults.len() < MAX_LISTED {
                        let (column, cell) = (head.columns[cell].clone(), text.trim().to_owned());
                        faults.push(FileFault::NotANumber { line: number, column, cell });
                    }
                    f64::NAN
                });
                table.columns[target].push(value);
            }
        }
        if found != head.columns.len() {
            if faults.len() < MAX_LISTED {
                let expected = head.columns.len();
                faults.push(FileFault::RowLength { line: number, expected, found });
            }
            table.columns.iter_mut().for_each(|column| column.resize(row + 1, f64::NAN));
        }
    }
    table.places = Places::Lines(runs);
    if faults.is_empty() { Ok((table, is_at_end)) } else { Err(faults) }
}

/// A cell: a number, or nothing (empty, `nan`) as NaN. None if it is neither.
fn parse(cell: &str) -> Option<f64> {
    match cell {
        "" | "nan" | "NaN" | "NAN" => Some(f64::NAN),
        _ => cell.parse::<f64>().ok().filter(|value| value.is_finite()),
    }
}
