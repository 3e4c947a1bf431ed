//! Trajectories that excite what is to be identified.

use crate::error::{Cause, Error};
use crate::observer::{Observer, Progress, Stage, Watched};
use denavit_codegen::model::Robot;
use denavit_excite::{self as excite, ExciteOptions, Excited};
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
        let mut starts = vec![None; options.starts];
        for progress in heard {
            if let Some(own) = starts.get_mut(progress.start) {
                *own = Some(progress);
            }
            let come_so_far = come_so_far(&starts, options);
            if !watched.progress(&come_so_far) {
                is_stopped.store(true, Ordering::Relaxed);
            }
        }
        searching.join()
    });
    let found = found.unwrap_or_else(|panicked| std::panic::resume_unwind(panicked));
    Ok(found.map_err(Cause::Excite)?)
}

/// The share is that of all evaluations that may be made.
fn come_so_far(starts: &[Option<excite::Progress>], options: &ExciteOptions) -> Progress<'static> {
    let begun = || starts.iter().flatten();
    let evaluations: usize = begun().map(|one| one.evaluations).sum();
    let most = options.evaluations.saturating_mul(starts.len()).max(1);
    let within = begun().filter(|one| one.iterate.excess <= 0.0);
    Progress {
        stage: Stage::Exciting(options.starts),
        share: Some((evaluations as f64 / most as f64).min(1.0)),
        condition: within.map(|one| one.iterate.condition).min_by(f64::total_cmp),
        ..Progress::default()
    }
}
