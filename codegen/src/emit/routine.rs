//! What the functions of a module have in common in all languages.

use super::body::Vocabulary;
use super::context::Context;
use super::names::Names;
use super::selectors::{Selector, links};
use super::wording::{argument, of_joints, summary, wrapped};
use crate::arena::Handle;
use crate::program::{Leaf, OutputShape, Routine};

/// How the values of a routine are written: parameters as fields of `parameters` (with the sign
/// that takes a field), arguments by their names, outputs to their places, in order. No value is
/// called as one of `reserved`.
pub(super) fn vocabulary(
    context: &Context<'_>,
    routine: &Routine,
    parameters: &str,
    reserved: &[&str],
    places: Vec<Option<String>>,
) -> Vocabulary {
    let text = |leaf: &Leaf| match *leaf {
        Leaf::Prelude(row) => Some(format!("{parameters}{}", context.prelude_fields[row])),
        Leaf::Argument { argument, entry } => Some(match routine.arguments[argument].name {
            "t" => "t".to_owned(),
            name => format!("{name}[{entry}]"),
        }),
        Leaf::Constant(_) | Leaf::Parameter(_) => None,
    };
    let mut names = Names::locals(context.words);
    reserved.iter().for_each(|name| {
        names.claim(name);
    });
    let mut entries = vec![Vec::new(); routine.code.slots];
    for (slot, place) in routine.code.outputs.iter().zip(places) {
        entries[slot.index()].extend(place);
    }
    Vocabulary {
        names,
        leaves: routine.code.leaves.values().map(text).collect(),
        named: vec![None; routine.code.slots],
        entries,
    }
}

/// Whether a routine reads parameters.
pub(super) fn reads_parameters(routine: &Routine) -> bool {
    routine.code.leaves.values().any(|leaf| matches!(leaf, Leaf::Prelude(_)))
}

/// The arguments that nothing reads.
pub(super) fn unread_arguments(routine: &Routine) -> Vec<&'static str> {
    let leaves = &routine.code.leaves;
    let is_read = |row: usize| {
        let reads =
            |leaf: &Leaf| matches!(leaf, Leaf::Argument { argument, .. } if *argument == row);
        leaves.values().any(reads)
    };
    let shapes = routine.arguments.iter().enumerate();
    shapes.filter(|(row, _)| !is_read(*row)).map(|(_, shape)| shape.name).collect()
}

/// The functions that a public function chooses from: the place of each among the links that are
/// chosen by, and its name.
pub(super) fn parts<'a>(
    context: &Context<'_>,
    first: &Routine,
    names: &'a [String],
) -> Vec<(usize, &'a str)> {
    let known = links(context, Selector::of(first.name));
    let routines = context.program.routines.iter().zip(names);
    let parts: Vec<(usize, &str)> = routines
        .filter(|(routine, _)| routine.name == first.name)
        .map(|(routine, name)| {
            let row = known.iter().position(|known| Some(*known) == routine.link.as_deref());
            (row.expect("the link is one of the links"), name.as_str())
        })
        .collect();
    assert!(
        parts.len() == known.len(),
        "{} is derived for each of its links or for none",
        first.name
    );
    parts
}

/// The dimensions of an output, outermost first; `dof` stands for the number of joints.
pub(super) fn dimensions(
    context: &Context<'_>,
    routine: &Routine,
    output: &OutputShape,
    dof: &str,
) -> Vec<String> {
    let (rows, columns) = of_joints(routine.name);
    let last = output.shape.len().saturating_sub(1);
    let dimension = |(place, &len): (usize, &usize)| {
        let of_joints = if place == last { columns } else { rows };
        if of_joints && len == context.dof { dof.to_owned() } else { len.to_string() }
    };
    output.shape.iter().enumerate().map(dimension).collect()
}

/// What a function computes, and a line for each argument.
pub(super) fn summary_and_arguments(routine: &Routine) -> Vec<String> {
    let mut lines = vec![summary(routine.name).to_owned(), String::new()];
    let shapes = routine.arguments.iter();
    lines.extend(shapes.map(|shape| format!("- `{}`: {}", shape.name, argument(shape))));
    lines
}

/// What the entries of an output are.
pub(super) fn output_doc(output: &OutputShape, text: fn(&str) -> String) -> String {
    text(&output.doc).trim_end_matches('.').to_owned()
}

/// Lines as a documentation comment.
pub(super) fn commented(lines: &[String]) -> String {
    let line = |line: &String| match line.is_empty() {
        true => "///\n".to_owned(),
        false => wrapped("/// ", line),
    };
    lines.iter().map(line).collect()
}
