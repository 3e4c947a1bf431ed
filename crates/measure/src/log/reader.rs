//! Logs as they stand in their files: streamed, only the columns that are wanted.

use super::fault::LogFault;
use std::io::{BufRead, ErrorKind, Read};

/// Faults of one kind that are listed; more would say nothing new.
const MAX_LISTED: usize = 5;

/// Bytes of a line; a source without ends of lines must not fill the memory.
pub(super) const LONGEST_LINE: u64 = 1 << 20;

/// The first lines of a log: what it says of itself, and the names of its columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Head {
    /// Name and value of lines `# name: value`.
    pub(super) header: Vec<(String, String)>,
    pub(super) columns: Vec<String>,
    pub(super) separator: char,
    /// Lines that have been read.
    pub(super) lines: usize,
}

/// Columns of a log; undefined cells are NaN.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Table {
    pub(super) columns: Vec<Vec<f64>>,
    /// The line of the first row of each run of rows without other lines between, with its row.
    lines: Vec<(usize, usize)>,
    /// The last line, if it has no end: it may be cut, and is none of the rows.
    pub(super) cut: Option<usize>,
}

impl Table {
    pub(super) fn rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// The line on which a row stands, from 1.
    pub(super) fn line(&self, row: usize) -> usize {
        let last = self.lines.partition_point(|&(first, _)| first <= row);
        let (first, line) = self.lines[last.saturating_sub(1)];
        line + row - first
    }
}

/// Lines of a source, without their ends.
pub(super) struct Lines<R> {
    source: R,
    buffer: Vec<u8>,
    number: usize,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(source: R) -> Self {
        Self { source, buffer: Vec::new(), number: 0 }
    }

    /// The next line with its number, and whether it has an end; none at the end.
    fn next(&mut self) -> Result<Option<(usize, &str, bool)>, LogFault> {
        self.buffer.clear();
        let mut source = (&mut self.source).take(LONGEST_LINE);
        let read = source.read_until(b'\n', &mut self.buffer).map_err(|error| {
            let text = match error.kind() {
                ErrorKind::IsADirectory => "it is a directory".to_owned(),
                _ => error.to_string(),
            };
            LogFault::Unreadable(text)
        })?;
        if read == 0 {
            return Ok(None);
        }
        self.number += 1;
        let is_whole = self.buffer.last() == Some(&b'\n');
        if read as u64 == LONGEST_LINE && !is_whole {
            return Err(LogFault::LongLine { line: self.number });
        }
        let line = std::str::from_utf8(&self.buffer)
            .map_err(|_| LogFault::NotUtf8 { line: self.number })?;
        let line = if self.number == 1 { line.trim_start_matches('\u{feff}') } else { line };
        Ok(Some((self.number, line.trim(), is_whole)))
    }
}

/// Reads up to the names of the columns.
pub(super) fn read_head<R: BufRead>(lines: &mut Lines<R>) -> Result<Head, Vec<LogFault>> {
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
                faults.push(LogFault::RepeatedColumn { column: column.clone() });
            }
        }
        return if faults.is_empty() { Ok(head) } else { Err(faults) };
    }
    Err(vec![LogFault::NoColumns])
}

/// Reads the columns of `places` of all rows.
pub(super) fn read_rows<R: BufRead>(
    lines: &mut Lines<R>,
    head: &Head,
    places: &[usize],
) -> Result<Table, Vec<LogFault>> {
    // Where the cell of each column of the file goes.
    let mut targets = vec![Vec::new(); head.columns.len()];
    for (target, &place) in places.iter().enumerate() {
        targets[place].push(target);
    }
    let mut table = Table { columns: vec![Vec::new(); places.len()], lines: Vec::new(), cut: None };
    let mut faults = Vec::new();
    let mut before = 0;
    while let Some((number, line, is_whole)) = lines.next().map_err(|fault| vec![fault])? {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let row = table.rows();
        if !is_whole && row > 0 {
            table.cut = Some(number);
            break;
        }
        if before + 1 != number || row == 0 {
            table.lines.push((row, number));
        }
        before = number;
        let mut found = 0;
        for (cell, text) in line.split(head.separator).enumerate() {
            found += 1;
            for &target in targets.get(cell).map_or(&[][..], Vec::as_slice) {
                let value = parse(text.trim()).unwrap_or_else(|| {
                    if faults.len() < MAX_LISTED {
                        let (column, cell) = (head.columns[cell].clone(), text.trim().to_owned());
                        faults.push(LogFault::NotANumber { line: number, column, cell });
                    }
                    f64::NAN
                });
                table.columns[target].push(value);
            }
        }
        if found != head.columns.len() {
            if faults.len() < MAX_LISTED {
                let expected = head.columns.len();
                faults.push(LogFault::RowLength { line: number, expected, found });
            }
            table.columns.iter_mut().for_each(|column| column.resize(row + 1, f64::NAN));
        }
    }
    if faults.is_empty() { Ok(table) } else { Err(faults) }
}

/// A cell: a number, or nothing (empty, `nan`) as NaN. None if it is neither.
fn parse(cell: &str) -> Option<f64> {
    match cell {
        "" | "nan" | "NaN" | "NAN" => Some(f64::NAN),
        _ => cell.parse::<f64>().ok().filter(|value| value.is_finite()),
    }
}
