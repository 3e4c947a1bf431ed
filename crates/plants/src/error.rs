//! Why a robot is no plant, has no regression, or numbers are no reference.

use denavit_codegen::model::{self, BakeError, ModelError};
use denavit_codegen::program::LowerError;
use denavit_codegen::regressor::BaseError;
use std::fmt;

/// Why there is no plant, no regression, no effect or no reference. [`Error::hint`] says what may
/// help, where the text does not.
#[derive(Clone, Debug, PartialEq)]
pub struct Error(Box<Cause>);

/// What kind of reason it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The model has no such parameter; [`Error::parameter`] has its name.
    UnknownParameter,
    /// A parameter has no value, and needs one.
    MissingValue,
    /// A value is not finite, or one that no robot has.
    Value,
    /// An effect acts otherwise than is asked for.
    Effect,
    /// The torques are no linear function of unknown parameters.
    Regression,
    /// With the values of its constants the regression has no finite change of basis.
    Singular,
    /// Columns of motion are not those of the joints.
    Motion,
    /// Numbers make no reference.
    Reference,
    /// Values make no model.
    NoModel,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Cause {
    /// The model has no parameter of that name; holds it and the one that was meant, perhaps.
    UnknownParameter(String, Option<String>),
    /// A value that is not finite.
    NotFinite(String),
    /// With the given values, something of a link would be negative.
    Negative {
        /// What, as "the mass".
        what: &'static str,
        /// The link.
        link: String,
        /// Its value.
        value: f64,
    },
    /// An added effect that a simulation cannot follow; holds its name and what it depends on.
    NotFollowed(String, &'static str),
    /// Parameters without a value.
    Bake(BakeError),
    /// A number that no computer arithmetic holds.
    Lower(LowerError),
    /// No base parameters are found.
    Base(BaseError),
    /// Everything that the torques depend on is known; holds the model's name.
    NothingUnknown(String),
    /// Known parameters that need a value.
    NoValues {
        /// The model.
        model: String,
        /// The parameters' names.
        parameters: Vec<String>,
    },
    /// The values of constants make columns that are independent for almost all values depend on
    /// each other, or a factor infinite; holds the model's name.
    Singular(String),
    /// Motion that does not have one column of equal length for q, qd and qdd of every joint.
    Motion {
        /// Columns that are expected.
        expected: usize,
        /// Columns that were given.
        found: usize,
    },
    /// A parameter of an effect has no value.
    NoEffectValue {
        /// The effect.
        effect: String,
        /// Its place.
        at: String,
        /// The parameter.
        parameter: String,
    },
    /// An effect has no law of one joint; holds its name and why.
    Law(String, Error),
    /// An effect changes the model, and with it the torques of all joints; holds its name.
    WholeRobot(String),
    /// An effect adds a law to one joint; holds its name.
    OneJoint(String),
    /// The place or the robot lacks what an effect would change.
    Place(Vec<model::Cause>),
    /// Fewer values of a reference than its kind needs.
    TooFew {
        /// How many it needs.
        needed: usize,
        /// How many are given.
        found: usize,
    },
    /// Lists of a reference that belong together have different lengths.
    LengthMismatch {
        /// The length of the first.
        expected: usize,
        /// The length of the other.
        found: usize,
    },
    /// A time of a reference is not after the one before it; holds its index.
    NotIncreasing(usize),
    /// A number of a reference is not finite.
    NoNumber,
    /// A frequency or a duration is not positive.
    NotPositive,
    /// A model's file has no place for values; holds its name.
    NoPlace(String),
    /// With new values a file is not that of a model.
    Unsound(Box<ModelError>),
}

impl Error {
    /// The model has no parameter of this name; `meant` is the one that was meant, perhaps.
    pub fn unknown_parameter(name: String, meant: Option<String>) -> Self {
        Cause::UnknownParameter(name, meant).into()
    }

    /// The file of a model, of this name, has no place for values.
    pub fn no_place(model: &str) -> Self {
        Cause::NoPlace(model.to_owned()).into()
    }

    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        match &*self.0 {
            Cause::UnknownParameter(..) => ErrorKind::UnknownParameter,
            Cause::Bake(_) | Cause::NoValues { .. } | Cause::NoEffectValue { .. } => {
                ErrorKind::MissingValue
            }
            Cause::NotFinite(_) | Cause::Negative { .. } | Cause::Lower(_) => ErrorKind::Value,
            Cause::NotFollowed(..)
            | Cause::Law(..)
            | Cause::WholeRobot(_)
            | Cause::OneJoint(_)
            | Cause::Place(_) => ErrorKind::Effect,
            Cause::Base(_) | Cause::NothingUnknown(_) => ErrorKind::Regression,
            Cause::Singular(_) => ErrorKind::Singular,
            Cause::Motion { .. } => ErrorKind::Motion,
            Cause::TooFew { .. }
            | Cause::LengthMismatch { .. }
            | Cause::NotIncreasing(_)
            | Cause::NoNumber
            | Cause::NotPositive => ErrorKind::Reference,
            Cause::NoPlace(_) | Cause::Unsound(_) => ErrorKind::NoModel,
        }
    }

    /// The parameter that is at fault.
    pub fn parameter(&self) -> Option<&str> {
        match &*self.0 {
            Cause::UnknownParameter(name, _) | Cause::NotFinite(name) => Some(name),
            Cause::NoEffectValue { parameter, .. } => Some(parameter),
            _ => None,
        }
    }

    /// What may help with values and references.
    pub fn hint(&self) -> Option<&'static str> {
        Some(match &*self.0 {
            Cause::Negative { .. } => {
                "masses, moments of inertia, stiffness and friction are not negative"
            }
            Cause::TooFew { .. } => "add values",
            Cause::LengthMismatch { .. } => "give a value for every time",
            Cause::NotIncreasing(_) => "list times in order, each once",
            Cause::NoNumber => "a number is too large",
            Cause::NotPositive => "give a number above 0",
            _ => return None,
        })
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownParameter(name, Some(nearest)) => {
                write!(f, "the model has no parameter `{name}`\n  hint: `{nearest}` is one")
            }
            Self::UnknownParameter(name, None) => {
                write!(f, "the model has no parameter `{name}`")
            }
            Self::NotFinite(name) => write!(f, "the value of `{name}` is not a finite number"),
            Self::Negative { what, link, value } => {
                write!(f, "with these values {what} of `{link}` is {value}")
            }
            Self::NotFollowed(name, what) => write!(
                f,
                "the effect `{name}` depends on {what}, which simulations do not follow\n  hint: \
                 take it out of the model, or the contact points"
            ),
            Self::NoPlace(model) => {
                write!(f, "{model}: the identified values have no place in its file")
            }
            Self::Unsound(error) => write!(f, "{error}"),
            Self::Bake(error) => write!(f, "{error}"),
            Self::Lower(error) => write!(f, "{error}"),
            Self::Base(error) => write!(f, "{error}"),
            Self::NothingUnknown(_) | Self::NoValues { .. } | Self::Singular(_) => {
                self.of_regression(f)
            }
            Self::Motion { expected, found } => write!(
                f,
                "{found} columns of motion, perhaps of unequal length, in place of {expected}"
            ),
            Self::NoEffectValue { effect, at, parameter } => write!(
                f,
                "`{effect}` at {at} has no value for `{parameter}`\n  hint: give it one in \
                 \"parameters\" of the effect"
            ),
            Self::Law(effect, error) => write!(f, "`{effect}`: {error}"),
            Self::WholeRobot(name) => write!(f, "`{name}` acts on the whole robot, not on a joint"),
            Self::OneJoint(name) => write!(f, "`{name}` adds a law to one joint"),
            Self::Place(causes) => {
                let said: Vec<String> = causes.iter().map(ToString::to_string).collect();
                write!(f, "{}", said.join("; "))
            }
            Self::TooFew { needed, found } => {
                write!(f, "the reference needs {needed} values, {found} are given")
            }
            Self::LengthMismatch { expected, found } => {
                write!(f, "lists that belong together have {expected} and {found} values")
            }
            Self::NotIncreasing(index) => {
                write!(f, "time number {} is not after the one before it", index + 1)
            }
            Self::NoNumber => write!(f, "a number of the reference is not finite"),
            Self::NotPositive => write!(f, "a frequency or duration is not positive"),
        }
    }
}

