//! Which column of a foreign log is which of ours.

use crate::error::{Error, ErrorKind};
use denavit_codegen::model::json::Value;
use denavit_codegen::model::{self, Explained, Node, Report, read_document};
use std::collections::BTreeMap;
use std::fmt;

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

/// What is wrong at a place of a mapping.
#[derive(Clone, Debug, PartialEq)]
enum MappingCause {
    /// A fault of form: of JSON, of keys, of kinds of values.
    Form(model::Cause),
    /// An entry of another kind; holds what it is.
    NoEntry(&'static str),
    /// A scale of 0, or about that.
    NoScale,
    /// A name without letters.
    NoName,
}

impl From<model::Cause> for MappingCause {
    fn from(cause: model::Cause) -> Self {
        Self::Form(cause)
    }
}

impl fmt::Display for MappingCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Form(cause) => write!(f, "{cause}"),
            Self::NoEntry(found) => {
                write!(f, "an entry is the name of a column, an object, or null; found {found}")
            }
            Self::NoScale => write!(f, "a scale of 0 makes every number of the column the same"),
            Self::NoName => write!(f, "the name of the column is empty"),
        }
    }
}

impl Explained for MappingCause {
    fn hint(&self) -> Option<String> {
        let example = "as {\"q_knee\": {\"column\": \"deg\", \"scale\": 0.0174533, \
                       \"offset\": 0}, \"t\": \"time\", \"tau_hip\": null, \"q_{joint}\": \
                       \"/joint_states/{joint}/position\"}";
        match self {
            Self::Form(cause) => cause.hint(),
            Self::NoEntry(_) => Some(example.to_owned()),
            Self::NoScale => None,
            Self::NoName => Some("null leaves a column out".to_owned()),
        }
    }
}
