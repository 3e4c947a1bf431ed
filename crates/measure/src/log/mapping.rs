//! Which column of a foreign log is which of ours.

use crate::error::{Cause, Error};
use serde::Deserialize;
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

#[derive(Deserialize)]
#[serde(untagged)]
enum Entry {
    Name(String),
    Full(Full),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Full {
    column: Option<String>,
    scale: Option<f64>,
    offset: Option<f64>,
}

impl ColumnMapping {
    /// Reads a mapping from JSON. `file` is its name, for messages alone.
    pub fn from_json(file: &str, source: &[u8]) -> Result<Self, Error> {
        let error = |at, cause| Error::from(Cause::Mapping { file: file.to_owned(), at, cause });
        let raw: BTreeMap<String, Option<Entry>> =
            serde_json::from_slice(source).map_err(|problem| {
                let text = problem.to_string();
                let cause = text.find(" at line").map_or(text.as_str(), |end| &text[..end]);
                let cause = match problem.classify() {
                    serde_json::error::Category::Data => {
                        format!("an entry is the name of a column, an object, or null: {cause}")
                    }
                    _ => format!("no JSON: {cause}"),
                };
                error((problem.line(), problem.column()), cause)
            })?;
        let mut sources = BTreeMap::new();
        for (name, entry) in raw {
            let Some(entry) = entry else {
                sources.insert(name, None);
                continue;
            };
            let source = match entry {
                Entry::Name(column) => ColumnSource::of(&column),
                Entry::Full(Full { column, scale, offset }) => ColumnSource {
                    column: column.unwrap_or_else(|| name.clone()),
                    scale: scale.unwrap_or(1.0),
                    offset: offset.unwrap_or(0.0),
                },
            };
            if source.scale == 0.0 || !source.scale.is_finite() || !source.offset.is_finite() {
                let cause = format!("`{name}`: the scale must be a finite number other than 0");
                return Err(error((1, 1), cause));
            }
            sources.insert(name, Some(source));
        }
        Ok(Self { sources })
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
