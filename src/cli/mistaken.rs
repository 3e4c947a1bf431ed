//! What a file or a name is, where something else is wanted: a fault of its first key would not say
//! that it is a good file for another command.

use denavit::model::json::{self, Value};
use denavit::shipped::{self, ShippedModel};
use denavit::{effect, import, model, regressor, simulate, walk};
use std::fmt;

/// What a file is, or what is shipped under a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Model,
    Description,
    Equations,
    Scenario,
    Gait,
    Controller,
    Trajectory,
    Effect,
    Certificate,
    Statics,
    Log,
}

/// What the key `format` of a file says.
const FORMATS: [(&str, Kind); 9] = [
    (model::FORMAT, Kind::Model),
    (model::equations::FORMAT, Kind::Equations),
    (simulate::scenario::FORMAT, Kind::Scenario),
    (walk::gait_file::FORMAT, Kind::Gait),
    (simulate::scenario::CONTROLLER_FORMAT, Kind::Controller),
    (simulate::scenario::TRAJECTORY_FORMAT, Kind::Trajectory),
    (effect::FORMAT, Kind::Effect),
    (regressor::certificate::FORMAT, Kind::Certificate),
    (denavit::identify::STATICS_FORMAT, Kind::Statics),
];

/// What is shipped; a name that stands twice is what stands first.
const SHIPPED: [(&[ShippedModel], Kind); 7] = [
    (shipped::MODELS, Kind::Model),
    (shipped::BODIES, Kind::Model),
    (shipped::EQUATIONS, Kind::Equations),
    (shipped::SCENARIOS, Kind::Scenario),
    (shipped::GAITS, Kind::Gait),
    (shipped::CONTROLLERS, Kind::Controller),
    (shipped::TRAJECTORIES, Kind::Trajectory),
];

/// The first bytes of logs that are no text.
const LOGS: [&[u8]; 4] = [b"\x89MCAP", b"PAR1", b"ARROW1", b"SQLite format 3\0"];

impl Kind {
    /// What is shipped under a name.
    pub(crate) fn of_name(name: &str) -> Option<Self> {
        let has = |list: &[ShippedModel]| list.iter().any(|one| one.name == name);
        SHIPPED.into_iter().find(|(list, _)| has(list)).map(|(_, kind)| kind)
    }

    /// What a file says of itself; none where it says nothing that is known.
    pub(crate) fn of_bytes(bytes: &[u8]) -> Option<Self> {
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
}

/// Whether the first row of a text is that of a log: names between commas, one of them the time.
fn is_csv_log(bytes: &[u8]) -> bool {
    let lines = bytes.split(|byte| *byte == b'\n');
    let mut rows = lines.filter(|line| !line.is_empty() && !line.starts_with(b"#"));
    let row = rows.next().and_then(|row| std::str::from_utf8(row).ok()).unwrap_or_default();
    let names: Vec<&str> = row.split(',').map(str::trim).collect();
    names.len() > 1 && names.contains(&"t")
}

/// What a command reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    Model,
    Scenario,
    Gait,
    Controller,
    Trajectory,
    Certificate,
    Statics,
    Description,
    Log,
}

impl Wanted {
    fn clause(self) -> &'static str {
        match self {
            Self::Model => "a model is read",
            Self::Scenario => "a scenario is simulated",
            Self::Gait => "a gait is designed",
            Self::Controller => "a controller is read",
            Self::Trajectory => "a trajectory is checked",
            Self::Certificate => "a certificate is verified",
            Self::Statics => "weighings are read",
            Self::Description => "a URDF or MJCF is imported",
            Self::Log => "a log is read",
        }
    }

    /// The same as [`Kind`].
    fn kind(self) -> Kind {
        match self {
            Self::Model => Kind::Model,
            Self::Scenario => Kind::Scenario,
            Self::Gait => Kind::Gait,
            Self::Controller => Kind::Controller,
            Self::Trajectory => Kind::Trajectory,
            Self::Certificate => Kind::Certificate,
            Self::Statics => Kind::Statics,
            Self::Description => Kind::Description,
            Self::Log => Kind::Log,
        }
    }
}

/// Something good where something else is wanted.
#[derive(Debug)]
pub(crate) struct Mistaken {
    name: String,
    found: Kind,
    wanted: Wanted,
}

impl Mistaken {
    /// If a file is something else that is known.
    pub(crate) fn file(name: &str, bytes: &[u8], wanted: Wanted) -> Option<Self> {
        Self::of(name, Kind::of_bytes(bytes)?, wanted)
    }

    /// If something else is shipped under a name.
    pub(crate) fn name(name: &str, wanted: Wanted) -> Option<Self> {
        Self::of(name, Kind::of_name(name)?, wanted)
    }

    fn of(name: &str, found: Kind, wanted: Wanted) -> Option<Self> {
        let name = name.to_owned();
        (found != wanted.kind()).then_some(Self { name, found, wanted })
    }

    /// What reads it, or how what is wanted is come by.
    fn hint(&self) -> String {
        let name = &self.name;
        match (self.found, self.wanted) {
            (Kind::Model | Kind::Description, Wanted::Scenario) => smallest_scenario(name),
            (Kind::Model | Kind::Description, Wanted::Gait) => "a gait file says how a model \
                walks: docs/reference/gait.md; `denavit list gaits` has those that are shipped"
                .to_owned(),
            (Kind::Model | Kind::Description, Wanted::Certificate) => {
                format!(
                    "`denavit verify CERTIFICATE {name}`; `denavit base --certificate` writes one"
                )
            }
            (Kind::Model | Kind::Description, _) => format!("`denavit inspect {name}` reads it"),
            (Kind::Equations, _) => format!("`denavit decompose {name}` reads it"),
            (Kind::Scenario, Wanted::Log) => {
                format!("`denavit simulate {name} -o run.csv` makes one of it")
            }
            (Kind::Scenario, _) => format!("`denavit simulate {name}` runs it"),
            (Kind::Gait, _) => {
                format!("a gait is designed first: `denavit walk design {name} -o walk.json`")
            }
            (Kind::Controller, _) => {
                format!("`denavit identify MODEL --train LOG --controller {name}` reads it")
            }
            (Kind::Trajectory, _) => {
                format!("a scenario names it, and `denavit excite MODEL --check {name}` reads it")
            }
            (Kind::Effect, _) => "a model names it; `--effects DIR` takes its folder".to_owned(),
            (Kind::Certificate, _) => format!("`denavit verify {name} MODEL` reads it"),
            (Kind::Statics, _) => format!("`denavit identify MODEL --static {name}` reads it"),
            (Kind::Log, _) => format!(
                "`denavit identify MODEL --train {name}` estimates parameters from it, `denavit \
                 diagnose` says what the model lacks"
            ),
        }
    }
}

impl fmt::Display for Mistaken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, found, wanted } = self;
        write!(f, "{name}: this is {}, where {}", found.word(), wanted.clause())?;
        write!(f, "\n  hint: {}", self.hint())
    }
}

/// What to write where a model alone was given.
fn smallest_scenario(model: &str) -> String {
    let model = serde_json::Value::from(model);
    format!(
        "a scenario says what a model does: {{\"format\": \"{}\", \"model\": {model}, \
         \"duration_s\": 1}} lets it go from rest; docs/reference/scenario.md has the rest, \
         `denavit schema scenario` all keys",
        simulate::scenario::FORMAT
    )
}
