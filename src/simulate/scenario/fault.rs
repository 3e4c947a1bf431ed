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
        Some(match self {
            Self::UnknownKey(_, Some(near), _) => format!("`{near}` is meant, perhaps"),
            Self::UnknownJoint(_, Some(near)) | Self::UnknownColumn(_, Some(near)) => {
                format!("`{near}` is meant, perhaps")
            }
            Self::UnknownKey(_, None, known) => format!("keys are {}", known.join(", ")),
            Self::UnknownWord(_, known) => format!("words are {}", known.join(", ")),
            Self::MissingKey(key) => format!("add `\"{key}\": ..`"),
            Self::WrongFormat(_) => format!("a scenario has `\"format\": \"{}\"`", super::FORMAT),
            Self::WrongLength(expected, _) => format!("give {expected} numbers: [..]"),
            other => return other.fixed_hint().map(str::to_owned),
        })
    }

    fn fixed_hint(&self) -> Option<&'static str> {
        Some(match self {
            Self::WrongKind(_) => "docs/scenario.md says what stands here",
            Self::DuplicateKey(_) => "keep one of them",
            Self::UnknownJoint(..) => "`denavit inspect MODEL` lists the joints",
            Self::UnknownColumn(..) => "columns are named in the first line of the log",
            Self::Undrivable(_) => "control the joints between links",
            Self::NotPositive => "give a number above 0",
            Self::Negative => "give 0 or more",
            Self::AboveOne => "give 0 to 1",
            Self::TooManyRows(_) => "write a row less often: `log_period_s`",
            Self::Log(_) => "a log is a table with a column `t` that increases (docs/scenario.md)",
            Self::EmptyCell(..) => "fill the gap, or cut the log before it",
            Self::Gait(error) => match error {
                GaitError::Posture { .. } => {
                    "a shorter or lower step, or a more bent knee, may be within reach"
                }
                GaitError::Missing(_) => "this gait is TUlip's",
                GaitError::Times | GaitError::Spline(_) => {
                    "`phases_s` are four times that increase"
                }
            },
            Self::Start(_) => "raise the robot, or give `on_ground` in `initial`",
            Self::Singular(_) => "give the link a mass and inertia, or start in another position",
            Self::TorqueNotFinite(_) => {
                "gains times errors, or a reference, exceed what a number holds"
            }
            Self::File(..) => "paths are taken from the scenario's directory",
            Self::Reference(error) => match error {
                TrajectoryError::TooFew { .. } => "add values",
                TrajectoryError::LengthMismatch { .. } => "give a value for every time",
                TrajectoryError::NotIncreasing(_) => "list times in order, each once",
                TrajectoryError::NotFinite => "a number is too large",
                TrajectoryError::NotPositive => "give a number above 0",
            },
            Self::NoPlacing => "give the position itself, without `on_ground`",
            // what the readers of these say has its hint
            _ => return None,
        })
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
    /// The faults, at least one, at most [`MAX_FAULTS`](denavit_codegen::model::MAX_FAULTS).
    pub faults: Vec<Fault>,
    /// How many more there are.
    pub omitted: usize,
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
        match self.omitted {
            0 => Ok(()),
            1 => write!(f, "\nand 1 more fault"),
            more => write!(f, "\nand {more} more faults"),
        }
    }
}

impl std::error::Error for ScenarioError {}
