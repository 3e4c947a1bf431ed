//! The rows of some samples of logs under a reading of their columns.

use super::misreading::Misreading;
use super::reading::Reading;
use super::window::{Window, with_sign};
use crate::estimate::{Coulomb, coulomb};
use denavit_measure::condition::Conditioned;
use denavit_measure::{JointIndex, SampleIndex};
use denavit_numerics::time_alike;
use denavit_plants::regression::{RegressionEvaluator, RegressionModel, RegressionRows};
use nalgebra::{DMatrix, DVector};

/// Samples of a block: residuals that are alike for long are seen so.
const BLOCK: usize = 256;

/// Products of rows that are not read anew where torques alone are scaled, of so many readings.
const KEPT: usize = 2;

/// Some samples of logs, to be read in one way or another.
pub(super) struct Sample<'a> {
    pub(super) model: &'a RegressionModel,
    evaluator: RegressionEvaluator,
    rows: RegressionRows,
    windows: Vec<Window<'a>>,
    /// Columns that jump with the rate: they pass the filter of the torque.
    coulomb: Vec<Coulomb>,
    kept: Vec<(Reading, Vec<Option<JointRows>>)>,
}

/// What is of the rows of a joint: the mean products of the measured torque, of what is known of
/// it, of 1, of the columns of the regressor and of lines with each other, in this order.
#[derive(Clone)]
pub(super) struct JointRows {
    rows: usize,
    products: DMatrix<f64>,
}

/// Columns before those of the regressor.
const BEFORE: usize = 3;

impl JointRows {
    fn new(columns: usize) -> Self {
        Self { rows: 0, products: DMatrix::zeros(BEFORE + columns, BEFORE + columns) }
    }

    /// The mean square of the torque.
    pub(super) fn square(&self) -> f64 {
        self.products[(0, 0)]
    }

    /// The mean products of what is to be explained and of the columns, in this order.
    pub(super) fn of_columns(&self) -> DMatrix<f64> {
        let size = self.products.nrows();
        let combined =
            DMatrix::from_fn(size, size - BEFORE + 1, |row, column| match (row, column) {
                (0, 0) => 1.0,
                (1, 0) => -1.0,
                (row, column) if column > 0 && row + 1 == column + BEFORE => 1.0,
                _ => 0.0,
            });
        combined.tr_mul(&(&self.products * &combined))
    }

    /// The same of a torque that is multiplied with a factor, and has a constant added.
    fn with_torque(&self, factor: f64, offset: f64) -> Self {
        let size = self.products.nrows();
        let mut change = DMatrix::identity(size, size);
        change[(0, 0)] = factor;
        change[(2, 0)] = offset;
        Self { rows: self.rows, products: change.tr_mul(&(&self.products * &change)) }
    }
}

