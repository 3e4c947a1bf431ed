//! What is left of torques: how much, and whether it is noise.

use super::least_squares::Estimate;
use super::left_out::{LeftOut, NumberedLog};
use super::unexplained::{ShownLogs, samples_of};
use crate::policy::left_over::{NO_NOISE, SAID};
use denavit_measure::LogIndex;
use denavit_measure::condition::Conditioned;
use denavit_plants::regression::RegressionModel;
use std::collections::VecDeque;

/// What is left of the torque of a joint in a log.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Left {
    pub(super) rows: f64,
    pub(super) squares: f64,
    /// Of rows half a period of the filter's cutoff apart their products, and mean squares.
    pub(super) alike: f64,
    pub(super) both: f64,
    /// Rows in that time.
    pub(super) apart: f64,
}

impl Left {
    /// Adds a row, or one that does not count; `recent` are those before, the last one first.
    pub(super) fn add(&mut self, one: Option<f64>, recent: &mut VecDeque<Option<f64>>) {
        if let Some(one) = one {
            self.rows += 1.0;
            self.squares += one * one;
            if let Some(Some(other)) = recent.get(self.apart as usize - 1) {
                self.alike += one * other;
                self.both += 0.5 * (one * one + other * other);
            }
        }
        recent.push_front(one);
        recent.truncate(self.apart as usize);
    }

    /// The same of another log, too.
    fn with(self, other: &Self) -> Self {
        Self {
            rows: self.rows + other.rows,
            squares: self.squares + other.squares,
            alike: self.alike + other.alike,
            both: self.both + other.both,
            apart: self.apart.max(other.apart),
        }
    }

    fn mean_square(&self) -> f64 {
        self.squares / self.rows.max(1.0)
    }

    /// Whether it is no noise: half a period later it is like itself by more than chance.
    fn is_no_noise(&self) -> bool {
        let alike = if self.both > 0.0 { self.alike / self.both } else { 0.0 };
        alike > NO_NOISE + (2.0 * self.apart / self.rows.max(1.0)).sqrt()
    }
}

impl LeftOut {
    /// What phi leaves of the rows that count, by log and joint.
    fn left(&self, model: &RegressionModel, logs: &[Conditioned], phi: &[f64]) -> Vec<Vec<Left>> {
        let of_log = |(number, log): (usize, &Conditioned)| {
            let apart = samples_of(log, 0.5) as f64;
            let mut left = vec![Left { apart, ..Left::default() }; model.joints.len()];
            let mut recent = vec![VecDeque::new(); left.len()];
            let own = NumberedLog { number: LogIndex(number), log };
            self.for_each_left(model, own, phi, |joint, _, one, counts| {
                left[joint.0].add(counts.then_some(one), &mut recent[joint.0]);
            });
            left
        };
        logs.iter().enumerate().map(of_log).collect()
    }
}

/// The joints of whose torques something is left of the rows that count in logs that is no noise,
/// with its share; `torques` are roots of mean squares [N m, N].
pub(crate) fn lacking(
    model: &RegressionModel,
    shown_logs: ShownLogs<'_>,
    found: &Estimate,
    torques: &[f64],
) -> Vec<(String, f64)> {
    let ShownLogs { logs, shown } = shown_logs;
    let left = found.left_out.left(model, logs, found.solution.phi.as_slice());
    let of_joint = |(joint, torque): (usize, &f64)| {
        let all = shown.iter().fold(Left::default(), |sum, &log| sum.with(&left[log.0][joint]));
        let share = all.mean_square().sqrt() / torque;
        (all.is_no_noise() && share > SAID).then(|| (model.joints[joint].name.clone(), share))
    };
    torques.iter().enumerate().filter_map(of_joint).collect()
}

#[cfg(test)]
#[path = "../../tests/unit/left_over.rs"]
mod tests;
