//! Why a command stops: always the input's or the system's fault, with the way out.

use super::identify::IdentifyFailure;
use super::output_failure::OutputFailure;
use denavit::demo::RobotError;
use denavit::derive::MotionError;
use denavit::diagnose::DiagnosisError;
use denavit::emit::SourceError;
use denavit::emit::latex::TooLongToSet;
use denavit::excite::ExciteError;
use denavit::import::{ExportError, ImportError};
use denavit::model::ModelError;
use denavit::plants::effect::AddedError;
use denavit::program::{CodeError, StatesError};
use denavit::regressor::{DecomposedError, ProvenBaseError};
use denavit::shipped::ShippedModel;
use denavit::simulate::LogFaults;
use denavit::simulate::scenario::ScenarioError;
use std::fmt;
use std::io;

/// Why a command stops before its answer.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The model file is wrong.
    Model(ModelError),
    /// A description of a robot in another format is wrong.
    Import(ImportError),
    /// A model is not described in another format; holds the model.
    Export(String, ExportError),
    /// A file of states is wrong; holds the file and why.
    States(String, StatesError),
    /// Neither a file nor a shipped model has this name; holds the name, the shipped model that was
    /// meant, perhaps, and whether it can only be a file.
    NoModel { name: String, nearest: Option<&'static str>, is_path: bool },
    /// A file cannot be read.
    Read { file: String, error: io::Error },
    /// A file is larger than any model.
    TooLarge { file: String, limit: u64 },
    /// An output is not written.
    Output(OutputFailure),
    /// A model has an effect beside its equations, for which a command has no place; holds model
    /// and effect.
    Effect(String, String),
    /// The effects of a model cannot be taken apart; holds the model.
    Apart(String, AddedError),
    /// A model has no code.
    Code(CodeError),
    /// A model has no files of source code.
    Source(SourceError),
    /// The base parameters are not found; holds the file.
    Base(String, Box<ProvenBaseError>),
    /// A file is no certificate.
    Certificate { file: String, error: serde_json::Error },
    /// There are no f and B.
    Decompose(DecomposedError),
    /// `--with modelled` was given with other joint parameters.
    ModelledAndMore,
    /// Options that only models have were given for equations; holds their name.
    NotOfEquations(String),
    /// A document would be too long to be read, or set.
    TooLongToSet(TooLongToSet),
    /// A scenario file is wrong.
    Scenario(ScenarioError),
    /// Neither a file nor a shipped one of a kind has this name; holds both, the one that was
    /// meant, perhaps, and all there are.
    NoShipped {
        kind: &'static str,
        name: String,
        nearest: Option<&'static str>,
        all: &'static [ShippedModel],
    },
    /// A model stands where a scenario should; holds its name.
    ModelForScenario(String),
    /// A window that the run does not have; holds the run's beginning and end \[s\].
    Window([f64; 2]),
    /// No trajectory can be looked for.
    Excite(ExciteError),
    /// Nothing is identified.
    Identify(IdentifyFailure),
    /// Nothing is diagnosed.
    Diagnose(DiagnosisError),
    /// A log is wrong.
    Log(LogFaults),
    /// A gait has no answer; holds the scenario and why.
    Walk(String, String),
    /// A step was given for the scheme that chooses its own.
    StepOfEventScheme,
    /// The answer cannot be written to standard output.
    Stdout(io::Error),
}

/// Errors of writing that are not turned into another failure are those of standard output.
impl Failure {
    /// All of some logs, or the faults of all that are wrong.
    pub(crate) fn of_any_log<T>(
        logs: impl Iterator<Item = Result<T, Self>>,
    ) -> Result<Vec<T>, Self> {
        let (mut right, mut wrong) = (Vec::new(), Vec::new());
        for log in logs {
            match log {
                Ok(log) => right.push(log),
                Err(Self::Identify(IdentifyFailure::Logs(faults))) => wrong.extend(faults),
                Err(failure) => return Err(failure),
            }
        }
        if wrong.is_empty() { Ok(right) } else { Err(IdentifyFailure::Logs(wrong).into()) }
    }
}

