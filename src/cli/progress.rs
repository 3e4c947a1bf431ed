//! What a command is doing: a line on a terminal, now and then a line where standard error goes
//! elsewhere, and all of it for the observer of a run in another program. Short work shows nothing.

use super::embedded::{Observed, observed};
use super::printed::shown;
use super::said::{loudness, say_aside, say_time};
use denavit::workflow;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Work, and a stage of it, that takes less is not worth a word.
const SHORT: Duration = Duration::from_secs(2);

/// Where lines stay, a long stage has one this often.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// How often a terminal's line is drawn, and how often it is asked whether a line is due.
const TICK: Duration = Duration::from_millis(200);

/// Less than this share says little of the rest.
const TELLING_SHARE: f64 = 0.02;

/// The line that a terminal shows now: other messages go above it.
static DRAWN: Mutex<Option<ProgressBar>> = Mutex::new(None);

/// A poisoned lock holds a line that is half said, no harm.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes to standard error above the line that is shown there, if one is.
pub(super) fn above(write: impl FnOnce()) {
    match &*locked(&DRAWN) {
        Some(line) => line.suspend(write),
        None => write(),
    }
}

/// What is being done.
struct Stage {
    name: String,
    /// More about it, of this moment.
    detail: String,
    /// How much of it is done, from 0 to 1.
    share: Option<f64>,
    began: Instant,
    has_line: bool,
}

/// Work of one or more stages, one after the other.
struct Work {
    is_terminal: bool,
    /// Whether times of stages are reported.
    is_timed: bool,
    began: Instant,
    stage: Option<Stage>,
    /// When the last line was written, where lines stay.
    last_line: Option<Instant>,
}

/// Looks at the work now and then; ends with it.
struct Ticker {
    end: Sender<()>,
    thread: JoinHandle<()>,
}

/// Progress of some work; what is shown of it goes when it ends.
pub(crate) struct Progress {
    observed: Option<Observed>,
    work: Arc<Mutex<Work>>,
    ticker: Option<Ticker>,
}

impl Progress {
    /// Of work that begins now.
    pub(crate) fn new() -> Self {
        let observed = observed();
        let loudness = loudness();
        let work = Work {
            is_terminal: io::stderr().is_terminal(),
            is_timed: loudness.is_verbose() && observed.is_none(),
            began: Instant::now(),
            stage: None,
            last_line: None,
        };
        let work = Arc::new(Mutex::new(work));
        let is_shown = observed.is_none() && !loudness.is_quiet();
        let ticker = is_shown.then(|| Ticker::start(&work)).flatten();
        Self { observed, work, ticker }
    }

    /// Says what is being done now.
    pub(crate) fn show(&self, stage: &str) {
        self.show_part(stage, None, "");
    }

    /// Says what is being done now, how much of it is done where that is known, and a detail of
    /// this moment, which makes no stage of its own.
    pub(crate) fn show_part(&self, stage: &str, share: Option<f64>, detail: &str) {
        if let Some(observed) = &self.observed {
            observed.progress(stage, share);
        }
        let mut work = locked(&self.work);
        if work.stage.as_ref().is_none_or(|now| now.name != stage) {
            work.end_stage();
            let (name, began) = (stage.to_owned(), Instant::now());
            let detail = String::new();
            work.stage = Some(Stage { name, detail, share, began, has_line: false });
        }
        if let Some(now) = &mut work.stage {
            detail.clone_into(&mut now.detail);
            now.share = share.map(|share| share.clamp(0.0, 1.0));
        }
    }

    /// Watches a use case, and stops nothing.
    pub(crate) fn observer(&self) -> impl FnMut(&workflow::Progress<'_>) -> bool + '_ {
        |at| {
            self.report(at);
            true
        }
    }

    /// Says how far a use case has come.
    pub(crate) fn report(&self, at: &workflow::Progress<'_>) {
        let best = at.condition.map(|condition| format!("condition {condition:.4e}"));
        self.show_part(&at.stage.to_string(), at.share, best.as_deref().unwrap_or_default());
    }

    /// Ends the stage and takes its line away, so that an answer can be written.
    pub(crate) fn clear(&self) {
        let mut work = locked(&self.work);
        work.end_stage();
        // what comes after the answer is other work
        work.began = Instant::now();
        erase();
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(Ticker { end, thread }) = self.ticker.take() {
            drop(end);
            // a thread that panicked has said so
            let _ = thread.join();
        }
        self.clear();
    }
}

impl Ticker {
    /// None where the system has no thread to give: then nothing is shown.
    fn start(work: &Arc<Mutex<Work>>) -> Option<Self> {
        let (end, is_ended) = mpsc::channel();
        let work = Arc::clone(work);
        let look = move || {
            while is_ended.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                locked(&work).look(Instant::now());
            }
        };
        let thread = thread::Builder::new().name("progress".to_owned()).spawn(look).ok()?;
        Some(Self { end, thread })
    }
}

impl Work {
    fn end_stage(&mut self) {
        // a worker may begin the next stage: what is said is not asked of its thread
        if let Some(stage) = self.stage.take().filter(|_| self.is_timed) {
            say_time(&stage.name, stage.began.elapsed());
        }
    }

