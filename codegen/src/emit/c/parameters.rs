//! The parameters that a user may set, and those that functions read.

use super::comment;
use super::dialect::Dialect;
use super::syntax::{InC, InCpp};
use crate::arena::Handle;
use crate::emit::body::{Body, Vocabulary};
use crate::emit::context::{Context, EmitError};
use crate::emit::layout::template;
use crate::emit::names::{C, Names};
use crate::emit::syntax::Syntax;
use crate::emit::wording::parameter_field;
use crate::program::{Leaf, code_counts};

/// What a header declares and a source defines; in C++ all of it is declared.
#[derive(Default)]
pub(super) struct Items {
    pub(super) declarations: Vec<String>,
    pub(super) definitions: Vec<String>,
}

/// The structs of parameters with their functions; nothing where no parameter is read.
pub(super) fn items(context: &Context<'_>, dialect: &Dialect) -> Result<Items, EmitError> {
    if !context.has_parameters() {
        return Ok(Items::default());
    }
    let values = context.default_values()?;
    // No value is made up: without all of them there are no defaults.
    let values: Option<Vec<f64>> = values.iter().copied().collect();
    let operations = code_counts(&context.program.prelude).total().to_string();
    Ok(match dialect.is_cpp {
        true => cpp(context, dialect, values.as_deref(), &operations),
        false => c(context, dialect, values.as_deref(), &operations),
    })
}

fn c(context: &Context<'_>, dialect: &Dialect, values: Option<&[f64]>, operations: &str) -> Items {
    let prefix = ("prefix", dialect.prefix.as_str());
    let (mut declared, mut defined) = (String::new(), Vec::new());
    let prelude = prelude(context, &InC { scalar: "double" }, "model->", "parameters->");
    defined.push(template(
        include_str!("../../../templates/c/prepare.c.in"),
        &[prefix, ("prelude", &prelude)],
    ));
    if let Some(values) = values {
        declared = template(include_str!("../../../templates/c/defaults.h.in"), &[prefix]);
        let fields = context.model_fields.iter().zip(values);
        let lines: String =
            fields.map(|(field, value)| format!("model->{field} = {value:?};\n")).collect();
        let text = include_str!("../../../templates/c/defaults.c.in");
        defined.push(template(text, &[prefix, ("values", &lines)]));
    }
    let fields = fields(context, |field, _| format!("double {field};\n"));
    let prelude_fields = context.prelude_fields.iter();
    let prelude_fields: String =
        prelude_fields.map(|field| format!("{}_real {field};\n", dialect.prefix)).collect();
    let text = template(
        include_str!("../../../templates/c/parameters.h.in"),
        &[
            prefix,
            ("fields", &fields),
            ("prelude_fields", &prelude_fields),
            ("prelude_operations", operations),
            ("defaults", &declared),
        ],
    );
    Items { declarations: vec![text], definitions: defined }
}

fn cpp(
    context: &Context<'_>,
    dialect: &Dialect,
    values: Option<&[f64]>,
    operations: &str,
) -> Items {
    let each = |line: &dyn Fn(&String) -> String| -> String {
        context.prelude_fields.iter().map(line).collect()
    };
    let prelude = prelude(context, &InCpp, "model.", "parameters.");
    let fields = fields(context, |field, row| match values {
        Some(values) => format!("S {field} = S({:?});\n", values[row]),
        None => format!("S {field};\n"),
    });
    let text = template(
        include_str!("../../../templates/c/parameters.hpp.in"),
        &[
            ("given", if values.is_some() { ", with its values" } else { "" }),
            ("fields", &fields),
            ("prelude_fields", &each(&|field| format!("S {field};\n"))),
            ("prelude_operations", operations),
            ("exact", &dialect.exact()),
            ("prelude", &prelude),
            ("conversions", &each(&|field| format!("to.{field} = S(from.{field});\n"))),
            (
                "defaults",
                match values {
                    Some(_) => include_str!("../../../templates/c/defaults.hpp.in"),
                    None => "",
                },
            ),
        ],
    );
    Items { declarations: vec![text], definitions: Vec::new() }
}

/// The fields of the model's parameters with their meaning, unit and default.
fn fields(context: &Context<'_>, line: impl Fn(&str, usize) -> String) -> String {
    let values = context.default_values().unwrap_or_default();
    let parameters = context.robot.parameters.values().zip(&context.model_fields).enumerate();
    parameters
        .map(|(row, (parameter, field))| {
            let value = values.get(row).copied().flatten();
            parameter_field(context.robot, parameter, value, comment) + &line(field, row)
        })
        .collect()
}

/// The statements of the prelude: each of its results goes to its field as soon as it is there.
fn prelude(context: &Context<'_>, syntax: &dyn Syntax, model: &str, to: &str) -> String {
    let code = &context.program.prelude;
    let mut leaves = vec![None; code.slots];
    for (slot, leaf) in code.leaves.iter() {
        if let Leaf::Parameter(row) = leaf {
            let field = context.model_field(&context.program.parameters[*row]);
            leaves[slot.index()] = Some(format!("{model}{field}"));
        }
    }
    let mut entries = vec![Vec::new(); code.slots];
    for (output, field) in code.outputs.iter().zip(&context.prelude_fields) {
        entries[output.index()].push(format!("{to}{field}"));
    }
    let (names, named) = (Names::locals(C), vec![None; code.slots]);
    let mut body = Body::new(code, syntax, Vocabulary { names, leaves, named, entries });
    body.store_leaves();
    body.write_all();
    body.take_lines().join("\n")
}
