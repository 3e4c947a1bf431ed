//! `denavit emit`: a model as Rust, C or C++.

mod language;

use super::Answer;
use super::failure::Failure;
use super::files::read_model_with_effects;
use super::json::write_json;
use super::options::{EffectsOption, FlavourOption, FunctionList, ModelArgument};
use super::outputs::{on_stdout, write_together, write_whole};
use super::progress::Progress;
use clap::Args;
use denavit::derive::{Derivation, Flavour, derive};
use denavit::dynamics::implicit_effects;
use denavit::emit::rust::module;
use denavit::function::FunctionName;
use denavit::model::Robot;
use denavit::program::{Program, fuse, lower};
use language::Language;
use serde::Serialize;
use std::io::Write;
use std::path::PathBuf;

/// Write the functions of a model as Rust, C or C++
///
/// A module of Rust needs the crate `denavit-runtime` and nothing else; C and C++ need nothing. The
/// same model gives the same bytes. In a crate of your own, let build.rs do this:
/// denavit_codegen::build_script.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit emit puma560 -o puma560_dynamics.rs
  denavit emit tulip --baked --functions inverse_dynamics,mass_matrix -o tulip.rs
  denavit emit tulip_leg6 --baked --fused -o leg.rs
  denavit emit puma560 --sparse -o puma560.rs
  denavit emit puma560 --language c -o puma560.c
  denavit emit puma560 --language cpp -o puma560.hpp
  denavit emit scara -o -")]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    #[command(flatten)]
    effects: EffectsOption,
    #[command(flatten)]
    functions: FunctionList,
    #[command(flatten)]
    flavour: FlavourOption,
    /// The language; if not given, that of the output's name (.c, .h, .hpp, ..), else Rust
    #[arg(long, visible_alias = "lang", value_name = "NAME")]
    language: Option<Language>,
    /// Fuse products with the sums that they go into: faster with the feature `fma` of
    /// denavit-runtime and -C target-cpu=native (C: -march=native), but the last bits then depend
    /// on the processor
    #[arg(long)]
    fused: bool,
    /// The file to write; - is standard output. C is two files: a header goes beside the source
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Print JSON (about the file, which is code all the same)
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct EmitJson<'a> {
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

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let is_answered = on_stdout(&[Some(&arguments.output)], arguments.json)?;
    let language = arguments.language.unwrap_or(Language::of(&arguments.output));
    language.check(&arguments.output)?;
    let robot =
        read_model_with_effects(&arguments.model.model, arguments.effects.effects.as_deref())?;
    let flavour = arguments.flavour.flavour();
    let progress = Progress::new();
    progress.show(&format!("deriving and emitting {}", robot.name));
    let lowered = Lowered::new(&robot, flavour, arguments.fused, &arguments.functions.wanted())?;
    let files = language.files(&lowered.derivation, &lowered.program, &arguments.output)?;
    drop(progress);
    let found = lowered.program.routines.iter().map(|routine| routine.name);
    arguments.functions.refuse_missing(&robot.name, found)?;
    write_files(&files)?;
    if is_answered {
        return Ok(Answer::Done);
    }
    let (text, beside) = (&files[0].1, files.get(1).map(|(path, _)| path.display().to_string()));
    let (file, lines) = (arguments.output.display().to_string(), text.lines().count());
    let functions: Vec<String> =
        lowered.program.routines.iter().map(|routine| routine.full_name()).collect();
    let implicit_effects = implicit_effects(&robot);
    if arguments.json {
        let json = EmitJson {
            model: &robot.name,
            flavour: flavour.to_string(),
            language: language.to_string(),
            fused: arguments.fused,
            file,
            beside,
            bytes: text.len(),
            lines,
            functions,
            implicit_effects,
        };
        write_json(out, &json)?;
    } else {
        let count = functions.len();
        let file = beside.map_or(file.clone(), |beside| format!("{file}, {beside}"));
        writeln!(out, "wrote {file}: {count} functions, {lines} lines, {flavour} parameters")?;
        for effect in &implicit_effects {
            writeln!(
                out,
                "left out: bias, forward dynamics and derivatives, because the effect `{effect}` \
                 depends on what they would have to find"
            )?;
        }
    }
    Ok(Answer::Done)
}

/// Writes the files of a module: all of them, or none.
fn write_files(files: &[(PathBuf, String)]) -> Result<(), Failure> {
    if let [(path, text)] = files {
        return write_whole(path, text.as_bytes());
    }
    let files: Vec<_> =
        files.iter().map(|(path, text)| (path.clone(), text.clone().into_bytes())).collect();
    write_together(&files)
}

/// A model on its way to code.
pub(crate) struct Lowered {
    /// Its functions as expressions.
    pub(crate) derivation: Derivation,
    /// Its functions as code.
    pub(crate) program: Program,
}

impl Lowered {
    /// Derives the functions of a robot and lowers them.
    pub(crate) fn new(
        robot: &Robot,
        flavour: Flavour,
        fuses: bool,
        wanted: &[FunctionName],
    ) -> Result<Self, Failure> {
        let derivation = derive(robot, flavour, wanted).map_err(Failure::Bake)?;
        if derivation.functions.is_empty() {
            let asked = wanted.iter().map(|name| name.to_string()).collect();
            return Err(Failure::NoFunction { model: robot.name.clone(), asked });
        }
        let mut program = lower(&derivation.dag, &derivation.functions)
            .map_err(|error| Failure::Lower(robot.name.clone(), error))?;
        if fuses {
            fuse(&mut program);
        }
        Ok(Self { derivation, program })
    }

    /// The module of Rust.
    pub(crate) fn rust(&self) -> Result<String, Failure> {
        let robot = &self.derivation.robot;
        module(robot, &self.program).map_err(|error| Failure::Emit(robot.name.clone(), error))
    }
}
