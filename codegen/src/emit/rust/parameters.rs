//! `ModelParameters`, what a user may set, and `Parameters`, what functions read.

use super::syntax::Rust;
use super::{bound, template};
use crate::arena::Handle;
use crate::emit::body::{Body, Vocabulary};
use crate::emit::context::{Context, EmitError};
use crate::emit::names::{Names, RUST};
use crate::emit::wording::{documentation, parameter_field};
use crate::program::{Leaf, code_counts};

/// The structs of parameters with their conversions.
pub(super) fn items(context: &Context<'_>) -> Result<Vec<String>, EmitError> {
    if !context.has_parameters() {
        let text = include_str!("../../../templates/rust/no_parameters.rs.in");
        return Ok(vec![template(text, &[])]);
    }
    let values = context.default_values()?;
    let (prelude, results) = prelude(context);
    let fields = &context.prelude_fields;
    let each = |line: &dyn Fn(&String) -> String| -> String { fields.iter().map(line).collect() };
    let parameters = context.robot.parameters.values();
    let model_fields: String = parameters
        .zip(&context.model_fields)
        .zip(&values)
        .map(|((parameter, field), &value)| {
            let doc = parameter_field(context.robot, parameter, value, documentation);
            format!("{doc}pub {field}: S,\n")
        })
        .collect();
    let operations = code_counts(&context.program.prelude).total();
    let text = template(
        include_str!("../../../templates/rust/parameters.rs.in"),
        &[
            ("fields", &model_fields),
            ("defaults", &defaults(context, &values)),
            ("prelude_fields", &each(&|field| format!("{field}: S,\n"))),
            ("trait", bound(context.program.prelude.is_transcendental())),
            ("prelude_operations", &operations.to_string()),
            ("prelude", &prelude),
            ("prelude_results", &results),
            ("conversions", &each(&|field| format!("{field}: S::from_f64(self.{field}),\n"))),
        ],
    );
    Ok(vec![text])
}

/// The statements of the prelude, and the fields of its result.
fn prelude(context: &Context<'_>) -> (String, String) {
    let code = &context.program.prelude;
    let mut leaves = vec![None; code.slots];
    for (slot, leaf) in code.leaves.iter() {
        if let Leaf::Parameter(row) = leaf {
            let field = context.model_field(&context.program.parameters[*row]);
            leaves[slot.index()] = Some(format!("model.{field}"));
        }
    }
    let mut names = Names::locals(RUST);
    let mut named = vec![None; code.slots];
    for (output, field) in code.outputs.iter().zip(&context.prelude_fields) {
        if output.index() >= code.leaves.len() && names.claim(field) {
            named[output.index()] = Some(field.clone());
        }
    }
    let entries = vec![Vec::new(); code.slots];
    let mut body = Body::new(code, &Rust, Vocabulary { names, leaves, named, entries });
    body.write_all();
    code.outputs.iter().for_each(|&output| body.declare(output));
    let statements = body.take_lines().join("\n");
    let result = |(&output, field): (&_, &String)| match body.text(output) {
        text if text == field => format!("{field},\n"),
        text => format!("{field}: {text},\n"),
    };
    (statements, code.outputs.iter().zip(&context.prelude_fields).map(result).collect())
}

/// `impl Default`, if the file gives every value; else nothing, for no value is made up.
fn defaults(context: &Context<'_>, values: &[Option<f64>]) -> String {
    let line = |(field, value): (&String, &Option<f64>)| {
        value.map(|value| format!("{field}: S::from_f64({value:?}),\n"))
    };
    let lines: Option<String> = context.model_fields.iter().zip(values).map(line).collect();
    match lines {
        None => String::new(),
        Some(lines) => {
            let text = include_str!("../../../templates/rust/defaults.rs.in");
            template(text, &[("values", &lines)]) + "\n"
        }
    }
}