impl<'a> Sample<'a> {
    /// Of logs, so many samples of all, whose signals are read up to `latest` samples late.
    pub(super) fn new(
        model: &'a RegressionModel,
        logs: &[&'a Conditioned],
        latest: isize,
        samples: usize,
    ) -> Self {
        let blocks = (samples / BLOCK / logs.len().max(1)).max(1);
        let mut windows = Vec::new();
        for &log in logs {
            let counts: Vec<_> =
                (0..log.joints()).map(|joint| with_sign(log, JointIndex(joint))).collect();
            let samples = log.samples();
            let every = samples.div_ceil(BLOCK * blocks).max(1);
            for first in (0..samples).step_by(BLOCK * every) {
                let count = BLOCK.min(samples - first);
                windows.push(Window::new(log, &counts, SampleIndex(first), count, latest));
            }
        }
        let (mut evaluator, rows) = (model.evaluator(), RegressionRows::default());
        let coulomb = coulomb(model, &mut evaluator);
        Self { model, evaluator, rows, windows, coulomb, kept: Vec::new() }
    }

    /// Whether a joint moves in some of the logs.
    pub(super) fn moves(&self, joint: JointIndex) -> bool {
        self.windows.iter().any(|window| window.log().resting.get(joint.0) != Some(&true))
    }

    /// Whether the torque of a joint is measured in some of the logs.
    pub(super) fn is_measured(&self, joint: JointIndex) -> bool {
        self.windows.iter().any(|window| window.log().torque[joint.0].is_some())
    }

    /// The root of the mean square of each torque.
    pub(super) fn torques(&mut self, reading: &Reading) -> Vec<f64> {
        let rows = self.rows(reading);
        rows.iter().map(|rows| rows.as_ref().map_or(0.0, |rows| rows.square().sqrt())).collect()
    }

    /// How many samples of each column of torque that is measured the filter leaves independent of
    /// each other.
    pub(super) fn independent_by_filter(&self) -> Vec<f64> {
        let of = |column: usize| {
            let measured = |window: &&Window<'_>| window.log().torque[column].is_some();
            self.windows.iter().filter(measured).map(Window::independent).sum()
        };
        let columns =
            (0..self.model.joints.len()).filter(|&column| self.is_measured(JointIndex(column)));
        columns.map(of).collect()
    }

    /// Makes the rows of a window under a reading.
    fn read(&mut self, window: usize, reading: &Reading) {
        let n = self.model.joints.len();
        let window = &mut self.windows[window];
        let column = |at: usize| window.motion(&reading.positions[at % n], at / n, reading.time);
        let motion: Vec<Vec<f64>> = (0..3 * n).map(column).collect();
        let motion: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
        self.evaluator.evaluate(&motion, &mut self.rows).expect("every joint has its columns");
        for one in &self.coulomb {
            let law = window.law(&reading.positions[one.joint.0], reading.time, self.model.law);
            let column = self.rows.column_mut(one.joint.0, one.place).iter_mut();
            column.zip(law).for_each(|(entry, law)| *entry = one.factor * law);
        }
    }

    /// The rows of each joint under a reading; none of one whose torque is not measured.
    pub(super) fn rows(&mut self, reading: &Reading) -> Vec<Option<JointRows>> {
        let plain = reading.with_plain_torques();
        let kept = self.kept.iter().find(|(one, _)| *one == plain).map(|(_, rows)| rows.clone());
        let rows = kept.unwrap_or_else(|| {
            let rows = self.rows_anew(&plain);
            self.kept.truncate(KEPT - 1);
            self.kept.insert(0, (plain, rows.clone()));
            rows
        });
        let scaled = rows.iter().zip(&reading.torques).map(|(rows, torque)| {
            rows.as_ref().map(|rows| rows.with_torque(torque.factor, torque.offset))
        });
        scaled.collect()
    }

    fn rows_anew(&mut self, reading: &Reading) -> Vec<Option<JointRows>> {
        self.rows_with(reading, &mut |_, _| Vec::new(), 0)
    }

    /// The rows of each joint with `count` more columns, which are made for a window and a joint.
    fn rows_with(
        &mut self,
        reading: &Reading,
        more: &mut dyn FnMut(usize, JointIndex) -> Vec<Vec<f64>>,
        count: usize,
    ) -> Vec<Option<JointRows>> {
        let of_joint = |places: &Vec<usize>| JointRows::new(places.len() + count);
        let mut all: Vec<JointRows> = self.model.pattern().iter().map(of_joint).collect();
        for window in 0..self.windows.len() {
            self.read(window, reading);
            for (joint, own) in all.iter_mut().enumerate() {
                let Some(torque) = self.windows[window].torque(&reading.torques[joint]) else {
                    continue;
                };
                let mut columns = DMatrix::zeros(torque.len(), own.products.ncols());
                columns.column_mut(0).copy_from_slice(&torque);
                if let Some(known) = self.rows.known(joint) {
                    columns.column_mut(1).copy_from_slice(known);
                }
                columns.column_mut(2).fill(1.0);
                let width = self.rows.width(joint);
                for place in 0..width {
                    columns
                        .column_mut(BEFORE + place)
                        .copy_from_slice(self.rows.column(joint, place));
                }
                for (place, column) in more(window, JointIndex(joint)).iter().enumerate() {
                    columns.column_mut(BEFORE + width + place).copy_from_slice(column);
                }
                let mut counted = torque.len();
                if let Some(counts) = self.windows[window].counts(JointIndex(joint)) {
                    for at in (0..counts.len()).filter(|&at| !counts[at]) {
                        columns.row_mut(at).fill(0.0);
                        counted -= 1;
                    }
                }
                own.products += columns.tr_mul(&columns);
                own.rows += counted;
            }
        }
        let measured = |mut own: JointRows| {
            own.products /= own.rows.max(1) as f64;
            (own.square() > 0.0).then_some(own)
        };
        all.into_iter().map(measured).collect()
    }

    /// The rows of each joint under a reading, with a column for each line: what a step of 1 along
    /// it adds to what the torques are, less what phi makes of the motion.
    pub(super) fn rows_along(
        &mut self,
        reading: &Reading,
        lines: &[Misreading],
        phi: &DVector<f64>,
    ) -> Vec<Option<JointRows>> {
        let n = self.model.joints.len();
        let mut slopes: Vec<Vec<Vec<Vec<f64>>>> = Vec::new();
        for window in 0..self.windows.len() {
            let mut own = vec![Vec::new(); n];
            for line in lines {
                let step = line.step();
                let [above, below] = [step, -step].map(|by| {
                    let other = reading.with(line.of_size(by), &self.model.joints);
                    self.read(window, &other);
                    (0..n)
                        .map(|joint| self.left(window, &other, JointIndex(joint), phi))
                        .collect::<Vec<_>>()
                });
                for (own, (above, below)) in own.iter_mut().zip(above.into_iter().zip(below)) {
                    let slope = |(above, below): (f64, f64)| (below - above) / (2.0 * step);
                    own.push(above.into_iter().zip(below).map(slope).collect::<Vec<f64>>());
                }
                if let Misreading::TorqueGain(joint, _) = *line {
                    // of the torque that phi makes: the measured one times 0 would explain all
                    self.read(window, reading);
                    let measured = self.windows[window].torque(&reading.torques[joint.0]);
                    let left = self.left(window, reading, joint, phi);
                    let made = left.iter().zip(measured.iter().flatten());
                    *own[joint.0].last_mut().expect("it was pushed") =
                        made.map(|(left, measured)| left - measured).collect();
                }
            }
            slopes.push(own);
        }
        self.rows_with(reading, &mut |window, joint| slopes[window][joint.0].clone(), lines.len())
    }

    /// What phi leaves of the torque of a joint, of the rows that were made last; nothing of one
    /// that is not measured.
    fn left(
        &self,
        window: usize,
        reading: &Reading,
        joint: JointIndex,
        phi: &DVector<f64>,
    ) -> Vec<f64> {
        let Some(measured) = self.windows[window].torque(&reading.torques[joint.0]) else {
            return Vec::new();
        };
        let own: Vec<f64> = self.model.pattern()[joint.0].iter().map(|&at| phi[at]).collect();
        let mut left = vec![0.0; measured.len()];
        self.rows.torque(joint.0, &own, &mut left);
        left.iter_mut().zip(&measured).for_each(|(left, torque)| *left = torque - *left);
        self.count(window, joint, &mut left);
        left
    }

    /// Makes 0 of what does not count.
    fn count(&self, window: usize, joint: JointIndex, values: &mut [f64]) {
        let counts = self.windows[window].counts(joint).unwrap_or_default();
        let left_out = values.iter_mut().zip(counts).filter(|(_, counts)| !**counts);
        left_out.for_each(|(value, _)| *value = 0.0);
    }

    /// The share of each joint's torque that phi leaves, as roots of mean squares.
    pub(super) fn left_by(&mut self, reading: &Reading, phi: &DVector<f64>) -> Vec<Option<f64>> {
        let mut sums = vec![[0.0; 2]; self.model.joints.len()];
        for window in 0..self.windows.len() {
            self.read(window, reading);
            for (joint, [left, all]) in sums.iter_mut().enumerate() {
                let source = &reading.torques[joint];
                let joint = JointIndex(joint);
                let mut torque = self.windows[window].torque(source).unwrap_or_default();
                self.count(window, joint, &mut torque);
                let square = |values: &[f64]| values.iter().map(|one| one * one).sum::<f64>();
                *left += square(&self.left(window, reading, joint, phi));
                *all += square(&torque);
            }
        }
        let share = |[left, all]: [f64; 2]| (all > 0.0).then(|| (left / all).sqrt());
        sums.into_iter().map(share).collect()
    }

    /// How many samples of each torque that is measured are independent of each other: by how long
    /// what phi leaves is like itself, and no more than the filter lets be.
    pub(super) fn independent(&mut self, reading: &Reading, phi: &DVector<f64>) -> Vec<f64> {
        let n = self.model.joints.len();
        let mut alike = vec![vec![0.0; BLOCK]; n];
        let mut rows = vec![0.0; n];
        for window in 0..self.windows.len() {
            self.read(window, reading);
            for joint in 0..n {
                let left = self.left(window, reading, JointIndex(joint), phi);
                rows[joint] += left.iter().filter(|left| **left != 0.0).count() as f64;
                for (lag, sum) in alike[joint].iter_mut().enumerate().take(left.len()) {
                    *sum += left.iter().zip(&left[lag..]).map(|(a, b)| a * b).sum::<f64>();
                }
            }
        }
        let by_filter = self.independent_by_filter().into_iter().fold(f64::INFINITY, f64::min);
        let measured = (0..n).filter(|&joint| rows[joint] > 0.0);
        measured
            .map(|joint| by_filter.min(rows[joint] / time_alike(&alike[joint])).max(1.0))
            .collect()
    }
}
