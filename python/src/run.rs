//! Use cases of the command, in a thread of their own: Python stays responsive, hears of progress,
//! and an interrupt stops them.

use crate::failure::{Failure, Wrong, internal};
use crate::keyword::{in_python, usage};
use denavit::cli::embedded::{self, Answered, GivenLog, Observer, Unanswered};
use denavit::logs::MemoryLog;
use denavit::model::Robot;
use denavit::simulate::Log;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// How often Python is asked for an interrupt.
const PATIENCE: Duration = Duration::from_millis(50);

/// Emitted code of large robots has large frames.
const STACK_BYTES: usize = 64 << 20;

/// What the thread of a run tells that of Python.
enum Told<T> {
    Progress(String, Option<f64>),
    Done(Result<T, Unanswered>),
}

/// Hears a run in its own threads.
struct Ear<T> {
    notes: Mutex<Vec<String>>,
    told: Mutex<Sender<Told<T>>>,
    is_stopped: AtomicBool,
}

impl<T: Send> Ear<T> {
    fn tell(&self, told: Told<T>) {
        // an error says that Python has gone on without an answer
        let _ = self.told.lock().unwrap_or_else(PoisonError::into_inner).send(told);
    }

    fn notes(&self) -> Vec<String> {
        std::mem::take(&mut self.notes.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl<T: Send> Observer for Ear<T> {
    fn note(&self, text: &str) {
        self.notes.lock().unwrap_or_else(PoisonError::into_inner).push(text.to_owned());
    }

    fn progress(&self, stage: &str, share: Option<f64>) -> bool {
        self.tell(Told::Progress(stage.to_owned(), share));
        !self.is_stopped.load(Ordering::Relaxed)
    }
}

/// Runs something in a thread of its own. `progress` hears the stage and the share of it that is
/// done, if that is known; an answer of `False` stops the run, as an exception does.
fn observed<T: Send + 'static>(
    py: Python<'_>,
    command: &str,
    progress: Option<&Bound<'_, PyAny>>,
    run: impl FnOnce(Arc<dyn Observer>) -> Result<T, Unanswered> + Send + 'static,
) -> PyResult<(T, Vec<String>)> {
    let (sender, told) = mpsc::channel();
    let ear = Arc::new(Ear {
        notes: Mutex::new(Vec::new()),
        told: Mutex::new(sender),
        is_stopped: AtomicBool::new(false),
    });
    let own = Arc::clone(&ear);
    let work = move || {
        let answer = run(Arc::clone(&own) as Arc<dyn Observer>);
        own.tell(Told::Done(answer));
    };
    let builder = thread::Builder::new().name("denavit".to_owned()).stack_size(STACK_BYTES);
    builder.spawn(work).map_err(internal)?;
    let told = Mutex::new(told);
    loop {
        let next = py
            .detach(|| told.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(PATIENCE));
        let heard = match next {
            Ok(Told::Done(answer)) => {
                let answer = answer.map_err(|why| raised(why, command))?;
                return Ok((answer, ear.notes()));
            }
            Ok(Told::Progress(stage, share)) => hear(progress, &stage, share),
            Err(RecvTimeoutError::Timeout) => Ok(true),
            Err(RecvTimeoutError::Disconnected) => {
                return Err(internal("a run ended without an answer"));
            }
        };
        let heard = heard.and_then(|goes_on| py.check_signals().map(|()| goes_on));
        match heard {
            Ok(true) => {}
            // the run unwinds at its next stage; nobody waits for it
            Ok(false) => {
                ear.is_stopped.store(true, Ordering::Relaxed);
                return Err(stopped());
            }
            Err(error) => {
                ear.is_stopped.store(true, Ordering::Relaxed);
                return Err(error);
            }
        }
    }
}

fn hear(progress: Option<&Bound<'_, PyAny>>, stage: &str, share: Option<f64>) -> PyResult<bool> {
    let Some(progress) = progress else { return Ok(true) };
    let answer = progress.call1((stage, share))?;
    Ok(answer.is_none() || answer.is_truthy()?)
}

/// The exception of a run of a command without an answer.
fn raised(why: Unanswered, command: &str) -> PyErr {
    match why {
        Unanswered::Usage(text) => Failure::argument(usage(&text, command)).into(),
        Unanswered::Input(class_of, all) => {
            let all = all.into_iter().map(|one| Wrong {
                file: one.file,
                place: one.line.map(|line| (line, one.column)),
                cause: in_python(&one.cause, command),
                hint: one.hint.as_deref().map(|hint| in_python(hint, command)),
            });
            Failure::all(class(class_of), all.collect()).into()
        }
        Unanswered::Stopped => stopped(),
        Unanswered::Internal(why) => internal(why),
    }
}

fn stopped() -> PyErr {
    PyKeyboardInterrupt::new_err("the run was stopped")
}

fn class(command: &str) -> &'static str {
    match command {
        "simulate" => "SimulateError",
        "walk" => "WalkError",
        "excite" => "ExciteError",
        "identify" | "long" => "IdentifyError",
        "diagnose" => "DiagnoseError",
        _ => "ModelError",
    }
}

/// A log in memory: its option, which of the logs of this it is, its name, what it says of itself,
/// its columns.
type Columns<'py> =
    (String, usize, String, Vec<(String, String)>, Vec<(String, PyReadonlyArray1<'py, f64>)>);

fn given((option, at, name, header, columns): Columns<'_>) -> GivenLog {
    let columns = columns.into_iter().map(|(name, array)| (name, array.as_array().to_vec()));
    GivenLog { option, at, name, log: MemoryLog { header, columns: columns.collect() } }
}

fn words(arguments: Vec<String>) -> Vec<OsString> {
    arguments.into_iter().map(OsString::from).collect()
}

/// Runs a command, with logs in memory in place of some that its arguments name: its JSON, whether
/// its answer is good, and notes.
#[pyfunction]
#[pyo3(signature = (arguments, progress=None, logs=Vec::new()))]
pub(crate) fn run(
    py: Python<'_>,
    arguments: Vec<String>,
    progress: Option<&Bound<'_, PyAny>>,
    logs: Vec<Columns<'_>>,
) -> PyResult<(String, bool, Vec<String>)> {
    let command = arguments.first().cloned().unwrap_or_default();
    let (arguments, logs) = (words(arguments), logs.into_iter().map(given).collect());
    let (answered, notes) = observed(py, &command, progress, move |observer| {
        embedded::answer_of_logs(&arguments, logs, observer)
    })?;
    let Answered { output, is_good } = answered;
    Ok((String::from_utf8(output).map_err(internal)?, is_good, notes))
}

/// What a simulation gives: summary as JSON, whether it is good, notes, columns and rows.
type Simulated<'py> = (String, bool, Vec<String>, Vec<String>, Bound<'py, PyArray2<f64>>);

/// Runs `simulate`, and keeps the log.
#[pyfunction]
#[pyo3(signature = (arguments, progress=None))]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    arguments: Vec<String>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Simulated<'py>> {
    let arguments = words(arguments);
    let ((answered, log), notes) = observed(py, "simulate", progress, move |observer| {
        embedded::simulate(&arguments, observer)
    })?;
    let Log { columns, values, .. } = log;
    let shape = [values.len() / columns.len().max(1), columns.len()];
    // the array takes the memory over
    let values = PyArray1::from_vec(py, values).reshape(shape)?;
    let text = String::from_utf8(answered.output).map_err(internal)?;
    Ok((text, answered.is_good, notes, columns, values))
}

/// A model with its text and with notes: of a place, or of a text with the name of its file.
pub(crate) fn open_model(
    py: Python<'_>,
    place: &str,
    text: Option<String>,
    effects: Option<PathBuf>,
) -> PyResult<(Robot, String, Vec<String>)> {
    let place = place.to_owned();
    let (opened, notes) = observed(py, "inspect", None, move |observer| {
        let effects = effects.as_deref();
        match text {
            Some(text) => embedded::open_model_text(&place, &text, effects, observer),
            None => embedded::open_model(Path::new(&place), effects, observer),
        }
    })?;
    Ok((opened.robot, opened.source, notes))
}

fn names(all: &[denavit::shipped::ShippedModel]) -> Vec<&'static str> {
    all.iter().map(|one| one.name).collect()
}

/// Names of the models that are part of the package.
#[pyfunction]
pub(crate) fn shipped_models() -> Vec<&'static str> {
    names(denavit::shipped::MODELS)
}

/// Names of the scenarios that are part of the package.
#[pyfunction]
pub(crate) fn shipped_scenarios() -> Vec<&'static str> {
    names(denavit::shipped::SCENARIOS)
}

/// Names of the gaits that are part of the package.
#[pyfunction]
pub(crate) fn shipped_gaits() -> Vec<&'static str> {
    names(denavit::shipped::GAITS)
}
