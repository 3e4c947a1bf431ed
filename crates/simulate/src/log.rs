//! Logs: a table in time, with what it was made of in its header.

use std::borrow::Cow;
use std::fmt::{self, Write};

/// A table of numbers with named columns, `t` first; the columns are those of the project's logs:
/// `t`, `q_JOINT`, `qd_JOINT`, `ref_JOINT`, `tau_JOINT`, `tau_cmd_JOINT`, `motor_JOINT`,
/// `f_CONTACT_x|y|z`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Log {
    /// Name and value of each line of the header.
    pub header: Vec<(String, String)>,
    /// The columns.
    pub columns: Vec<String>,
    /// Row after row.
    pub values: Vec<f64>,
}

/// What is wrong with a log, where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogError {
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
    /// There are no rows.
    NoRows,
    /// A row with more or fewer cells than there are columns: expected, found.
    RowLength(usize, usize),
    /// A cell that is no finite number; holds it.
    NotANumber(String),
    /// A time that is missing, or not after the one before it.
    NotIncreasing,
}

impl fmt::Display for LogError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}: ", self.file, self.line, self.cell)?;
        match &self.cause {
            LogFault::NotUtf8 => write!(f, "not UTF-8 text"),
            LogFault::NoColumns => write!(f, "no line with the names of columns"),
            LogFault::RepeatedColumn(name) => write!(f, "a second column `{name}`"),
            LogFault::NoTime => write!(f, "no column `t`, the time in seconds"),
            LogFault::NoRows => write!(f, "no rows"),
            LogFault::RowLength(expected, found) => {
                write!(f, "{found} cells, where there are {expected} columns")
            }
            LogFault::NotANumber(cell) => write!(f, "`{cell}` is not a finite number"),
            LogFault::NotIncreasing => write!(f, "the time is not after that of the row before"),
        }
    }
}

impl std::error::Error for LogError {}

impl Log {
    /// Reads CSV: lines `# name: value`, the names of the columns, rows of numbers; empty cells are
    /// undefined (NaN), and empty lines are nothing. `file` is its name, for messages alone.
    pub fn from_csv(file: &str, source: &[u8]) -> Result<Self, LogError> {
        let error = |line, cell, cause| LogError { file: file.to_owned(), line, cell, cause };
        let text = std::str::from_utf8(source).map_err(|invalid| {
            let line = source[..invalid.valid_up_to()].iter().filter(|b| **b == b'\n').count();
            error(line + 1, 1, LogFault::NotUtf8)
        })?;
        let mut log = Self::default();
        let mut time = None;
        for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
            let (number, line) = (index + 1, line.trim());
            if line.is_empty() {
                continue;
            }
            if let Some(said) = line.strip_prefix('#') {
                let (name, value) = said.split_once(':').unwrap_or((said, ""));
                log.header.push((name.trim().to_owned(), value.trim().to_owned()));
            } else if log.columns.is_empty() {
                for (cell, name) in line.split(',').map(str::trim).enumerate() {
                    if log.columns.iter().any(|known| known == name) {
                        let cause = LogFault::RepeatedColumn(name.to_owned());
                        return Err(error(number, cell + 1, cause));
                    }
                    log.columns.push(name.to_owned());
                }
                time = log.columns.iter().position(|column| column == "t");
                if time.is_none() {
                    return Err(error(number, 1, LogFault::NoTime));
                }
            } else {
                log.push_row(line, time.unwrap_or(0))
                    .map_err(|(cell, cause)| error(number, cell, cause))?;
            }
        }
        let lines = text.lines().count().max(1);
        match (log.columns.is_empty(), log.values.is_empty()) {
            (true, _) => Err(error(lines, 1, LogFault::NoColumns)),
            (_, true) => Err(error(lines, 1, LogFault::NoRows)),
            _ => Ok(log),
        }
    }

    fn push_row(&mut self, line: &str, time: usize) -> Result<(), (usize, LogFault)> {
        let (columns, first) = (self.columns.len(), self.values.len());
        for (cell, text) in line.split(',').map(str::trim).enumerate() {
            let value = match text {
                "" => f64::NAN,
                text => match text.parse::<f64>() {
                    Ok(value) if value.is_finite() => value,
                    _ => return Err((cell + 1, LogFault::NotANumber(text.to_owned()))),
                },
            };
            self.values.push(value);
        }
        let found = self.values.len() - first;
        if found != columns {
            return Err((1, LogFault::RowLength(columns, found)));
        }
        let now = self.values[first + time];
        let before = first.checked_sub(columns).map(|row| self.values[row + time]);
        // Written so that an empty cell fails as well.
        let increases = before.map_or(now.is_finite(), |before| now > before);
        if increases { Ok(()) } else { Err((time + 1, LogFault::NotIncreasing)) }
    }

    /// The line on which row number `row` stands in a file without empty lines, from 1.
    pub fn line_of_row(&self, row: usize) -> usize {
        self.header.len() + row + 2
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.values.len().checked_div(self.columns.len()).unwrap_or(0)
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The rows.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.columns.len().max(1))
    }

    /// The entries of a column; none if there is no such column.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let index = self.columns.iter().position(|column| column == name)?;
        Some(self.rows().map(|row| row[index]).collect())
    }

    /// CSV: lines `# name: value`, the names of the columns, the rows. Numbers are written so that
    /// reading them gives the same bits; what is undefined (the zero moment point in flight) is
    /// empty.
    pub fn to_csv(&self) -> String {
        let mut text = String::new();
        for (name, value) in &self.header {
            let [name, value] = [name, value].map(|said| on_one_line(said));
            // writing to a string cannot fail
            let _ = writeln!(text, "# {name}: {value}");
        }
        text.push_str(&self.columns.join(","));
        text.push('\n');
        for row in self.rows() {
            for (index, value) in row.iter().enumerate() {
                if index > 0 {
                    text.push(',');
                }
                if value.is_finite() {
                    let _ = write!(text, "{value}");
                }
            }
            text.push('\n');
        }
        text
    }
}

