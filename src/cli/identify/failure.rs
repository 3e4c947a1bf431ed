//! Why nothing is identified.

use denavit::identify::UpdateError;
use denavit::identify::doubt::MisreadColumns;
use denavit::identify::estimate::EstimateError;
use denavit::identify::forward::ForwardError;
use denavit::identify::statics::StaticFault;
use denavit::identify::two_stage::TwoStageError;
use denavit::measure::condition::ConditionError;
use denavit::measure::log::{LogFaults, MappingError};
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
    /// Logs are wrong.
    Logs(Vec<LogFaults>),
    /// A log cannot be conditioned; holds its name.
    Condition(String, ConditionError),
    /// A model has no plant; holds its name.
    Plant(String, PlantError),
    /// Nothing can be estimated; holds the model's name.
    Estimate(String, EstimateError),
    /// Columns seem to be other ones than they are taken for.
    Misread(Vec<MisreadColumns>),
    /// What was found makes no model.
    Update(UpdateError),
    /// A log cannot be simulated again; holds its name.
    Forward(String, ForwardError),
    /// Two stages need one log.
    OneLog,
    /// A log does not give springs and load; holds its name.
    TwoStage(String, TwoStageError),
    /// Measurements at rest do not fit the model; holds their file.
    Statics(String, Vec<StaticFault>),
    /// Instrumental variables without instruments, and nothing to simulate them with.
    NoInstruments,
    /// Instruments for a method that takes none.
    UnusedInstruments,
    /// Instruments that are a log for training itself, noise and all: its name.
    OwnInstruments(String),
    /// `--prior`, and the model states no standard deviation that says anything.
    NoPrior(String),
    /// Two logs for training say the same.
    SameLogs([String; 2]),
    /// A picture of a simulation that was not made.
    NotSimulated,
    /// A formula is not shown in a page.
    Formula(FormulaError),
}

impl fmt::Display for IdentifyFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Regression(error) => write!(f, "{error}"),
            Self::Mapping(error) => write!(f, "{error}"),
            Self::Logs(all) => {
                let all: Vec<String> = all.iter().map(ToString::to_string).collect();
                write!(f, "{}", all.join("\n"))
            }
            Self::Condition(file, error) => write!(f, "{file}: {error}"),
            Self::Plant(model, error) => write!(f, "{model}: {error}"),
            Self::Estimate(model, error) => write!(f, "{model}: {error}"),
            Self::Misread(all) => {
                for one in all {
                    writeln!(f, "{one}")?;
                }
                write!(f, "  hint: --accept-suspicious takes the logs as they are")
            }
            Self::Formula(error) => write!(f, "{error}"),
            Self::Update(error) => write!(f, "{error}"),
            Self::Forward(file, error) => write!(f, "{file}: {error}"),
            Self::OneLog => write!(f, "--two-stage takes one log: --train LOG"),
            Self::TwoStage(file, error) => write!(f, "{file}: {error}"),
            Self::Statics(file, faults) => {
                for (index, fault) in faults.iter().enumerate() {
                    let end = if index > 0 { "\n" } else { "" };
                    write!(f, "{end}{file}: {fault}")?;
                }
                Ok(())
            }
            Self::NoInstruments => write!(
                f,
                "--method iv needs --instruments LOG.., or --controller FILE to simulate them"
            ),
            Self::UnusedInstruments => {
                write!(f, "--instruments, and no method that takes them\n  hint: --method iv does")
            }
            Self::OwnInstruments(file) => write!(
                f,
                "{file}: a log for training as --instruments has its own noise in them, and \
                 would say what least squares does\n  hint: --controller FILE simulates instruments"
            ),
            Self::NoPrior(model) => write!(
                f,
                "{model}: --prior, and no base parameter is known by the standard deviations that \
                 the model states\n  hint: {{\"value\": 2, \"std\": 0.1}} states one; all numbers \
                 that a parameter depends on must have one"
            ),
            Self::SameLogs([one, other]) => write!(
                f,
                "{other} says the same as {one}: measured once, it counts once\n  hint: name each \
                 log once"
            ),
            Self::NotSimulated => write!(
                f,
                "--motion-svg: no log was simulated again\n  hint: --validate or --controller \
                 does that, for robots on a fixed base"
            ),
        }
    }
}

impl From<LogFaults> for IdentifyFailure {
    fn from(faults: LogFaults) -> Self {
        Self::Logs(vec![faults])
    }
}
