//! Which column of a foreign log is which of ours (`--columns MAP.json`).

use serde::Deserialize;
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

/// A mapping of columns: our name to its source, or to nothing if it is left out on purpose. A
/// column that is not mapped has our name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnMapping {
    sources: BTreeMap<String, Option<ColumnSource>>,
}

/// A mapping that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MappingError {
    /// The file, as it was given.
    pub file: String,
    /// Line and column, from 1.
    pub at: (usize, usize),
    /// What is wrong.
    pub cause: String,
}

impl fmt::Display for MappingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, at: (line, column), cause } = self;
        write!(
            f,
            "{file}:{line}:{column}: {cause}\n  hint: as {{\"q_knee\": {{\"column\": \"deg\", \
             \"scale\": 0.0174533, \"offset\": 0}}, \"t\": \"time\", \"tau_hip\": \
             null}}"
        )
    }
}

impl std::error::Error for MappingError {}

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
    pub fn from_json(file: &str, source: &[u8]) -> Result<Self, MappingError> {
        let error = |at, cause| MappingError { file: file.to_owned(), at, cause };
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
                Entry::Name(column) => ColumnSource { column, scale: 1.0, offset: 0.0 },
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

    /// The source of one of our columns; none if it is left out on purpose.
    pub fn source(&self, name: &str) -> Option<ColumnSource> {
        let own = || ColumnSource { column: name.to_owned(), scale: 1.0, offset: 0.0 };
        self.sources.get(name).cloned().unwrap_or_else(|| Some(own()))
    }

    /// The names that are mapped.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.sources.keys().map(String::as_str)
    }
}