/// What is said in a line of the header: control characters, ends of lines among them, are written
/// as `\u000a`, so that no text makes a line of its own.
fn on_one_line(said: &str) -> Cow<'_, str> {
    // some readers end lines at these too
    let is_broken = |c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}');
    if !said.contains(is_broken) {
        return Cow::Borrowed(said);
    }
    let mut line = String::new();
    for c in said.chars() {
        match is_broken(c) {
            true => {
                let _ = write!(line, "\\u{:04x}", u32::from(c));
            }
            false => line.push(c),
        }
    }
    Cow::Owned(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again_bit_for_bit() {
        let log = Log {
            header: vec![("seed".to_owned(), "7".to_owned())],
            columns: ["t", "q_knee"].map(str::to_owned).to_vec(),
            values: vec![0.0, 0.1, 1e-3, -1.0 / 3.0],
        };
        assert_eq!(Log::from_csv("a.csv", log.to_csv().as_bytes()), Ok(log));
    }

    #[test]
    fn no_text_makes_a_line_of_the_header() {
        let said = "a\n# torque_side: motor\r\u{2028}\u{1b}[2J";
        let log = Log {
            header: vec![("scenario".to_owned(), said.to_owned())],
            columns: vec!["t".to_owned()],
            values: vec![0.0],
        };
        let text = log.to_csv();
        let escaped = r"a\u000a# torque_side: motor\u000d\u2028\u001b[2J";
        assert_eq!(text, format!("# scenario: {escaped}\nt\n0\n"));
        let read = Log::from_csv("a.csv", text.as_bytes()).expect("a log");
        assert_eq!(read.header, [("scenario".to_owned(), escaped.to_owned())]);
    }

    #[test]
    fn faults_have_their_place() {
        let fault = |text: &str| {
            let error = Log::from_csv("a.csv", text.as_bytes()).unwrap_err();
            (error.line, error.cell, error.cause)
        };
        assert_eq!(fault(""), (1, 1, LogFault::NoColumns));
        assert_eq!(fault("# a: b\nt,q\n"), (2, 1, LogFault::NoRows));
        assert_eq!(fault("q,p\n1,2\n"), (1, 1, LogFault::NoTime));
        assert_eq!(fault("t,q,q\n"), (1, 3, LogFault::RepeatedColumn("q".to_owned())));
        assert_eq!(fault("t,q\n0,1\n1\n"), (3, 1, LogFault::RowLength(2, 1)));
        assert_eq!(fault("t,q\n0,nan\n"), (2, 2, LogFault::NotANumber("nan".to_owned())));
        assert_eq!(fault("t,q\n0,1\n0,2\n"), (3, 1, LogFault::NotIncreasing));
        assert_eq!(fault("t,q\n,1\n"), (2, 1, LogFault::NotIncreasing));
        let wide = Log::from_csv("a.csv", b"t,q\n0,\xff\n").unwrap_err();
        assert_eq!((wide.line, wide.cause), (2, LogFault::NotUtf8));
    }
}
