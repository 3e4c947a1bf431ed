//! A program as C99 or as a C++17 header.
//!
//! The text needs a compiler and nothing else: no library of ours, no allocation, no state. Sine
//! and cosine are those of denavit-runtime, transcribed, so that the bits are those of the emitted
//! Rust. Both languages have the same arrays: a matrix is stored row by row.

mod dialect;
mod enumerations;
mod functions;
mod parameters;
mod runtime;
mod syntax;

use self::dialect::Dialect;
use super::context::{Context, EmitError};
use super::heading::{Heading, operations_table};
use super::layout::template;
use super::names::C;
use super::wording::{one_line, wrapped};
use crate::model::Robot;
use crate::program::Program;

/// A module of C: the header that a program includes, and what it is linked with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Files {
    /// Declarations and documentation.
    pub header: String,
    /// The functions.
    pub source: String,
}

const HEADING: Heading = Heading {
    text: comment,
    tunable: "tunable at run time, by their names",
    fused: "// products: fused with sums where the target has the instruction (-mfma,\n\
            // -march=native)\n",
    transcendental: "// needs: the platform's mathematics library (-lm), whose bits are its own\n\
                     // but for square roots\n",
};

/// The text of C99 with the functions of `program`, which belong to `robot`. `header` is the file
/// name that the source includes. Where the functions read no parameter (the baked flavour), they
/// have no argument for parameters.
pub fn files(robot: &Robot, program: &Program, header: &str) -> Result<Files, EmitError> {
    let context = Context::new(robot, program, C);
    let dialect = Dialect::c(&robot.name);
    let parameters = parameters::items(&context, &dialect)?;
    let functions = functions::items(&context, &dialect);
    let mut declarations = enumerations::items(&context, &dialect);
    declarations.extend(parameters.declarations);
    declarations.extend(functions.declarations);
    let mut definitions = parameters.definitions;
    definitions.extend(functions.definitions);
    let definitions = definitions.join("\n");
    let runtime = runtime::of_c(&dialect, program, &definitions);
    let items = runtime.items + &definitions;

    let (title, about) = (HEADING.title(&context), HEADING.about(&context));
    let version = env!("CARGO_PKG_VERSION");
    let names = dialect.filling();
    let joint_names = joint_names(robot, " \\\n");
    let mut values = vec![
        ("title", title.as_str()),
        ("version", version),
        ("about", &about),
        ("joint_names", &joint_names),
    ];
    values.extend(names);
    let (operations, dof) = (operations_table(&context), context.dof.to_string());
    let declarations = declarations.join("\n");
    values.extend([("operations", operations.as_str()), ("dof", &dof), ("items", &declarations)]);
    let header_text = template(include_str!("../../templates/c/header.h.in"), &values);
    let source = template(
        include_str!("../../templates/c/source.c.in"),
        &[
            ("title", &title),
            ("version", version),
            ("header", header),
            ("prefix", &dialect.prefix),
            ("includes", &runtime.includes),
            ("items", &items),
        ],
    );
    Ok(Files { header: header_text, source })
}

/// The text of a C++17 header with the functions of `program`, which belong to `robot`: templates
/// over the scalar.
pub fn cpp_header(robot: &Robot, program: &Program) -> Result<String, EmitError> {
    let context = Context::new(robot, program, C);
    let dialect = Dialect::cpp(&robot.name);
    let parameters = parameters::items(&context, &dialect)?;
    let functions = functions::items(&context, &dialect);
    let mut items = enumerations::items(&context, &dialect);
    items.extend(parameters.declarations);
    items.extend(functions.definitions);
    let runtime = runtime::of_cpp(&dialect, program);
    let values = [
        ("title", HEADING.title(&context)),
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ("about", HEADING.about(&context)),
        ("operations", operations_table(&context)),
        ("runtime", runtime.items),
        ("straight_line", runtime::STRAIGHT_LINE.to_owned()),
        ("scalar", runtime.scalar),
        ("dof", context.dof.to_string()),
        ("joint_names", joint_names(robot, "\n")),
        ("items", items.join("\n")),
    ];
    let mut values: Vec<(&str, &str)> =
        values.iter().map(|(name, value)| (*name, value.as_str())).collect();
    values.extend(dialect.filling());
    Ok(template(include_str!("../../templates/c/header.hpp.in"), &values))
}

/// The names of the joints in braces, one a line.
fn joint_names(robot: &Robot, line_end: &str) -> String {
    let names: Vec<&str> = robot.joints().map(|(id, _)| robot.links[id].name.as_str()).collect();
    let lines: Vec<String> = names.iter().map(|name| format!("    {}", string(name))).collect();
    format!("{{{line_end}{}}}", lines.join(&format!(",{line_end}")))
}

/// A name as a string: what is no plain letter or sign is an octal number, which ends after three
/// digits.
fn string(name: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_graphic() && !matches!(byte, b'"' | b'\\' | b'?');
    let escaped = |byte: u8| match plain(byte) || byte == b' ' {
        true => char::from(byte).to_string(),
        false => format!("\\{byte:03o}"),
    };
    format!("\"{}\"", name.bytes().map(escaped).collect::<String>())
}

/// Text of a model in a comment: a line that ended in a backslash, or in the old spelling of one,
/// would go on in the next.
fn comment(text: &str) -> String {
    let safe = one_line(text).replace("??/", "?? /");
    let word = |word: &str| match word.strip_suffix('\\') {
        Some(word) => format!("{word}/"),
        None => word.to_owned(),
    };
    safe.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// A remark of one sentence before a function.
fn remark(text: &str) -> String {
    wrapped("/// ", text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_of_a_model_ends_no_comment_and_no_string() {
        assert_eq!(comment("a\\ b\n??/ c:\\"), "a/ b ?? / c:/");
        assert_eq!(string("a\"b\\?"), "\"a\\042b\\134\\077\"");
        assert_eq!(string("µ1"), "\"\\302\\2651\"");
    }
}
