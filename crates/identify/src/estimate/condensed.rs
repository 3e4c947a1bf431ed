//! Logs condensed to triangles: one for each joint and each part of a log.
//!
//! Joints are kept apart, so that they can be weighted afterwards; parts are, so that errors can be
//! found that residuals make which are alike from one sample to the next.

use super::left_out::{LeftOut, NumberedLog};
use super::rows::{Block, BlockMaker};
use denavit_measure::condition::Conditioned;
use denavit_measure::{JointIndex, LogIndex, PartIndex, SampleIndex};
use denavit_numerics::least_squares::{PriorRow, Triangle, stacked};
use denavit_plants::regression::RegressionModel;
use nalgebra::DMatrix;
use std::borrow::Cow;

/// Parts that logs are cut into, altogether.
pub(super) const PARTS: usize = 96;

/// The fewest samples of a part.
pub(super) const MIN_PART: usize = 20;

/// Triangles of every joint, part by part.
#[derive(Clone, Debug, PartialEq)]
pub struct Condensed {
    /// For each joint the places of phi that its columns belong to.
    pub pattern: Vec<Vec<usize>>,
    /// Part by part, for each joint its triangle.
    pub parts: Vec<Vec<Triangle>>,
    /// The log that each part is of.
    pub log_of_part: Vec<LogIndex>,
    /// For each part the time of its last sample since the beginning of its log \[s\].
    pub end_s: Vec<f64>,
    /// For each log the share of its rows that are independent of each other.
    pub independent: Vec<f64>,
    /// For each log how long a row of it stands for \[s\].
    pub row_s: Vec<f64>,
    /// Number of base parameters.
    pub rank: usize,
}

/// Logs, with the rows of them that are left out.
pub(super) type Rows<'a> = (&'a [Conditioned], &'a LeftOut);

