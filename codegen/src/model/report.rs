//! Collects faults while a file is read and checked, and turns byte offsets into places.

use super::fault::{Cause, Fault, FileError, MAX_FAULTS};
use super::json::{Json, Value};

/// More faults than this are counted, not kept: the first [`MAX_FAULTS`] of the file are shown, and
/// a file with this many is no model.
const MAX_KEPT: usize = 10_000;

/// The faults found so far.
#[derive(Debug)]
pub struct Report<C = Cause> {
    faults: Vec<(usize, C)>,
    omitted: usize,
}

impl<C> Default for Report<C> {
    fn default() -> Self {
        Self { faults: Vec::new(), omitted: 0 }
    }
}

impl<C> Report<C> {
    /// Notes a fault of the value that begins at byte `at`.
    pub fn push(&mut self, at: usize, cause: C) {
        if self.faults.len() < MAX_KEPT {
            self.faults.push((at, cause));
        } else {
            self.omitted += 1;
        }
    }

    /// How many faults are kept.
    pub fn count(&self) -> usize {
        self.faults.len()
    }

    /// Forgets the faults noted after there were `count`.
    pub fn truncate(&mut self, count: usize) {
        self.faults.truncate(count);
    }

    /// Whether nothing was noted.
    pub fn is_empty(&self) -> bool {
        self.faults.is_empty()
    }

    /// Whether a search for a nearest name is still worth its time.
    pub fn wants_hints(&self) -> bool {
        self.faults.len() < MAX_FAULTS
    }

    /// The answer: faults by place, each with pointer, line and column.
    pub fn into_error(mut self, file: &str, source: &[u8], root: Option<&Json>) -> FileError<C> {
        // stable: faults of one value stay in the order in which they were found
        self.faults.sort_by_key(|&(at, _)| at);
        let omitted = self.omitted + self.faults.len().saturating_sub(MAX_FAULTS);
        self.faults.truncate(MAX_FAULTS);
        let mut place = Place { line: 1, column: 1, at: 0 };
        let faults = self
            .faults
            .into_iter()
            .map(|(at, cause)| {
                place.advance(source, at);
                let pointer = root.map(|root| pointer(root, at)).unwrap_or_default();
                Fault { pointer, line: place.line, column: place.column, cause }
            })
            .collect();
        FileError { file: file.to_owned(), faults, omitted }
    }
}

/// A place in the text that moves forward.
struct Place {
    line: usize,
    column: usize,
    at: usize,
}

impl Place {
    fn advance(&mut self, source: &[u8], to: usize) {
        let to = to.min(source.len());
        for &byte in &source[self.at..to] {
            if byte == b'\n' {
                self.line += 1;
                self.column = 1;
            } else if byte & 0xc0 != 0x80 {
                // the bytes after the first of a UTF-8 character are no columns
                self.column += 1;
            }
        }
        self.at = to;
    }
}

/// JSON pointer (RFC 6901) of the innermost value that contains byte `at`.
fn pointer(root: &Json, at: usize) -> String {
    let mut pointer = String::new();
    let mut value = root;
    loop {
        let inside = |child: &Json| child.start <= at && at < child.end;
        match &value.value {
            Value::List(items) => {
                let index = items.partition_point(|item| item.end <= at);
                match items.get(index).filter(|item| inside(item)) {
                    Some(item) => {
                        pointer.push_str(&format!("/{index}"));
                        value = item;
                    }
                    None => return pointer,
                }
            }
            Value::Object(entries) => {
                let index = entries.partition_point(|(_, entry)| entry.end <= at);
                match entries.get(index).filter(|(_, entry)| inside(entry)) {
                    Some((key, entry)) => {
                        let key: String = key.chars().take(64).collect();
                        pointer.push('/');
                        pointer.push_str(&key.replace('~', "~0").replace('/', "~1"));
                        value = entry;
                    }
                    None => return pointer,
                }
            }
            _ => return pointer,
        }
    }
}
