//! Why a command stops: always the input's or the system's fault, with the way out.

use super::identify::IdentifyFailure;
use super::mistaken::Mistaken;
use super::output_failure::OutputFailure;
use denavit::diagnose::DiagnosisError;
use denavit::emit::EmitError;
use denavit::excite::ExciteError;
use denavit::function::FunctionName;
use denavit::import::{ExportError, ImportError};
use denavit::model::{BakeError, ModelError};
use denavit::plants::effect::AddedError;
use denavit::program::LowerError;
use denavit::regressor::equations::EquationsError;
use denavit::regressor::{BaseError, DecomposeError};
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
    States(String, String),
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
    /// Values are missing that the baked flavour needs.
    Bake(BakeError),
    /// A model holds numbers that no computer arithmetic holds; holds model and cause.
    Lower(String, LowerError),
    /// A default of a model is no number that Rust can hold; holds model and cause.
    Emit(String, EmitError),
    /// The model has none of the functions asked for.
    NoFunction { model: String, asked: Vec<String> },
    /// The base parameters are not found; holds the file.
    Base(String, Box<BaseError>),
    /// No terms are left in which bodies act by themselves; holds the model.
    NoMotionTerms(String),
    /// A file is no certificate.
    Certificate { file: String, error: serde_json::Error },
    /// A model is not decomposed.
    Decompose(DecomposeError),
    /// Equations have no regressor.
    Equations(EquationsError),
    /// There are no angles to cumulate; holds the model.
    NoParallelAxes(String),
    /// `--with modelled` was given with other joint parameters.
    ModelledAndMore,
    /// Options that only models have were given for equations; holds their name.
    NotOfEquations(String),
    /// A document would be too long to be read, or set.
    TooLongToSet { name: String, formulas: usize },
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
    /// Something good stands where something else should.
    Mistaken(Mistaken),
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

impl From<Mistaken> for Failure {
    fn from(mistaken: Mistaken) -> Self {
        Self::Mistaken(mistaken)
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
            Self::NoMotionTerms(_) => {
                "--terms inertia,gravity; --with friction,rotor adds the parameters of joints"
                    .to_owned()
            }
            Self::ModelledAndMore => "the others add those of all joints".to_owned(),
            Self::Effect(..) => "see \"effects\" in docs/reference/model-file.md".to_owned(),
            Self::Lower(..) | Self::Emit(..) => {
                "check the exponents of the numbers in the model".to_owned()
            }
            Self::NoFunction { asked, .. } => why_no_function(asked),
            Self::NotOfEquations(_) => "write the terms into the equations".to_owned(),
            Self::TooLongToSet { .. } => {
                "leave out terms (--terms inertia,gravity), or take --json".to_owned()
            }
            Self::NoParallelAxes(_) => "choose the basis fourier or product".to_owned(),
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
            | Self::Decompose(..)
            | Self::Equations(_)
            | Self::Read { .. }
            | Self::Bake(_)
            | Self::Mistaken(_)
            | Self::Stdout(_) => return None,
        })
    }
}

/// Whether a function finds a point of the ground.
fn is_of_ground(name: &str) -> bool {
    use FunctionName::{CapturePoint, CartTableZmp, FootRotationIndicator, ZeroMomentPoint};
    let points = [ZeroMomentPoint, CartTableZmp, FootRotationIndicator, CapturePoint];
    points.iter().any(|point| point.as_str() == name)
}

/// Why a model has none of these functions.
fn why_no_function(asked: &[String]) -> String {
    let why = |name: &String| match name.as_str() {
        name if name.contains("contact") => "contacts are declared under \"contacts\"",
        name if name.starts_with("base_") => {
            "`denavit base` says why its base parameters are not found"
        }
        name if is_of_ground(name) => {
            "points of the ground are those of robots with a floating base and contact points"
        }
        "state_rates" => "it has no effects with states",
        _ => {
            "its mass matrix has no inverse (a joint moves no mass, or none of its own), or an \
             effect depends on what would have to be found"
        }
    };
    let mut reasons: Vec<&str> = asked.iter().map(why).collect();
    reasons.dedup();
    reasons.join("; ")
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
            Self::Bake(error) => write!(f, "{error}")?,
            Self::Output(error) => write!(f, "{error}")?,
            Self::Equations(error) => write!(f, "{error}")?,
            Self::Decompose(error) => write!(f, "{error}")?,
            Self::NotOfEquations(name) => write!(
                f,
                "{name}: equations have no --with, --terms, --basis, --numeric or --certificate"
            )?,
            Self::TooLongToSet { name, formulas } => {
                write!(f, "{name}: {formulas} formulas are too many for a document")?;
            }
            Self::NoParallelAxes(model) => {
                write!(f, "{model}: there are no parallel axes whose angles could be cumulated")?;
            }
            Self::NoModel { name, is_path: true, .. } => write!(f, "{name}: no such file")?,
            Self::NoModel { name, is_path: false, .. } => {
                write!(f, "{name}: there is no such file, and no shipped model of that name")?;
            }
            Self::Read { file, error } => write!(f, "{file}: cannot be read: {}", reason(error))?,
            Self::TooLarge { file, limit } => {
                write!(f, "{file}: has more than the {limit} bytes that are read")?;
            }
            Self::NoMotionTerms(model) => {
                write!(f, "{model}: base parameters need inertia or gravity among the terms")?;
            }
            Self::ModelledAndMore => write!(f, "--with modelled stands alone")?,
            Self::Effect(model, effect) => {
                write!(f, "{model}: this has no place for the effect `{effect}`")?;
            }
            Self::Apart(model, error) => write!(f, "{model}: {error}")?,
            Self::Lower(model, error) => write!(f, "{model}: {error}")?,
            Self::Emit(model, error) => write!(f, "{model}: {error}")?,
            Self::NoFunction { model, asked } => {
                write!(f, "{model}: the model has no {}", asked.join(", "))?;
            }
            Self::Base(file, error) if matches!(**error, BaseError::Inexact { .. }) => {
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
            Self::Mistaken(mistaken) => write!(f, "{mistaken}")?,
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
            Self::States(file, why) => write!(f, "{file}: these are no states: {why}"),
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
