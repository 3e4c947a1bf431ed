//! Why work has no answer.

use crate::faults::{PlacedFault, faults_of};
use crate::files::reason;
use crate::mistaken::Mistaken;
use denavit_codegen::model::{FileError, ModelError};
use denavit_identify::doubt::MisreadColumns;
use denavit_measure::log::LogFault;
use denavit_plants::shipped::{self, ShippedModel};
use denavit_simulate::scenario::ScenarioError;
use std::fmt;
use std::io;
use std::path::Path;

/// Why work has no answer. It is printed with the file, the place and the cause of all that is
/// wrong; faults of a file have their hints below them. [`Error::hints`] has those of the whole.
#[derive(Debug)]
pub struct Error(Box<Cause>);

/// What kind of reason it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Neither a file nor a shipped one has this name.
    NotFound,
    /// A file is not read.
    Unreadable,
    /// A file says something that is wrong.
    Wrong,
    /// Files are right, and do not suit what is asked.
    Unsuitable,
    /// The observer stopped the work before there was anything.
    Stopped,
}

/// What to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Hint {
    /// A sentence.
    Advice(String),
    /// Logs can be taken as they are.
    AcceptSuspicious,
    /// Logs without noise, or a controller to simulate them, are needed.
    GiveInstruments,
    /// A controller simulates instruments.
    SimulateInstruments,
    /// A file is for other work.
    OtherWork(Mistaken),
}

impl fmt::Display for Hint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Advice(text) => write!(f, "{text}"),
            Self::AcceptSuspicious => write!(f, "`accepts_suspicious` takes the logs as they are"),
            Self::GiveInstruments => {
                write!(f, "give logs as `instruments`, or a `controller` to simulate them")
            }
            Self::SimulateInstruments => write!(f, "a `controller` simulates instruments"),
            Self::OtherWork(one) => write!(f, "`{}` is for other work", one.name),
        }
    }
}

