//! How columns of a log are read, and how they could have to be read instead.

use crate::plants::regression::{RegressionJoint, RegressionModel};
use std::f64::consts::PI;
use std::fmt;

/// Units that are another power of ten.
const POWERS: [f64; 6] = [1e-3, 1e-2, 0.1, 10.0, 100.0, 1e3];

/// Degrees that were taken for radians, and radians for degrees.
const OF_ANGLES: [f64; 2] = [PI / 180.0, 180.0 / PI];

/// Lengths in mm or cm, and metres taken for these.
const OF_LENGTHS: [f64; 4] = [1e-3, 1e-2, 100.0, 1e3];

/// Which columns of two joints have each other's names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExchangedColumns {
    /// Their positions.
    Positions,
    /// Their torques.
    Torques,
    /// Both: one joint has the name of the other.
    Both,
}

/// One way in which columns can be other ones than they are taken for. Joints are numbers of the
/// model's; factors are what columns are to be multiplied with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Misreading {
    /// The time is in another unit.
    Time(f64),
    /// All torques are in another unit, or all of the other sign.
    Torques(f64),
    /// All torques are of the motors; or, if false, of the joints, and were taken for the motors'.
    TorquesOfMotors(bool),
    /// The torque of a joint is in another unit, of the other side of its gear, or of the other
    /// sign.
    Torque(usize, f64),
    /// All positions of joints that turn are in another unit, or all positions of the other sign.
    Angles(f64),
    /// All positions of joints that slide are in another unit.
    Lengths(f64),
    /// The position of a joint is in another unit, or of the other sign.
    Position(usize, f64),
    /// Columns of two joints have each other's names.
    Exchanged([usize; 2], ExchangedColumns),
    /// Torques are so many samples late.
    Late(isize),
}

impl Misreading {
    /// Whether it is of all joints alike: what is off by one mistake.
    pub(super) fn is_of_all(self) -> bool {
        use Misreading::{Angles, Lengths, Time, Torques, TorquesOfMotors};
        matches!(self, Time(_) | Torques(_) | TorquesOfMotors(_) | Angles(_) | Lengths(_))
    }

    /// The joints whose own torque must be explained then.
    pub(super) fn torques_of(self) -> Vec<usize> {
        match self {
            Self::Torque(joint, _) => vec![joint],
            Self::Exchanged(both, columns) if columns != ExchangedColumns::Positions => {
                both.to_vec()
            }
            _ => Vec::new(),
        }
    }

    /// Whether it makes less of noise of the positions, whatever is true.
    fn hides_noise(self) -> bool {
        match self {
            Self::Time(factor) => factor > 1.0,
            Self::Angles(factor) | Self::Lengths(factor) | Self::Position(_, factor) => {
                factor.abs() < 1.0
            }
            _ => false,
        }
    }

    /// What the log is with it, in words of [`MisreadColumns`](super::MisreadColumns).
    pub(super) fn describe(
        self,
        f: &mut fmt::Formatter<'_>,
        (names, step_s): (&[String], f64),
    ) -> fmt::Result {
        let name = |joint: usize| names[joint].as_str();
        match self {
            Self::Time(_) => write!(f, "the time seems to be in another unit"),
            Self::Torques(-1.0) => write!(f, "all torques seem to have the wrong sign"),
            Self::Torques(_) => write!(f, "torques seem to be in another unit"),
            Self::TorquesOfMotors(true) => {
                write!(f, "torques seem to be those of the motors, before their gears")
            }
            Self::TorquesOfMotors(false) => {
                write!(f, "torques seem to be those of the joints, not of the motors")
            }
            Self::Torque(joint, -1.0) => {
                write!(f, "the torque of {} seems to have the wrong sign", name(joint))
            }
            Self::Torque(joint, _) => {
                write!(f, "the torque of {} seems to be in another unit", name(joint))
            }
            Self::Angles(-1.0) => write!(f, "all positions seem to have the wrong sign"),
            Self::Angles(factor) if factor < 1.0 => {
                write!(f, "positions seem to be in another unit, degrees")
            }
            Self::Angles(_) => {
                write!(f, "positions seem to be radians that were taken for degrees")
            }
            Self::Lengths(_) => {
                write!(f, "positions of joints that slide seem to be in another unit")
            }
            Self::Position(joint, -1.0) => {
                write!(f, "the position of {} seems to have the wrong sign", name(joint))
            }
            Self::Position(joint, _) => {
                write!(f, "the position of {} seems to be in another unit", name(joint))
            }
            Self::Exchanged([a, b], columns) => {
                let what = match columns {
                    ExchangedColumns::Positions => "the positions",
                    ExchangedColumns::Torques => "the torques",
                    ExchangedColumns::Both => "positions and torques",
                };
                write!(f, "{what} of {} and {} seem to be exchanged", name(a), name(b))
            }
            Self::Late(samples) => {
                let late = samples as f64 * step_s;
                let how = if late < 0.0 { "early" } else { "late" };
                write!(f, "torques seem to be {:.4} s {how}", late.abs())
            }
        }
    }

