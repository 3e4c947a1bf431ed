//! Robots in three dimensions: runs that a reader plays back, joints that a reader moves.

use super::data::embedded;
use serde::Serialize;

/// A robot in three dimensions.
#[derive(Clone, Debug, Serialize)]
pub struct Replay {
    /// What it shows, for whom the picture does not.
    name: String,
    caption: String,
    marks: Vec<SceneMark>,
    events: Vec<ReplayEvent>,
    sliders: Vec<Slider>,
    has_time: bool,
    data: String,
}

/// What is around a robot that is drawn.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scene {
    /// What it shows, for whom the picture does not.
    pub(crate) name: String,
    /// What is to be known of it.
    pub(crate) caption: String,
    /// What is shown beside the robot.
    pub(crate) marks: Vec<SceneMark>,
    /// Joints that a reader moves.
    pub(crate) sliders: Vec<Slider>,
    /// Whether it is played back.
    pub(crate) has_time: bool,
}

/// A joint that a reader moves.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Slider {
    /// The joint.
    pub(crate) name: String,
    /// Of its positions.
    pub(crate) unit: &'static str,
    /// Its lowest position.
    pub(crate) low: f64,
    /// Its highest position.
    pub(crate) high: f64,
    /// Where it is at first.
    pub(crate) start: f64,
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
    fn named(self) -> SceneMark {
        let (key, word) = match self {
            Self::CenterOfMass => ("com", "centre of mass"),
            Self::ZeroMomentPoint => ("zmp", "zero moment point"),
            Self::CapturePoint => ("capture", "capture point"),
            Self::Support => ("support", "support polygon"),
            Self::Forces => ("force", "contact forces"),
        };
        SceneMark { key, word: word.to_owned(), is_toggled: true }
    }
}

/// What is shown beside a robot, or of it, in words.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SceneMark {
    /// What scripts and styles call it.
    key: &'static str,
    word: String,
    /// Whether a reader may hide it.
    is_toggled: bool,
}

impl SceneMark {
    /// The frames of the links.
    pub(crate) fn frames() -> Self {
        Self { key: "frames", word: "frames of the links".to_owned(), is_toggled: true }
    }

    /// The shapes of the links.
    pub(crate) fn shapes() -> Self {
        Self { key: "shapes", word: "shapes of the links".to_owned(), is_toggled: true }
    }

    /// The centre of mass.
    pub(crate) fn center_of_mass() -> Self {
        Mark::CenterOfMass.named()
    }

    /// Another motion of the same robot.
    pub(crate) fn beside(word: impl Into<String>) -> Self {
        Self { key: "beside", word: word.into(), is_toggled: true }
    }

    /// What two models leave of torques.
    pub(crate) fn left(words: [&str; 2]) -> [Self; 2] {
        let [before, after] = words.map(str::to_owned);
        [("before", before), ("after", after)].map(|(key, word)| Self {
            key,
            word,
            is_toggled: true,
        })
    }

    /// A joint or a body that stands out.
    pub(crate) fn marked(word: impl Into<String>) -> Self {
        Self { key: "marked", word: word.into(), is_toggled: false }
    }
}

/// What happened, in words.
#[derive(Clone, Debug, Serialize)]
struct ReplayEvent {
    at: String,
    text: String,
}

impl Replay {
    /// A run with what is shown beside it, other things of its script, and what happened;
    /// `data` is what the script draws.
    pub(crate) fn new(
        [name, caption]: [String; 2],
        marks: &[Mark],
        others: impl IntoIterator<Item = SceneMark>,
        events: impl Iterator<Item = (f64, String)>,
        data: &impl Serialize,
    ) -> Self {
        let marks = marks.iter().map(|mark| mark.named()).chain(others).collect();
        let scene = Scene { name, caption, marks, has_time: true, ..Scene::default() };
        Self {
            events: events.map(|(t, text)| ReplayEvent { at: format!("{t:.4} s"), text }).collect(),
            ..scene.shown(data)
        }
    }
}

impl Scene {
    /// The scene with what the script draws.
    pub(crate) fn shown(self, data: &impl Serialize) -> Replay {
        let Self { name, caption, marks, sliders, has_time } = self;
        let data = embedded(data);
        Replay { name, caption, marks, events: Vec::new(), sliders, has_time, data }
    }
}