/// All that is wrong with a file that describes a robot.
#[derive(Clone, Copy, Debug)]
pub enum RobotFaults<'a> {
    /// With a model file.
    Model(&'a ModelError),
    /// With a URDF or MJCF.
    Description(&'a FileError<denavit_import::Cause>),
}

/// What is wrong.
#[derive(Debug)]
pub(crate) enum Cause {
    /// A model file is wrong.
    Model(ModelError),
    /// A description of a robot in another format is wrong.
    Import(denavit_import::Error),
    /// Neither a file nor a shipped model has this name; holds the name, the shipped model that was
    /// meant, perhaps, and whether it can only be a file.
    NoModel { name: String, nearest: Option<&'static str>, is_path: bool },
    /// Neither a file nor a shipped one of a kind has this name; holds both, the one that was
    /// meant, perhaps, and all there are.
    NoShipped {
        kind: &'static str,
        name: String,
        nearest: Option<&'static str>,
        all: &'static [ShippedModel],
    },
    /// A file cannot be read.
    Read { file: String, error: io::Error },
    /// A file is larger than any model.
    TooLarge { file: String, limit: u64 },
    /// A model has an effect beside its equations, for which there is no place; holds model and
    /// effect.
    Effect(String, String),
    /// The effects of a model cannot be taken apart; holds the model.
    Apart(String, denavit_plants::Error),
    /// A scenario, a controller or a file of statics is wrong.
    Scenario(ScenarioError),
    /// No trajectory excites a robot as it is asked for.
    Excite(denavit_excite::Error),
    /// A log of the project's own columns is wrong.
    Log(denavit_simulate::Error),
    /// A model has no regression.
    Regression(denavit_plants::Error),
    /// A mapping of columns is wrong.
    Mapping(denavit_measure::Error),
    /// Logs are wrong.
    Logs(Vec<denavit_measure::Error>),
    /// A log cannot be conditioned; holds its name.
    Condition(String, denavit_measure::Error),
    /// A model has no plant; holds its name.
    Plant(String, denavit_plants::Error),
    /// Nothing can be identified; holds the name of the model or of the log.
    Identify(String, denavit_identify::Error),
    /// A log cannot be simulated again; holds its name.
    Replay(String, denavit_replay::Error),
    /// Columns seem to be other ones than they are taken for.
    Misread(Vec<MisreadColumns>),
    /// What was found makes no model.
    Update(denavit_plants::Error),
    /// Two stages need one log.
    OneLog,
    /// Measurements at rest do not fit the model; holds their file.
    Statics(String, denavit_statics::Error),
    /// Instrumental variables without instruments, and nothing to simulate them with.
    NoInstruments,
    /// Instruments that are a log for training itself, noise and all: its name.
    OwnInstruments(String),
    /// Knowledge is asked for, and the model states no standard deviation that says anything.
    NoPrior(String),
    /// Two logs for training say the same.
    SameLogs([String; 2]),
    /// A gait has no answer; holds the scenario and why.
    Walk(String, String),
    /// Something good stands where something else should.
    Mistaken(Mistaken),
    /// Nothing is diagnosed.
    Diagnosis(denavit_diagnose::Error),
    /// A log is not identified piece by piece; holds its name and why.
    Long(String, String),
    /// Stopped before there was anything.
    Stopped,
}

impl Error {
    /// A file that cannot be read.
    pub(crate) fn read(file: &Path, error: io::Error) -> Self {
        Cause::Read { file: file.display().to_string(), error }.into()
    }

    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        match &*self.0 {
            Cause::NoModel { .. } | Cause::NoShipped { .. } => ErrorKind::NotFound,
            Cause::Read { error, .. } if error.kind() == io::ErrorKind::NotFound => {
                ErrorKind::NotFound
            }
            Cause::Read { .. } | Cause::TooLarge { .. } => ErrorKind::Unreadable,
            Cause::Model(_)
            | Cause::Import(_)
            | Cause::Scenario(_)
            | Cause::Log(_)
            | Cause::Logs(_)
            | Cause::Mapping(_)
            | Cause::Statics(..)
            | Cause::Misread(_) => ErrorKind::Wrong,
            Cause::Stopped => ErrorKind::Stopped,
            _ => ErrorKind::Unsuitable,
        }
    }

    /// The faults of a file that describes a robot, each with its place; none where it is not such
    /// a file that is wrong.
    pub fn robot_faults(&self) -> Option<RobotFaults<'_>> {
        match &*self.0 {
            Cause::Model(error) => Some(RobotFaults::Model(error)),
            Cause::Import(error) => error.description().map(RobotFaults::Description),
            _ => None,
        }
    }

    /// What is wrong, one by one, with file, place and hint where these are known.
    pub fn faults(&self) -> Vec<PlacedFault> {
        faults_of(&self.to_string())
    }

    /// What to do about it.
    pub fn hints(&self) -> Vec<Hint> {
        let advice = |text: String| vec![Hint::Advice(text)];
        match &*self.0 {
            Cause::NoModel { nearest: Some(nearest), .. } => {
                advice(format!("`{nearest}` is a shipped model"))
            }
            Cause::NoModel { is_path: false, .. } => advice(format!(
                "give the path of a model file, or one of {}",
                listed(shipped::MODELS)
            )),
            Cause::NoModel { .. } => advice("check the path".to_owned()),
            Cause::NoShipped { kind, nearest: Some(nearest), .. } => {
                advice(format!("`{nearest}` is a shipped {kind}"))
            }
            Cause::NoShipped { kind, all, .. } => {
                advice(format!("give the path of a {kind} file, or one of {}", listed(all)))
            }
            Cause::Read { error, .. } => match error.kind() {
                io::ErrorKind::IsADirectory => {
                    advice("give the path of one model file in it".to_owned())
                }
                io::ErrorKind::PermissionDenied => {
                    advice("check the permissions of the file and of its directories".to_owned())
                }
                _ => Vec::new(),
            },
            Cause::TooLarge { .. } => {
                advice("a model is a table of some kilobytes: check the path".to_owned())
            }
            Cause::Effect(..) => {
                advice("see \"effects\" in docs/reference/model-file.md".to_owned())
            }
            Cause::Misread(_) => vec![Hint::AcceptSuspicious],
            Cause::NoInstruments => vec![Hint::GiveInstruments],
            Cause::OwnInstruments(_) => vec![Hint::SimulateInstruments],
            Cause::NoPrior(_) => advice(
                "{\"value\": 2, \"std\": 0.1} states one; all numbers that a parameter depends on \
                 must have one"
                    .to_owned(),
            ),
            Cause::Mistaken(mistaken) => vec![Hint::OtherWork(mistaken.clone())],
            Cause::SameLogs(_) => advice("name each log once".to_owned()),
            _ => Vec::new(),
        }
    }

    /// Whether all that is wrong with a log is that nothing moves.
    pub(crate) fn is_of_rest(&self) -> bool {
        let rests = |one: &denavit_measure::Error| {
            one.log_faults().is_some_and(|all| all.faults == [LogFault::NothingMoves])
        };
        matches!(&*self.0, Cause::Logs(faults) if faults.iter().all(rests))
    }

    /// Whether a file is not there.
    pub(crate) fn is_not_found(&self) -> bool {
        matches!(&*self.0, Cause::Read { error, .. } if error.kind() == io::ErrorKind::NotFound)
    }

    /// All of some logs, or the faults of all that are wrong.
    pub(crate) fn of_any_log<T>(
        logs: impl Iterator<Item = Result<T, Self>>,
    ) -> Result<Vec<T>, Self> {
        let (mut right, mut wrong) = (Vec::new(), Vec::new());
        for log in logs {
            match log {
                Ok(log) => right.push(log),
                Err(Self(cause)) => match *cause {
                    // a log may be given twice
                    Cause::Logs(faults) => {
                        for one in faults {
                            if !wrong.contains(&one) {
                                wrong.push(one);
                            }
                        }
                    }
                    cause => return Err(cause.into()),
                },
            }
        }
        if wrong.is_empty() { Ok(right) } else { Err(Cause::Logs(wrong).into()) }
    }
}

