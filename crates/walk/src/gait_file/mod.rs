//! Gait files (`"denavit-gait/1"`): what a gait is to be, to be designed.
//!
//! One key says the kind; the gait's numbers stand under it. All faults of a file are found in one
//! run, each with its place, its cause and what to do about it.

pub(crate) mod divergent_component;
mod inverted_pendulum;
mod laws;
mod limit_cycle;
mod primitives;

use crate::gait_plan::{DivergentComponentProblem, InvertedPendulumProblem, PrimitivesProblem};
use crate::optimal::LimitCycleProblem;
use denavit_codegen::model::{Fields, Node, read_document};
use denavit_plants::Override;
use denavit_simulate::scenario::{NodeNumbers, Report, ScenarioError, check_format};

/// The tag of a gait file.
pub const FORMAT: &str = "denavit-gait/1";

/// The JSON Schema (draft 2020-12) of a gait file: its form, not its content.
pub fn schema() -> &'static str {
    include_str!("schema.json")
}

const KEYS: &[&str] = &[
    "format",
    "name",
    "description",
    "source",
    "model",
    "parameters",
    "primitives",
    "inverted_pendulum",
    "divergent_component",
    "limit_cycle",
];
/// The kinds of gaits, each a key.
const KINDS: &[&str] = &["primitives", "inverted_pendulum", "divergent_component", "limit_cycle"];
/// What a file without any of them lacks.
const ANY_KIND: &str = "an object with a kind of gait: `primitives`, `inverted_pendulum`, \
                        `divergent_component` or `limit_cycle`";

/// A gait, to be designed.
#[derive(Clone, Debug, PartialEq)]
pub struct GaitFile {
    /// Its name; empty if the file says none.
    pub name: String,
    /// What it shows.
    pub description: String,
    /// The robot: the name of a shipped model, or of a file.
    pub model: String,
    /// Values in place of the model's.
    pub parameters: Vec<Override>,
    /// What it is to be.
    pub kind: GaitKind,
}

/// What a gait is to be, by its kind.
#[derive(Clone, Debug, PartialEq)]
pub enum GaitKind {
    /// Statically stable postures, joined.
    Primitives(PrimitivesProblem),
    /// A walk by the linear inverted pendulum.
    InvertedPendulum(InvertedPendulumProblem),
    /// A walk in space on planned footsteps.
    DivergentComponent(DivergentComponentProblem),
    /// A limit cycle by periodic optimal control.
    LimitCycle(Box<LimitCycleProblem>),
}

/// Reads a gait file from its bytes; `file` is its name, for messages alone.
///
/// # Errors
/// All faults of the file.
pub fn read_gait(file: &str, source: &[u8]) -> Result<GaitFile, ScenarioError> {
    read_document(file, source, |root, report| {
        let fields = &root.fields(KEYS, report)?;
        check_format(fields, FORMAT, report);
        let text = |key: &str, report: &mut Report| {
            let node = fields.get(key);
            node.and_then(|node| node.text(report)).unwrap_or_default().to_owned()
        };
        let [name, description, _] = ["name", "description", "source"].map(|key| text(key, report));
        let model = fields.require("model", report).and_then(|node| node.text(report));
        let parameters = parameters(fields, report);
        let kind = kind(root, fields, report);
        Some(GaitFile { name, description, model: model?.to_owned(), parameters, kind: kind? })
    })
}

/// Values in place of the model's. Which parameters it has is known when it is loaded.
fn parameters(fields: &Fields<'_>, report: &mut Report) -> Vec<Override> {
    let given = fields.get("parameters").and_then(|node| node.members(report));
    let given = given.iter().flat_map(|members| members.all());
    let value = |(name, node): (&str, Node<'_>)| {
        let value = node.finite(report)?;
        Some(Override { parameter: name.to_owned(), value })
    };
    given.filter_map(value).collect()
}

fn kind(root: Node<'_>, fields: &Fields<'_>, report: &mut Report) -> Option<GaitKind> {
    let mut kinds = KINDS.iter().filter_map(|kind| Some((*kind, fields.get(kind)?)));
    let Some((kind, node)) = kinds.next() else {
        return root.wrong_kind(ANY_KIND, report);
    };
    if let Some((_, other)) = kinds.next() {
        other.wrong_kind::<(), _>("one kind of gait, not two", report);
    }
    Some(match kind {
        "primitives" => GaitKind::Primitives(primitives::read(node, report)?),
        "inverted_pendulum" => GaitKind::InvertedPendulum(inverted_pendulum::read(node, report)?),
        "divergent_component" => {
            GaitKind::DivergentComponent(divergent_component::read(node, report)?)
        }
        _ => GaitKind::LimitCycle(Box::new(limit_cycle::read(node, report)?)),
    })
}