impl From<IdentifyFailure> for Failure {
    fn from(failure: IdentifyFailure) -> Self {
        Self::Identify(failure)
    }
}

impl From<MotionError> for Failure {
    fn from(error: MotionError) -> Self {
        match error {
            MotionError::NoFunction(error) => Self::Code(CodeError::NoFunction(error)),
            MotionError::Effect(model, effect) => Self::Effect(model, effect),
        }
    }
}

impl From<CodeError> for Failure {
    fn from(error: CodeError) -> Self {
        Self::Code(error)
    }
}

impl From<RobotError> for Failure {
    fn from(error: RobotError) -> Self {
        match error {
            RobotError::Source(error) => error.into(),
            RobotError::Base(error) => Self::Base(String::new(), Box::new(error)),
        }
    }
}

impl From<ScenarioError> for Failure {
    fn from(error: ScenarioError) -> Self {
        Self::Scenario(error)
    }
}

impl From<SourceError> for Failure {
    fn from(error: SourceError) -> Self {
        Self::Source(error)
    }
}

impl From<DecomposedError> for Failure {
    fn from(error: DecomposedError) -> Self {
        Self::Decompose(error)
    }
}

impl From<TooLongToSet> for Failure {
    fn from(error: TooLongToSet) -> Self {
        Self::TooLongToSet(error)
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Stdout(error)
    }
}

impl From<serde_json::Error> for Failure {
    fn from(error: serde_json::Error) -> Self {
        Self::Stdout(error.into())
    }
}

impl Failure {
    /// Whether the reader of our output has gone, which is no fault of anybody.
    pub(crate) fn is_closed_pipe(&self) -> bool {
        matches!(self, Self::Stdout(error) if error.kind() == io::ErrorKind::BrokenPipe)
    }

    fn hint(&self) -> Option<String> {
        Some(match self {
            Self::NoModel { nearest: Some(nearest), .. } => {
                format!("`{nearest}` is a shipped model")
            }
            Self::NoModel { is_path: false, .. } => {
                let names: Vec<_> = denavit::shipped::MODELS.iter().map(|m| m.name).collect();
                format!("give the path of a model file, or one of {}", names.join(", "))
            }
            Self::NoModel { .. } => "check the path".to_owned(),
            Self::Read { error, .. } if error.kind() == io::ErrorKind::IsADirectory => {
                "give the path of one model file in it".to_owned()
            }
            Self::Read { error, .. } if error.kind() == io::ErrorKind::PermissionDenied => {
                "check the permissions of the file and of its directories".to_owned()
            }
            Self::TooLarge { .. } => "a model is a table of some kilobytes: check the path".into(),
            Self::ModelledAndMore => "the others add those of all joints".to_owned(),
            Self::Effect(..) => "see \"effects\" in docs/reference/model-file.md".to_owned(),
            Self::NotOfEquations(_) => "write the terms into the equations".to_owned(),
            Self::Certificate { .. } => {
                "give a file that `denavit base --certificate` wrote".to_owned()
            }
            Self::StepOfEventScheme => "add --scheme time-stepping".to_owned(),
            Self::NoShipped { kind, nearest: Some(nearest), .. } => {
                format!("`{nearest}` is a shipped {kind}")
            }
            Self::NoShipped { kind, all, .. } => {
                let names: Vec<_> = all.iter().map(|one| one.name).collect();
                format!("give the path of a {kind} file, or one of {}", names.join(", "))
            }
            Self::ModelForScenario(name) => smallest_scenario(name),
            Self::Window(_) => "choose two times of the run".to_owned(),
            Self::Model(_)
            | Self::Import(_)
            | Self::Export(..)
            | Self::States(..)
            | Self::Output(_)
            | Self::Scenario(_)
            | Self::Apart(..)
            | Self::Excite(_)
            | Self::Identify(_)
            | Self::Diagnose(_)
            | Self::Log(_)
            | Self::Walk(..)
            | Self::Base(..)
            | Self::Decompose(_)
            | Self::TooLongToSet(_)
            | Self::Code(_)
            | Self::Source(_)
            | Self::Read { .. }
            | Self::Stdout(_) => return None,
        })
    }
}

