//! What a file or a name is, where something else is wanted: a fault of its first key would not say
//! that it is a good file for other work.

use crate::identify::STATICS_FORMAT;
use denavit_codegen::model::json::{self, Value};
use denavit_codegen::{effect, model, regressor};
use denavit_import as import;
use denavit_plants::shipped::{self, ShippedModel};
use denavit_simulate::scenario;
use denavit_walk::gait_file;
use std::fmt;

/// What a file is, or what is shipped under a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A model file.
    Model,
    /// A URDF or MJCF.
    Description,
    /// A file of equations.
    Equations,
    /// A scenario.
    Scenario,
    /// A gait.
    Gait,
    /// A controller.
    Controller,
    /// A trajectory.
    Trajectory,
    /// An effect.
    Effect,
    /// A certificate of base parameters.
    Certificate,
    /// Weighings and held postures.
    Statics,
    /// A log.
    Log,
}

/// What the key `format` of a file says.
const FORMATS: [(&str, FileKind); 9] = [
    (model::FORMAT, FileKind::Model),
    (model::equations::FORMAT, FileKind::Equations),
    (scenario::FORMAT, FileKind::Scenario),
    (gait_file::FORMAT, FileKind::Gait),
    (scenario::CONTROLLER_FORMAT, FileKind::Controller),
    (scenario::TRAJECTORY_FORMAT, FileKind::Trajectory),
    (effect::FORMAT, FileKind::Effect),
    (regressor::certificate::FORMAT, FileKind::Certificate),
    (STATICS_FORMAT, FileKind::Statics),
];

/// What is shipped; a name that stands twice is what stands first.
const SHIPPED: [(&[ShippedModel], FileKind); 6] = [
    (shipped::MODELS, FileKind::Model),
    (shipped::EQUATIONS, FileKind::Equations),
    (shipped::SCENARIOS, FileKind::Scenario),
    (shipped::GAITS, FileKind::Gait),
    (shipped::CONTROLLERS, FileKind::Controller),
    (shipped::TRAJECTORIES, FileKind::Trajectory),
];

/// The first bytes of logs that are no text.
const LOGS: [&[u8]; 4] = [b"\x89MCAP", b"PAR1", b"ARROW1", b"SQLite format 3\0"];

impl FileKind {
    /// What is shipped under a name.
    fn of_name(name: &str) -> Option<Self> {
        let has = |list: &[ShippedModel]| list.iter().any(|one| one.name == name);
        SHIPPED.into_iter().find(|(list, _)| has(list)).map(|(_, kind)| kind)
    }

    /// What a file says of itself; none where it says nothing that is known.
    fn of_bytes(bytes: &[u8]) -> Option<Self> {
        if import::is_description(bytes) {
            return Some(Self::Description);
        }
        if LOGS.iter().any(|magic| bytes.starts_with(magic)) || is_csv_log(bytes) {
            return Some(Self::Log);
        }
        let root = json::parse(bytes).ok()?;
        let (_, tag) = root.entries().iter().find(|(key, _)| key == "format")?;
        let Value::Text(tag) = &tag.value else { return None };
        // a later version is of the same kind
        let kind = |text: &str| text.split('/').next().unwrap_or_default().to_owned();
        let known = FORMATS.into_iter().find(|(format, _)| kind(format) == kind(tag));
        known.map(|(_, kind)| kind)
    }

    fn word(self) -> &'static str {
        match self {
            Self::Model => "a model",
            Self::Description => "a URDF or MJCF",
            Self::Equations => "a file of equations",
            Self::Scenario => "a scenario",
            Self::Gait => "a gait",
            Self::Controller => "a controller",
            Self::Trajectory => "a trajectory",
            Self::Effect => "an effect",
            Self::Certificate => "a certificate",
            Self::Statics => "a file of weighings",
            Self::Log => "a log",
        }
    }

    /// What becomes of it.
    fn clause(self) -> &'static str {
        match self {
            Self::Model => "a model is read",
            Self::Description => "a URDF or MJCF is imported",
            Self::Equations => "equations are read",
            Self::Scenario => "a scenario is simulated",
            Self::Gait => "a gait is designed",
            Self::Controller => "a controller is read",
            Self::Trajectory => "a trajectory is checked",
            Self::Effect => "an effect is read",
            Self::Certificate => "a certificate is verified",
            Self::Statics => "weighings are read",
            Self::Log => "a log is read",
        }
    }
}

/// Whether the first row of a text is that of a log: names between commas, one of them the time.
fn is_csv_log(bytes: &[u8]) -> bool {
    let lines = bytes.split(|byte| *byte == b'\n');
    let mut rows = lines.filter(|line| !line.is_empty() && !line.starts_with(b"#"));
    let row = rows.next().and_then(|row| std::str::from_utf8(row).ok()).unwrap_or_default();
    let names: Vec<&str> = row.split(',').map(str::trim).collect();
    names.len() > 1 && names.contains(&"t")
}

/// Something good where something else is wanted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistaken {
    /// The file, or the name of what is shipped.
    pub name: String,
    /// What it is.
    pub found: FileKind,
    /// What is wanted.
    pub wanted: FileKind,
}

impl Mistaken {
    /// If a file is something else that is known.
    pub(crate) fn file(name: &str, bytes: &[u8], wanted: FileKind) -> Option<Self> {
        Self::of(name, FileKind::of_bytes(bytes)?, wanted)
    }

    /// If something else is shipped under a name.
    pub(crate) fn name(name: &str, wanted: FileKind) -> Option<Self> {
        Self::of(name, FileKind::of_name(name)?, wanted)
    }

    fn of(name: &str, found: FileKind, wanted: FileKind) -> Option<Self> {
        let name = name.to_owned();
        (found != wanted).then_some(Self { name, found, wanted })
    }
}

impl fmt::Display for Mistaken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, found, wanted } = self;
        write!(f, "{name}: this is {}, where {}", found.word(), wanted.clause())
    }
}
