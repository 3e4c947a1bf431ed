//! How far measured and computed torques are apart, as one number (docs/reference/diagnosis.md).

use super::data::{Data, Stretch};
use super::floor::{NoiseFloor, rms};

/// What a row counts.
pub(super) type Weight<'w> = &'w dyn Fn(usize) -> f64;

/// gap = sqrt(mean over joints and springs of (rms of what is left / rms of the torque)^2).
///
/// Rows count alike, or for what is known of them: no model tells what friction is at velocity
/// reversals and rests.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gap {
    /// Over all joints.
    pub all: f64,
    /// For each joint, then for each spring; none where nothing was measured.
    pub per_joint: Vec<Option<f64>>,
}

impl Gap {
    /// The gap of what is left in the rows of data, by what they count.
    pub(super) fn new(data: &Data<'_>, residual: &[f64], weight: Weight<'_>) -> Self {
        Self::of(data, weight, |row, _| residual[row].powi(2))
    }

    /// The gap that noise alone leaves.
    pub(super) fn of_floor(data: &Data<'_>, floors: &[NoiseFloor], weight: Weight<'_>) -> Self {
        Self::of(data, weight, |_, stretch| floors[stretch.log.0][stretch.equation].powi(2))
    }

    fn of(data: &Data<'_>, weight: Weight<'_>, left: impl Fn(usize, &Stretch) -> f64) -> Self {
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

/// The share of a gap that can be closed that was closed: 1 if only noise is left, or less.
///
/// (before - after) / (before - floor); none where there is nothing to close.
pub fn share_closed(before: f64, after: f64, floor: f64) -> Option<f64> {
    (before > floor).then(|| ((before - after) / (before - floor)).min(1.0))
}