impl Cause {
    fn of_regression(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NothingUnknown(model) => write!(
                f,
                "{model}: the torques depend on nothing unknown\n  hint: give links a `body`, or \
                 add joint parameters with `options.with`"
            ),
            Self::NoValues { model, parameters } => write!(
                f,
                "{model}: these known parameters need a value: {}\n  hint: give each one in the \
                 model file",
                parameters.join(", ")
            ),
            Self::Singular(model) => write!(
                f,
                "{model}: with the values of its constants the base parameters have no finite \
                 change of basis\n  hint: write constants that are 0 as numbers in the table"
            ),
            _ => Ok(()),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &*self.0 {
            Cause::Bake(error) => Some(error),
            Cause::Lower(error) => Some(error),
            Cause::Base(error) => Some(error),
            Cause::Law(_, error) => Some(error),
            Cause::Unsound(error) => Some(error.as_ref()),
            _ => None,
        }
    }
}

impl From<Cause> for Error {
    fn from(cause: Cause) -> Self {
        Self(Box::new(cause))
    }
}

/// Parameters without a value.
impl From<BakeError> for Error {
    fn from(error: BakeError) -> Self {
        Cause::Bake(error).into()
    }
}

/// A file with new values is not that of a model.
impl From<ModelError> for Error {
    fn from(error: ModelError) -> Self {
        Cause::Unsound(Box::new(error)).into()
    }
}

/// A number that no computer arithmetic holds.
impl From<LowerError> for Error {
    fn from(error: LowerError) -> Self {
        Cause::Lower(error).into()
    }
}

impl From<BaseError> for Error {
    fn from(error: BaseError) -> Self {
        Cause::Base(error).into()
    }
}