/// What to write where a model alone was given.
fn smallest_scenario(model: &str) -> String {
    let model = serde_json::Value::from(model);
    format!(
        "a scenario says what a model does: {{\"format\": \"{}\", \"model\": {model}, \
         \"duration_s\": 1}} lets it go from rest; docs/reference/scenario.md has the rest, \
         `denavit schema scenario` all keys",
        denavit::simulate::scenario::FORMAT
    )
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.cause(f)?;
        match self.hint() {
            Some(hint) => write!(f, "\n  hint: {hint}"),
            None => Ok(()),
        }
    }
}

impl Failure {
    fn cause(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // place and hint are part of these
            Self::Model(error) => write!(f, "{error}")?,
            Self::Import(_) | Self::Export(..) | Self::States(..) => self.of_others(f)?,
            Self::Code(error) => write!(f, "{error}")?,
            Self::Source(error) => write!(f, "{error}")?,
            Self::TooLongToSet(error) => write!(f, "{error}")?,
            Self::Output(error) => write!(f, "{error}")?,
            Self::Decompose(error) => write!(f, "{error}")?,
            Self::NotOfEquations(name) => write!(
                f,
                "{name}: equations have no --with, --terms, --basis, --numeric or --certificate"
            )?,
            Self::NoModel { name, is_path: true, .. } => write!(f, "{name}: no such file")?,
            Self::NoModel { name, is_path: false, .. } => {
                write!(f, "{name}: there is no such file, and no shipped model of that name")?;
            }
            Self::Read { file, error } => write!(f, "{file}: cannot be read: {}", reason(error))?,
            Self::TooLarge { file, limit } => {
                write!(f, "{file}: has more than the {limit} bytes that are read")?;
            }
            Self::ModelledAndMore => write!(f, "--with modelled stands alone")?,
            Self::Effect(model, effect) => {
                write!(f, "{model}: this has no place for the effect `{effect}`")?;
            }
            Self::Apart(model, error) => write!(f, "{model}: {error}")?,
            Self::Base(file, error) if error.is_inexact() => {
                write!(f, "{file}: {error} (`--numeric`)")?;
            }
            Self::Base(_, error) => write!(f, "{error}")?,
            Self::Certificate { file, error } => {
                write!(f, "{file}: is no certificate: {error}")?;
            }
            Self::Scenario(error) => write!(f, "{error}")?,
            Self::Excite(error) => write!(f, "{error}")?,
            Self::Identify(error) => write!(f, "{error}")?,
            Self::Diagnose(error) => write!(f, "{error}")?,
            Self::Log(error) => write!(f, "{error}")?,
            Self::Walk(scenario, why) => write!(f, "{scenario}: {why}")?,
            Self::StepOfEventScheme => {
                write!(f, "--step: the event-driven scheme chooses its steps itself")?;
            }
            Self::NoShipped { kind, name, .. } => {
                write!(f, "{name}: there is no such file, and no shipped {kind} of that name")?;
            }
            Self::ModelForScenario(name) => {
                write!(f, "{name}: this is a model, where a scenario is simulated")?;
            }
            Self::Window([from, to]) => write!(f, "--window: the run is from {from} to {to} s")?,
            Self::Stdout(error) => {
                write!(f, "standard output: cannot be written: {}", reason(error))?;
            }
        }
        Ok(())
    }
}

impl Failure {
    /// What is wrong with descriptions in other formats, and with states.
    fn of_others(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Import(error) => write!(f, "{error}"),
            Self::Export(_, ExportError::Description(error)) => write!(f, "{error}"),
            Self::Export(model, error) => write!(f, "{model}: {error}"),
            Self::States(file, error) => write!(f, "{file}: {error}"),
            _ => Ok(()),
        }
    }
}

impl std::error::Error for Failure {}

/// What the system says, without its error number.
pub(super) fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    let end = text.find(" (os error").unwrap_or(text.len());
    let mut text = text[..end].to_owned();
    if let Some(first) = text.get_mut(..1) {
        first.make_ascii_lowercase();
    }
    text
}
