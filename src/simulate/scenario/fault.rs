//! What can be wrong with a scenario: where, why, and what to do about it.

use crate::plants::PlantError;
use crate::simulate::log::LogError;
use crate::simulate::start::StartError;
use crate::trajectory::TrajectoryError;
use crate::walk::weight_shift_step::GaitError;
use std::fmt;

/// What is wrong at a place.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// Not JSON; holds what the reader says.
    Syntax(String),
    /// A value of the wrong kind: what it should be.
    WrongKind(&'static str),
    /// A key that means nothing here; holds it, the one that was meant, perhaps, and all of them.
    UnknownKey(String, Option<&'static str>, &'static [&'static str]),
    /// A key that is written twice in one object.
    DuplicateKey(String),
    /// A key that must be there.
    MissingKey(&'static str),
    /// A word that is none of those that may stand here; holds it and them.
    UnknownWord(String, &'static [&'static str]),
    /// The tag of another format; holds it.
    WrongFormat(String),
    /// No joint has this name; holds it and the one that was meant, perhaps.
    UnknownJoint(String, Option<String>),
    /// A joint of the floating base, which nothing drives.
    Undrivable(String),
    /// A list of the wrong length: expected, found.
    WrongLength(usize, usize),
    /// A number that must be positive.
    NotPositive,
    /// A number that must not be negative.
    Negative,
    /// A number that must not exceed 1.
    AboveOne,
    /// More rows of the log than there may be; holds the most.
    TooManyRows(f64),
    /// A log is wrong.
    Log(LogError),
    /// A log has no such column; holds it and the one that was meant, perhaps.
    UnknownColumn(String, Option<String>),
    /// A column of a log has an empty cell; holds it and the line.
    EmptyCell(String, usize),
    /// The gait cannot be planned.
    Gait(GaitError),
    /// The run cannot begin.
    Start(StartError),
    /// The mass matrix is singular at the start, at this joint.
    Singular(String),
    /// The torque on this joint is not finite at the start.
    TorqueNotFinite(String),
    /// A file that cannot be read; holds its name and the reason.
    File(String, String),
    /// The numbers make no reference.
    Reference(TrajectoryError),
    /// The model makes no plant.
    Plant(PlantError),
    /// The model file is wrong; holds what its reader says.
    Model(String),
    /// The robot cannot be put on the ground: it has no `base_z`, or no contact.
    NoPlacing,
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Syntax(said) => write!(f, "not JSON: {said}"),
            Self::WrongKind(expected) => write!(f, "expected {expected}"),
            Self::UnknownKey(key, ..) => write!(f, "unknown key `{key}`"),
            Self::DuplicateKey(key) => write!(f, "the key `{key}` is given twice"),
            Self::MissingKey(key) => write!(f, "the key `{key}` is missing"),
            Self::UnknownWord(word, _) => write!(f, "unknown word `{word}`"),
            Self::WrongFormat(tag) => write!(f, "the format is `{tag}`, not `{}`", super::FORMAT),
            Self::UnknownJoint(name, _) => write!(f, "no joint is called `{name}`"),
            Self::Undrivable(name) => {
                write!(f, "`{name}` moves the floating base: no drive is there")
            }
            Self::WrongLength(expected, found) => {
                write!(f, "expected {expected} values, found {found}")
            }
            Self::NotPositive => write!(f, "the number must be positive"),
            Self::Negative => write!(f, "the number must not be negative"),
            Self::AboveOne => write!(f, "the number must not exceed 1"),
            Self::TooManyRows(most) => {
                write!(f, "the log would have more than {most} rows")
            }
            Self::Log(error) => write!(f, "{error}"),
            Self::UnknownColumn(name, _) => write!(f, "the log has no column `{name}`"),
            Self::EmptyCell(column, line) => {
                write!(f, "the column `{column}` has no number in line {line} of the log")
            }
            Self::Gait(error) => write!(f, "{error}"),
            Self::Start(error) => write!(f, "{error}"),
            Self::Singular(joint) => {
                write!(f, "the mass matrix is singular at `{joint}`: it moves no mass")
            }
            Self::TorqueNotFinite(joint) => {
                write!(f, "the torque on `{joint}` is not a finite number at the start")
            }
            Self::File(file, reason) => write!(f, "{file}: cannot be read: {reason}"),
            Self::Reference(error) => write!(f, "{error}"),
            Self::Plant(error) => write!(f, "{error}"),
            Self::Model(said) => write!(f, "the model is wrong:\n{said}"),
            Self::NoPlacing => write!(f, "a robot is put on the ground by `base_z` and contacts"),
        }
    }
}

impl Cause {
    /// What to do about it.
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::UnknownKey(_, Some(nearest), _) => Some(format!("`{nearest}` is meant, perhaps")),
            Self::UnknownKey(_, None, known) => Some(format!("keys are {}", known.join(", "))),
            Self::UnknownWord(_, known) => Some(format!("words are {}", known.join(", "))),
            Self::TooManyRows(_) => Some("write a row less often: `log_period_s`".to_owned()),
            Self::Log(_) => {
                Some("a log is a table with a column `t` (docs/scenario.md)".to_owned())
            }
            Self::UnknownColumn(_, Some(near)) => Some(format!("`{near}` is meant, perhaps")),
            Self::EmptyCell(..) => Some("fill the gap, or cut the log before it".to_owned()),
            Self::Gait(GaitError::Posture { .. }) => {
                Some("a shorter or lower step, or a more bent knee, may be within reach".to_owned())
            }
            Self::Gait(GaitError::Missing(_)) => Some("this gait is TUlip's".to_owned()),
            Self::Gait(_) => Some("`phases_s` are four times that increase".to_owned()),
            Self::Start(StartError::Penetration(..)) => {
                Some("raise the robot, or give `on_ground` in `initial`".to_owned())
            }
            Self::Singular(_) => {
                Some("give the link a mass and inertia, or start in another position".to_owned())
            }
            Self::TorqueNotFinite(_) => {
                Some("gains times errors, or a reference, exceed what a number holds".to_owned())
            }
            Self::UnknownJoint(_, Some(nearest)) => Some(format!("`{nearest}` is meant, perhaps")),
            Self::Undrivable(_) => Some("control the joints between links".to_owned()),
            Self::NoPlacing => Some("give the position itself, without `on_ground`".to_owned()),
            _ => None,
        }
    }
}

/// A fault with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// JSON pointer of the value at fault.
    pub pointer: String,
    /// Its line, from 1.
    pub line: usize,
    /// Its column in characters, from 1.
    pub column: usize,
    /// What is wrong.
    pub cause: Cause,
}

/// Everything that is wrong with a scenario, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioError {
    /// The name of the file, as it was given.
    pub file: String,
    /// The faults, at least one.
    pub faults: Vec<Fault>,
}

impl fmt::Display for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, fault) in self.faults.iter().enumerate() {
            let separator = if index == 0 { "" } else { "\n" };
            write!(f, "{separator}{}:{}:{}: ", self.file, fault.line, fault.column)?;
            if !fault.pointer.is_empty() {
                write!(f, "{}: ", fault.pointer)?;
            }
            write!(f, "{}", fault.cause)?;
            if let Some(hint) = fault.cause.hint() {
                write!(f, "\n  hint: {hint}")?;
            }
        }
        Ok(())
    }
}

impl std::error::Error for ScenarioError {}
