//! What becomes of a robot that was disturbed.

use denavit_simulate::{Breakdown, Stop};

/// How a disturbed run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// It walks to the end.
    Walks,
    /// Something that must not touch the ground did; holds the point, and when \[s\].
    Fell(String, f64),
    /// The laws of contact, or the steps of the integration, have no answer there \[s\].
    NoAnswer(Stop, f64),
    /// It did not begin.
    NoStart,
}

impl Outcome {
    /// Of the end of a run.
    pub(super) fn of(stop: Stop, t_s: f64) -> Self {
        match stop {
            Stop::End => Self::Walks,
            Stop::Fall(point) => Self::Fell(point, t_s),
            // a base that has rolled by a quarter turn lies on its side
            Stop::Breakdown(Breakdown::SingularPose) => Self::Fell("base".to_owned(), t_s),
            stop => Self::NoAnswer(stop, t_s),
        }
    }

    /// Whether it walks.
    pub fn walks(&self) -> bool {
        *self == Self::Walks
    }

    /// One word for tables and JSON.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Walks => "walks",
            Self::Fell(..) => "fell",
            Self::NoAnswer(stop, _) => stop.word(),
            Self::NoStart => "no_start",
        }
    }
}
