//! What was emitted.

use super::text_of;
use denavit_codegen::dynamics::implicit_effects;
use denavit_codegen::emit::{SourceOptions, Sources};
use denavit_codegen::model::Robot;
use serde::Serialize;
use std::fmt::Write;

#[derive(Serialize)]
struct SourcesJson<'a> {
    model: &'a str,
    flavour: String,
    language: String,
    /// Whether products are fused with sums.
    fused: bool,
    file: String,
    /// The other file of C.
    #[serde(skip_serializing_if = "Option::is_none")]
    beside: Option<String>,
    bytes: usize,
    lines: usize,
    functions: Vec<String>,
    /// Effects that keep functions from being written in closed form.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    implicit_effects: Vec<String>,
}

/// The source code of a robot as a JSON document: about the files, not their texts.
pub fn sources_json<'a>(
    robot: &'a Robot,
    options: &SourceOptions,
    sources: &Sources,
) -> impl Serialize + use<'a> {
    let mut names = sources.files.iter().map(|(path, _)| path.display().to_string());
    let text = sources.files.first().map_or("", |(_, text)| text);
    SourcesJson {
        model: &robot.name,
        flavour: options.code.flavour.to_string(),
        language: options.language.to_string(),
        fused: options.code.fused,
        file: names.next().unwrap_or_default(),
        beside: names.next(),
        bytes: text.len(),
        lines: text.lines().count(),
        functions: functions(sources),
        implicit_effects: implicit_effects(robot),
    }
}

/// The source code of a robot for people: which files were written, and what they lack.
pub fn sources_text(robot: &Robot, options: &SourceOptions, sources: &Sources) -> String {
    let names: Vec<String> =
        sources.files.iter().map(|(path, _)| path.display().to_string()).collect();
    let (files, count) = (names.join(", "), functions(sources).len());
    let lines = sources.files.first().map_or(0, |(_, text)| text.lines().count());
    let flavour = options.code.flavour;
    text_of(|out| {
        writeln!(out, "wrote {files}: {count} functions, {lines} lines, {flavour} parameters")?;
        for effect in implicit_effects(robot) {
            writeln!(
                out,
                "left out: bias, forward dynamics and derivatives, because the effect `{effect}` \
                 depends on what they would have to find"
            )?;
        }
        Ok(())
    })
}

/// The functions by name.
fn functions(sources: &Sources) -> Vec<String> {
    sources.lowered.program.routines.iter().map(|routine| routine.full_name()).collect()
}
