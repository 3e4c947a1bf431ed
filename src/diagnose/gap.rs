//! How far measured and computed torques are apart, as one number (docs/diagnosis.md).

use super::data::{Data, Stretch};
use super::floor::{NoiseFloor, rms};

/// gap = sqrt(mean over joints of (rms of what is left / rms of the torque)^2).
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// Over all joints.
    pub all: f64,
    /// For each joint; none where no torque was measured.
    pub per_joint: Vec<Option<f64>>,
}

impl Gap {
    /// The gap of what is left in the rows of data.
    pub fn new(data: &Data<'_>, residual: &[f64]) -> Self {
        let square = |values: &[f64], stretch: &Stretch| -> f64 {
            let part = &values[stretch.first..stretch.first + stretch.rows];
            part.iter().map(|value| value * value).sum()
        };
        Self::of(data, |stretch| square(residual, stretch), |stretch| square(&data.torque, stretch))
    }

    /// The gap that noise leaves, and what is not known of friction where joints turn around.
    pub fn of_floor(data: &Data<'_>, floors: &[NoiseFloor], turning: &[f64]) -> Self {
        let noise = |stretch: &Stretch| -> f64 {
            let floor = floors[stretch.log].deviation[stretch.joint];
            let rows = &turning[stretch.first..stretch.first + stretch.rows];
            rows.iter().map(|unsure| floor * floor + unsure * unsure).sum()
        };
        let torque = |stretch: &Stretch| {
            let part = &data.torque[stretch.first..stretch.first + stretch.rows];
            stretch.rows as f64 * rms(part).powi(2)
        };
        Self::of(data, noise, torque)
    }

    fn of(
        data: &Data<'_>,
        left: impl Fn(&Stretch) -> f64,
        torque: impl Fn(&Stretch) -> f64,
    ) -> Self {
        let of_joint = |joint: usize| {
            let own = || data.stretches.iter().filter(|stretch| stretch.joint == joint);
            let torque: f64 = own().map(&torque).sum();
            let left: f64 = own().map(&left).sum();
            (torque > 0.0).then(|| (left / torque).sqrt())
        };
        let joints = data.nominal.model.joints.len();
        let per_joint: Vec<Option<f64>> = (0..joints).map(of_joint).collect();
        let known: Vec<f64> = per_joint.iter().flatten().copied().collect();
        Self { all: rms(&known), per_joint }
    }
}

/// The share of the gap that can be closed that was closed: 1 if only noise is left.
///
/// (before - after) / (before - floor); none where there is nothing to close.
pub fn share_closed(before: f64, after: f64, floor: f64) -> Option<f64> {
    (before > floor).then(|| (before - after) / (before - floor))
}
