//! The functions: documentation, signature, statements.

use super::dialect::Dialect;
use super::enumerations::{members, type_of};
use super::parameters::Items;
use super::syntax::{InC, InCpp};
use super::{comment, remark};
use crate::emit::body::Body;
use crate::emit::context::Context;
use crate::emit::layout::template;
use crate::emit::names::Names;
use crate::emit::routine::{
    commented, dimensions, output_doc, parts, reads_parameters, summary_and_arguments,
    unread_arguments, vocabulary,
};
use crate::emit::selectors::{Selector, links};
use crate::emit::syntax::Syntax;
use crate::emit::wording::{operations, summary};
use crate::function::FunctionName;
use crate::program::{OutputShape, Routine, counts};

/// Where a signature stands.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    /// Declared in a header.
    Declared,
    /// Defined with its statements.
    Defined,
}

/// All functions. What chooses by link comes after what it chooses from.
pub(super) fn items(context: &Context<'_>, dialect: &Dialect) -> Items {
    let names = context.function_names();
    let routines = &context.program.routines;
    let mut items = Items::default();
    for (row, (routine, name)) in routines.iter().zip(&names).enumerate() {
        items.definitions.push(function(context, dialect, routine, name));
        if routine.link.is_none() {
            declare(context, dialect, routine, &mut items);
        } else if !routines[row + 1..].iter().any(|later| later.name == routine.name) {
            items.definitions.push(dispatch(context, dialect, routine, &names));
            declare(context, dialect, routine, &mut items);
        }
    }
    items
}

/// The declaration in C's header.
fn declare(context: &Context<'_>, dialect: &Dialect, routine: &Routine, items: &mut Items) {
    if dialect.is_cpp {
        return;
    }
    let start = format!("void {}_{}", dialect.prefix, routine.name);
    let arguments = arguments(context, dialect, routine, Side::Declared, routine.link.is_some());
    items.declarations.push(doc(context, routine) + &signature(&start, &arguments) + ";\n");
}

fn function(context: &Context<'_>, dialect: &Dialect, routine: &Routine, name: &str) -> String {
    let is_public = routine.link.is_none();
    let start = match (dialect.is_cpp, is_public) {
        (true, _) => format!("inline void {name}"),
        (false, true) => format!("void {}_{name}", dialect.prefix),
        (false, false) => format!("static void {name}"),
    };
    let doc = match &routine.link {
        Some(link) => {
            let counts = operations(&counts(context.program, routine));
            remark(&format!("{} Of the link `{}`: {counts}.", summary(routine.name), comment(link)))
        }
        None if dialect.is_cpp => doc(context, routine),
        None => String::new(),
    };
    let arguments = arguments(context, dialect, routine, Side::Defined, false);
    let lines = statements(context, dialect, routine);
    frame(dialect, &doc, &signature(&start, &arguments), &lines)
}

/// The statements of a function. Each entry of a result is stored as soon as it is there.
fn statements(context: &Context<'_>, dialect: &Dialect, routine: &Routine) -> Vec<String> {
    let mut lines = Vec::new();
    if dialect.is_cpp {
        lines.push(dialect.exact());
    }
    if context.has_parameters() && !reads_parameters(routine) {
        lines.push("(void)p;".to_owned());
    }
    lines.extend(unread_arguments(routine).iter().map(|name| format!("(void){name};")));
    let results = results(routine);
    let places = routine.outputs.iter().zip(&results).flat_map(|(output, name)| {
        (0..output.len()).map(move |entry| Some(format!("{name}[{entry}]")))
    });
    let names: Vec<&str> = results.iter().map(String::as_str).collect();
    let parameters = if dialect.is_cpp { "p." } else { "p->" };
    let vocabulary = vocabulary(context, routine, parameters, &names, places.collect());
    let in_c = InC { scalar: dialect.scalar() };
    let syntax: &dyn Syntax = if dialect.is_cpp { &InCpp } else { &in_c };
    let mut body = Body::new(&routine.code, syntax, vocabulary);
    body.store_leaves();
    body.write_all();
    lines.extend(body.take_lines());
    lines
}

/// The function that chooses by link.
fn dispatch(
    context: &Context<'_>,
    dialect: &Dialect,
    routine: &Routine,
    names: &[String],
) -> String {
    let selector = Selector::of(routine.name);
    let members = members(dialect, selector, &links(context, selector));
    let mut passed = Vec::new();
    if context.has_parameters() {
        passed.push("p".to_owned());
    }
    passed.extend(routine.arguments.iter().map(|shape| shape.name.to_owned()));
    passed.extend(results(routine));
    let passed = passed.join(", ");
    let mut lines = vec![format!("switch ({}) {{", selector.argument())];
    for (row, name) in parts(context, routine, names) {
        lines.push(format!("case {}:", members[row]));
        lines.push(format!("    {name}({passed});"));
        lines.push("    break;".to_owned());
    }
    lines.push("}".to_owned());
    let (start, doc) = match dialect.is_cpp {
        true => (format!("inline void {}", routine.name), doc(context, routine)),
        false => (format!("void {}_{}", dialect.prefix, routine.name), String::new()),
    };
    let arguments = arguments(context, dialect, routine, Side::Defined, true);
    frame(dialect, &doc, &signature(&start, &arguments), &lines)
}

