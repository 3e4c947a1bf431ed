//! Logs that contradict each other: of another payload, gain, offset or robot.
//!
//! All logs have one set of parameters, or one of them has parameters of its own, or a torque of it
//! has a constant or a gain of its own. Each is a linear model of the same rows, and they are
//! compared by the density that they give the torques with all factors integrated out. Residuals of
//! a log's own parameters tell how many of its samples are independent; noise of its positions is
//! the least that its torques have. Where that noise is all that is left, filters of half the
//! cutoff leave less of it, and the logs are asked once more behind these.

mod logs;
mod search;

pub(crate) use search::{Agreement, agreement};

use std::fmt;

/// A log that contradicts the others.
#[derive(Clone, Debug, PartialEq)]
pub struct ContradictingLog {
    /// Its name.
    pub file: String,
    /// The joints that tell it.
    pub joints: Vec<ContradictingJoint>,
    /// Which side is believed.
    pub standing: Standing,
}

/// Which of logs that contradict each other are believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// The others: they are more, and longer together, than those that contradict them.
    OfFew,
    /// The same, but parameters are not theirs alone.
    OfFewFollowed,
    /// Neither.
    Undecided,
    /// Those for the estimate: this one is for validation.
    HeldOut,
}

/// A joint whose torques in a log contradict those in the others.
#[derive(Clone, Debug, PartialEq)]
pub struct ContradictingJoint {
    /// The joint.
    pub joint: String,
    /// The share of its torque that parameters of the others leave, as root of mean square.
    pub left: f64,
    /// The same of what the log has of its own.
    pub own: f64,
    /// What is left is like this.
    pub like: Option<Likeness>,
}

/// What is left of a torque beside that of other logs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Likeness {
    /// A constant more, in this unit.
    Constant(f64, &'static str),
    /// So many times as large.
    Factor(f64),
}

impl fmt::Display for ContradictingJoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [left, own] = [self.left, self.own].map(|share| 100.0 * share);
        write!(f, "{left:.1} % of the torque of {} is left, {own:.1} % by its own", self.joint)?;
        match self.like {
            None => Ok(()),
            Some(Likeness::Constant(by, unit)) => write!(f, ", as if {by:+.3} {unit} were added"),
            Some(Likeness::Factor(by)) => write!(f, ", as if it were {by:.3} times as large"),
        }
    }
}

impl fmt::Display for ContradictingLog {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, joints, standing } = self;
        let joints: Vec<String> = joints.iter().map(ToString::to_string).collect();
        let contradicts = match standing {
            Standing::OfFew | Standing::OfFewFollowed => {
                "contradicts the other logs, which no parameters explain together with it"
            }
            Standing::Undecided => "and the other logs contradict each other",
            Standing::HeldOut => "and the logs for the estimate contradict each other",
        };
        let believed = match standing {
            Standing::OfFew => "Parameters are those of the others; leave it out.",
            Standing::OfFewFollowed => {
                "Parameters are not those of the others alone: leave it out."
            }
            Standing::HeldOut => "Which of them are right cannot be told.",
            Standing::Undecided => {
                "The logs that agree are not both more and longer together than those that do not: \
                 which of them are right cannot be told, and what was found is not to be believed. \
                 Look at each log by itself."
            }
        };
        write!(
            f,
            "{file} {contradicts}: {}. It may be of another payload, gain, offset or robot, or \
             show a law that the model lacks. {believed}",
            joints.join("; ")
        )
    }
}
