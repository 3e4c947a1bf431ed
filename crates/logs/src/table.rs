//! Columns of numbers, with the place of each row in its file.

use super::remark::FileRemark;
use std::fmt;

/// Where something stands in a file, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of text.
    Line(usize),
    /// A message, of all messages of the file.
    Message(usize),
    /// A row of a table without lines.
    Row(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(number) => write!(f, "line {number}"),
            Self::Message(number) => write!(f, "message {number}"),
            Self::Row(number) => write!(f, "row {number}"),
        }
    }
}

/// Columns of a log; what is undefined is NaN.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The columns, in the order in which they were asked for.
    pub columns: Vec<Vec<f64>>,
    /// What was done to get them.
    pub remarks: Vec<FileRemark>,
    pub(crate) places: Places,
}

/// The places of rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) enum Places {
    /// The line of the first row of each run of rows without other lines between, with its row.
    Lines(Vec<(usize, usize)>),
    /// The message of each row.
    #[cfg_attr(not(feature = "mcap"), allow(dead_code))] // only messages have them
    Messages(Vec<usize>),
    /// Rows are counted.
    #[default]
    Rows,
}

impl Table {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// Where a row stands in its file.
    pub fn place(&self, row: usize) -> Place {
        match &self.places {
            Places::Lines(runs) => {
                let last = runs.partition_point(|&(first, _)| first <= row);
                let run = runs.get(last.saturating_sub(1));
                Place::Line(run.map_or(row, |&(first, line)| line + row - first))
            }
            Places::Messages(numbers) => {
                Place::Message(numbers.get(row).copied().unwrap_or(row + 1))
            }
            Places::Rows => Place::Row(row + 1),
        }
    }
}
