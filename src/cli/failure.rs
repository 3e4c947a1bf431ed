//! Why a command stops: always the input's or the system's fault, with the way out.

use super::flags::by_flag;
use super::mistaken::other_command;
use super::output_failure::OutputFailure;
use denavit::demo::RobotError;
use denavit::derive::MotionError;
use denavit::emit::SourceError;
use denavit::emit::latex::TooLongToSet;
use denavit::import;
use denavit::program::{CodeError, StatesError};
use denavit::regressor::{DecomposedError, ProvenBaseError};
use denavit::report::html::FormulaError;
use denavit::simulate::scenario::ScenarioError;
use denavit::workflow::{self, Hint, reason};
use std::fmt;
use std::io;

/// Why a command stops before its answer.
#[derive(Debug)]
pub(crate) enum Failure {
    /// A description of a robot in another format is wrong.
    Import(import::Error),
    /// A model is not described in another format; holds the model.
    Export(String, import::Error),
    /// A file of states is wrong; holds the file and why.
    States(String, StatesError),
    /// An output is not written.
    Output(OutputFailure),
    /// The library has no answer, and says why.
    Library(Box<dyn std::error::Error>),
    /// The base parameters are not found; holds the file.
    Base(String, Box<ProvenBaseError>),
    /// A file is no certificate.
    Certificate { file: String, error: serde_json::Error },
    /// `--with modelled` was given with other joint parameters.
    ModelledAndMore,
    /// Options that only models have were given for equations; holds their name.
    NotOfEquations(String),
    /// A window that the run does not have; holds the run's beginning and end \[s\].
    Window([f64; 2]),
    /// A model has an effect beside its equations, for which a command has no place; holds model
    /// and effect.
    Effect(String, String),
    /// A use case has no answer.
    Work(workflow::Error),
    /// Options do not go together, or ask for what is not there.
    Misuse(Misuse),
    /// A gait has no answer; holds the scenario and why.
    Walk(String, String),
    /// A folder cannot be read; holds it and why.
    Folder(String, io::Error),
    /// A page that links to results of a folder is to be outside of it; holds both.
    Outside(String, String),
    /// Nothing can be served; holds the port and why.
    Serve(u16, String),
    /// A step was given for the scheme that chooses its own.
    StepOfEventScheme,
    /// The answer cannot be written to standard output.
    Stdout(io::Error),
}

/// What an answer of a use case has no place for.
#[derive(Debug)]
pub(crate) enum Misuse {
    /// Instruments for a method that takes none.
    UnusedInstruments,
    /// A picture of a simulation that was not made.
    NotSimulated,
    /// What was found makes no model.
    NoModel(denavit::plants::Error),
    /// A formula is not shown in a page.
    Formula(FormulaError),
}

impl fmt::Display for Misuse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnusedInstruments => {
                write!(f, "--instruments, and no method that takes them\n  hint: --method iv does")
            }
            Self::NotSimulated => write!(
                f,
                "--motion-svg: no log was simulated again\n  hint: --validate or --controller \
                 does that, for robots on a fixed base"
            ),
            Self::NoModel(error) => write!(f, "{error}"),
            Self::Formula(error) => write!(f, "{error}"),
        }
    }
}

impl From<Misuse> for Failure {
    fn from(misuse: Misuse) -> Self {
        Self::Misuse(misuse)
    }
}

impl From<MotionError> for Failure {
    fn from(error: MotionError) -> Self {
        match error {
            MotionError::NoFunction(error) => CodeError::NoFunction(error).into(),
            MotionError::Effect(model, effect) => Self::Effect(model, effect),
        }
    }
}

macro_rules! of_library {
    ($($error:ty),*) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Self::Library(Box::new(error))
            }
        })*
    };
}

of_library!(
    CodeError,
    DecomposedError,
    denavit::excite::Error,
    ScenarioError,
    SourceError,
    TooLongToSet
);

impl From<RobotError> for Failure {
    fn from(error: RobotError) -> Self {
        match error {
            RobotError::Source(error) => error.into(),
            RobotError::Base(error) => Self::Base(String::new(), Box::new(error)),
        }
    }
}

