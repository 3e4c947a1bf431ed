//! What may be wrong with a model and with options, so that no excitation is looked for.

use super::options::DURATIONS_S;
use denavit_codegen::model::BakeError;
use denavit_codegen::program::LowerError;
use std::fmt;

/// A limit of a joint in the model file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitKind {
    /// Lowest and highest position.
    Position,
    /// Largest speed.
    Velocity,
    /// Largest acceleration.
    Acceleration,
    /// Lowest and highest torque.
    Torque,
}

impl LimitKind {
    /// Its key in the model file.
    pub fn key(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Torque => "torque",
        }
    }

    fn example(self) -> &'static str {
        match self {
            Self::Position => "[-0.5, 0.5]",
            Self::Velocity => "2",
            Self::Acceleration => "10",
            Self::Torque => "[-50, 50]",
        }
    }
}

/// Something that is wrong.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ExciteFault {
    /// The model has no regressor.
    Regression(denavit_plants::Error),
    /// Values are missing that torques or points need.
    Bake(BakeError),
    /// A number that no computer arithmetic holds.
    Lower(LowerError),
    /// A joint that moves has no such limit.
    MissingLimit {
        /// The joint.
        joint: String,
        /// The limit.
        limit: LimitKind,
    },
    /// A limit leaves a joint no room.
    NoRoom {
        /// The joint.
        joint: String,
        /// The limit.
        limit: LimitKind,
    },
    /// No joint has this name.
    UnknownJoint {
        /// The option that names it.
        option: &'static str,
        /// The name.
        name: String,
        /// The one that is meant, perhaps.
        nearest: Option<String>,
    },
    /// A joint is held outside its limits.
    HeldOutside {
        /// The joint.
        joint: String,
        /// Where [rad, m].
        position: f64,
    },
    /// The duration is too short or too long.
    Duration(f64),
    /// The motion of starts has no size; holds what was asked for.
    Reach(f64),
    /// A weight is negative or not finite.
    Weight {
        /// The joint.
        joint: String,
        /// The weight.
        weight: f64,
    },
    /// The trajectories of the family that end as asked for do not move.
    TooFewFunctions,
    /// More functions, samples or starts than can be optimised; holds what and how many there may
    /// be.
    TooMany(&'static str, usize),
    /// Fewer than there must be; holds what and how many there must be.
    TooFewOf(&'static str, usize),
    /// No joint moves.
    NothingMoves,
    /// No row of the regressor has a weight, or none of its columns can be excited.
    NothingExcited,
    /// The objective has no weight, or a negative one.
    NoObjective,
}

impl fmt::Display for ExciteFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Regression(error) => write!(f, "{error}"),
            Self::Bake(error) => write!(f, "{error}"),
            Self::Lower(error) => write!(f, "{error}"),
            Self::MissingLimit { joint, limit } => {
                write!(f, "`{joint}` has no {} limit", limit.key())
            }
            Self::NoRoom { joint, limit } => {
                write!(f, "the {} limit of `{joint}` leaves it no room", limit.key())
            }
            Self::UnknownJoint { option, name, .. } => {
                write!(f, "{option}: no joint is called `{name}`")
            }
            Self::HeldOutside { joint, position } => {
                write!(f, "`{joint}` is held at {position}, outside its position limits")
            }
            Self::Duration(duration) => {
                let (least, most) = (DURATIONS_S.start(), DURATIONS_S.end());
                write!(f, "a duration of {duration} s is not from {least} s to {most} s")
            }
            Self::Reach(reach) => {
                write!(f, "`options.reach`: starts cannot use {reach} of a limit")
            }
            Self::Weight { joint, weight } => {
                write!(f, "the weight {weight} of `{joint}` is negative or no finite number")
            }
            Self::TooFewFunctions => {
                write!(f, "no trajectory of this basis moves and ends as asked for")
            }
            Self::TooMany(what, most) => write!(f, "there may be at most {most} {what}"),
            Self::TooFewOf(what, least) => write!(f, "there must be at least {least} {what}"),
            Self::NothingMoves => write!(f, "no joint moves"),
            Self::NothingExcited => write!(f, "no torque depends on a parameter that is unknown"),
            Self::NoObjective => write!(f, "the objective has no positive weight"),
        }
    }
}

impl ExciteFault {
    /// What to do about it.
    pub(crate) fn hint(&self) -> Option<String> {
        Some(match self {
            Self::MissingLimit { joint, limit } => format!(
                "add `\"limits\": {{\"{}\": {}}}` to the link `{joint}` of the model, or hold it: \
                 `options.hold={joint}=0`",
                limit.key(),
                limit.example()
            ),
            Self::NoRoom { joint, limit: LimitKind::Position | LimitKind::Torque } => format!(
                "the first number must be below the second; or hold the joint: \
                 `options.hold={joint}=0`"
            ),
            Self::NoRoom { joint, .. } => {
                format!("the limit must be positive; or hold the joint: `options.hold={joint}=0`")
            }
            Self::UnknownJoint { nearest: Some(nearest), .. } => {
                format!("`{nearest}` is meant, perhaps")
            }
            Self::UnknownJoint { .. } => "`denavit inspect MODEL` lists the joints".to_owned(),
            Self::HeldOutside { .. } => "hold it between its limits".to_owned(),
            Self::Duration(_) => "`options.duration_s=10`".to_owned(),
            Self::Reach(_) => "`options.reach=1`".to_owned(),
            Self::Weight { .. } => "give 1 over the noise of the joint's torque".to_owned(),
            Self::TooFewFunctions => {
                "give more harmonics, a higher degree or more samples".to_owned()
            }
            Self::NothingMoves => "do not hold every joint".to_owned(),
            Self::NothingExcited => {
                "give links a `body`, or add joint parameters with `options.with`".to_owned()
            }
            Self::NoObjective => "`options.objective=condition`".to_owned(),
            Self::TooMany(..) | Self::TooFewOf(..) => return None,
            Self::Regression(_) | Self::Bake(_) | Self::Lower(_) => return None,
        })
    }
}