fn frame(dialect: &Dialect, doc: &str, signature: &str, lines: &[String]) -> String {
    let head = if dialect.is_cpp { "template <typename S>\n" } else { "" };
    template(
        include_str!("../../../templates/c/function.c.in"),
        &[("doc", doc), ("signature", &format!("{head}{signature}")), ("body", &lines.join("\n"))],
    )
}

/// The arguments with their types; the results are the last ones.
fn arguments(
    context: &Context<'_>,
    dialect: &Dialect,
    routine: &Routine,
    side: Side,
    is_chosen: bool,
) -> Vec<String> {
    let (prefix, upper) = (&dialect.prefix, &dialect.upper);
    let dof = format!("{upper}_DOF");
    let real = match side {
        Side::Declared => format!("{prefix}_real"),
        Side::Defined => dialect.scalar().to_owned(),
    };
    // A declaration without `restrict` fits a definition with it, and is C++, too.
    let restrict = if side == Side::Defined { "restrict " } else { "" };
    let array = |qualifier: &str, name: &str, length: &str| match dialect.is_cpp {
        true if qualifier.is_empty() => format!("S *{upper}_RESTRICT {name}"),
        true => format!("const S *{name}"),
        false => format!("{qualifier}{real} {name}[{restrict}{length}]"),
    };
    let mut arguments = Vec::new();
    if context.has_parameters() {
        arguments.push(match (dialect.is_cpp, side) {
            (true, _) => "const Parameters<S> &p".to_owned(),
            (false, Side::Declared) => format!("const {prefix}_parameters *parameters"),
            (false, Side::Defined) => format!("const {prefix}_parameters *restrict p"),
        });
    }
    if is_chosen {
        let selector = Selector::of(routine.name);
        arguments.push(format!("{} {}", type_of(dialect, selector), selector.argument()));
    }
    arguments.extend(routine.arguments.iter().map(|shape| match shape.name {
        "t" => format!("{real} t"),
        name @ ("states" | "f") => array("const ", name, &shape.len.to_string()),
        name => array("const ", name, &dof),
    }));
    for (output, name) in routine.outputs.iter().zip(results(routine)) {
        let dimensions = dimensions(context, routine, output, &dof);
        let length = if dimensions.is_empty() { "1".to_owned() } else { dimensions.join(" * ") };
        arguments.push(array("", &name, &length));
    }
    arguments
}

/// `void name(arguments)`, on one line if it fits; `start` goes up to the name.
fn signature(start: &str, arguments: &[String]) -> String {
    let line = format!("{start}({})", arguments.join(", "));
    // Room for ` {`.
    if line.len() <= 98 {
        return line;
    }
    let lines: Vec<String> = arguments.iter().map(|argument| format!("    {argument}")).collect();
    format!("{start}(\n{})", lines.join(",\n"))
}

/// The names of the results, which none of the arguments has.
fn results(routine: &Routine) -> Vec<String> {
    let name = |output: &OutputShape| match (routine.name, routine.outputs.len()) {
        (FunctionName::InverseDynamics | FunctionName::Bias, 1) => "tau",
        (FunctionName::ForwardDynamics, 1) => "qdd",
        (FunctionName::MassMatrixSolve, 1) => "x",
        _ => output.name,
    };
    let mut names = Names::fields(super::C);
    routine.arguments.iter().for_each(|shape| {
        names.claim(shape.name);
    });
    ["p", "link", "foot"].iter().for_each(|name| {
        names.claim(name);
    });
    routine.outputs.iter().map(|output| names.unique(name(output))).collect()
}

fn doc(context: &Context<'_>, routine: &Routine) -> String {
    let mut lines = summary_and_arguments(routine);
    let selector = Selector::of(routine.name).argument();
    if routine.link.is_some() {
        lines.insert(
            2,
            format!("- `{selector}`: which {selector}; another value leaves the results alone"),
        );
    }
    // What is said of one link holds for each of them.
    let one = routine.link.as_ref().map(|link| format!("link {}", comment(link)));
    let of_each = |text: String| match &one {
        Some(one) => text.replace(one, &format!("the {selector}")),
        None => text,
    };
    for (output, name) in routine.outputs.iter().zip(results(routine)) {
        let shape: Vec<String> = output.shape.iter().map(ToString::to_string).collect();
        let shape = match &shape[..] {
            [] => "one number".to_owned(),
            [length] => format!("{length} entries"),
            _ => shape.join(" x "),
        };
        let doc = of_each(output_doc(output, comment));
        lines.push(format!("- `{name}`: result, {shape}. {doc}."));
        let details = output.details.iter();
        lines.extend(details.map(|detail| format!("    - {}", of_each(comment(detail)))));
    }
    if routine.link.is_none() {
        let counts = operations(&counts(context.program, routine));
        lines.extend([String::new(), format!("One call: {counts}.")]);
    }
    commented(&lines)
}
