//! Trajectories that excite what is to be identified.

use crate::error::{Cause, Error};
use crate::files::Files;
use crate::mistaken::FileKind;
use crate::observer::{Observer, Progress, Stage, Watched};
use denavit_codegen::model::Robot;
use denavit_excite::{self as excite, Check, ExciteOptions, Excited, Stack};
use denavit_simulate::scenario::read_trajectory;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::thread;

/// Looks for a trajectory within the limits of a robot that excites its base parameters. If the
/// observer stops it, the best so far is the answer.
///
/// # Errors
/// All that is wrong with the options, or limits that no trajectory can keep.
pub fn excite(
    robot: &Robot,
    options: &ExciteOptions,
    observer: &mut dyn Observer,
) -> Result<Excited, Error> {
    let mut watched = Watched::new(observer);
    let stage = Stage::Exciting(options.starts);
    let is_stopped = AtomicBool::new(!watched.begins(stage));
    let (sender, heard) = mpsc::channel::<excite::Progress>();
    // Starts go on side by side in other threads, and an observer is heard in its own.
    let found = thread::scope(|scope| {
        let is_stopped = &is_stopped;
        let searching = scope.spawn(move || {
            let tell = |progress: &excite::Progress| {
                sender.send(*progress).is_ok() && !is_stopped.load(Ordering::Relaxed)
            };
            excite::excite(robot, options, &tell)
        });
        let (mut evaluations, mut condition) = (BTreeMap::new(), None);
        for progress in heard {
            evaluations.insert(progress.start, progress.evaluations);
            // the share is that of all evaluations that may be made
            let most = options.evaluations.saturating_mul(options.starts).max(1);
            let share = Some((evaluations.values().sum::<usize>() as f64 / most as f64).min(1.0));
            if progress.iterate.excess <= 0.0 {
                let here = progress.iterate.condition;
                condition = Some(condition.map_or(here, |best: f64| best.min(here)));
            }
            if !watched.progress(&Progress { stage, share, condition, ..Progress::default() }) {
                is_stopped.store(true, Ordering::Relaxed);
            }
        }
        searching.join()
    });
    let found = found.unwrap_or_else(|panicked| std::panic::resume_unwind(panicked));
    Ok(found.map_err(Cause::Excite)?)
}

/// Checks the trajectory of a file against the limits of a robot, and says what it excites.
///
/// # Errors
/// All that is wrong with the trajectory or the options, or why it is not read.
pub fn check_excitation(
    files: &Files,
    robot: &Robot,
    options: &ExciteOptions,
    path: &Path,
) -> Result<(Check, Stack), Error> {
    let load = |log: &str| files.beside(path, log);
    let bytes = files.wanted(path, FileKind::Trajectory)?;
    let trajectory = read_trajectory(&path.display().to_string(), &bytes, &load);
    let checked = excite::check_trajectory(robot, options, &trajectory.map_err(Cause::Scenario)?);
    Ok(checked.map_err(Cause::Excite)?)
}
