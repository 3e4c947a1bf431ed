//! The ways in which columns can be other ones than they are taken for, and how each is said.

use super::policy;
use super::reading::{OF_ANGLES, Signal};
use denavit_measure::JointIndex;
use denavit_measure::log::ColumnMapping;
use denavit_plants::regression::RegressionJoint;
use std::fmt;

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

/// One way in which columns can be other ones than they are taken for. Factors are what columns are
/// to be multiplied with.
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
    Torque(JointIndex, f64),
    /// All positions of joints that turn are in another unit, or all positions of the other sign.
    Angles(f64),
    /// All positions of joints that slide are in another unit.
    Lengths(f64),
    /// The position of a joint is in another unit, or of the other sign.
    Position(JointIndex, f64),
    /// The position of a joint is counted from another zero: what is to be added to it [rad, m].
    Zero(JointIndex, f64),
    /// The torque of a joint is off by a constant: what is to be added to it [N m, N].
    TorqueOffset(JointIndex, f64),
    /// The torque of a joint is scaled: what it is to be multiplied with.
    TorqueGain(JointIndex, f64),
    /// Columns of two joints have each other's names.
    Exchanged([JointIndex; 2], ExchangedColumns),
    /// Torques are so many samples late.
    Late(isize),
    /// The torque of a joint is so many samples late.
    LateTorque(JointIndex, isize),
    /// The position of a joint is so many samples late.
    LatePosition(JointIndex, isize),
}

impl Misreading {
    /// Whether something is late.
    pub(super) fn is_late(self) -> bool {
        matches!(self, Self::Late(_) | Self::LateTorque(..) | Self::LatePosition(..))
    }

    /// Whether it is one of many that differ by a number.
    pub(super) fn is_by_degrees(self) -> bool {
        self.is_late()
            || matches!(self, Self::Zero(..) | Self::TorqueOffset(..) | Self::TorqueGain(..))
    }

    /// Whether another is the same mistake, but for how large it is.
    pub(crate) fn is_like(self, other: Self) -> bool {
        self.of_size(0.0) == other.of_size(0.0)
    }

    /// Of those that differ by a number the one of a size: samples, rad or m, N m or N, and the
    /// logarithm of a factor; others as they are.
    pub(super) fn of_size(self, size: f64) -> Self {
        let samples = size.round() as isize;
        match self {
            Self::Late(_) => Self::Late(samples),
            Self::LateTorque(joint, _) => Self::LateTorque(joint, samples),
            Self::LatePosition(joint, _) => Self::LatePosition(joint, samples),
            Self::Zero(joint, _) => Self::Zero(joint, size),
            Self::TorqueOffset(joint, _) => Self::TorqueOffset(joint, size),
            Self::TorqueGain(joint, _) => Self::TorqueGain(joint, size.exp()),
            other => other,
        }
    }

    /// Half the difference of sizes that a slope is found with.
    pub(super) fn step(self) -> f64 {
        if self.is_late() { 1.0 } else { policy::SLOPE_STEP }
    }

    /// What is believed of its size: a deviation, where signals have samples of so many seconds and
    /// joints torques of some size.
    pub(super) fn deviation(self, step_s: f64, torque: &[f64]) -> f64 {
        match self {
            _ if self.is_late() => policy::LATE_S / step_s,
            Self::TorqueOffset(joint, _) => policy::OFFSET * torque[joint.0],
            Self::TorqueGain(..) => policy::GAIN,
            _ => policy::ZERO,
        }
    }

    /// The joints whose positions alone it is of.
    pub(super) fn positions_of(self) -> Vec<JointIndex> {
        match self {
            Self::Position(joint, _) => vec![joint],
            Self::Exchanged(both, ExchangedColumns::Positions) => both.to_vec(),
            _ => Vec::new(),
        }
    }

    /// Whether it makes less of noise of the positions, or of their derivatives, whatever is true.
    pub(super) fn hides_noise(self) -> bool {
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
        joints: &[RegressionJoint],
        step_s: f64,
    ) -> fmt::Result {
        let of_all = |what: &str, factor: f64| match factor == -1.0 {
            true => format!("all {what} seem"),
            false => format!("{what} seem"),
        };
        let of_joint =
            |what: &str, joint: JointIndex| format!("the {what} of {} seems", joints[joint.0].name);
        let what = match self {
            Self::Time(_) => "the time seems".to_owned(),
            Self::Torques(factor) => of_all("torques", factor),
            Self::TorquesOfMotors(_) | Self::Late(_) => "torques seem".to_owned(),
            Self::Angles(factor) => of_all("positions", factor),
            Self::Lengths(_) => "positions of joints that slide seem".to_owned(),
            Self::Torque(joint, _)
            | Self::LateTorque(joint, _)
            | Self::TorqueOffset(joint, _)
            | Self::TorqueGain(joint, _) => of_joint("torque", joint),
            Self::Position(joint, _) | Self::Zero(joint, _) | Self::LatePosition(joint, _) => {
                of_joint("position", joint)
            }
            Self::Exchanged([a, b], columns) => {
                let what = match columns {
                    ExchangedColumns::Positions => "the positions",
                    ExchangedColumns::Torques => "the torques",
                    ExchangedColumns::Both => "positions and torques",
                };
                format!("{what} of {} and {} seem", joints[a.0].name, joints[b.0].name)
            }
        };
        write!(f, "{what} to {}", self.predicate(joints, step_s))
    }

