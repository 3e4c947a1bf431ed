//! Why no excitation is looked for: everything that is wrong with model and options, at once.

use super::fault::{ExciteFault, LimitKind};
use std::fmt;

/// Why no excitation is looked for: all that is wrong, each with what helps.
#[derive(Clone, Debug, PartialEq)]
pub struct Error(Box<Faults>);

/// What kind of reason it is; of several faults that of the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The model has no torques that are linear in unknown parameters.
    Model,
    /// A limit of a joint is missing, or leaves no room; [`Error::limit`] has it.
    Limits,
    /// No joint has this name; [`Error::joint`] has it.
    UnknownJoint,
    /// An option asks for what there is not.
    Options,
}

#[derive(Clone, Debug, PartialEq)]
struct Faults {
    model: String,
    /// At least one.
    faults: Vec<ExciteFault>,
}

impl Error {
    /// The error that faults of a model make, if there are any.
    pub(super) fn of(model: &str, faults: Vec<ExciteFault>) -> Result<(), Self> {
        match faults.is_empty() {
            true => Ok(()),
            false => Err(Self(Box::new(Faults { model: model.to_owned(), faults }))),
        }
    }

    fn first(&self) -> &ExciteFault {
        &self.0.faults[0]
    }

    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        match self.first() {
            ExciteFault::Regression(_)
            | ExciteFault::Bake(_)
            | ExciteFault::Lower(_)
            | ExciteFault::NothingExcited => ErrorKind::Model,
            ExciteFault::MissingLimit { .. } | ExciteFault::NoRoom { .. } => ErrorKind::Limits,
            ExciteFault::UnknownJoint { .. } => ErrorKind::UnknownJoint,
            ExciteFault::HeldOutside { .. }
            | ExciteFault::Duration(_)
            | ExciteFault::Reach(_)
            | ExciteFault::Weight { .. }
            | ExciteFault::TooFewFunctions
            | ExciteFault::TooMany(..)
            | ExciteFault::TooFewOf(..)
            | ExciteFault::NothingMoves
            | ExciteFault::NoObjective => ErrorKind::Options,
        }
    }

    /// The joint that the first fault names.
    pub fn joint(&self) -> Option<&str> {
        match self.first() {
            ExciteFault::MissingLimit { joint, .. }
            | ExciteFault::NoRoom { joint, .. }
            | ExciteFault::HeldOutside { joint, .. }
            | ExciteFault::Weight { joint, .. }
            | ExciteFault::UnknownJoint { name: joint, .. } => Some(joint),
            _ => None,
        }
    }

    /// The limit that the first fault is about.
    pub fn limit(&self) -> Option<LimitKind> {
        match self.first() {
            ExciteFault::MissingLimit { limit, .. } | ExciteFault::NoRoom { limit, .. } => {
                Some(*limit)
            }
            _ => None,
        }
    }

    /// The faults, one by one.
    pub fn faults(&self) -> Vec<Self> {
        let Faults { model, faults } = &*self.0;
        let one = |fault: &ExciteFault| {
            Self(Box::new(Faults { model: model.clone(), faults: vec![fault.clone()] }))
        };
        faults.iter().map(one).collect()
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, fault) in self.0.faults.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            match fault {
                // these name the model themselves
                ExciteFault::Regression(_) | ExciteFault::Bake(_) => write!(f, "{fault}")?,
                _ => write!(f, "{}: {fault}", self.0.model)?,
            }
            if let Some(hint) = fault.hint() {
                write!(f, "\n  hint: {hint}")?;
            }
        }
        Ok(())
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self.first() {
            ExciteFault::Regression(error) => Some(error),
            ExciteFault::Bake(error) => Some(error),
            ExciteFault::Lower(error) => Some(error),
            _ => None,
        }
    }
}