impl From<workflow::Error> for Failure {
    fn from(error: workflow::Error) -> Self {
        Self::Work(error)
    }
}

/// A hint of the library by the option that is meant.
fn by_option(hint: &Hint) -> String {
    match hint {
        Hint::AcceptSuspicious => "--accept-suspicious takes the logs as they are".to_owned(),
        Hint::GiveInstruments => {
            "--instruments LOG.., or --controller FILE to simulate them".to_owned()
        }
        Hint::SimulateInstruments => "--controller FILE simulates instruments".to_owned(),
        Hint::OtherWork(mistaken) => other_command(mistaken),
        hint => hint.to_string(),
    }
}

/// Errors of writing that are not turned into another failure are those of standard output.
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
            Self::ModelledAndMore => "the others add those of all joints".to_owned(),
            Self::Effect(..) => "see \"effects\" in docs/reference/model-file.md".to_owned(),
            Self::NotOfEquations(_) => "write the terms into the equations".to_owned(),
            Self::Certificate { .. } => {
                "give a file that `denavit base --certificate` wrote".to_owned()
            }
            Self::StepOfEventScheme => "add --scheme time-stepping".to_owned(),
            Self::Work(error) => {
                let hints: Vec<String> = error.hints().iter().map(by_option).collect();
                return (!hints.is_empty()).then(|| hints.join("\n  hint: "));
            }
            Self::Window(_) => "choose two times of the run".to_owned(),
            Self::Import(_)
            | Self::Export(..)
            | Self::States(..)
            | Self::Output(_)
            | Self::Misuse(_)
            | Self::Walk(..)
            | Self::Folder(..)
            | Self::Outside(..)
            | Self::Serve(..)
            | Self::Base(..)
            | Self::Library(_)
            | Self::Stdout(_) => return None,
        })
    }
}

/// A failure in the words of the library.
struct AsToldBelow<'a>(&'a Failure);

impl fmt::Display for AsToldBelow<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.cause(f)?;
        match self.0.hint() {
            Some(hint) => write!(f, "\n  hint: {hint}"),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&by_flag(&AsToldBelow(self).to_string()))
    }
}

impl Failure {
    fn cause(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // place and hint are part of these
            Self::Import(_) | Self::Export(..) | Self::States(..) => self.of_others(f)?,
            Self::Library(error) => write!(f, "{error}")?,
            Self::Output(error) => write!(f, "{error}")?,
            Self::NotOfEquations(name) => write!(
                f,
                "{name}: equations have no --with, --terms, --basis, --numeric or --certificate"
            )?,
            Self::ModelledAndMore => write!(f, "--with modelled stands alone")?,
            Self::Base(file, error) if error.is_inexact() => {
                write!(f, "{file}: {error} (`--numeric`)")?;
            }
            Self::Base(_, error) => write!(f, "{error}")?,
            Self::Certificate { file, error } => {
                write!(f, "{file}: is no certificate: {error}")?;
            }
            Self::Effect(model, effect) => {
                write!(f, "{model}: this has no place for the effect `{effect}`")?;
            }
            Self::Work(error) => write!(f, "{error}")?,
            Self::Misuse(error) => write!(f, "{error}")?,
            Self::Walk(scenario, why) => write!(f, "{scenario}: {why}")?,
            Self::Folder(folder, error) => {
                write!(f, "{folder}: cannot be read: {}", reason(error))?;
            }
            Self::Outside(file, folder) => write!(
                f,
                "{file}: is not in {folder}, whose results the page links to\n  hint: give the \
                 path of a file right in the folder"
            )?,
            Self::Serve(port, why) => write!(
                f,
                "--port {port}: cannot be listened on: {why}\n  hint: another port, or none for \
                 one that is free"
            )?,
            Self::StepOfEventScheme => {
                write!(f, "--step: the event-driven scheme chooses its steps itself")?;
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
            Self::Export(_, error) if error.kind() == import::ErrorKind::Description => {
                write!(f, "{error}")
            }
            Self::Export(model, error) => write!(f, "{model}: {error}"),
            Self::States(file, error) => write!(f, "{file}: {error}"),
            _ => Ok(()),
        }
    }
}

impl std::error::Error for Failure {}
