//! Why nothing is identified.

use crate::cli::failure::Failure;
use denavit::identify::condition::ConditionError;
use denavit::identify::estimate::EstimateError;
use denavit::identify::log::{LogFaults, MappingError};
use denavit::plants::PlantError;
use denavit::plants::regression::RegressionError;
use denavit::report::html::FormulaError;
use std::fmt;

/// Why nothing is identified.
#[derive(Debug)]
pub(crate) enum IdentifyFailure {
    /// A model has no regression.
    Regression(Box<RegressionError>),
    /// A mapping of columns is wrong.
    Mapping(MappingError),
    /// A log is wrong.
    Log(LogFaults),
    /// A log cannot be conditioned; holds its name.
    Condition(String, ConditionError),
    /// A model has no plant; holds its name.
    Plant(String, PlantError),
    /// Nothing can be estimated; holds the model's name.
    Estimate(String, EstimateError),
    /// Values have no place in the model's file; holds the model's name.
    NotUpdated(String),
    /// A formula is not shown in a page.
    Formula(FormulaError),
}

impl fmt::Display for IdentifyFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Regression(error) => write!(f, "{error}"),
            Self::Mapping(error) => write!(f, "{error}"),
            Self::Log(error) => write!(f, "{error}"),
            Self::Condition(file, error) => write!(f, "{file}: {error}"),
            Self::Plant(model, error) => write!(f, "{model}: {error}"),
            Self::Estimate(model, error) => write!(f, "{model}: {error}"),
            Self::Formula(error) => write!(f, "{error}"),
            Self::NotUpdated(model) => {
                write!(f, "{model}: the identified values have no place in its file")
            }
        }
    }
}

impl From<IdentifyFailure> for Failure {
    fn from(failure: IdentifyFailure) -> Self {
        Self::Identify(failure)
    }
}
