//! Samples at equal distances: repeated rows dropped, single missing samples filled in.

use super::fault::{LogFault, LogRemark};
use crate::policy::repair::{MAX_JITTER, MAX_MISSING, RESAMPLED_JITTER};
use denavit_logs::Table;
use denavit_numerics::median;

/// Fewer rows make no log.
const FEWEST_ROWS: usize = 4;

/// Samples that may be missing at once.
const MAX_GAP: usize = 5;

/// Samples at equal distances.
pub(super) struct Even {
    /// The distance \[s\].
    pub(super) step_s: f64,
    /// The time of the first \[s\].
    pub(super) start_s: f64,
    pub(super) columns: Vec<Vec<f64>>,
    pub(super) remarks: Vec<LogRemark>,
}

/// Brings rows to equal distances. The first column of `table` is the time; `names` are those of
/// the columns.
pub(super) fn even(mut table: Table, names: &[String]) -> Result<Even, Vec<LogFault>> {
    let mut remarks = Vec::new();
    let mut faults = Vec::new();
    let undefined = table.columns[0].iter().position(|time| time.is_nan());
    if let Some(row) = undefined {
        let count = table.columns[0].iter().filter(|time| time.is_nan()).count();
        let (column, at) = (names[0].clone(), table.place(row));
        return Err(vec![LogFault::Undefined { column, count, at }]);
    }
    drop_repeats(&mut table, &mut faults, &mut remarks);
    if table.rows() < FEWEST_ROWS {
        faults.push(too_short(table.rows()));
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    fill_cells(&mut table, names, &mut faults, &mut remarks);
    let time = &table.columns[0];
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let median = median(steps.clone());
    let mut gaps = Gaps::default();
    let mut scatter = 0.0;
    for (row, step) in steps.iter_mut().enumerate() {
        let samples = (*step / median).round().max(1.0);
        gaps.add(samples as usize - 1, row);
        scatter += (*step / median - samples).powi(2);
    }
    let jitter = (scatter / steps.len() as f64).sqrt();
    let samples = time.len() + gaps.missing;
    if gaps.missing as f64 > MAX_MISSING * samples as f64 || gaps.longest > MAX_GAP {
        let Gaps { missing, longest, row } = gaps;
        faults.push(LogFault::Gaps { missing, samples, longest, at: table.place(row + 1) });
    } else if jitter > MAX_JITTER {
        let percent = 100.0 * jitter;
        faults.push(LogFault::other(format!(
            "the distances of samples scatter by {percent:.0} %, too much for derivatives"
        )));
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let (start_s, end_s) = (time[0], time[time.len() - 1]);
    let step_s = (end_s - start_s) / (samples - 1) as f64;
    let is_even = gaps.missing == 0 && jitter <= RESAMPLED_JITTER;
    if gaps.missing > 0 {
        let Gaps { missing, longest, .. } = gaps;
        remarks.push(LogRemark::FilledGaps { missing, samples, longest });
    }
    if jitter > RESAMPLED_JITTER {
        remarks.push(LogRemark::Resampled { jitter });
    }
    let mut columns = table.columns;
    let time = columns.remove(0);
    if !is_even {
        for column in &mut columns {
            *column = interpolated(&time, column, start_s, step_s, samples);
        }
    }
    Ok(Even { step_s, start_s, columns, remarks })
}

/// So many rows make no log.
pub(super) fn too_short(rows: usize) -> LogFault {
    let rows = if rows == 0 { "no rows".to_owned() } else { format!("{rows} rows") };
    LogFault::other(format!("{rows}: at least {FEWEST_ROWS} are needed"))
}

#[derive(Default)]
struct Gaps {
    missing: usize,
    longest: usize,
    /// The row before the longest.
    row: usize,
}

impl Gaps {
    fn add(&mut self, missing: usize, row: usize) {
        self.missing = self.missing.saturating_add(missing);
        if missing > self.longest {
            (self.longest, self.row) = (missing, row);
        }
    }
}

/// Rows that say the same as the one before go; others with its time, or an earlier one, are
/// faults.
fn drop_repeats(table: &mut Table, faults: &mut Vec<LogFault>, remarks: &mut Vec<LogRemark>) {
    let time = &table.columns[0];
    let mut keep = vec![true; time.len()];
    for row in 1..time.len() {
        if time[row] > time[row - 1] || faults.len() >= 5 {
            continue;
        }
        let same = |column: &Vec<f64>| {
            let (a, b) = (column[row], column[row - 1]);
            a == b || a.is_nan() && b.is_nan()
        };
        if table.columns.iter().all(same) {
            keep[row] = false;
        } else if time[row] == time[row - 1] {
            let text = "the time is that of the row above, with other numbers".to_owned();
            faults.push(LogFault::Other { text, at: Some(table.place(row)) });
        } else {
            faults.push(LogFault::TimeNotIncreasing { at: table.place(row) });
        }
    }
    let count = keep.iter().filter(|&&keep| !keep).count();
    if count > 0 && faults.is_empty() {
        for column in &mut table.columns {
            let mut row = 0;
            column.retain(|_| {
                row += 1;
                keep[row - 1]
            });
        }
        remarks.push(LogRemark::DroppedRepeats { count });
    }
}

/// Cells without a number get one from their neighbours, if they are few.
fn fill_cells(
    table: &mut Table,
    names: &[String],
    faults: &mut Vec<LogFault>,
    remarks: &mut Vec<LogRemark>,
) {
    let time = table.columns[0].clone();
    for index in 1..table.columns.len() {
        let holes: Vec<usize> =
            (0..time.len()).filter(|&row| table.columns[index][row].is_nan()).collect();
        let Some(&first) = holes.first() else { continue };
        let is_gap = |run: &[usize]| run[run.len() - 1] - run[0] == run.len() - 1;
        let longest = holes.windows(MAX_GAP + 1).any(is_gap);
        let column = names[index].clone();
        if holes.len() as f64 > MAX_MISSING * time.len() as f64 || longest {
            let at = table.place(first);
            faults.push(LogFault::Undefined { column, count: holes.len(), at });
            continue;
        }
        remarks.push(LogRemark::FilledCells { column, count: holes.len() });
        let known: Vec<usize> =
            (0..time.len()).filter(|&row| !table.columns[index][row].is_nan()).collect();
        let times: Vec<f64> = known.iter().map(|&row| time[row]).collect();
        let values: Vec<f64> = known.iter().map(|&row| table.columns[index][row]).collect();
        for row in holes {
            table.columns[index][row] = cubic(&times, &values, time[row]);
        }
    }
}

fn interpolated(time: &[f64], column: &[f64], start: f64, step: f64, count: usize) -> Vec<f64> {
    (0..count).map(|sample| cubic(time, column, start + step * sample as f64)).collect()
}

/// The polynomial through the four samples about a time (Lagrange).
fn cubic(time: &[f64], column: &[f64], at: f64) -> f64 {
    let after = time.partition_point(|&one| one < at);
    let first = after.saturating_sub(2).min(time.len().saturating_sub(4));
    let (time, column) = (&time[first..], &column[first..]);
    let points = time.len().min(4);
    let mut sum = 0.0;
    for i in 0..points {
        let others = (0..points).filter(|&j| j != i);
        let weight: f64 = others.map(|j| (at - time[j]) / (time[i] - time[j])).product();
        sum += weight * column[i];
    }
    sum
}
