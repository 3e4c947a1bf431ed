//! Why nothing is identified.

mod estimate;
mod forward;
mod statics;
mod two_stage;
mod update;

pub(crate) use estimate::EstimateError;
pub(crate) use forward::ForwardError;
pub(crate) use statics::{MisreadPostures, StaticFault};
pub(crate) use two_stage::TwoStageError;
pub(crate) use update::UpdateError;

use denavit_codegen::model::ModelError;
use std::fmt;

/// Why there is no answer. It is printed with what helps, where something does.
#[derive(Clone, Debug, PartialEq)]
pub struct Error(Box<Cause>);

/// What kind of reason it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Logs lack a column that is needed; [`Error::column`] has it.
    MissingColumn,
    /// Logs are too short, or nothing is left of them.
    TooShort,
    /// A log cannot be conditioned; the source says why.
    Condition,
    /// The motion does not tell parameters apart.
    NotExcited,
    /// Measurements contradict the model: another unit, perhaps. [`Error::scale`] mends a column.
    Contradicting,
    /// Measurements at rest are wrong; [`Error::faults`] has them one by one.
    Measurements,
    /// Robot and logs are right, and do not suit what is asked.
    Unsuitable,
    /// An iteration does not settle.
    NotSettled,
    /// A simulation does not begin.
    NotStarted,
    /// A simulation broke off.
    BrokeOff,
    /// Values make no model.
    NoModel,
    /// A text is no piece of a log of the model.
    Piece,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
enum Cause {
    Estimate(EstimateError),
    Forward(ForwardError),
    TwoStage(TwoStageError),
    Statics(Vec<StaticFault>),
    Update(UpdateError),
    Piece(String),
}

impl Error {
    /// A log lacks a column of this name.
    pub fn missing_column(name: String) -> Self {
        TwoStageError::MissingColumn(name).into()
    }

    /// The file of a model, of this name, has no place for values.
    pub fn no_place(model: &str) -> Self {
        UpdateError::NoPlace(model.to_owned()).into()
    }

    /// A text is no piece of a log of the model; holds why.
    pub(crate) fn of_piece(why: String) -> Self {
        Self(Box::new(Cause::Piece(why)))
    }

    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        match &*self.0 {
            Cause::Estimate(error) => of_estimate(error),
            Cause::Forward(error) => of_forward(error),
            Cause::TwoStage(error) => of_two_stage(error),
            Cause::Statics(_) => ErrorKind::Measurements,
            Cause::Update(_) => ErrorKind::NoModel,
            Cause::Piece(_) => ErrorKind::Piece,
        }
    }

    /// The column of a log that is missing, or that contradicts the model.
    pub fn column(&self) -> Option<String> {
        match &*self.0 {
            Cause::TwoStage(TwoStageError::MissingColumn(column)) => Some(column.clone()),
            Cause::TwoStage(TwoStageError::MotorAngle { joint, .. }) => {
                Some(format!("motor_{joint}"))
            }
            Cause::TwoStage(TwoStageError::MotorTorque { joint, .. }) => {
                Some(format!("tau_cmd_{joint}"))
            }
            Cause::Forward(ForwardError::NoReference(joint)) => Some(format!("ref_{joint}")),
            Cause::Forward(ForwardError::NoTorque(joint)) => Some(format!("tau_{joint}")),
            _ => None,
        }
    }

    /// What that column is to be multiplied with, if a known mistake explains it.
    pub fn scale(&self) -> Option<f64> {
        match &*self.0 {
            Cause::TwoStage(TwoStageError::MotorAngle { scale, .. }) => scale.map(|one| one.0),
            Cause::TwoStage(TwoStageError::MotorTorque { scale, .. }) => Some(scale.0),
            _ => None,
        }
    }

    /// The number of the measurement at rest that is wrong, from 0.
    pub fn measurement(&self) -> Option<usize> {
        match &*self.0 {
            Cause::Statics(faults) => faults.first().and_then(StaticFault::measurement),
            _ => None,
        }
    }

    /// All that is wrong, one by one.
    pub fn faults(&self) -> Vec<Self> {
        match &*self.0 {
            Cause::Statics(faults) => {
                faults.iter().map(|fault| vec![fault.clone()].into()).collect()
            }
            _ => vec![self.clone()],
        }
    }
}

fn of_estimate(error: &EstimateError) -> ErrorKind {
    match error {
        EstimateError::NoTorque => ErrorKind::MissingColumn,
        EstimateError::NothingLeft
        | EstimateError::TooFewRows(..)
        | EstimateError::TooShort(..) => ErrorKind::TooShort,
        EstimateError::Instruments | EstimateError::OtherMotion(..) => ErrorKind::Unsuitable,
        EstimateError::NotSettled => ErrorKind::NotSettled,
    }
}

fn of_forward(error: &ForwardError) -> ErrorKind {
    match error {
        ForwardError::FloatingBase | ForwardError::BadReference(_) => ErrorKind::Unsuitable,
        ForwardError::NoReference(_) | ForwardError::NoTorque(_) => ErrorKind::MissingColumn,
        ForwardError::TooShort(_) => ErrorKind::TooShort,
        ForwardError::Start(_) => ErrorKind::NotStarted,
        ForwardError::Stopped { .. } => ErrorKind::BrokeOff,
    }
}

fn of_two_stage(error: &TwoStageError) -> ErrorKind {
    match error {
        TwoStageError::NoSprings | TwoStageError::NoDrive(_) => ErrorKind::Unsuitable,
        TwoStageError::MissingColumn(_) => ErrorKind::MissingColumn,
        TwoStageError::Condition(_) => ErrorKind::Condition,
        TwoStageError::NotExcited(_) | TwoStageError::NoStiffness { .. } => ErrorKind::NotExcited,
        TwoStageError::MotorAngle { .. } | TwoStageError::MotorTorque { .. } => {
            ErrorKind::Contradicting
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &*self.0 {
            Cause::Estimate(error) => write!(f, "{error}"),
            Cause::Forward(error) => write!(f, "{error}"),
            Cause::TwoStage(error) => write!(f, "{error}"),
            Cause::Statics(faults) => {
                let all: Vec<String> = faults.iter().map(ToString::to_string).collect();
                f.write_str(&all.join("\n"))
            }
            Cause::Update(error) => write!(f, "{error}"),
            Cause::Piece(why) => f.write_str(why),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &*self.0 {
            Cause::Forward(ForwardError::Start(error)) => Some(error),
            Cause::TwoStage(TwoStageError::Condition(error)) => Some(error),
            Cause::Update(UpdateError::Unsound(error)) => Some(error),
            _ => None,
        }
    }
}

impl From<EstimateError> for Error {
    fn from(error: EstimateError) -> Self {
        Self(Box::new(Cause::Estimate(error)))
    }
}

impl From<ForwardError> for Error {
    fn from(error: ForwardError) -> Self {
        Self(Box::new(Cause::Forward(error)))
    }
}

impl From<TwoStageError> for Error {
    fn from(error: TwoStageError) -> Self {
        Self(Box::new(Cause::TwoStage(error)))
    }
}

impl From<Vec<StaticFault>> for Error {
    fn from(faults: Vec<StaticFault>) -> Self {
        Self(Box::new(Cause::Statics(faults)))
    }
}

impl From<UpdateError> for Error {
    fn from(error: UpdateError) -> Self {
        Self(Box::new(Cause::Update(error)))
    }
}

/// A file with new values is not that of a model.
impl From<ModelError> for Error {
    fn from(error: ModelError) -> Self {
        UpdateError::Unsound(error).into()
    }
}
