//! Logs: a table in time, with what it was made of in its header.

use super::error::Error;
use super::log_file::LogFile;
use std::borrow::Cow;
use std::fmt::Write;

/// A table of numbers with named columns, `t` first; the columns are those of the project's logs:
/// `t`, `q_JOINT`, `qd_JOINT`, `ref_JOINT`, `tau_JOINT`, `tau_cmd_JOINT`, `motor_JOINT`,
/// `f_CONTACT_x|y|z`, `w_LINK_fx|fy|fz|mx|my|mz`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Log {
    /// Name and value of each line of the header.
    pub header: Vec<(String, String)>,
    /// The columns.
    pub columns: Vec<String>,
    /// Row after row.
    pub values: Vec<f64>,
}

impl Log {
    /// Reads CSV: lines `# name: value`, the names of the columns, rows of numbers; empty cells are
    /// undefined (NaN), and empty lines are nothing. `file` is its name, for messages alone.
    pub fn from_csv(file: &str, source: &[u8]) -> Result<Self, Error> {
        LogFile::from_csv(file, source).map(|read| read.log)
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
}