/// What the rows of a joint in a block become: columns, and what they are to give, of one length;
/// none where there are none.
pub(super) type RowsOf<'a> =
    &'a mut dyn for<'b> FnMut(LogIndex, &'b Block, JointIndex) -> Option<Vec<Cow<'b, [f64]>>>;

/// The factors of a block's rows of a joint, beside the joint's weight: log, block, joint.
pub(super) type RowFactors<'a> = &'a dyn Fn(LogIndex, &Block, JointIndex) -> Vec<f64>;

/// The parts that a log is cut into.
#[derive(Clone, Copy)]
struct PartsOfLog {
    /// The number of the first of them.
    begin: usize,
    count: usize,
    /// Samples in a part; the last one has the rest, too.
    length: usize,
}

impl Condensed {
    /// No parts yet, of logs with these shares of independent rows that stand for so long.
    pub(super) fn without_parts(
        (pattern, rank): (Vec<Vec<usize>>, usize),
        independent: Vec<f64>,
        row_s: Vec<f64>,
    ) -> Self {
        let (parts, log_of_part, end_s) = (Vec::new(), Vec::new(), Vec::new());
        Self { pattern, parts, log_of_part, end_s, independent, row_s, rank }
    }

    /// Condenses all rows of conditioned logs.
    pub fn new(model: &RegressionModel, logs: &[Conditioned]) -> Self {
        Self::counted(model, (logs, &LeftOut::none(logs)))
    }

    /// Condenses conditioned logs without the rows that are left out.
    pub(super) fn counted(model: &RegressionModel, logs: Rows<'_>) -> Self {
        Self::of_rows(model, logs, model.pattern().to_vec(), model.rank(), &mut plain)
    }

    /// Condenses them with each row multiplied by a factor, which is found for a log, a block and a
    /// joint.
    pub(super) fn weighted(
        model: &RegressionModel,
        logs: Rows<'_>,
        factors: RowFactors<'_>,
    ) -> Self {
        let (pattern, rank) = (model.pattern().to_vec(), model.rank());
        Self::of_rows(model, logs, pattern, rank, &mut |log, block, joint| {
            let columns = block.with_target(joint)?;
            let factors = factors(log, block, joint);
            let scaled = |column: &[f64]| -> Vec<f64> {
                column.iter().zip(&factors).map(|(a, b)| a * b).collect()
            };
            Some(columns.into_iter().map(|column| Cow::Owned(scaled(column))).collect())
        })
    }

    /// Condenses rows of another pattern and rank.
    pub(super) fn of_rows(
        model: &RegressionModel,
        (logs, left_out): Rows<'_>,
        pattern: Vec<Vec<usize>>,
        rank: usize,
        rows: RowsOf<'_>,
    ) -> Self {
        let all: usize = logs.iter().map(Conditioned::samples).sum();
        Self::of_parts(model, (logs, left_out), pattern, rank, part_length(all), rows)
    }

    /// The same in parts of so many samples.
    pub(super) fn of_parts(
        model: &RegressionModel,
        (logs, left_out): Rows<'_>,
        pattern: Vec<Vec<usize>>,
        rank: usize,
        length: usize,
        rows: RowsOf<'_>,
    ) -> Self {
        let share = |log: &Conditioned| log.independent() / log.samples().max(1) as f64;
        let independent = logs.iter().map(share).collect();
        let row_s = logs.iter().map(|log| log.step_s * log.decimation as f64).collect();
        let mut condensed = Self::without_parts((pattern, rank), independent, row_s);
        for (number, log) in logs.iter().enumerate() {
            let number = LogIndex(number);
            // A short rest goes with the part before it.
            let count = (log.samples() / length).max(1);
            let begin = condensed.parts.len();
            for part in 0..count {
                let widths = condensed.pattern.iter().map(Vec::len);
                condensed.parts.push(widths.map(Triangle::new).collect());
                condensed.log_of_part.push(number);
                let last = if part + 1 == count { log.samples() } else { (part + 1) * length };
                condensed
                    .end_s
                    .push(log.time_s(SampleIndex(last.max(1) - 1)) - log.time_s(SampleIndex(0)));
            }
            let parts = PartsOfLog { begin, count, length };
            let own = NumberedLog { number, log };
            BlockMaker::new(model, log).for_each(|block| {
                for joint in (0..condensed.pattern.len()).map(JointIndex) {
                    let Some(columns) = rows(number, block, joint) else { continue };
                    let counts = left_out.counts(own, joint, block.first, block.samples);
                    condensed.add(block, joint, &columns, counts.as_deref(), parts);
                }
            });
        }
        condensed
    }

    /// Adds the rows of a joint in a block, those that count.
    fn add(
        &mut self,
        block: &Block,
        joint: JointIndex,
        columns: &[Cow<'_, [f64]>],
        counts: Option<&[bool]>,
        parts: PartsOfLog,
    ) {
        let PartsOfLog { begin, count, length } = parts;
        let mut from = 0;
        while from < block.samples {
            let part = ((block.first.0 + from) / length).min(count - 1);
            let end = if part + 1 == count { usize::MAX } else { (part + 1) * length };
            let to = block.samples.min(end.saturating_sub(block.first.0));
            let rows: Vec<&[f64]> = columns.iter().map(|column| &column[from..to]).collect();
            let triangle = &mut self.parts[begin + part][joint.0];
            match counts {
                None => triangle.push(&rows),
                Some(counts) => {
                    let counted = |column: &&[f64]| -> Vec<f64> {
                        let pairs = column.iter().zip(&counts[from..to]);
                        pairs.filter(|(_, counts)| **counts).map(|(entry, _)| *entry).collect()
                    };
                    let counted: Vec<Vec<f64>> = rows.iter().map(counted).collect();
                    triangle.push(&counted.iter().map(Vec::as_slice).collect::<Vec<_>>());
                }
            }
            from = to;
        }
    }

    /// Some of the logs alone.
    pub(super) fn of_logs(&self, logs: &[LogIndex]) -> Self {
        let number = |part: usize| logs.iter().position(|log| *log == self.log_of_part[part]);
        let own: Vec<(usize, LogIndex)> = (0..self.parts.len())
            .filter_map(|part| Some((part, LogIndex(number(part)?))))
            .collect();
        Self {
            pattern: self.pattern.clone(),
            parts: own.iter().map(|&(part, _)| self.parts[part].clone()).collect(),
            log_of_part: own.iter().map(|&(_, log)| log).collect(),
            end_s: own.iter().map(|&(part, _)| self.end_s[part]).collect(),
            independent: logs.iter().map(|&log| self.independent[log.0]).collect(),
            row_s: logs.iter().map(|&log| self.row_s[log.0]).collect(),
            rank: self.rank,
        }
    }

    /// For each log the triangles of its joints, of the given parts.
    pub fn merged(&self, parts: impl Iterator<Item = PartIndex>) -> Vec<Vec<Triangle>> {
        let none = || self.pattern.iter().map(|places| Triangle::new(places.len())).collect();
        let mut merged: Vec<Vec<Triangle>> = self.independent.iter().map(|_| none()).collect();
        parts.for_each(|part| self.merge(part, &mut merged));
        merged
    }

    /// Adds the rows of a part.
    pub(super) fn merge(&self, part: PartIndex, merged: &mut [Vec<Triangle>]) {
        let of_log = &mut merged[self.log_of_part[part.0].0];
        for (sum, own) in of_log.iter_mut().zip(&self.parts[part.0]) {
            if own.rows() > 0 {
                sum.merge(own);
            }
        }
    }

    /// The mean of what phi leaves of each joint's torque in some logs.
    pub(super) fn means(&self, logs: &[LogIndex], phi: &[f64]) -> Vec<f64> {
        let own = self.parts.iter().zip(&self.log_of_part).filter(|(_, log)| logs.contains(log));
        let of = |joint: usize| {
            let phi = self.of_joint(JointIndex(joint), phi);
            let all = own.clone().map(|(part, _)| (part[joint].rows(), part[joint].sum(&phi)));
            let (rows, sum) = all.fold((0, 0.0), |(n, s), (rows, sum)| (n + rows, s + sum));
            sum / rows.max(1) as f64
        };
        (0..self.pattern.len()).map(of).collect()
    }

    /// For each log the triangles of its joints, of all parts.
    pub fn whole(&self) -> Vec<Vec<Triangle>> {
        self.merged((0..self.parts.len()).map(PartIndex))
    }

    /// R of [W | y] of weighted triangles of logs, and of what is known beforehand.
    pub(crate) fn system(
        &self,
        triangles: &[Vec<Triangle>],
        weights: &[Vec<f64>],
        prior: &[PriorRow],
    ) -> DMatrix<f64> {
        let both = triangles.iter().zip(weights);
        let logs: Vec<(&[Triangle], &[f64])> =
            both.map(|(triangles, weights)| (&triangles[..], &weights[..])).collect();
        stacked(&logs, &self.pattern, prior, self.rank)
    }

    /// The entries of phi that a joint's columns belong to.
    pub fn of_joint(&self, joint: JointIndex, phi: &[f64]) -> Vec<f64> {
        self.pattern[joint.0].iter().map(|&place| phi[place]).collect()
    }
}

/// Samples of a part of logs that have so many together.
pub(super) fn part_length(samples: usize) -> usize {
    samples.div_ceil(PARTS).max(MIN_PART)
}

/// The rows as they are.
pub(super) fn plain(_: LogIndex, block: &Block, joint: JointIndex) -> Option<Vec<Cow<'_, [f64]>>> {
    let columns = block.with_target(joint)?;
    Some(columns.into_iter().map(Cow::Borrowed).collect())
}
