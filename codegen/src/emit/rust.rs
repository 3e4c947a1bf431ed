//! A program as a module of Rust source.
//!
//! The text needs `denavit-runtime` and nothing else: no standard library, no allocation, no
//! panic, no unsafe code. It has no inner attributes, so that `include!` takes it as well as
//! `mod`. All functions are generic over the runtime's scalar.

mod filling;
mod functions;
mod parameters;
mod selectors;

use super::arrays::{Place, list};
use super::layout::fill;
use super::names::Names;
use super::wording::{columns, one_line, wrapped};
use crate::model::Robot;
use crate::program::{Counts, Program, counts};
use std::fmt;

/// Why a program cannot be written as a module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EmitError {
    /// The default of a parameter is no finite `f64`.
    NotFinite {
        /// The parameter.
        parameter: String,
    },
}

impl fmt::Display for EmitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { parameter } => {
                write!(f, "the default of `{parameter}` is too large, or divides by zero")
            }
        }
    }
}

impl std::error::Error for EmitError {}

/// What the parts of the module share.
struct Context<'a> {
    robot: &'a Robot,
    program: &'a Program,
    /// Fields of `ModelParameters`, by row of the robot's parameters.
    model_fields: Vec<String>,
    /// Fields of `Parameters`, by row of the prelude's outputs.
    prelude_fields: Vec<String>,
    /// Number of entries of `q`.
    dof: usize,
}

/// The text of a module with the functions of `program`, which belong to `robot`. Where they read
/// no parameter (the baked flavour), `Parameters` is empty and there is no `ModelParameters`.
pub fn module(robot: &Robot, program: &Program) -> Result<String, EmitError> {
    let context = Context::new(robot, program);
    let mut items = selectors::items(&context);
    items.extend(parameters::items(&context)?);
    items.extend(functions::items(&context));
    let items = items.join("\n");

    let quoted = |name: &str| vec![format!("{name:?}")];
    let joint_names = robot.joints().map(|(id, _)| quoted(&robot.links[id].name)).collect();
    let text = template(
        include_str!("../../templates/rust/module.rs.in"),
        &[
            ("title", &format!("Dynamics of the robot `{}`.", one_line(&robot.name))),
            ("version", env!("CARGO_PKG_VERSION")),
            ("about", &about(robot, program)),
            ("operations", &operations(program)),
            ("imports", imports(&items)),
            ("dof", &context.dof.to_string()),
            ("joint_names", &list(joint_names, Place { indent: 0, followed: true }).join("\n")),
            ("items", &items),
        ],
    );
    Ok(text)
}

impl<'a> Context<'a> {
    fn new(robot: &'a Robot, program: &'a Program) -> Self {
        let mut names = Names::fields();
        let model_fields =
            robot.parameters.values().map(|parameter| names.field(&parameter.name)).collect();
        let dof = robot.degrees_of_freedom();
        let mut context = Self { robot, program, model_fields, prelude_fields: Vec::new(), dof };
        context.prelude_fields = parameters::prelude_fields(&context);
        context
    }

    /// The field of a parameter of the program.
    fn model_field(&self, name: &str) -> &str {
        let mut parameters = self.robot.parameters.values();
        let row = parameters.position(|parameter| parameter.name == name);
        &self.model_fields[row.expect("the program's parameters are the robot's")]
    }
}

/// Comment lines about the model and the flavour.
fn about(robot: &Robot, program: &Program) -> String {
    let flavour = match !program.parameters.is_empty() {
        true => "tunable at run time (`ModelParameters`)",
        false => "none: the functions hold all values",
    };
    let mut lines = format!("// model: {}, hash {:016x}\n", one_line(&robot.name), robot.hash);
    lines += &format!("// parameters: {flavour}\n");
    if program.routines.iter().any(|routine| routine.code.is_fused()) {
        lines += "// products: fused with sums where denavit-runtime has its feature `fma` and\n\
                  // the target the instruction (`-C target-cpu=native`)\n";
    }
    let routines = program.routines.iter().map(|routine| &routine.code);
    if routines.chain([&program.prelude]).any(|code| code.is_transcendental()) {
        lines += "// needs: denavit-runtime with its feature `libm`\n";
    }
    for (label, text) in [("description", &robot.description), ("source", &robot.source)] {
        if !text.trim().is_empty() {
            lines += &wrapped("// ", &format!("{label}: {}", one_line(text)));
        }
    }
    for assumption in &robot.assumptions {
        lines += &wrapped("// ", &format!("assumed: {}", one_line(assumption)));
    }
    lines
}

/// The table of operations: a line for each function, the columns that have an entry.
fn operations(program: &Program) -> String {
    let rows: Vec<(String, Counts)> = program
        .routines
        .iter()
        .map(|routine| (routine.full_name(), counts(program, routine)))
        .collect();
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0).max(8);
    let titles = columns(&Counts::default()).map(|(title, _)| title);
    let shown: Vec<usize> = (0..titles.len())
        .filter(|&column| rows.iter().any(|(_, counts)| columns(counts)[column].1 > 0))
        .collect();
    let line = |name: &str, cells: Vec<String>| {
        let cells: String = cells.iter().map(|cell| format!(" {cell:>8}")).collect();
        format!("//     {name:width$}{cells}\n")
    };
    let cells = |counts: &Counts| {
        shown.iter().map(|&column| columns(counts)[column].1.to_string()).collect()
    };
    let head = line("function", shown.iter().map(|&column| titles[column].to_owned()).collect());
    rows.iter().map(|(name, counts)| line(name, cells(counts))).fold(head, |all, row| all + &row)
}

/// What the module imports: the traits that its text names.
fn imports(items: &str) -> &'static str {
    match (items.contains("S: Scalar"), items.contains("S: Transcendental")) {
        (true, true) => "use denavit_runtime::{Scalar, Transcendental};\n\n",
        (false, true) => "use denavit_runtime::Transcendental;\n\n",
        (true, false) => "use denavit_runtime::Scalar;\n\n",
        (false, false) => "",
    }
}

/// A template of ours, filled.
fn template(text: &str, values: &[(&str, &str)]) -> String {
    fill(text, values).expect("a template and its caller fit")
}

/// The name of the trait that code needs.
fn bound(is_transcendental: bool) -> &'static str {
    if is_transcendental { "Transcendental" } else { "Scalar" }
}
