//! A run that a reader plays back in three dimensions.

use super::data::embedded;
use serde::Serialize;

/// A run in three dimensions.
#[derive(Clone, Debug, Serialize)]
pub struct Replay {
    /// What it shows, for whom the picture does not.
    name: String,
    caption: String,
    marks: Vec<NamedMark>,
    events: Vec<ReplayEvent>,
    data: String,
}

/// What is shown beside the robot, if a reader wants it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// The centre of mass, with its trail.
    CenterOfMass,
    /// The zero moment point.
    ZeroMomentPoint,
    /// The capture point.
    CapturePoint,
    /// The support polygon.
    Support,
    /// Forces on contact points.
    Forces,
}

impl Mark {
    /// What scripts and styles call it, and its words.
    fn named(self) -> NamedMark {
        let (key, word) = match self {
            Self::CenterOfMass => ("com", "centre of mass"),
            Self::ZeroMomentPoint => ("zmp", "zero moment point"),
            Self::CapturePoint => ("capture", "capture point"),
            Self::Support => ("support", "support polygon"),
            Self::Forces => ("force", "contact forces"),
        };
        NamedMark { key, word }
    }
}

#[derive(Clone, Copy, Debug, Serialize)]
struct NamedMark {
    key: &'static str,
    word: &'static str,
}

/// What happened, in words.
#[derive(Clone, Debug, Serialize)]
struct ReplayEvent {
    at: String,
    text: String,
}

impl Replay {
    /// A run with what is shown beside it and what happened; `data` is what the script draws.
    pub(crate) fn new(
        [name, caption]: [String; 2],
        marks: &[Mark],
        events: impl Iterator<Item = (f64, String)>,
        data: &impl Serialize,
    ) -> Self {
        Self {
            name,
            caption,
            marks: marks.iter().map(|mark| mark.named()).collect(),
            events: events.map(|(t, text)| ReplayEvent { at: format!("{t:.4} s"), text }).collect(),
            data: embedded(data),
        }
    }
}