    /// Shows what is due now.
    fn look(&mut self, now: Instant) {
        if now.duration_since(self.began) < SHORT {
            return;
        }
        if self.is_terminal {
            if let Some(stage) = &self.stage {
                draw(stage, now);
            }
        } else if let Some(line) = self.due_line(now) {
            say_aside(&line);
        }
    }

    /// The line that is due where lines stay: one for a stage that is not short, one now and then
    /// of what takes long.
    fn due_line(&mut self, now: Instant) -> Option<String> {
        let began = self.began;
        let quiet_for = now.duration_since(self.last_line.unwrap_or(began));
        let stage = self.stage.as_mut()?;
        let is_first = !stage.has_line && now.duration_since(stage.began) >= SHORT;
        if !is_first && quiet_for < BETWEEN_LINES {
            return None;
        }
        stage.has_line = true;
        self.last_line = Some(now);
        Some(format!("progress: {}: {}", stage.name, stage.state(now)))
    }
}

impl Stage {
    /// How far it is: the share, the detail, and the time that is left where it is known.
    fn state(&self, now: Instant) -> String {
        let elapsed = now.duration_since(self.began);
        let share = self.share.map(|share| format!("{:.0} %", 100.0 * share));
        let detail = Some(self.detail.clone()).filter(|detail| !detail.is_empty());
        let left = self.share.and_then(|share| left(elapsed, share));
        let time = left.unwrap_or_else(|| format!("since {}", rounded(elapsed)));
        share.into_iter().chain(detail).chain([time]).collect::<Vec<_>>().join(", ")
    }
}

/// The rest of work of which a share is done, if it goes on as it went.
fn left(elapsed: Duration, share: f64) -> Option<String> {
    let told = elapsed >= SHORT && (TELLING_SHARE..1.0).contains(&share);
    told.then(|| format!("about {} left", rounded(elapsed.mul_f64((1.0 - share) / share))))
}

fn rounded(time: Duration) -> String {
    match time.as_secs_f64() {
        seconds if seconds < 100.0 => format!("{:.0} s", seconds.ceil()),
        seconds if seconds < 6000.0 => format!("{:.0} min", (seconds / 60.0).ceil()),
        seconds => format!("{:.0} h", (seconds / 3600.0).ceil()),
    }
}

/// Thousandths are enough for a bar.
const WHOLE: u64 = 1000;

/// Draws the line of a terminal.
fn draw(stage: &Stage, now: Instant) {
    let mut drawn = locked(&DRAWN);
    let line = drawn.get_or_insert_with(|| {
        ProgressBar::with_draw_target(Some(WHOLE), ProgressDrawTarget::stderr())
    });
    let template = match stage.share {
        Some(_) => "{spinner} [{bar:20}] {wide_msg}",
        None => "{spinner} {wide_msg}",
    };
    if let Ok(style) = ProgressStyle::with_template(template) {
        line.set_style(style.progress_chars("=> ").tick_chars("|/-\\ "));
    }
    let text = format!("{}: {}", stage.name, stage.state(now));
    line.set_message(shown(&text).replace(['\n', '\t'], " "));
    line.set_position((WHOLE as f64 * stage.share.unwrap_or(0.0)) as u64);
    line.tick();
}

/// Takes the line of a terminal away.
fn erase() {
    if let Some(line) = locked(&DRAWN).take() {
        line.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn work(share: Option<f64>, began: Instant) -> Work {
        let (name, detail) = ("searching".to_owned(), String::new());
        let stage = Some(Stage { name, detail, share, began, has_line: false });
        Work { is_terminal: false, is_timed: false, began, stage, last_line: None }
    }

    /// The seconds at which lines are due, of looks ten times a second.
    fn due(work: &mut Work, seconds: u64) -> Vec<u64> {
        let began = work.began;
        let at = |tenths: u64| Duration::from_millis(100 * tenths);
        let looks = (0..10 * seconds).filter(|&t| work.due_line(began + at(t)).is_some());
        looks.map(|tenths| tenths / 10).collect()
    }

    #[test]
    fn short_work_has_no_line_and_long_work_has_few() {
        let now = Instant::now();
        assert!(due(&mut work(None, now), 2).is_empty());
        assert_eq!(due(&mut work(None, now), 35), [2, 12, 22, 32]);
    }

    #[test]
    fn a_line_says_share_and_time_left() {
        let began = Instant::now();
        let mut half = work(Some(0.25), began);
        let line = half.due_line(began + Duration::from_secs(3));
        assert_eq!(line.as_deref(), Some("progress: searching: 25 %, about 9 s left"));
        let line = work(None, began).due_line(began + Duration::from_secs(3));
        assert_eq!(line.as_deref(), Some("progress: searching: since 3 s"));
    }

    #[test]
    fn times_are_rounded_up() {
        let texts = [0.4, 61.0, 119.0, 7000.0].map(|s| rounded(Duration::from_secs_f64(s)));
        assert_eq!(texts, ["1 s", "61 s", "2 min", "2 h"]);
    }
}
