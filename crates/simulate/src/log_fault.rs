//! What can be wrong with a log, and how it is told.

use std::fmt;

/// What is wrong with a log, where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlacedLogFault {
    /// The name of the file, as it was given.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// The cell in that line, from 1; 1 where the whole line is meant.
    pub cell: usize,
    /// What is wrong.
    pub cause: LogFault,
}

/// What can be wrong with a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LogFault {
    /// The file is not UTF-8.
    NotUtf8,
    /// There is no line with the names of the columns.
    NoColumns,
    /// Two columns have this name.
    RepeatedColumn(String),
    /// There is no column `t`.
    NoTime,
    /// A column is missing that is needed; holds its name.
    NoColumn(String),
    /// There are no rows.
    NoRows,
    /// A row with more or fewer cells than there are columns: expected, found.
    RowLength(usize, usize),
    /// A cell that is no finite number; holds it.
    NotANumber(String),
    /// A cell is empty that must not be; holds the column.
    Empty(String),
    /// One force of a row is missing, where others are there; holds the column.
    EmptyForce(String),
    /// No digits of that many contacts; holds the cell.
    Modes(String, usize),
    /// A time that is missing, or not after the one before it.
    NotIncreasing,
    /// The header names another model: the log's, the one given.
    OtherModel(String, String),
    /// The header has the hash of another model: the log's, that of the model given, its name.
    OtherHash(String, String, String),
    /// The header's values of parameters are none; holds the entry.
    Parameter(String),
    /// The model has no such parameter.
    UnknownParameter(String),
}

impl LogFault {
    /// What helps.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::NotUtf8 => "save it as UTF-8",
            Self::NoColumns => "the first line without `#` names the columns: t,q_JOINT,..",
            Self::RepeatedColumn(_) => "rename one of them, or take it out",
            Self::NoTime => "name the column of the time `t`",
            Self::NoColumn(_) => "`denavit simulate SCENARIO -o LOG` writes all columns",
            Self::NoRows => "a row for each time follows the names of the columns",
            Self::RowLength(..) => "was the file cut, or has a number a comma in it?",
            Self::NotANumber(_) => "write a number as 0.25 or 1e-3, or nothing where it is unknown",
            Self::Empty(_) => "fill the cell, or take the row out",
            Self::EmptyForce(_) => "fill the cell, or empty all forces of the row",
            Self::Modes(..) => {
                "a decimal digit per contact, the first the lowest: 0 open, 1 sticks, 2 slips"
            }
            Self::NotIncreasing => "put the rows in the order of their times, each time once",
            Self::OtherModel(..) | Self::OtherHash(..) => {
                "name the model that the log was made with; without this line of its header the \
                 log is taken for one of any model"
            }
            Self::Parameter(_) => "write NAME=NUMBER, with ; between them",
            Self::UnknownParameter(_) => "name the model that the log was made with",
        }
    }
}

impl fmt::Display for LogFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotUtf8 => write!(f, "not UTF-8 text"),
            Self::NoColumns => write!(f, "no line with the names of columns"),
            Self::RepeatedColumn(name) => write!(f, "a second column `{name}`"),
            Self::NoTime => write!(f, "no column `t`, the time in seconds"),
            Self::NoColumn(name) => write!(f, "the log has no column `{name}`"),
            Self::NoRows => write!(f, "no rows"),
            Self::RowLength(expected, found) => {
                write!(f, "{found} cells, where there are {expected} columns")
            }
            Self::NotANumber(cell) => write!(f, "`{cell}` is not a finite number"),
            Self::Empty(column) => write!(f, "an empty cell in column `{column}`"),
            Self::EmptyForce(column) => {
                write!(f, "no force in column `{column}`, where the row has others")
            }
            Self::Modes(cell, contacts) => {
                write!(f, "`contact_modes` of {cell} are no digits of {contacts} contacts")
            }
            Self::NotIncreasing => write!(f, "the time is not after that of the row before"),
            Self::OtherModel(log, model) => {
                write!(f, "a log of another model: of `{log}`, where `{model}` was given")
            }
            Self::OtherHash(log, hash, model) => {
                write!(f, "a log of another model: its hash is {log}, that of `{model}` is {hash}")
            }
            Self::Parameter(entry) => write!(f, "`{entry}` is no value of a parameter"),
            Self::UnknownParameter(name) => write!(f, "the model has no parameter `{name}`"),
        }
    }
}

impl fmt::Display for PlacedLogFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}: {}", self.file, self.line, self.cell, self.cause)
    }
}

/// So many faults are told one by one.
const TOLD: usize = 10;

/// All that is wrong with a log: the first faults, and how many there are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LogFaults {
    told: Vec<PlacedLogFault>,
    count: usize,
}

impl LogFaults {
    /// Adds one.
    pub fn push(&mut self, fault: PlacedLogFault) {
        self.count += 1;
        if self.told.len() < TOLD {
            self.told.push(fault);
        }
    }

    /// The first ones, in the order of the file.
    pub fn told(&self) -> &[PlacedLogFault] {
        &self.told
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// A value, if nothing is wrong.
    pub fn or<T>(self, value: T) -> Result<T, Self> {
        if self.count == 0 { Ok(value) } else { Err(self) }
    }
}

impl From<PlacedLogFault> for LogFaults {
    fn from(fault: PlacedLogFault) -> Self {
        Self { told: vec![fault], count: 1 }
    }
}

impl fmt::Display for LogFaults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, fault) in self.told.iter().enumerate() {
            let end = if index == 0 { "" } else { "\n" };
            write!(f, "{end}{fault}\n  hint: {}", fault.cause.hint())?;
        }
        match self.count - self.told.len() {
            0 => Ok(()),
            1 => write!(f, "\nand 1 more fault"),
            more => write!(f, "\nand {more} more faults"),
        }
    }
}
