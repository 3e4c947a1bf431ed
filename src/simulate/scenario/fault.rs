//! What can be wrong with a scenario: where, why, and what to do about it.

use crate::plants::PlantError;
use crate::trajectory::TrajectoryError;
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