    /// How to mend it.
    pub(super) fn hint(self, names: &[String]) -> String {
        let scale = |column: &str, factor: f64| {
            let factor =
                if factor == OF_ANGLES[0] { "0.0174532925".into() } else { factor.to_string() };
            format!("--columns with {{\"{column}\": {{\"scale\": {factor}}}}} mends that")
        };
        match self {
            Self::Time(factor) => scale("t", factor),
            Self::Torques(factor) => scale("tau_JOINT", factor),
            Self::TorquesOfMotors(is_motor) => {
                let side = if is_motor { "motor" } else { "joint" };
                format!("`# torque_side: {side}` in the log's header, or the model's, says that")
            }
            Self::Torque(joint, factor) => scale(&format!("tau_{}", names[joint]), factor),
            Self::Angles(factor) | Self::Lengths(factor) => scale("q_JOINT", factor),
            Self::Position(joint, factor) => scale(&format!("q_{}", names[joint]), factor),
            Self::Exchanged(..) => "--columns can name them the other way round".to_owned(),
            Self::Late(_) => {
                "shift them against the positions; friction that the model lacks may look alike"
                    .to_owned()
            }
        }
    }
}

/// Which column each signal is taken from, and times what.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reading {
    pub(super) time: f64,
    pub(super) positions: Vec<(usize, f64)>,
    pub(super) torques: Vec<(usize, f64)>,
    /// Samples by which torques are late, before decimation.
    pub(super) late: isize,
}

impl Reading {
    /// As the log says it.
    pub(super) fn straight(joints: usize) -> Self {
        let own: Vec<(usize, f64)> = (0..joints).map(|joint| (joint, 1.0)).collect();
        Self { time: 1.0, positions: own.clone(), torques: own, late: 0 }
    }

    /// The same with one more mistake mended.
    pub(super) fn with(&self, one: Misreading, joints: &[RegressionJoint]) -> Self {
        let mut new = self.clone();
        let all = 0..joints.len();
        match one {
            Misreading::Time(factor) => new.time *= factor,
            Misreading::Torques(factor) => all.for_each(|joint| new.torques[joint].1 *= factor),
            Misreading::TorquesOfMotors(is_motor) => {
                for joint in all.filter(|&joint| is_geared(&joints[joint])) {
                    let ratio = joints[joint].gear_ratio;
                    new.torques[joint].1 *= if is_motor { ratio } else { 1.0 / ratio };
                }
            }
            Misreading::Torque(joint, factor) => new.torques[joint].1 *= factor,
            Misreading::Angles(factor) => {
                let is_meant = |joint: &usize| factor == -1.0 || !joints[*joint].slides;
                all.filter(is_meant).for_each(|joint| new.positions[joint].1 *= factor);
            }
            Misreading::Lengths(factor) => {
                all.filter(|&joint| joints[joint].slides)
                    .for_each(|joint| new.positions[joint].1 *= factor);
            }
            Misreading::Position(joint, factor) => new.positions[joint].1 *= factor,
            Misreading::Exchanged([a, b], columns) => {
                if columns != ExchangedColumns::Torques {
                    new.positions.swap(a, b);
                }
                if columns != ExchangedColumns::Positions {
                    new.torques.swap(a, b);
                }
            }
            Misreading::Late(samples) => new.late += samples,
        }
        new
    }
}

/// Whether torques of its motor and its axis are another.
fn is_geared(joint: &RegressionJoint) -> bool {
    let ratio = joint.gear_ratio;
    !joint.is_elastic && !joint.is_base && ratio.is_finite() && ratio != 0.0 && ratio != 1.0
}

/// All that is tried; single columns only if they are asked for, and torques of joints of which
/// some were measured. In noisy logs nothing is tried
/// that merely makes less of the noise.
pub(super) fn hypotheses(
    model: &RegressionModel,
    is_measured: &dyn Fn(usize) -> bool,
    [single, is_noisy]: [bool; 2],
) -> Vec<Misreading> {
    use Misreading::{
        Angles, Exchanged, Lengths, Position, Time, Torque, Torques, TorquesOfMotors,
    };
    let joints = &model.joints;
    let mut tried: Vec<Misreading> = POWERS.into_iter().map(Time).collect();
    tried.extend(POWERS.into_iter().chain([-1.0]).map(Torques));
    if joints.iter().any(is_geared) {
        tried.extend([true, false].map(TorquesOfMotors));
    }
    let real: Vec<usize> = (0..joints.len()).filter(|&joint| !joints[joint].is_base).collect();
    let count = |slides: bool| real.iter().filter(|&&joint| joints[joint].slides == slides).count();
    tried.push(Angles(-1.0));
    if count(false) > 0 {
        tried.extend(OF_ANGLES.map(Angles));
    }
    if count(true) > 0 {
        tried.extend(OF_LENGTHS.map(Lengths));
    }
    for (place, &joint) in real.iter().enumerate().filter(|_| single && real.len() > 1) {
        if is_measured(joint) {
            tried.extend(POWERS.into_iter().chain([-1.0]).map(|factor| Torque(joint, factor)));
        }
        if is_measured(joint) && is_geared(&joints[joint]) {
            let ratio = joints[joint].gear_ratio;
            tried.extend([ratio, 1.0 / ratio].map(|factor| Torque(joint, factor)));
        }
        let slides = joints[joint].slides;
        let units = if slides { &OF_LENGTHS[..] } else { &OF_ANGLES[..] };
        let units = units.iter().copied().filter(|_| count(slides) > 1);
        tried.extend(units.chain([-1.0]).map(|factor| Position(joint, factor)));
        for &other in real[..place].iter().filter(|&&other| joints[other].slides == slides) {
            use ExchangedColumns::{Both, Positions, Torques};
            tried.push(Exchanged([other, joint], Positions));
            if is_measured(joint) && is_measured(other) {
                tried.extend([Torques, Both].map(|one| Exchanged([other, joint], one)));
            }
        }
    }
    tried.retain(|one| !(is_noisy && one.hides_noise()));
    tried
}
