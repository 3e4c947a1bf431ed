//! How far measured and computed torques are apart, as one number (docs/reference/diagnosis.md).

use super::data::{Data, Stretch};
use super::floor::{NoiseFloor, rms};

/// gap = sqrt(mean over joints and springs of (rms of what is left / rms of the torque)^2).
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// Over all joints.
    pub all: f64,
    /// For each joint, then for each spring; none where nothing was measured.
    pub per_joint: Vec<Option<f64>>,
}

impl Gap {
    /// The gap of what is left in the rows of data.
    pub(super) fn new(data: &Data<'_>, residual: &[f64]) -> Self {
        Self::of(data, |row, _| residual[row].powi(2))
    }

    /// The gap that noise alone leaves.
    pub(super) fn of_floor(data: &Data<'_>, floors: &[NoiseFloor]) -> Self {
        Self::of(data, |_, stretch| floors[stretch.log.0][stretch.equation].powi(2))
    }

    fn of(data: &Data<'_>, left: impl Fn(usize, &Stretch) -> f64) -> Self {
        let of = |equation: usize| {
            let own = data.stretches.iter().filter(|stretch| stretch.equation == equation);
            let rows = own.flat_map(|stretch| stretch.range().map(move |row| (row, stretch)));
            let (mut over, mut under) = (0.0, 0.0);
            for (row, stretch) in rows {
                over += left(row, stretch);
                under += data.torque[row].powi(2);
            }
            (under > 0.0).then(|| (over / under).sqrt())
        };
        let equations = 0..data.nominal.equations();
        let per_joint: Vec<Option<f64>> = equations.map(of).collect();
        let known: Vec<f64> = per_joint.iter().flatten().copied().collect();
        Self { all: rms(&known), per_joint }
    }
}

/// The share of the gap that can be closed that was closed: 1 if only noise is left, or less.
///
/// (before - after) / (before - floor); none where there is nothing to close.
pub fn share_closed(before: f64, after: f64, floor: f64) -> Option<f64> {
    (before > floor).then(|| ((before - after) / (before - floor)).min(1.0))
}
