//! The functions: documentation, signature, statements, result.

use super::enumerations::variants;
use super::filling::{array_name, empty_arrays, entry_places, filled_result, fills_arrays};
use super::syntax::Rust;
use super::{bound, template};
use crate::emit::arrays::{Place, array};
use crate::emit::body::{Body, Vocabulary};
use crate::emit::context::Context;
use crate::emit::names::camel_case;
use crate::emit::routine::{
    commented, dimensions, output_doc, parts, reads_parameters, summary_and_arguments,
    unread_arguments, vocabulary as shared_vocabulary,
};
use crate::emit::selectors::{Selector, links};
use crate::emit::wording::{documentation, operations, summary, wrapped};
use crate::function::FunctionName;
use crate::program::{OutputShape, Routine, counts};

/// All functions, with the structs of their results.
pub(super) fn items(context: &Context<'_>) -> Vec<String> {
    let names = context.function_names();
    let mut items = Vec::new();
    let mut dispatched: Vec<FunctionName> = Vec::new();
    for (routine, name) in context.program.routines.iter().zip(&names) {
        if routine.link.is_none() || !dispatched.contains(&routine.name) {
            items.extend(results(context, routine));
        }
        if routine.link.is_some() && !dispatched.contains(&routine.name) {
            dispatched.push(routine.name);
            items.push(dispatch(context, routine, &names));
        }
        items.push(function(context, routine, name));
    }
    items
}

/// A function.
fn function(context: &Context<'_>, routine: &Routine, name: &str) -> String {
    let code = &routine.code;
    let mut body = Body::new(code, &Rust, vocabulary(context, routine));
    let mut lines = prologue(routine);
    if fills_arrays(routine) {
        lines.extend(empty_arrays(context, routine));
        body.store_leaves();
        body.write_all();
        lines.extend(body.take_lines());
        lines.extend(filled_result(routine));
        return finished(context, routine, name, &body, &lines);
    }
    body.write_all();
    code.outputs.iter().for_each(|&output| body.declare(output));
    lines.extend(body.take_lines());
    let entries: Vec<&str> = code.outputs.iter().map(|&output| body.text(output)).collect();
    if let (true, [entry]) = (is_scalar(routine), &entries[..]) {
        let result = scalar_result(entry, &mut lines);
        lines.push(result);
    } else {
        lines.extend(result_lines(routine, &entries));
    }
    finished(context, routine, name, &body, &lines)
}

/// A function of its statements.
fn finished(
    context: &Context<'_>,
    routine: &Routine,
    name: &str,
    body: &Body<'_>,
    lines: &[String],
) -> String {
    let is_public = routine.link.is_none();
    let result = result_type(context, routine);
    let start = if is_public { format!("pub fn {name}") } else { format!("fn {name}") };
    let signature = signature(routine, &start, &arguments(routine), &result);
    let mut doc = doc(context, routine);
    if body.is_in_blocks() {
        doc += "#[rustfmt::skip] // each name would get a line of its own\n";
    }
    frame(&doc, is_public, &signature, lines)
}

/// Documentation, attributes, signature and statements together.
fn frame(doc: &str, is_public: bool, signature: &str, lines: &[String]) -> String {
    let mut attributes = String::new();
    if is_public {
        attributes += "#[must_use]\n";
    }
    if lines.iter().any(|line| line.contains("from_f64(")) {
        attributes +=
            "#[allow(clippy::approx_constant)] // a model's number may lie near a famous one\n";
    }
    template(
        include_str!("../../../templates/rust/function.rs.in"),
        &[
            ("doc", doc),
            ("attributes", &attributes),
            ("signature", signature),
            ("body", &lines.join("\n")),
        ],
    )
}

/// How the values of a routine are written.
fn vocabulary(context: &Context<'_>, routine: &Routine) -> Vocabulary {
    if !fills_arrays(routine) {
        return shared_vocabulary(context, routine, "p.", &[], Vec::new());
    }
    let arrays = routine.outputs.iter().map(|output| array_name(routine, output));
    let arrays: Vec<&str> = arrays.collect();
    shared_vocabulary(context, routine, "p.", &arrays, entry_places(routine))
}

/// Statements before all others: a short name for the parameters; arguments that nothing reads are
/// read, so that the compiler does not warn.
fn prologue(routine: &Routine) -> Vec<String> {
    let parameters =
        if reads_parameters(routine) { "let p = parameters;" } else { "let _ = parameters;" };
    let mut lines = vec![parameters.to_owned()];
    lines.extend(unread_arguments(routine).iter().map(|name| format!("let _ = {name};")));
    lines
}

/// The arguments with their types.
fn arguments(routine: &Routine) -> Vec<String> {
    let vectors = routine.arguments.iter().map(|shape| match shape.name {
        "t" => "t: S".to_owned(),
        name @ ("states" | "f") => format!("{name}: &[S; {}]", shape.len),
        name => format!("{name}: &[S; DOF]"),
    });
    std::iter::once("parameters: &Parameters<S>".to_owned()).chain(vectors).collect()
}

/// `pub fn name<S: Scalar>(arguments) -> result`, on one line if it fits; `start` goes up to the
/// name.
fn signature(routine: &Routine, start: &str, arguments: &[String], result: &str) -> String {
    let start = format!("{start}<S: {}>", bound(routine.code.is_transcendental()));
    let line = format!("{start}({}) -> {result}", arguments.join(", "));
    // Room for ` {`.
    if line.len() <= 98 {
        return line;
    }
    let lines: String = arguments.iter().map(|argument| format!("    {argument},\n")).collect();
    format!("{start}(\n{lines}) -> {result}")
}

