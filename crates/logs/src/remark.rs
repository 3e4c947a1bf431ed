//! What was done to a file to get its columns, and is worth knowing.

use super::table::Place;
use std::fmt;

/// What was done to a file, or found in it, and needs no answer.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // the fields are what the messages name
pub enum FileRemark {
    /// The last line has no end, so that it may be cut: it was left out.
    CutLine { line: usize },
    /// The file is damaged from here on: what is before was read.
    Damaged { at: Place, whole: usize, cause: String },
    /// A topic was brought to the clock of another by interpolation; sampling rates.
    Joined { topic: String, rate_hz: f64, clock: String, clock_hz: f64 },
    /// Topics begin and end at different times: so long of the clock's topic was left out \[s\].
    OutsideOfOthers { clock: String, left_out_s: f64 },
    /// Some messages have no time of measurement: the times of recording count.
    RecordingTimes { topics: Vec<String> },
    /// Messages of topics that nothing here reads; topic and why.
    Unread { topics: Vec<(String, String)> },
    /// A definition of messages was not in the file: one of ours was taken.
    OwnDefinition { topic: String, kind: String },
}

/// Topics that are named; more would say nothing new.
const NAMED: usize = 4;

fn listed(names: impl ExactSizeIterator<Item = String>) -> String {
    let count = names.len();
    let mut text = names.take(NAMED).collect::<Vec<_>>().join(", ");
    if count > NAMED {
        text.push_str(&format!(" and {} more", count - NAMED));
    }
    text
}

impl fmt::Display for FileRemark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CutLine { line } => {
                write!(f, "line {line}, the last one, has no end and may be cut: left out")
            }
            Self::Damaged { at, whole, cause } => {
                write!(f, "damaged from {at} on ({cause}): the {whole} before were read")
            }
            Self::Joined { topic, rate_hz, clock, clock_hz } => write!(
                f,
                "`{topic}` ({rate_hz:.1} Hz) was interpolated at the times of `{clock}` \
                 ({clock_hz:.1} Hz)"
            ),
            Self::OutsideOfOthers { clock, left_out_s } => write!(
                f,
                "{left_out_s:.3} s of `{clock}` are before or after what other topics have: left \
                 out"
            ),
            Self::RecordingTimes { topics } => write!(
                f,
                "{}: no time of measurement in the messages, so the times of recording count",
                listed(topics.iter().map(|topic| format!("`{topic}`")))
            ),
            Self::Unread { topics } => write!(
                f,
                "not read: {}",
                listed(topics.iter().map(|(topic, why)| format!("`{topic}` ({why})")))
            ),
            Self::OwnDefinition { topic, kind } => write!(
                f,
                "`{topic}`: the file does not say what a {kind} is; the usual definition was taken"
            ),
        }
    }
}
