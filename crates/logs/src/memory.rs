//! Logs in memory: columns of numbers that a program has, and no file.

use super::error::Error;
use super::fault::FileFault;
use super::source::{Column, Log, Rows};
use super::table::{Places, Table};
use std::fmt;

/// Columns of numbers by their names; what is undefined is NaN.
#[derive(Clone, Default, PartialEq)]
pub struct MemoryLog {
    /// Name and value of what the log says of itself.
    pub header: Vec<(String, String)>,
    /// Name and values of each column.
    pub columns: Vec<(String, Vec<f64>)>,
}

/// Numbers are too many to be shown.
impl fmt::Debug for MemoryLog {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = |(name, values): &(String, Vec<f64>)| (name.clone(), values.len());
        f.debug_map().entries(self.columns.iter().map(rows)).finish()
    }
}

impl MemoryLog {
    /// Opens it, as often as it is wanted: its numbers are read as they are.
    ///
    /// # Errors
    /// There are no columns, two of one name, or columns of different lengths.
    pub fn open(&self) -> Result<Log<'_>, Error> {
        let Some((first, of_first)) = self.columns.first() else {
            return Err(vec![FileFault::NoColumns].into());
        };
        let mut faults = Vec::new();
        for (at, (name, values)) in self.columns.iter().enumerate() {
            if self.columns[..at].iter().any(|(before, _)| before == name) {
                faults.push(FileFault::RepeatedColumn { column: name.clone() });
            }
            let (rows, expected) = (values.len(), of_first.len());
            if rows != expected {
                let (column, other) = (name.clone(), first.clone());
                faults.push(FileFault::ColumnLength { column, rows, other, expected });
            }
        }
        if !faults.is_empty() {
            return Err(faults.into());
        }
        let named = |(name, _): &(String, Vec<f64>)| Column { name: name.clone(), known: None };
        let columns = self.columns.iter().map(named).collect();
        Ok(Log { header: self.header.clone(), columns, rows: Box::new(Held(&self.columns)) })
    }
}

struct Held<'a>(&'a [(String, Vec<f64>)]);

impl Rows for Held<'_> {
    fn read(self: Box<Self>, places: &[usize], _: &[usize]) -> Result<Table, Vec<FileFault>> {
        let columns = places.iter().map(|&place| self.0[place].1.clone()).collect();
        Ok(Table { columns, places: Places::Rows, ..Table::default() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Found, Place};

    fn log(columns: &[(&str, &[f64])]) -> MemoryLog {
        let own = |(name, values): &(&str, &[f64])| ((*name).to_owned(), values.to_vec());
        MemoryLog { columns: columns.iter().map(own).collect(), ..MemoryLog::default() }
    }

    #[test]
    fn numbers_are_read_bit_by_bit_as_often_as_wanted() {
        let third = 1.0 / 3.0;
        let held = log(&[("t", &[0.0, 0.1]), ("q_knee", &[third, -0.0])]);
        for _ in 0..2 {
            let opened = held.open().unwrap();
            assert_eq!(opened.find("q_knee"), Found::At(1));
            let table = opened.read(&[1, 0], &[]).unwrap();
            let bits = |values: &[f64]| values.iter().map(|one| one.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&table.columns[0]), bits(&[third, -0.0]));
            assert_eq!(table.place(1), Place::Row(2));
        }
    }

    #[test]
    fn all_that_is_wrong_is_said() {
        assert_eq!(log(&[]).open().unwrap_err().faults(), [FileFault::NoColumns]);
        let wrong = log(&[("t", &[0.0, 0.1]), ("q", &[0.0]), ("t", &[0.0, 0.1])]);
        let said = wrong.open().unwrap_err().to_string();
        assert_eq!(said, "column `q` has 1 rows, and `t` has 2\ntwo columns `t`");
    }
}