fn doc(context: &Context<'_>, routine: &Routine) -> String {
    let counts = operations(&counts(context.program, routine));
    if let Some(link) = &routine.link {
        let of = format!("Of the link `{}`: {counts}.", documentation(link));
        return wrapped("/// ", &format!("{} {of}", summary(routine.name)));
    }
    let mut lines = summary_and_arguments(routine);
    if !routine.arguments.is_empty() {
        lines.push(String::new());
    }
    if let [output] = &routine.outputs[..] {
        lines.push(format!("Result: {}.", output_doc(output, documentation)));
        lines.push(String::new());
        if !output.details.is_empty() {
            let details = output.details.iter();
            lines.extend(details.map(|detail| format!("- {}", documentation(detail))));
            lines.push(String::new());
        }
    }
    lines.push(format!("One call: {counts}."));
    commented(&lines)
}

/// The struct of several outputs.
fn results(context: &Context<'_>, routine: &Routine) -> Option<String> {
    if routine.outputs.len() == 1 {
        return None;
    }
    let field = |output: &OutputShape| {
        let doc = wrapped("/// ", &format!("{}.", output_doc(output, documentation)));
        format!("{doc}pub {}: {},\n", output.name, array_type(context, routine, output))
    };
    Some(template(
        include_str!("../../../templates/rust/results.rs.in"),
        &[
            ("function", routine.name.as_str()),
            ("name", &camel_case(routine.name.as_str())),
            ("fields", &routine.outputs.iter().map(field).collect::<String>()),
        ],
    ))
}

fn result_type(context: &Context<'_>, routine: &Routine) -> String {
    match &routine.outputs[..] {
        [output] => array_type(context, routine, output),
        _ => format!("{}<S>", camel_case(routine.name.as_str())),
    }
}

/// `[[S; 3]; DOF]`: outermost dimension last.
fn array_type(context: &Context<'_>, routine: &Routine, output: &OutputShape) -> String {
    array_of("S", context, routine, output)
}

/// An array in the shape of an output: of one type, or of one value.
pub(super) fn array_of(
    entry: &str,
    context: &Context<'_>,
    routine: &Routine,
    output: &OutputShape,
) -> String {
    let dimensions = dimensions(context, routine, output, "DOF");
    dimensions
        .iter()
        .rev()
        .fold(entry.to_owned(), |inner, dimension| format!("[{inner}; {dimension}]"))
}

fn is_scalar(routine: &Routine) -> bool {
    matches!(&routine.outputs[..], [output] if output.shape.is_empty())
}

/// The result of a function that computes one number: what the last statement assigns, if that is
/// the number.
fn scalar_result(entry: &str, lines: &mut Vec<String>) -> String {
    let assigned = lines.last().and_then(|line| {
        line.strip_prefix(&format!("let {entry} = "))
            .map(|value| value.trim_end_matches(';').to_owned())
    });
    if assigned.is_some() {
        lines.pop();
    }
    assigned.unwrap_or_else(|| entry.to_owned())
}

/// The arrays of the result, in their struct if there are several.
fn result_lines(routine: &Routine, entries: &[&str]) -> Vec<String> {
    let place = match routine.outputs.len() {
        1 => Place { indent: 4, followed: false },
        _ => Place { indent: 8, followed: true },
    };
    let mut rest = entries;
    let mut arrays = Vec::new();
    for output in &routine.outputs {
        let (own, others) = rest.split_at(output.len());
        rest = others;
        arrays.push(array(&output.shape, own, place));
    }
    match &arrays[..] {
        [array] => array.clone(),
        _ => {
            let mut lines = vec![format!("{} {{", camel_case(routine.name.as_str()))];
            for (output, array) in routine.outputs.iter().zip(&arrays) {
                let mut array = array.clone();
                array[0].insert_str(0, &format!("{}: ", output.name));
                array.last_mut().expect("an array has a line").push(',');
                lines.extend(array.iter().map(|line| format!("    {line}")));
            }
            lines.push("}".to_owned());
            lines
        }
    }
}

/// The public function that chooses by link.
fn dispatch(context: &Context<'_>, first: &Routine, names: &[String]) -> String {
    let selector = Selector::of(first.name);
    let variants = variants(&links(context, selector));
    let vectors = first.arguments.iter().map(|shape| format!(", {}", shape.name));
    let vectors: String = vectors.collect();
    let arm = |&(row, name): &(usize, &str)| {
        let chosen = format!("{}::{}", selector.type_name(), variants[row]);
        format!("    {chosen} => {name}(parameters{vectors}),")
    };
    let arms: Vec<String> = parts(context, first, names).iter().map(arm).collect();
    let mut lines = vec![format!("match {} {{", selector.argument())];
    lines.extend(arms);
    lines.push("}".to_owned());

    let is_transcendental = |routine: &&Routine| routine.code.is_transcendental();
    let all = context.program.routines.iter().filter(|routine| routine.name == first.name);
    let bounding = all.clone().find(is_transcendental).unwrap_or(first);
    let mut arguments = arguments(first);
    arguments.insert(1, format!("{}: {}", selector.argument(), selector.type_name()));
    let result = result_type(context, first);
    let start = format!("pub fn {}", first.name);
    let signature = signature(bounding, &start, &arguments, &result);
    let mut doc = summary_and_arguments(first);
    if let [output] = &first.outputs[..] {
        doc.extend([String::new(), format!("Result: {}.", output_doc(output, documentation))]);
    }
    frame(&commented(&doc), true, &signature, &lines)
}
