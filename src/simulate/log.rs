//! Logs: a table in time, with what it was made of in its header.

use std::fmt::Write;

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

impl Log {
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
