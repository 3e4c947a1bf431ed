//! Rows of a log's file, some at a time.

use super::LongLog;
use super::plan::name_of;
use crate::error::{Cause, Error};
use crate::logs::Logs;
use denavit_logs::{Batches, MemoryLog, Table};
use denavit_measure::log::{LogOf, of_file};
use denavit_plants::regression::RegressionModel;
use std::ops::Range;

/// What a long log is, from end to end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Survey {
    pub(super) rows: usize,
    /// The time of the first row \[s\].
    pub(super) start_s: f64,
    /// The distance of rows \[s\].
    pub(super) step_s: f64,
}

impl Survey {
    fn new(rows: usize, start_s: f64, end_s: f64) -> Self {
        Self { rows, start_s, step_s: (end_s - start_s) / (rows.max(2) - 1) as f64 }
    }
}

/// Which robot a log is of.
pub(super) struct OfRobot<'a> {
    model: &'a RegressionModel,
    contacts: Vec<String>,
}

impl OfRobot<'_> {
    fn log_of(&self) -> LogOf<'_> {
        LogOf {
            model: &self.model.model,
            joints: &self.model.joints,
            contacts: &self.contacts,
            accepts_suspicious: false,
        }
    }
}

impl LongLog<'_> {
    pub(super) fn robot<'b>(&self, model: &'b RegressionModel) -> OfRobot<'b> {
        let contacts = self.file.apart.robot.contacts.values();
        OfRobot { model, contacts: contacts.map(|one| one.name.clone()).collect() }
    }

    /// Reads the times of a log from end to end.
    pub(super) fn survey(&self, model: &RegressionModel) -> Result<Survey, Error> {
        let source = &self.logs.train[0];
        let (log, used) = self.logs.opened(source, self.robot(model).log_of())?;
        let failed = |faults| Cause::Logs(vec![of_file(&source.to_string(), faults)]);
        let (mut rows, mut first, mut last) = (0, None, f64::NAN);
        for batch in log.batches(&[used.time]).map_err(failed)? {
            let batch = batch.map_err(failed)?;
            rows += batch.rows();
            let times = &batch.columns[0];
            first = first.or(times.first().copied());
            last = times.last().copied().unwrap_or(last);
        }
        let [scale, offset] = used.to_seconds;
        let [start_s, end_s] = [first.unwrap_or(f64::NAN), last].map(|t| scale * t + offset);
        self.sound(Survey::new(rows, start_s, end_s))
    }

    /// The same of a log whose head is in memory, with so many rows, the last one at `end`, as its
    /// column of times has it.
    pub(super) fn survey_of_head(
        &self,
        model: &RegressionModel,
        rows: usize,
        end: f64,
    ) -> Result<Survey, Error> {
        let source = &self.logs.train[0];
        let (log, used) = self.logs.opened(source, self.robot(model).log_of())?;
        let failed = |faults| Cause::Logs(vec![of_file(&source.to_string(), faults)]);
        let head = log.read(&[used.time], &[]).map_err(failed)?;
        let start = head.columns[0].first().copied().unwrap_or(f64::NAN);
        let [scale, offset] = used.to_seconds;
        let [start_s, end_s] = [start, end].map(|t| scale * t + offset);
        self.sound(Survey::new(rows, start_s, end_s))
    }

    fn sound(&self, survey: Survey) -> Result<Survey, Error> {
        let is_sound = survey.rows > 1 && survey.step_s > 0.0 && survey.step_s.is_finite();
        match is_sound {
            true => Ok(survey),
            false => Err(self.wrong("its times do not go from its first row to its last")),
        }
    }
}

/// The numbers of a log that is held as a whole, before anything is made of them.
pub(super) struct Held(Vec<Vec<f64>>);

impl Held {
    pub(super) fn read(logs: &Logs, robot: &OfRobot<'_>) -> Result<Self, Error> {
        let source = &logs.train[0];
        let (log, used) = logs.opened(source, robot.log_of())?;
        let mut places = used.places;
        places.sort_unstable();
        places.dedup();
        let failed = |faults| Cause::Logs(vec![of_file(&source.to_string(), faults)]);
        Ok(Self(log.read(&places, &[]).map_err(failed)?.columns))
    }

    /// Names rows by all their numbers; those beyond the end are not there.
    pub(super) fn name_of(&self, rows: Range<usize>) -> String {
        let of = |column: &Vec<f64>| {
            let [from, to] = [rows.start, rows.end].map(|row| row.min(column.len()));
            column[from..to].to_vec()
        };
        let numbers = self.0.iter().flat_map(of);
        name_of(numbers.flat_map(|number| number.to_bits().to_le_bytes()))
    }
}

/// The rows of a log that are held, as its file goes on.
pub(super) struct Window<'a> {
    name: String,
    header: Vec<(String, String)>,
    names: Vec<String>,
    batches: Batches<'a>,
    /// The row of the file that the first one is.
    first: usize,
    columns: Vec<Vec<f64>>,
    is_at_end: bool,
}

impl<'a> Window<'a> {
    pub(super) fn open(logs: &'a Logs, robot: &OfRobot<'_>) -> Result<Self, Error> {
        let source = &logs.train[0];
        let (log, used) = logs.opened(source, robot.log_of())?;
        let mut places = used.places;
        places.sort_unstable();
        places.dedup();
        let names: Vec<String> =
            places.iter().map(|&place| log.columns[place].name.clone()).collect();
        let (name, header) = (source.to_string(), log.header.clone());
        let failed = |faults| Cause::Logs(vec![of_file(&name, faults)]);
        let batches = log.batches(&places).map_err(failed)?;
        let columns = vec![Vec::new(); names.len()];
        Ok(Self { name, header, names, batches, first: 0, columns, is_at_end: false })
    }

    /// Rows of the file, which begin no earlier than those that were asked for before; those beyond
    /// its end are not there.
    pub(super) fn rows(&mut self, rows: Range<usize>) -> Result<MemoryLog, Error> {
        self.forget(rows.start);
        while !self.is_at_end && self.first + self.held() < rows.end {
            match self.batches.next() {
                None => self.is_at_end = true,
                Some(batch) => {
                    let failed = |faults| Cause::Logs(vec![of_file(&self.name, faults)]);
                    let Table { columns, .. } = batch.map_err(failed)?;
                    for (held, new) in self.columns.iter_mut().zip(&columns) {
                        held.extend_from_slice(new);
                    }
                    self.forget(rows.start);
                }
            }
        }
        let held = self.held();
        let [from, to] = [rows.start, rows.end].map(|row| (row - self.first).min(held));
        let named = self.names.iter().zip(&self.columns);
        let columns =
            named.map(|(name, values)| (name.clone(), values[from..to].to_vec())).collect();
        Ok(MemoryLog { header: self.header.clone(), columns })
    }

    fn held(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// Drops rows before one of the file.
    fn forget(&mut self, row: usize) {
        let gone = row.saturating_sub(self.first).min(self.held());
        self.columns.iter_mut().for_each(|column| drop(column.drain(..gone)));
        self.first += gone;
    }
}
