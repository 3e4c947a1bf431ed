//! Positions that jump: slips of an encoder, laps that were joined end to end.

use super::fault::Suspicion;
use crate::policy::jumps::{OF_NEIGHBOURS, OF_RANGE, OF_STEP};
use denavit_logs::Table;

/// Samples on either side that a jump is compared with, and those of them that are part of it.
const ABOUT: usize = 50;
const PART: usize = 3;

/// The first jump of a position, a column of the table, whose first is the time; rows without a
/// number are passed over.
pub(super) fn jump(table: &Table, place: usize, column: &str) -> Option<Suspicion> {
    let (time, values) = (&table.columns[0], &table.columns[place]);
    let is_sound = |row: &usize| time[*row].is_finite() && values[*row].is_finite();
    let rows: Vec<usize> = (0..values.len()).filter(is_sound).collect();
    let (low, high) = rows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &row| {
        (low.min(values[row]), high.max(values[row]))
    });
    let step = |at: usize| values[rows[at + 1]] - values[rows[at]];
    let count = rows.len().saturating_sub(1);
    let tiny = 1e-12 * low.abs().max(high.abs());
    let least = (0..count).map(|at| step(at).abs()).filter(|size| *size > tiny);
    let least = least.fold(f64::INFINITY, f64::min);
    let least = (OF_RANGE * (high - low)).max(OF_STEP * least);
    // a jump differs from the steps on both sides of it
    let differs = |at: usize, other: usize| (step(at) - step(other)).abs() > least;
    let is_apart = |at: &usize| differs(*at, at - 1) && differs(*at, at + 1);
    let is_jump = |at: &usize| {
        let near = at.saturating_sub(ABOUT)..(at + ABOUT + 1).min(count);
        let others = near.filter(|other| other.abs_diff(*at) > PART);
        // a longer time between two samples is a gap, not a jump
        let length = |at: usize| time[rows[at + 1]] - time[rows[at]];
        let usual = others.clone().map(|at| step(at).abs() / length(at).max(f64::MIN_POSITIVE));
        let usual = usual.fold(0.0, f64::max) * length(*at);
        step(*at).abs() > least.max(OF_NEIGHBOURS * usual)
    };
    let mut jumps = (1..count.saturating_sub(1)).filter(is_apart).filter(is_jump);
    let first = jumps.next()?;
    let (from, to) = (values[rows[first]], values[rows[first + 1]]);
    let others = jumps.count();
    let (column, at) = (column.to_owned(), table.place(rows[first + 1]));
    Some(Suspicion::Jump { column, at, from, to, others })
}
