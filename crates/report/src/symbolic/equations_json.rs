//! Equations of motion as JSON.

use super::{Intermediate, PLAIN_NODES, intermediates};
use crate::Ordered;
use denavit_codegen::derive::MotionEquations;
use denavit_codegen::expr::text::{print, print_with_intermediates};
use denavit_codegen::model::{JointLaw, Robot};
use serde::Serialize;

#[derive(Serialize)]
struct EquationsJson<'a> {
    model: &'a str,
    method: &'static str,
    joints: &'a [String],
    functions: Ordered<PartJson<'a>>,
    intermediates: Vec<Intermediate>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    effects: Vec<LawJson<'a>>,
}

#[derive(Serialize)]
struct LawJson<'a> {
    effect: &'a str,
    title: &'a str,
    joint: &'a str,
    torque: String,
    states: Ordered<String>,
}

#[derive(Serialize)]
struct PartJson<'a> {
    symbol: &'static str,
    shape: &'a [usize],
    entries: Vec<String>,
}

/// The equations of motion of a robot as a JSON document: every entry as text, with intermediates
/// where they are long.
pub fn equations_json<'a>(
    robot: &'a Robot,
    equations: &'a MotionEquations,
) -> impl Serialize + use<'a> {
    let entries: Vec<_> =
        equations.parts.iter().flat_map(|part| part.entries.iter().copied()).collect();
    let printed = print_with_intermediates(&equations.dag, &entries, PLAIN_NODES);
    let mut texts = printed.outputs.into_iter();
    let functions = equations.parts.iter().map(|part| {
        let own = texts.by_ref().take(part.entries.len()).collect();
        let json = PartJson { symbol: part.symbol, shape: &part.shape, entries: own };
        (part.key.clone(), json)
    });
    EquationsJson {
        model: &equations.model,
        method: equations.method,
        joints: &equations.joints,
        functions: Ordered(functions.collect()),
        intermediates: intermediates(printed.bindings),
        effects: robot.laws.iter().map(|law| law_json(robot, law)).collect(),
    }
}

fn law_json<'a>(robot: &'a Robot, law: &'a JointLaw) -> LawJson<'a> {
    let rates = law.states.iter();
    LawJson {
        effect: &law.effect,
        title: &law.title,
        joint: &robot.links[law.joint].name,
        torque: print(&robot.dag, law.torque),
        states: Ordered(
            rates.map(|state| (state.name.clone(), print(&robot.dag, state.rate))).collect(),
        ),
    }
}