fn listed(all: &[ShippedModel]) -> String {
    let names: Vec<_> = all.iter().map(|one| one.name).collect();
    names.join(", ")
}

impl From<Cause> for Error {
    fn from(cause: Cause) -> Self {
        Self(Box::new(cause))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Model(error) => write!(f, "{error}"),
            Self::Import(error) => write!(f, "{error}"),
            Self::NoModel { name, is_path: true, .. } => write!(f, "{name}: no such file"),
            Self::NoModel { name, is_path: false, .. } => {
                write!(f, "{name}: there is no such file, and no shipped model of that name")
            }
            Self::NoShipped { kind, name, .. } => {
                write!(f, "{name}: there is no such file, and no shipped {kind} of that name")
            }
            Self::Read { file, error } => write!(f, "{file}: cannot be read: {}", reason(error)),
            Self::TooLarge { file, limit } => {
                write!(f, "{file}: has more than the {limit} bytes that are read")
            }
            Self::Effect(model, effect) => {
                write!(f, "{model}: this has no place for the effect `{effect}`")
            }
            Self::Apart(model, error) => write!(f, "{model}: {error}"),
            Self::Scenario(error) => write!(f, "{error}"),
            Self::Excite(error) => write!(f, "{error}"),
            Self::Log(error) => write!(f, "{error}"),
            Self::Regression(error) => write!(f, "{error}"),
            Self::Mapping(error) => write!(f, "{error}"),
            Self::Logs(all) => lines(f, all),
            Self::Condition(file, error) => write!(f, "{file}: {error}"),
            Self::Plant(model, error) => write!(f, "{model}: {error}"),
            Self::Identify(name, error) => write!(f, "{name}: {error}"),
            Self::Replay(name, error) => write!(f, "{name}: {error}"),
            Self::Misread(all) => lines(f, all),
            Self::Update(error) => write!(f, "{error}"),
            Self::OneLog => write!(f, "`identify_two_stage` takes one log for training"),
            Self::Statics(file, error) => {
                let faults = error.faults();
                let all: Vec<String> =
                    faults.iter().map(|fault| format!("{file}: {fault}")).collect();
                lines(f, &all)
            }
            Self::NoInstruments => write!(f, "`options.method=iv` needs instruments"),
            Self::OwnInstruments(file) => write!(
                f,
                "{file}: a log for training as instrument has its own noise in it, and would say \
                 what least squares does"
            ),
            Self::NoPrior(model) => write!(
                f,
                "{model}: `options.uses_prior`, and no base parameter is known by the standard \
                 deviations that the model states"
            ),
            Self::SameLogs([one, other]) => {
                write!(f, "{other} says the same as {one}: measured once, it counts once")
            }
            Self::Walk(scenario, why) => write!(f, "{scenario}: {why}"),
            Self::Mistaken(mistaken) => write!(f, "{mistaken}"),
            Self::Diagnosis(error) => write!(f, "{error}"),
            Self::Long(file, why) => write!(f, "{file}: {why}"),
            Self::Stopped => write!(f, "stopped before there was an answer"),
        }
    }
}

fn lines(f: &mut fmt::Formatter<'_>, all: &[impl fmt::Display]) -> fmt::Result {
    for (index, one) in all.iter().enumerate() {
        let end = if index > 0 { "\n" } else { "" };
        write!(f, "{end}{one}")?;
    }
    Ok(())
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &*self.0 {
            Cause::Model(error) => Some(error),
            Cause::Import(error) => Some(error),
            Cause::Read { error, .. } => Some(error),
            Cause::Apart(_, error) => Some(error),
            Cause::Scenario(error) => Some(error),
            Cause::Excite(error) => Some(error),
            Cause::Log(error) => Some(error),
            Cause::Regression(error) => Some(error),
            Cause::Mapping(error) => Some(error),
            Cause::Condition(_, error) => Some(error),
            Cause::Plant(_, error) => Some(error),
            Cause::Identify(_, error) => Some(error),
            Cause::Statics(_, error) => Some(error),
            Cause::Replay(_, error) => Some(error),
            Cause::Update(error) => Some(error),
            Cause::Diagnosis(error) => Some(error),
            Cause::NoModel { .. }
            | Cause::NoShipped { .. }
            | Cause::TooLarge { .. }
            | Cause::Effect(..)
            | Cause::Logs(_)
            | Cause::Misread(_)
            | Cause::OneLog
            | Cause::NoInstruments
            | Cause::OwnInstruments(_)
            | Cause::NoPrior(_)
            | Cause::SameLogs(_)
            | Cause::Walk(..)
            | Cause::Mistaken(_)
            | Cause::Long(..)
            | Cause::Stopped => None,
        }
    }
}
