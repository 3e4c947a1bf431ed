//! `ModelParameters`, what a user may set, and `Parameters`, what functions read.

use super::{Context, EmitError, bound, template};
use crate::arena::Handle;
use crate::emit::body::{Body, Vocabulary};
use crate::emit::names::Names;
use crate::emit::wording::{self, wrapped};
use crate::model::Parameter;
use crate::program::{Leaf, code_counts, constant_values};

/// The structs of parameters with their conversions.
pub(super) fn items(context: &Context<'_>) -> Result<Vec<String>, EmitError> {
    if context.program.parameters.is_empty() {
        let text = include_str!("../../../templates/rust/no_parameters.rs.in");
        return Ok(vec![template(text, &[])]);
    }
    let values = default_values(context)?;
    let (prelude, results) = prelude(context);
    let fields = &context.prelude_fields;
    let each = |line: &dyn Fn(&String) -> String| -> String { fields.iter().map(line).collect() };
    let parameters = context.robot.parameters.values();
    let model_fields: String = parameters
        .zip(&context.model_fields)
        .zip(&values)
        .map(|((parameter, field), &value)| model_field(context, parameter, field, value))
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

/// The names of the prelude's outputs: a parameter keeps its own, the others are numbered.
pub(super) fn prelude_fields(context: &Context<'_>) -> Vec<String> {
    let code = &context.program.prelude;
    // A number never makes the name of another parameter of the model.
    let mut names = Names::fields();
    let mut taken = names.clone();
    context.model_fields.iter().for_each(|field| {
        taken.claim(field);
    });
    let mut fields = vec![None; code.outputs.len()];
    for (field, output) in fields.iter_mut().zip(&code.outputs) {
        if let Some(Leaf::Parameter(row)) = code.leaves.get(*output) {
            let name = context.model_field(&context.program.parameters[*row]);
            *field = names.claim(name).then(|| name.to_owned());
        }
    }
    let mut numbers = 1..;
    let mut numbered = || loop {
        let name = format!("r{}", numbers.next().expect("numbers do not end"));
        if taken.claim(&name) {
            return name;
        }
    };
    fields.into_iter().map(|field| field.unwrap_or_else(&mut numbered)).collect()
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
    let mut names = Names::locals();
    let mut named = vec![None; code.slots];
    for (output, field) in code.outputs.iter().zip(&context.prelude_fields) {
        if output.index() >= code.leaves.len() && names.claim(field) {
            named[output.index()] = Some(field.clone());
        }
    }
    let entries = vec![Vec::new(); code.slots];
    let mut body = Body::new(code, Vocabulary { names, leaves, named, entries });
    body.write_all();
    code.outputs.iter().for_each(|&output| body.declare(output));
    let statements = body.take_lines().join("\n");
    let result = |(&output, field): (&_, &String)| match body.text(output) {
        text if text == field => format!("{field},\n"),
        text => format!("{field}: {text},\n"),
    };
    (statements, code.outputs.iter().zip(&context.prelude_fields).map(result).collect())
}

/// The default of each parameter of the model; none if the file gives none.
fn default_values(context: &Context<'_>) -> Result<Vec<Option<f64>>, EmitError> {
    let parameters = || context.robot.parameters.values();
    let given: Vec<_> = parameters().filter_map(|parameter| parameter.default).collect();
    let mut values = constant_values(&context.robot.dag, &given).into_iter();
    let value = |parameter: &Parameter| match parameter.default.and_then(|_| values.next()) {
        Some(value) if !value.is_finite() => {
            Err(EmitError::NotFinite { parameter: parameter.name.clone() })
        }
        value => Ok(value),
    };
    parameters().map(value).collect()
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

/// A field of `ModelParameters` with its meaning, unit and default.
fn model_field(
    context: &Context<'_>,
    parameter: &Parameter,
    field: &str,
    value: Option<f64>,
) -> String {
    let mut doc = wording::parameter(context.robot, parameter);
    if let Some(unit) = &parameter.unit {
        doc += &format!("; unit `{}`", unit.text());
    }
    if let Some(value) = value {
        doc += &format!("; {value:?} in the model");
    }
    format!("{}pub {field}: S,\n", wrapped("/// ", &(doc + ".")))
}
