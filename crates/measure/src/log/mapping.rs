//! Which column of a foreign log is which of ours.

use super::mapping_fault::MappingCause;
use crate::error::{Error, ErrorKind};
use denavit_codegen::model::json::Value;
use denavit_codegen::model::{Node, Report, read_document};
use std::collections::BTreeMap;

/// Where one of our columns stands in a log, and how its numbers become ours:
/// scale * value + offset.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnSource {
    /// The name in the log.
    pub column: String,
    /// From the log's unit to ours.
    pub scale: f64,
    /// Added after that, in our unit.
    pub offset: f64,
}

impl ColumnSource {
    /// A column of this name, in our unit.
    pub fn of(column: &str) -> Self {
        Self { column: column.to_owned(), scale: 1.0, offset: 0.0 }
    }
}

/// A mapping of columns: our name to its source, or to nothing if it is left out on purpose. A
/// column that is not mapped has our name. A name with `{joint}`, `{contact}` or `{link}` in it is
/// meant for each of them, and so is the same in its source; a name that is given itself counts
/// before.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnMapping {
    sources: BTreeMap<String, Option<ColumnSource>>,
}

/// What a mapping says of one of our columns.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Mapped {
    /// Nothing.
    Not,
    /// It is left out on purpose.
    LeftOut,
    /// Where it stands, by its own name.
    ByName(ColumnSource),
    /// Where it stands, by a name with `{joint}`, `{contact}` or `{link}` in it.
    ByPattern(ColumnSource),
}

/// What stands for a joint, a contact or a link in names and sources.
const SUBJECTS: [&str; 3] = ["{joint}", "{contact}", "{link}"];

impl ColumnMapping {
    /// Reads a mapping from JSON. `file` is its name, for messages alone.
    ///
    /// # Errors
    ///
    /// All that is wrong with the file, each with its place.
    pub fn from_json(file: &str, source: &[u8]) -> Result<Self, Error> {
        let read = read_document(file, source, |root, report| {
            let entries = root.members(report)?.all();
            let sources = entries.map(|(name, node)| (name.to_owned(), entry(name, node, report)));
            Some(Self { sources: sources.collect() })
        });
        read.map_err(|faults| Error::new(ErrorKind::Mapping, faults.to_string()))
    }

    /// Adds or replaces the source of a column.
    pub fn insert(&mut self, name: &str, source: ColumnSource) {
        self.sources.insert(name.to_owned(), Some(source));
    }

    /// What is said of one of our columns, whose name for whatever joint, contact or link is
    /// `pattern`.
    pub(super) fn source_of(&self, name: &str, pattern: &str, subject: &str) -> Mapped {
        if let Some(source) = self.sources.get(name) {
            return source.clone().map_or(Mapped::LeftOut, Mapped::ByName);
        }
        let with_subject = |source: &ColumnSource| {
            let put = |text: String, stand_in: &&str| text.replace(*stand_in, subject);
            let column = SUBJECTS.iter().fold(source.column.clone(), put);
            Mapped::ByPattern(ColumnSource { column, ..source.clone() })
        };
        match self.sources.get(pattern) {
            None => Mapped::Not,
            Some(source) => source.as_ref().map_or(Mapped::LeftOut, with_subject),
        }
    }

    /// The beginnings, up to `{joint}`, `{contact}` or `{link}`, of the names of sources.
    pub fn beginnings(&self) -> Vec<String> {
        let beginning = |source: &ColumnSource| {
            let end = source.column.find('{').unwrap_or(source.column.len());
            source.column[..end].to_owned()
        };
        self.sources.values().flatten().map(beginning).collect()
    }

    /// The source of one of our columns; none if it is left out on purpose.
    pub fn source(&self, name: &str) -> Option<ColumnSource> {
        self.sources.get(name).cloned().unwrap_or_else(|| Some(ColumnSource::of(name)))
    }

    /// The names that are mapped.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.sources.keys().map(String::as_str)
    }
}

/// What an entry says of one of our columns; nothing if it is left out, or wrong.
fn entry(name: &str, node: Node<'_>, report: &mut Report<MappingCause>) -> Option<ColumnSource> {
    match &node.0.value {
        Value::Null => None,
        Value::Text(column) => {
            if column.is_empty() {
                report.push(node.at(), MappingCause::NoName);
            }
            Some(ColumnSource::of(column))
        }
        Value::Object(_) => {
            let fields = node.fields(&["column", "scale", "offset"], report)?;
            let column = fields.text("column", report).unwrap_or(name);
            let mut number = |key: &str, without: f64| {
                let given = fields.get(key).and_then(|node| {
                    let finite = |text: &str| text.parse().ok().filter(|n: &f64| n.is_finite());
                    node.number(finite, report)
                });
                given.unwrap_or(without)
            };
            let (scale, offset) = (number("scale", 1.0), number("offset", 0.0));
            if !scale.is_normal() {
                report.push(fields.place("scale"), MappingCause::NoScale);
            }
            if column.is_empty() {
                report.push(fields.place("column"), MappingCause::NoName);
            }
            Some(ColumnSource { column: column.to_owned(), scale, offset })
        }
        other => {
            report.push(node.at(), MappingCause::NoEntry(other.kind()));
            None
        }
    }
}
