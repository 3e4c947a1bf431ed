//! A log as it stands in a file: with the place of all that is in it, for messages.

use super::error::Error;
use super::log::Log;
use super::log_fault::{LogFault, LogFaults, PlacedLogFault};

/// A log, and where its parts stand in its file.
#[derive(Clone, Debug, PartialEq)]
pub struct LogFile {
    /// The file's name, as it was given.
    pub file: String,
    /// What is in it.
    pub log: Log,
    /// The line of each entry of the header, from 1.
    header_lines: Vec<usize>,
    /// The line with the names of the columns.
    columns_line: usize,
    /// The line of each row.
    row_lines: Vec<usize>,
}

impl LogFile {
    /// A log as [`Log::to_csv`] writes it.
    pub fn of(file: &str, log: Log) -> Self {
        Self {
            file: file.to_owned(),
            header_lines: (1..=log.header.len()).collect(),
            columns_line: log.header.len() + 1,
            row_lines: (0..log.len()).map(|row| log.line_of_row(row)).collect(),
            log,
        }
    }

    /// Reads what [`Log::from_csv`] describes.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub fn from_csv(file: &str, source: &[u8]) -> Result<Self, Error> {
        let mut read = Self::of(file, Log::default());
        read.columns_line = 0;
        let text = std::str::from_utf8(source).map_err(|invalid| {
            let line = source[..invalid.valid_up_to()].iter().filter(|b| **b == b'\n').count();
            LogFaults::from(read.fault(line + 1, 1, LogFault::NotUtf8))
        })?;
        let (mut faults, mut has_rows) = (LogFaults::default(), false);
        for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
            let (number, line) = (index + 1, line.trim());
            if line.is_empty() {
                continue;
            }
            if let Some(said) = line.strip_prefix('#') {
                let (name, value) = said.split_once(':').unwrap_or((said, ""));
                read.log.header.push((name.trim().to_owned(), value.trim().to_owned()));
                read.header_lines.push(number);
            } else if read.log.columns.is_empty() {
                read.name_columns(number, line, &mut faults);
            } else {
                has_rows = true;
                read.push_row(number, line, &mut faults);
            }
        }
        let lines = text.lines().count().max(1);
        match (read.log.columns.is_empty(), has_rows) {
            (true, _) => faults.push(read.fault(lines, 1, LogFault::NoColumns)),
            (_, false) => faults.push(read.fault(lines, 1, LogFault::NoRows)),
            _ => {}
        }
        Ok(faults.or(read)?)
    }

    fn name_columns(&mut self, number: usize, line: &str, faults: &mut LogFaults) {
        self.columns_line = number;
        for (cell, name) in line.split(',').map(str::trim).enumerate() {
            if self.log.columns.iter().any(|known| known == name) {
                let cause = LogFault::RepeatedColumn(name.to_owned());
                faults.push(self.fault(number, cell + 1, cause));
            }
            self.log.columns.push(name.to_owned());
        }
        if self.time().is_none() {
            faults.push(self.fault(number, 1, LogFault::NoTime));
        }
    }

    fn time(&self) -> Option<usize> {
        self.log.columns.iter().position(|column| column == "t")
    }

    /// Adds a row if it has as many cells as there are columns.
    fn push_row(&mut self, number: usize, line: &str, faults: &mut LogFaults) {
        let (columns, first) = (self.log.columns.len(), self.log.values.len());
        for (cell, text) in line.split(',').map(str::trim).enumerate() {
            let value = match text.parse::<f64>() {
                _ if text.is_empty() => f64::NAN,
                Ok(value) if value.is_finite() => value,
                _ => {
                    let cause = LogFault::NotANumber(text.to_owned());
                    faults.push(self.fault(number, cell + 1, cause));
                    f64::NAN
                }
            };
            self.log.values.push(value);
        }
        let found = self.log.values.len() - first;
        if found != columns {
            faults.push(self.fault(number, 1, LogFault::RowLength(columns, found)));
            self.log.values.truncate(first);
            return;
        }
        self.row_lines.push(number);
        let Some(time) = self.time() else { return };
        let now = self.log.values[first + time];
        let before = first.checked_sub(columns).map(|row| self.log.values[row + time]);
        // what is no number has been told; an empty cell has not
        let is_told = line.split(',').nth(time).is_some_and(|cell| !cell.trim().is_empty());
        let is_late = before.is_none_or(|before| before.is_nan() || now > before);
        if (now.is_nan() && !is_told) || (now.is_finite() && !is_late) {
            faults.push(self.fault(number, time + 1, LogFault::NotIncreasing));
        }
    }

    fn fault(&self, line: usize, cell: usize, cause: LogFault) -> PlacedLogFault {
        PlacedLogFault { file: self.file.clone(), line, cell, cause }
    }

    /// A fault of a cell; row and column from 0.
    pub fn fault_of_cell(&self, row: usize, column: usize, cause: LogFault) -> PlacedLogFault {
        self.fault(self.row_lines.get(row).copied().unwrap_or(1), column + 1, cause)
    }

    /// A fault of the names of the columns.
    pub fn fault_of_columns(&self, cause: LogFault) -> PlacedLogFault {
        self.fault(self.columns_line, 1, cause)
    }

    /// A fault of the header's line of this name.
    pub fn fault_of_header(&self, name: &str, cause: LogFault) -> PlacedLogFault {
        let place = self.log.header.iter().position(|(known, _)| known == name);
        let line = place.and_then(|place| self.header_lines.get(place).copied());
        self.fault(line.unwrap_or(1), 1, cause)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_have_their_place() {
        let fault = |text: &str| {
            let error = Log::from_csv("a.csv", text.as_bytes()).unwrap_err();
            let faults = error.log_faults().expect("faults of the log");
            assert_eq!(faults.count(), 1, "{faults}");
            let error = faults.told()[0].clone();
            (error.line, error.cell, error.cause)
        };
        assert_eq!(fault(""), (1, 1, LogFault::NoColumns));
        assert_eq!(fault("# a: b\nt,q\n"), (2, 1, LogFault::NoRows));
        assert_eq!(fault("q,p\n1,2\n"), (1, 1, LogFault::NoTime));
        assert_eq!(fault("t,q,q\n0,1,2\n"), (1, 3, LogFault::RepeatedColumn("q".to_owned())));
        assert_eq!(fault("t,q\n0,1\n1\n"), (3, 1, LogFault::RowLength(2, 1)));
        assert_eq!(fault("t,q\n0,nan\n"), (2, 2, LogFault::NotANumber("nan".to_owned())));
        assert_eq!(fault("t,q\nx,1\n"), (2, 1, LogFault::NotANumber("x".to_owned())));
        assert_eq!(fault("t,q\n0,1\n0,2\n"), (3, 1, LogFault::NotIncreasing));
        assert_eq!(fault("t,q\n,1\n"), (2, 1, LogFault::NotIncreasing));
        let error = Log::from_csv("a.csv", b"t,q\n0,\xff\n").unwrap_err();
        let wide = error.log_faults().expect("faults of the log");
        assert_eq!((wide.told()[0].line, &wide.told()[0].cause), (2, &LogFault::NotUtf8));
    }

    /// Lines are those of the file, empty ones and later lines of the header counted.
    #[test]
    fn all_faults_are_told_at_once() {
        let text = "t,q\n0,1\n\n1\n# note: x\n2,y\n1,3\n";
        let error = Log::from_csv("a.csv", text.as_bytes()).unwrap_err();
        let faults = error.log_faults().expect("faults of the log");
        let places: Vec<_> = faults.told().iter().map(|one| (one.line, one.cell)).collect();
        assert_eq!(places, [(4, 1), (6, 2), (7, 1)]);
        let many = "t,q\n".to_owned() + &"1\n".repeat(25);
        let error = Log::from_csv("a.csv", many.as_bytes()).unwrap_err();
        let faults = error.log_faults().expect("faults of the log");
        assert_eq!((faults.told().len(), faults.count()), (10, 25));
        assert!(faults.to_string().ends_with("and 15 more faults"), "{faults}");
        assert_eq!(faults.to_string().matches("hint: ").count(), 10);
    }
}
