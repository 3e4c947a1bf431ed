//! A program as a module of Rust source.
//!
//! The text needs `denavit-runtime` and nothing else: no standard library, no allocation, no
//! panic, no unsafe code. It has no inner attributes, so that `include!` takes it as well as
//! `mod`. All functions are generic over the runtime's scalar.

mod enumerations;
mod filling;
mod functions;
mod parameters;
mod syntax;

use super::arrays::{Place, list};
use super::context::{Context, EmitError};
use super::heading::{Heading, operations_table};
use super::layout::template;
use super::names::RUST;
use super::wording::one_line;
use crate::model::Robot;
use crate::program::Program;

const HEADING: Heading = Heading {
    text: one_line,
    tunable: "tunable at run time (`ModelParameters`)",
    fused: "// products: fused with sums where denavit-runtime has its feature `fma` and\n\
            // the target the instruction (`-C target-cpu=native`)\n",
    transcendental: "// needs: denavit-runtime with its feature `libm`\n",
};

/// The text of a module with the functions of `program`, which belong to `robot`. Where they read
/// no parameter (the baked flavour), `Parameters` is empty and there is no `ModelParameters`.
pub fn module(robot: &Robot, program: &Program) -> Result<String, EmitError> {
    let context = Context::new(robot, program, RUST);
    let mut items = enumerations::items(&context);
    items.extend(parameters::items(&context)?);
    items.extend(functions::items(&context));
    let items = items.join("\n");

    let quoted = |name: &str| vec![format!("{name:?}")];
    let joint_names = robot.joints().map(|(id, _)| quoted(&robot.links[id].name)).collect();
    let text = template(
        include_str!("../../templates/rust/module.rs.in"),
        &[
            ("title", &HEADING.title(&context)),
            ("version", env!("CARGO_PKG_VERSION")),
            ("about", &HEADING.about(&context)),
            ("operations", &operations_table(&context)),
            ("imports", imports(&items)),
            ("dof", &context.dof.to_string()),
            ("joint_names", &list(joint_names, Place { indent: 0, followed: true }).join("\n")),
            ("items", &items),
        ],
    );
    Ok(text)
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

/// The name of the trait that code needs.
fn bound(is_transcendental: bool) -> &'static str {
    if is_transcendental { "Transcendental" } else { "Scalar" }
}
