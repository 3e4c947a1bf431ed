//! What is wrong with the file of a log.

use super::csv::LONGEST_LINE;
use super::table::Place;
use std::fmt;
use std::io::{self, ErrorKind};

/// What keeps a file from being read.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // the fields are what the messages name
pub enum FileFault {
    /// The file cannot be read.
    Unreadable(String),
    /// A line is not UTF-8 text.
    NotUtf8 { line: usize },
    /// A line is longer than any log's.
    LongLine { line: usize },
    /// There is no line with the names of the columns.
    NoColumns,
    /// Two columns have one name.
    RepeatedColumn { column: String },
    /// A row with another number of cells than there are columns.
    RowLength { line: usize, expected: usize, found: usize },
    /// A column in memory with another number of rows than the first.
    ColumnLength { column: String, rows: usize, other: String, expected: usize },
    /// A cell that is no number.
    NotANumber { line: usize, column: String, cell: String },
    /// A format that this build does not read; its name and that of the feature that reads it.
    NoFeature { format: &'static str, feature: &'static str },
    /// A format that is read as a whole alone.
    NotInBatches,
    /// A format that is not read; what to do.
    OtherFormat { format: &'static str, hint: &'static str },
    /// The file is cut or corrupt; where, how much before is whole, and what is wrong.
    Damaged { at: Place, whole: usize, cause: String },
    /// There are no messages that have columns; topics with what they are.
    NoMessages { topics: Vec<(String, String)> },
    /// What is wrong with a folder of a bag, and what to do.
    Bag { cause: String, hint: &'static str },
    /// A file names one outside its folder.
    Outside { file: String },
    /// A column of a table has no numbers.
    NoNumbers { column: String, kind: String },
    /// Two messages of a topic have one time, and differ.
    Repeated { topic: String, at: Place },
    /// A topic pauses for longer than can be interpolated \[s\].
    Pause { topic: String, longest_s: f64, at: Place },
    /// Topics have hardly any time in common.
    Apart { topics: Vec<String>, rows: usize },
}

/// What the system says of a file.
pub(crate) fn of_io(error: &io::Error) -> FileFault {
    FileFault::Unreadable(match error.kind() {
        ErrorKind::IsADirectory => "it is a directory".to_owned(),
        _ => error.to_string(),
    })
}

impl FileFault {
    /// Where it is, if it is at one place.
    pub fn place(&self) -> Option<Place> {
        match *self {
            Self::NotUtf8 { line }
            | Self::LongLine { line }
            | Self::RowLength { line, .. }
            | Self::NotANumber { line, .. } => Some(Place::Line(line)),
            Self::Damaged { at, .. } | Self::Repeated { at, .. } | Self::Pause { at, .. } => {
                Some(at)
            }
            _ => None,
        }
    }
}

const NO_COLUMNS: &str = "no line with the names of columns\n  hint: a log begins with one, as \
                          `t,q_knee,tau_knee`";

fn not_a_number(f: &mut fmt::Formatter<'_>, column: &str, cell: &str) -> fmt::Result {
    write!(f, "`{cell}` in column `{column}` is not a number")?;
    match cell.replace(',', ".").parse::<f64>() {
        Ok(_) => write!(f, "\n  hint: numbers have a decimal point, and no comma"),
        Err(_) => Ok(()),
    }
}

fn damaged(f: &mut fmt::Formatter<'_>, at: Place, whole: usize, cause: &str) -> fmt::Result {
    let what = match at {
        Place::Message(_) => "messages",
        _ => "rows",
    };
    write!(f, "{cause}")?;
    match whole {
        0 => write!(f, "\n  hint: no {what} are whole"),
        _ => {
            write!(f, "\n  hint: {whole} {what} before are whole: `logs.accepts_cut` reads them")
        }
    }
}

/// Topics that are listed; a list of all is no message.
const LISTED: usize = 8;

fn no_messages(f: &mut fmt::Formatter<'_>, topics: &[(String, String)]) -> fmt::Result {
    if topics.is_empty() {
        return write!(f, "no messages\n  hint: was anything recorded?");
    }
    write!(f, "no messages that can be read as columns; there are:")?;
    for (topic, what) in topics.iter().take(LISTED) {
        write!(f, "\n    {topic} ({what})")?;
    }
    if topics.len() > LISTED {
        write!(f, "\n    and {} more", topics.len() - LISTED)?;
    }
    write!(f, "\n  hint: sensor_msgs/msg/JointState in CDR is what ROS 2 records of joints")
}

impl fmt::Display for FileFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(reason) => write!(f, "cannot be read: {reason}"),
            Self::NotUtf8 { .. } => write!(f, "not UTF-8 text"),
            Self::LongLine { .. } => write!(f, "more than {LONGEST_LINE} bytes: is it CSV?"),
            Self::NoColumns => write!(f, "{NO_COLUMNS}"),
            Self::RepeatedColumn { column } => write!(f, "two columns `{column}`"),
            Self::RowLength { expected, found, .. } => {
                write!(f, "{found} cells, where there are {expected} columns")
            }
            Self::ColumnLength { column, rows, other, expected } => {
                write!(f, "column `{column}` has {rows} rows, and `{other}` has {expected}")
            }
            Self::NotANumber { column, cell, .. } => not_a_number(f, column, cell),
            Self::NoFeature { format, feature } => write!(
                f,
                "is {format}, which this build does not read\n  hint: `cargo install --locked \
                 --path . --features {feature}` in the sources of denavit builds one that does"
            ),
            Self::NotInBatches => write!(
                f,
                "messages are read as a whole, and not piece by piece\n  hint: write them as a \
                 table, in CSV or Parquet"
            ),
            Self::OtherFormat { format, hint } => {
                write!(f, "is {format}, which is not read\n  hint: {hint}")
            }
            Self::Damaged { at, whole, cause } => damaged(f, *at, *whole, cause),
            Self::NoMessages { topics } => no_messages(f, topics),
            Self::Bag { cause, hint } => write!(f, "{cause}\n  hint: {hint}"),
            Self::Outside { file } => write!(
                f,
                "metadata.yaml names `{file}`, which is not in its folder\n  hint: a bag's files \
                 stand beside its metadata.yaml"
            ),
            Self::NoNumbers { column, kind } => {
                write!(f, "column `{column}` holds {kind}, no numbers")
            }
            Self::Repeated { topic, .. } => {
                write!(f, "`{topic}` has the time of an earlier message, with other numbers")
            }
            Self::Pause { topic, longest_s, .. } => write!(
                f,
                "`{topic}` pauses for {longest_s:.3} s: more than can be interpolated\n  hint: cut \
                 the log there, or leave its columns out: null in `logs.columns`"
            ),
            Self::Apart { topics, rows } => write!(
                f,
                "{} have {rows} rows in common\n  hint: were they recorded at the same time, with \
                 one clock?",
                topics.iter().map(|topic| format!("`{topic}`")).collect::<Vec<_>>().join(", ")
            ),
        }
    }
}