    /// What its columns seem to be or have.
    fn predicate(self, joints: &[RegressionJoint], step_s: f64) -> String {
        let words = match self {
            Self::Angles(factor) if factor > 1.0 => "be radians that were taken for degrees",
            Self::Angles(factor) if factor > 0.0 => "be in another unit, degrees",
            Self::Torques(-1.0)
            | Self::Torque(_, -1.0)
            | Self::Angles(_)
            | Self::Position(_, -1.0) => "have the wrong sign",
            Self::Time(_)
            | Self::Torques(_)
            | Self::Torque(..)
            | Self::Lengths(_)
            | Self::Position(..) => "be in another unit",
            Self::TorquesOfMotors(true) => "be those of the motors, before their gears",
            Self::TorquesOfMotors(false) => "be those of the joints, not of the motors",
            Self::Exchanged(..) => "be exchanged",
            Self::Zero(joint, offset) | Self::TorqueOffset(joint, offset) => {
                let (size, is_zero) = (offset.abs(), matches!(self, Self::Zero(..)));
                let unit = match (is_zero, joints[joint.0].slides) {
                    (true, false) => format!("rad ({:.1} degrees)", size.to_degrees()),
                    (true, true) => "m".to_owned(),
                    (false, false) => "N m".to_owned(),
                    (false, true) => "N".to_owned(),
                };
                let side = if offset < 0.0 { "above" } else { "below" };
                return format!("be {size:.4} {unit} {side} its true value, all the time");
            }
            Self::TorqueGain(_, factor) => {
                return format!(
                    "be {:.4} times its true value, or all others to be {factor:.4} times theirs",
                    1.0 / factor
                );
            }
            Self::Late(samples) | Self::LateTorque(_, samples) | Self::LatePosition(_, samples) => {
                let late_s = samples as f64 * step_s;
                let how = if late_s < 0.0 { "early" } else { "late" };
                return format!("be {:.4} s {how}", late_s.abs());
            }
        };
        words.to_owned()
    }

    /// How to mend it, beside what is mapped already.
    pub(super) fn hint(self, joints: &[RegressionJoint], given: &ColumnMapping) -> String {
        let mends = |column: &str, what: &str, number: String| {
            let own = given.source(column).map(|own| own.column).filter(|own| own != column);
            let own = own.map_or_else(String::new, |own| format!("\"column\": {own:?}, "));
            let new = format!("{{\"{column}\": {{{own}\"{what}\": {number}}}}}");
            format!("`logs.columns` with {new} mends that")
        };
        let scale = |column: &str, factor: f64| {
            let (prefix, is_of_all) = match column.strip_suffix("JOINT") {
                Some(prefix) => (prefix, true),
                None => (column, false),
            };
            let own = given.source(column).filter(|_| !is_of_all);
            let number = factor * own.as_ref().map_or(1.0, |own| own.scale);
            let number = match number == OF_ANGLES[0] {
                true => "0.0174532925".to_owned(),
                // seven digits, in the shortest form
                false => format!("{number:.6e}").parse::<f64>().unwrap_or(number).to_string(),
            };
            let hint = mends(column, "scale", number);
            let has_scale = |name: &str| given.source(name).is_some_and(|one| one.scale != 1.0);
            let scaled = |name: &&str| name.starts_with(prefix) && has_scale(name);
            match (is_of_all && given.names().any(|name| scaled(&name)), own) {
                (true, _) => hint + ", times the scale that a column has already",
                (false, Some(own)) if own.offset != 0.0 => {
                    hint + &format!(", with an offset of {}", factor * own.offset)
                }
                _ => hint,
            }
        };
        let offset = |column: &str, by: f64| {
            let own = given.source(column).map_or(0.0, |own| own.offset);
            mends(column, "offset", format!("{:.5}", own + by))
        };
        let of = |signal: Signal, joint: JointIndex| {
            format!("{}{}", signal.prefix(), joints[joint.0].name)
        };
        match self {
            Self::Time(factor) => scale("t", factor),
            Self::Torques(factor) => scale("tau_JOINT", factor),
            Self::TorquesOfMotors(is_motor) => {
                let side = if is_motor { "motor" } else { "joint" };
                format!("`# torque_side: {side}` in the log's header, or the model's, says that")
            }
            Self::Torque(joint, factor) => scale(&of(Signal::Torque, joint), factor),
            Self::TorqueGain(joint, factor) => {
                let factor = (factor * 1e4).round() / 1e4;
                scale(&of(Signal::Torque, joint), factor) + ", if it is that one"
            }
            Self::Angles(factor) | Self::Lengths(factor) => scale("q_JOINT", factor),
            Self::Position(joint, factor) => scale(&of(Signal::Position, joint), factor),
            Self::Zero(joint, by) => {
                let column = of(Signal::Position, joint);
                offset(&column, by) + ", if the model's zero is that of the robot"
            }
            Self::TorqueOffset(joint, by) => {
                let column = of(Signal::Torque, joint);
                "`options.with=friction,offset` estimates it; ".to_owned() + &offset(&column, by)
            }
            Self::Exchanged(..) => "`logs.columns` can name them the other way round".to_owned(),
            Self::Late(_) | Self::LateTorque(..) | Self::LatePosition(..) => {
                "shift them against the others; friction that the model lacks may look alike"
                    .to_owned()
            }
        }
    }
}
