//! The command inside another program: the same use cases, options and answers, for a caller in the
//! same process. The Python package is one.
//!
//! What a person reads of a run in a terminal goes to an [`Observer`]: notes and progress. Nothing
//! is written to standard output or error, and signals are left to the program.

use super::failure::Failure;
use super::files::{FILES, say_notes};
use super::printed::Printed;
use super::said::{Loudness, set_loudness};
use super::{Answer, Cli, Command};
use denavit::import::nothing_included;
use denavit::logs::MemoryLog;
use denavit::model::Robot;
use denavit::simulate::Log;
use denavit::workflow::{LogSource, PlacedFault, WholeRobot, described, faults_of};
use std::any::Any;
use std::cell::RefCell;
use std::ffi::OsString;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, ThreadId};

/// Who hears what a run says while it goes on.
pub trait Observer: Send + Sync {
    /// Something that the reader of the answer should know.
    fn note(&self, text: &str);

    /// What is being done now, and the share of it that is done where that is known. Answers
    /// whether to go on; a run that is not to stops at once, without an answer.
    fn progress(&self, stage: &str, share: Option<f64>) -> bool;
}

/// What a command answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answered {
    /// What it would have written to standard output: JSON, with `--json`.
    pub output: Vec<u8>,
    /// Whether the answer is good: exit code 0, not 1.
    pub is_good: bool,
}

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Unanswered {
    /// The arguments are wrong, as the command says it.
    Usage(String),
    /// Inputs are wrong; holds the subcommand.
    Input(&'static str, Vec<PlacedFault>),
    /// The observer did not want to go on.
    Stopped,
    /// A fault of denavit itself.
    Internal(String),
}

thread_local! {
    static OBSERVED: RefCell<Option<Observed>> = const { RefCell::new(None) };
}

/// Whether the process is another program's.
static IS_EMBEDDED: AtomicBool = AtomicBool::new(false);

/// A run with an observer.
#[derive(Clone)]
pub(super) struct Observed {
    observer: Arc<dyn Observer>,
    /// The thread that can end the run by unwinding.
    thread: ThreadId,
}

/// What unwinds a run that is not to go on.
struct Stopped;

impl Observed {
    pub(super) fn note(&self, text: &str) {
        self.observer.note(text);
    }

    /// Passes progress on; unwinds to [`answer`] if the run is not to go on.
    pub(super) fn progress(&self, stage: &str, share: Option<f64>) {
        let goes_on = self.observer.progress(stage, share);
        if !goes_on && thread::current().id() == self.thread {
            resume_unwind(Box::new(Stopped));
        }
    }
}

/// The observer of this thread's run; none in the command's own process.
pub(super) fn observed() -> Option<Observed> {
    OBSERVED.with_borrow(Clone::clone)
}

/// Whether signals belong to another program.
pub(super) fn is_embedded() -> bool {
    IS_EMBEDDED.load(Ordering::Relaxed)
}

/// Runs the command with its arguments, `identify tulip_leg --train leg.csv --json`, without its
/// name. Runs need a stack of 64 MiB for large models.
///
/// # Errors
/// What would end the command with exit code 2.
pub fn answer(arguments: &[OsString], observer: Arc<dyn Observer>) -> Result<Answered, Unanswered> {
    answer_of_logs(arguments, Vec::new(), observer)
}

/// A log in memory, in place of a file of an option.
#[derive(Clone, Debug)]
pub struct GivenLog {
    /// The option, `train` of `--train`.
    pub option: String,
    /// Which of its files, from 0.
    pub at: usize,
    /// What messages call it: a word, which faults have as their file.
    pub name: String,
    /// Its columns.
    pub log: MemoryLog,
}

/// The same with logs in memory, each in place of a file that the arguments name.
///
/// # Errors
/// As of [`answer`].
pub fn answer_of_logs(
    arguments: &[OsString],
    logs: Vec<GivenLog>,
    observer: Arc<dyn Observer>,
) -> Result<Answered, Unanswered> {
    let Cli { mut command, loudness } = parsed(arguments)?;
    for GivenLog { option, at, name, log } in logs {
        let place = command.logs_of(&option).and_then(|all| all.get_mut(at));
        let nowhere = || Unanswered::Internal(format!("no log {at} of --{option}"));
        *place.ok_or_else(nowhere)? = LogSource::Memory { name, log: Arc::new(log) };
    }
    let mut out = Printed::new(Vec::new());
    let ran = observed_run(command.name(), observer, || {
        set_loudness(loudness);
        command.run(&mut out)
    });
    ran.map(|answer| Answered { output: out.into_inner(), is_good: answer == Answer::Done })
}

/// The same of `simulate SCENARIO ..`, with the log of the run.
///
/// # Errors
/// As of [`answer`].
pub fn simulate(
    arguments: &[OsString],
    observer: Arc<dyn Observer>,
) -> Result<(Answered, Log), Unanswered> {
    let Cli { command, loudness } = parsed(arguments)?;
    let Command::Simulate(options) = &command else {
        return Err(Unanswered::Internal(format!("{} is no simulation", command.name())));
    };
    let mut out = Printed::new(Vec::new());
    let ran = observed_run(command.name(), observer, || {
        set_loudness(loudness);
        super::simulate::run_kept(options, &mut out)
    });
    ran.map(|(answer, log)| {
        (Answered { output: out.into_inner(), is_good: answer == Answer::Done }, log)
    })
}

/// A model that was read.
#[derive(Debug)]
pub struct OpenedModel {
    /// The robot, with its effects.
    pub robot: Robot,
    /// The text of its model file: of a URDF or MJCF that of the model that it became.
    pub source: String,
}

/// Reads the model of a path or of a shipped name, with definitions of effects from a folder, or
/// from the folder `effects` beside it.
///
/// # Errors
/// If there is none, or it is wrong.
pub fn open_model(
    place: &Path,
    effects: Option<&Path>,
    observer: Arc<dyn Observer>,
) -> Result<OpenedModel, Unanswered> {
    observed_run("inspect", observer, || Ok(opened(FILES.whole_robot(place, effects)?)))
}

/// The same of the text of a model file, a URDF or an MJCF. `name` is that of the file, for
/// messages alone.
///
/// # Errors
/// If it is wrong.
pub fn open_model_text(
    name: &str,
    text: &str,
    effects: Option<&Path>,
    observer: Arc<dyn Observer>,
) -> Result<OpenedModel, Unanswered> {
    observed_run("inspect", observer, || {
        let own = effects.map_or(Ok(Vec::new()), |folder| FILES.given_effects(folder))?;
        let read = described(name.to_owned(), text.as_bytes().to_vec(), &mut nothing_included)?;
        Ok(opened(WholeRobot::new(read, &own)?))
    })
}

fn opened(read: WholeRobot) -> OpenedModel {
    say_notes(&read.notes);
    OpenedModel { robot: read.robot, source: read.source }
}

fn parsed(arguments: &[OsString]) -> Result<Cli, Unanswered> {
    let whole = [OsString::from("denavit")].into_iter().chain(arguments.iter().cloned());
    Cli::of(whole).map_err(|error| Unanswered::Usage(error.render().to_string()))
}

/// Runs something with an observer, which may stop it.
fn observed_run<T>(
    command: &'static str,
    observer: Arc<dyn Observer>,
    run: impl FnOnce() -> Result<T, Failure>,
) -> Result<T, Unanswered> {
    IS_EMBEDDED.store(true, Ordering::Relaxed);
    FILES.forget();
    OBSERVED.set(Some(Observed { observer, thread: thread::current().id() }));
    let ran = catch_unwind(AssertUnwindSafe(run));
    OBSERVED.set(None);
    set_loudness(Loudness::default());
    match ran {
        Ok(Ok(answer)) => Ok(answer),
        Ok(Err(failure)) => Err(Unanswered::Input(command, faults_of(&failure.to_string()))),
        Err(payload) if payload.is::<Stopped>() => Err(Unanswered::Stopped),
        Err(payload) => Err(Unanswered::Internal(panic_text(payload.as_ref()))),
    }
}

fn panic_text(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| payload.downcast_ref::<&str>().copied());
    text.unwrap_or("no reason is given").to_owned()
}
