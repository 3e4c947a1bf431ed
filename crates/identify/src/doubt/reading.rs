//! How columns of a log are read, and how they could have to be read instead.

use super::misreading::{ExchangedColumns, Misreading};
use denavit_measure::JointIndex;
use denavit_plants::regression::{RegressionJoint, RegressionModel};
use std::f64::consts::PI;

/// Units that are another power of ten.
const POWERS: [f64; 6] = [1e-3, 1e-2, 0.1, 10.0, 100.0, 1e3];

/// Minutes and hours, ticks of 60 a second, and seconds taken for these.
const OF_TIMES: [f64; 4] = [60.0, 3600.0, 1.0 / 60.0, 1.0 / 3600.0];

/// Degrees that were taken for radians, and radians for degrees.
pub(super) const OF_ANGLES: [f64; 2] = [PI / 180.0, 180.0 / PI];

/// Lengths in mm or cm, and metres taken for these.
const OF_LENGTHS: [f64; 4] = [1e-3, 1e-2, 100.0, 1e3];

/// What is measured of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Signal {
    Position,
    Torque,
}

impl Signal {
    /// What the names of its columns begin with.
    pub(super) fn prefix(self) -> &'static str {
        match self {
            Self::Position => "q_",
            Self::Torque => "tau_",
        }
    }
}

/// What a signal is: a column, times a factor, plus an offset, so many samples late (before
/// decimation).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Source {
    pub(super) column: usize,
    pub(super) factor: f64,
    pub(super) offset: f64,
    pub(super) late: isize,
}

impl Source {
    fn scale(&mut self, factor: f64) {
        self.factor *= factor;
        self.offset *= factor;
    }
}

/// What each signal is.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reading {
    pub(super) time: f64,
    pub(super) positions: Vec<Source>,
    pub(super) torques: Vec<Source>,
}

impl Reading {
    /// As the log says it.
    pub(super) fn straight(joints: usize) -> Self {
        let own = |column: usize| Source { column, factor: 1.0, offset: 0.0, late: 0 };
        let own: Vec<Source> = (0..joints).map(own).collect();
        Self { time: 1.0, positions: own.clone(), torques: own }
    }

    /// The same with one more mistake mended.
    pub(super) fn with(&self, one: Misreading, joints: &[RegressionJoint]) -> Self {
        let mut new = self.clone();
        let all = 0..joints.len();
        match one {
            Misreading::Time(factor) => new.time *= factor,
            Misreading::Torques(factor) => all.for_each(|joint| new.torques[joint].scale(factor)),
            Misreading::TorquesOfMotors(is_motor) => {
                for joint in all.filter(|&joint| is_geared(&joints[joint])) {
                    let ratio = joints[joint].gear_ratio;
                    new.torques[joint].scale(if is_motor { ratio } else { 1.0 / ratio });
                }
            }
            Misreading::Torque(joint, factor) | Misreading::TorqueGain(joint, factor) => {
                new.torques[joint.0].scale(factor);
            }
            Misreading::Angles(factor) => {
                let is_meant = |joint: &usize| factor == -1.0 || !joints[*joint].slides;
                all.filter(is_meant).for_each(|joint| new.positions[joint].scale(factor));
            }
            Misreading::Lengths(factor) => {
                all.filter(|&joint| joints[joint].slides)
                    .for_each(|joint| new.positions[joint].scale(factor));
            }
            Misreading::Position(joint, factor) => new.positions[joint.0].scale(factor),
            Misreading::Zero(joint, offset) => new.positions[joint.0].offset += offset,
            Misreading::TorqueOffset(joint, offset) => new.torques[joint.0].offset += offset,
            Misreading::Exchanged([a, b], columns) => {
                if columns != ExchangedColumns::Torques {
                    new.positions.swap(a.0, b.0);
                }
                if columns != ExchangedColumns::Positions {
                    new.torques.swap(a.0, b.0);
                }
            }
            Misreading::Late(samples) => all.for_each(|joint| new.torques[joint].late += samples),
            Misreading::LateTorque(joint, samples) => new.torques[joint.0].late += samples,
            Misreading::LatePosition(joint, samples) => new.positions[joint.0].late += samples,
        }
        new
    }

    /// The same with torques as their columns are.
    pub(super) fn with_plain_torques(&self) -> Self {
        let mut new = self.clone();
        new.torques.iter_mut().for_each(|one| (one.factor, one.offset) = (1.0, 0.0));
        new
    }

    /// For each joint what is known of the column that is its torque.
    pub(super) fn by_joint<T: Copy>(&self, by_column: &[T]) -> Vec<T> {
        self.torques.iter().map(|torque| by_column[torque.column]).collect()
    }

    /// Whether something was mended by a number of samples.
    pub(super) fn is_shifted(&self) -> bool {
        self.positions.iter().chain(&self.torques).any(|source| source.late != 0)
    }
}

/// Whether torques of its motor and its axis are another.
fn is_geared(joint: &RegressionJoint) -> bool {
    let ratio = joint.gear_ratio;
    !joint.is_elastic && !joint.is_base && ratio.is_finite() && ratio != 0.0 && ratio != 1.0
}

/// All that is tried but what differs by degrees, of joints whose torques are measured or not.
pub(super) fn hypotheses(
    model: &RegressionModel,
    is_measured: &dyn Fn(JointIndex) -> bool,
) -> Vec<Misreading> {
    use Misreading::{
        Angles, Exchanged, Lengths, Position, Time, Torque, Torques, TorquesOfMotors,
    };
    let joints = &model.joints;
    let mut tried: Vec<Misreading> = POWERS.into_iter().chain(OF_TIMES).map(Time).collect();
    tried.extend(POWERS.into_iter().chain([-1.0]).map(Torques));
    if joints.iter().any(is_geared) {
        tried.extend([true, false].map(TorquesOfMotors));
    }
    let all = (0..joints.len()).map(JointIndex);
    let real: Vec<JointIndex> = all.filter(|joint| !joints[joint.0].is_base).collect();
    let count = |slides: bool| real.iter().filter(|joint| joints[joint.0].slides == slides).count();
    tried.push(Angles(-1.0));
    if count(false) > 0 {
        tried.extend(OF_ANGLES.map(Angles));
    }
    if count(true) > 0 {
        tried.extend(OF_LENGTHS.map(Lengths));
    }
    for (place, &joint) in real.iter().enumerate().filter(|_| real.len() > 1) {
        if is_measured(joint) {
            tried.extend(POWERS.into_iter().chain([-1.0]).map(|factor| Torque(joint, factor)));
        }
        if is_measured(joint) && is_geared(&joints[joint.0]) {
            let ratio = joints[joint.0].gear_ratio;
            tried.extend([ratio, 1.0 / ratio].map(|factor| Torque(joint, factor)));
        }
        let slides = joints[joint.0].slides;
        let units = if slides { &OF_LENGTHS[..] } else { &OF_ANGLES[..] };
        let units = units.iter().copied().filter(|_| count(slides) > 1);
        tried.extend(units.chain([-1.0]).map(|factor| Position(joint, factor)));
        for &other in real[..place].iter().filter(|other| joints[other.0].slides == slides) {
            use ExchangedColumns::{Both, Positions, Torques};
            tried.push(Exchanged([other, joint], Positions));
            if is_measured(joint) && is_measured(other) {
                tried.extend([Torques, Both].map(|one| Exchanged([other, joint], one)));
            }
        }
    }
    tried
}
