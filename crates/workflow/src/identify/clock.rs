//! The clock of a long log: rows at equal distances of time, so that places are times.

use denavit_measure::log::{LogFault, LogRemark, MeasuredLog};

/// How far a sample may be from where equal distances have it, in steps: nearer to it than to any
/// other.
const MOST_OFF: f64 = 0.5;

/// Times of the samples of a long log.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    /// Of the first \[s\].
    pub(super) start_s: f64,
    /// The distance of samples \[s\].
    pub(super) step_s: f64,
    /// Whether suspicions are no faults.
    pub(super) accepts_suspicious: bool,
}

impl Clock {
    /// Gives a stretch that begins at a row of the log the clock of the whole; what is wrong if its
    /// rows are not at their times, were repaired, or are suspicious by themselves.
    pub(super) fn set(self, log: &mut MeasuredLog, first: usize) -> Vec<LogFault> {
        let start_s = self.start_s + first as f64 * self.step_s;
        let last = log.samples().max(1) - 1;
        let off_first = (log.start_s - start_s) / self.step_s;
        let off_last = off_first + last as f64 * (log.step_s / self.step_s - 1.0);
        let off = if off_last.abs() > off_first.abs() { off_last } else { off_first };
        (log.start_s, log.step_s) = (start_s, self.step_s);
        let of_clock = (off.abs() > MOST_OFF).then(|| {
            LogFault::other(format!(
                "samples are {:.1} steps from where equal distances of time have them\n  hint: a \
                 log that is read piece by piece has all of its samples: cut it where some are \
                 missing, or resample it",
                off.abs()
            ))
        });
        let of_remark = |remark: LogRemark| match remark {
            LogRemark::DroppedRepeats { .. }
            | LogRemark::FilledGaps { .. }
            | LogRemark::Resampled { .. } => Some(LogFault::other(format!(
                "{remark}: a log that is read piece by piece is not repaired\n  hint: cut it \
                 before and behind these rows, or resample it"
            ))),
            LogRemark::Accepted(one) if !self.accepts_suspicious && one.is_of_samples() => {
                Some(LogFault::Suspicion(one))
            }
            _ => None,
        };
        let remarks = std::mem::take(&mut log.remarks);
        of_clock.into_iter().chain(remarks.into_iter().filter_map(of_remark)).collect()
    }
}
