//! How far measured and computed torques are apart, as one number (docs/reference/diagnosis.md).

use super::data::{Data, Stretch};
use super::floor::{NoiseFloor, rms};

/// gap = sqrt(mean over joints and springs of (rms of what is left / rms of the torque)^2).
///
/// Rows count alike, or for what is known of them: what friction does while it turns around or
/// rests no model tells.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// Over all joints.
    pub all: f64,
    /// For each joint, then for each spring; none where nothing was measured.
    pub per_joint: Vec<Option<f64>>,
}

impl Gap {
    /// The gap of what is left in the rows of data, which count alike.
    pub(super) fn new(data: &Data<'_>, residual: &[f64]) -> Self {
        Self::of(data, |_| 1.0, |row, _| residual[row].powi(2))
    }

    /// The gap that noise alone leaves.
    pub(super) fn of_floor(data: &Data<'_>, floors: &[NoiseFloor]) -> Self {
        Self::of(data, |_| 1.0, |_, stretch| floors[stretch.log.0][stretch.equation].powi(2))
    }

    fn of(
        data: &Data<'_>,
        weight: impl Fn(usize) -> f64,
        left: impl Fn(usize, &Stretch) -> f64,
    ) -> Self {
        let of = |equation: usize| {
            let own = data.stretches.iter().filter(|stretch| stretch.equation == equation);
            let rows = own.flat_map(|stretch| stretch.range().map(move |row| (row, stretch)));
            let (mut over, mut under) = (0.0, 0.0);
            for (row, stretch) in rows {
                over += weight(row).powi(2) * left(row, stretch);
                under += (weight(row) * data.torque[row]).powi(2);
            }
            (under > 0.0).then(|| (over / under).sqrt())
        };
        let equations = 0..data.nominal.equations();
        let per_joint: Vec<Option<f64>> = equations.map(of).collect();
        let known: Vec<f64> = per_joint.iter().flatten().copied().collect();
        Self { all: rms(&known), per_joint }
    }
}

/// Gaps of rows that count for what is known of them.
pub(super) struct Known<'d> {
    data: &'d Data<'d>,
    floor: f64,
}

impl<'d> Known<'d> {
    /// Those of data with floors.
    pub(super) fn new(data: &'d Data<'d>, floors: &[NoiseFloor]) -> Self {
        let of_stretch = |_, stretch: &Stretch| floors[stretch.log.0][stretch.equation].powi(2);
        let floor = Gap::of(data, |row| data.weights[row], of_stretch).all;
        Self { data, floor }
    }

    /// The gap of what is left.
    pub(super) fn gap(&self, residual: &[f64]) -> f64 {
        let data = self.data;
        Gap::of(data, |row| data.weights[row], |row, _| residual[row].powi(2)).all
    }

    /// The gap between what was left before and after that noise does not make.
    pub(super) fn closable(&self, [before, after]: [&[f64]; 2]) -> f64 {
        let [before, after] = [before, after].map(|residual| self.gap(residual));
        // where all was below the floor already, what was closed
        (before - self.floor).max(before - after).max(f64::MIN_POSITIVE)
    }

    /// The share of the gap that can be closed that was closed: 1 if only noise is left, or less;
    /// none where there is nothing to close.
    pub(super) fn share_closed(&self, [before, after]: [&[f64]; 2]) -> Option<f64> {
        let [before, after] = [before, after].map(|residual| self.gap(residual));
        share_closed(before, after, self.floor)
    }
}

/// The share of a gap that can be closed that was closed: 1 if only noise is left, or less.
///
/// (before - after) / (before - floor); none where there is nothing to close.
pub fn share_closed(before: f64, after: f64, floor: f64) -> Option<f64> {
    (before > floor).then(|| ((before - after) / (before - floor)).min(1.0))
}
