//! Mistakes of columns that differ by a number: how late a signal is, how far off a zero, a
//! constant or a gain.

use super::super::policy;
use super::misreading::Misreading;
use denavit_measure::JointIndex;

/// A mistake whose size is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Line {
    Late,
    LateTorque(JointIndex),
    LatePosition(JointIndex),
    Zero(JointIndex),
    Offset(JointIndex),
    Gain(JointIndex),
}

impl Line {
    /// The mistake of a size: samples, rad or m, N m or N, and the logarithm of a factor.
    pub(super) fn at(self, size: f64) -> Misreading {
        let samples = size.round() as isize;
        match self {
            Self::Late => Misreading::Late(samples),
            Self::LateTorque(joint) => Misreading::LateTorque(joint, samples),
            Self::LatePosition(joint) => Misreading::LatePosition(joint, samples),
            Self::Zero(joint) => Misreading::Zero(joint, size),
            Self::Offset(joint) => Misreading::TorqueOffset(joint, size),
            Self::Gain(joint) => Misreading::TorqueGain(joint, size.exp()),
        }
    }

    /// Whether its size is a number of samples.
    pub(super) fn is_late(self) -> bool {
        matches!(self, Self::Late | Self::LateTorque(_) | Self::LatePosition(_))
    }

    /// Half the difference that a slope is found with.
    pub(super) fn step(self) -> f64 {
        match self.is_late() {
            true => 1.0,
            false => policy::SLOPE_STEP,
        }
    }

    /// What is believed of its size: a deviation, where signals have samples of so many seconds and
    /// joints torques of some size.
    pub(super) fn deviation(self, step_s: f64, torque: &[f64]) -> f64 {
        match self {
            Self::Late | Self::LateTorque(_) | Self::LatePosition(_) => policy::LATE_S / step_s,
            Self::Zero(_) => policy::ZERO,
            Self::Offset(joint) => policy::OFFSET * torque[joint.0],
            Self::Gain(_) => policy::GAIN,
        }
    }
}
