//! The functions of a model as numbers.

use crate::Ordered;
use denavit_codegen::model::Robot;
use denavit_codegen::program::{CalledFunction, Evaluated};
use serde::Serialize;

#[derive(Serialize)]
struct EvaluatedJson<'a> {
    model: &'a str,
    joints: Vec<&'a str>,
    links: Vec<&'a str>,
    states: Vec<Ordered<Ordered<Nested>>>,
}

/// An array of any number of dimensions.
#[derive(Serialize)]
#[serde(untagged)]
enum Nested {
    Number(f64),
    List(Vec<Nested>),
}

/// A JSON document: the names of joints and links and, state by state, each function with its
/// arrays, rows within rows.
pub fn evaluated_json<'a>(robot: &'a Robot, found: &Evaluated) -> impl Serialize + use<'a> {
    let arrays = |function: &CalledFunction| {
        let arrays = function.arrays.iter();
        let arrays = arrays.map(|one| (one.name.to_owned(), nested(&one.entries, &one.shape)));
        (function.name.clone(), Ordered(arrays.collect()))
    };
    let name = |link| robot.links[link].name.as_str();
    EvaluatedJson {
        model: &robot.name,
        joints: robot.joints().map(|(link, _)| name(link)).collect(),
        links: robot.links.values().map(|link| link.name.as_str()).collect(),
        states: found
            .states
            .iter()
            .map(|state| Ordered(state.iter().map(arrays).collect()))
            .collect(),
    }
}

fn nested(entries: &[f64], shape: &[usize]) -> Nested {
    match shape {
        [] => entries.first().map_or(Nested::List(Vec::new()), |&entry| Nested::Number(entry)),
        [first, rest @ ..] => {
            let size = entries.len().checked_div(*first).unwrap_or(0).max(1);
            Nested::List(entries.chunks(size).map(|part| nested(part, rest)).collect())
        }
    }
}
