//! Who watches long work, and may stop it.

use crate::error::{Cause, Error};
use std::fmt;

/// What work is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage {
    /// Logs are read, checked and filtered.
    #[default]
    ReadingLogs,
    /// They are read again, behind a filter whose cutoff was halved so often.
    ReadingLogsAgain(u32),
    /// Logs that judge are read again, behind a lower filter.
    ReadingHeldOutAgain,
    /// A long log is read piece by piece.
    Condensing,
    /// Parameters are estimated.
    Estimating,
    /// They are estimated again, behind a filter whose cutoff was halved so often.
    EstimatingAgain(u32),
    /// Logs are simulated without noise, as instruments.
    SimulatingInstruments,
    /// The identified model moves as the logs did.
    SimulatingLogs,
    /// Effects of the catalogue are evaluated.
    EvaluatingEffects,
    /// So many effects have been found.
    EffectsFound(usize),
    /// A scenario is simulated.
    Simulating,
    /// Trajectories are searched that excite a robot; holds of how many starts.
    Exciting(usize),
    /// The cycle of a gait is looked for.
    FollowingCycle,
    /// A gait is walked from starts off its cycle.
    Starts,
    /// A robot is pushed.
    Pushes,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ReadingLogs => write!(f, "reading logs"),
            Self::ReadingLogsAgain(1) => write!(f, "reading logs, filter halved once"),
            Self::ReadingLogsAgain(times) => write!(f, "reading logs, filter halved {times} times"),
            Self::ReadingHeldOutAgain => {
                write!(f, "reading logs for validation, filter halved")
            }
            Self::Condensing => write!(f, "reading the log piece by piece"),
            Self::Estimating => write!(f, "estimating"),
            Self::EstimatingAgain(1) => write!(f, "estimating, filter halved once"),
            Self::EstimatingAgain(times) => write!(f, "estimating, filter halved {times} times"),
            Self::SimulatingInstruments => write!(f, "simulating instruments"),
            Self::SimulatingLogs => write!(f, "simulating the logs again"),
            Self::EvaluatingEffects => write!(f, "effects evaluated"),
            Self::EffectsFound(1) => write!(f, "one effect found"),
            Self::EffectsFound(count) => write!(f, "{count} effects found"),
            Self::Simulating => write!(f, "simulating"),
            Self::FollowingCycle => write!(f, "following the cycle"),
            Self::Starts => write!(f, "starts"),
            Self::Pushes => write!(f, "pushes"),
            Self::Exciting(1) => write!(f, "searching from one start"),
            Self::Exciting(starts) => write!(f, "searching from {starts} starts"),
        }
    }
}

/// How far work has come.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress<'a> {
    /// What is being done.
    pub stage: Stage,
    /// The share of the stage that is done, from 0 to 1, where that is known: where logs are read
    /// or simulated again, effects evaluated, a scenario simulated, trajectories searched, or gaits
    /// disturbed.
    pub share: Option<f64>,
    /// The best answer so far: effects that are missing, each with its place.
    pub best: &'a [[String; 2]],
    /// The lowest condition number of a trajectory so far, where these are searched.
    pub condition: Option<f64>,
}

/// Who watches. A closure is one.
pub trait Observer {
    /// Work has come so far. Answers whether to go on. Work that is not to go on returns what it
    /// has; where that is nothing, an error of [`ErrorKind::Stopped`](crate::ErrorKind::Stopped).
    fn progress(&mut self, progress: &Progress<'_>) -> bool;
}

impl<F: FnMut(&Progress<'_>) -> bool> Observer for F {
    fn progress(&mut self, progress: &Progress<'_>) -> bool {
        self(progress)
    }
}

/// Watches nothing, and stops nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    fn progress(&mut self, _: &Progress<'_>) -> bool {
        true
    }
}

/// An observer, and whether it has stopped the work.
pub(crate) struct Watched<'a> {
    observer: &'a mut dyn Observer,
    /// Whether the work was stopped.
    pub(crate) is_stopped: bool,
}

impl<'a> Watched<'a> {
    pub(crate) fn new(observer: &'a mut dyn Observer) -> Self {
        Self { observer, is_stopped: false }
    }

    /// Who watches.
    pub(crate) fn observer(&mut self) -> &mut dyn Observer {
        self.observer
    }

    /// A stage has come so far; whether to go on.
    pub(crate) fn share(&mut self, stage: Stage, share: f64) -> bool {
        self.progress(&Progress { stage, share: Some(share), ..Progress::default() })
    }

    /// A stage begins; whether to go on. Work that was stopped stays so.
    pub(crate) fn begins(&mut self, stage: Stage) -> bool {
        self.progress(&Progress { stage, ..Progress::default() })
    }

    /// Work has come so far; whether to go on.
    pub(crate) fn progress(&mut self, progress: &Progress<'_>) -> bool {
        self.is_stopped = self.is_stopped || !self.observer.progress(progress);
        !self.is_stopped
    }
}

/// Logs that are read one after the other.
pub(crate) struct Reading<'w, 'o> {
    watched: &'w mut Watched<'o>,
    stage: Stage,
    done: usize,
    count: usize,
    /// Whether one who stops the work now gets no answer. Else all logs are read to the end, since
    /// the answer needs them.
    may_end: bool,
}

impl<'w, 'o> Reading<'w, 'o> {
    /// Logs of which nothing is there yet.
    pub(crate) fn first(watched: &'w mut Watched<'o>, count: usize) -> Self {
        Self { watched, stage: Stage::ReadingLogs, done: 0, count, may_end: true }
    }

    /// Logs that are needed even if the work is to stop.
    pub(crate) fn needed(watched: &'w mut Watched<'o>, stage: Stage, count: usize) -> Self {
        Self { watched, stage, done: 0, count, may_end: false }
    }

    /// A log begins to be read.
    pub(crate) fn next(&mut self) -> Result<(), Error> {
        let share = self.done as f64 / self.count.max(1) as f64;
        self.done += 1;
        match self.watched.share(self.stage, share) || !self.may_end {
            true => Ok(()),
            false => Err(Cause::Stopped.into()),
        }
    }
}
