//! `denavit emit`: a model as Rust, C or C++.

use super::Answer;
use super::failure::Failure;
use super::files::read_model_with_effects;
use super::json::write_json;
use super::options::{EffectsOption, FlavourOption, FunctionList, ModelArgument};
use super::outputs::{on_stdout, write_together, write_whole};
use super::progress::Progress;
use clap::{Args, ValueEnum};
use denavit::emit::{Language, SourceError, SourceOptions, Sources};
use denavit::program::CodeOptions;
use denavit::report::symbolic::{sources_json, sources_text};
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
    /// The language; if not given, that of the output's name (.rs, .c, .h, .hpp, ..), and Rust for
    /// standard output and names without an ending
    #[arg(long, visible_alias = "lang", value_name = "NAME")]
    language: Option<LanguageName>,
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

/// A language that code is emitted in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum LanguageName {
    /// A module that needs the crate denavit-runtime
    Rust,
    /// C99: a header and a source that need nothing else
    C,
    /// A header of C++17: templates over the scalar
    #[value(alias = "c++")]
    Cpp,
}

impl LanguageName {
    fn language(self) -> Language {
        match self {
            Self::Rust => Language::Rust,
            Self::C => Language::C,
            Self::Cpp => Language::Cpp,
        }
    }
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let is_answered = on_stdout(&[Some(&arguments.output)], arguments.json)?;
    let language = match arguments.language {
        Some(name) => name.language(),
        None => Language::of(&arguments.output).map_err(SourceError::FileName)?,
    };
    language.check(&arguments.output).map_err(SourceError::FileName)?;
    let robot =
        read_model_with_effects(&arguments.model.model, arguments.effects.effects.as_deref())?;
    let progress = Progress::new();
    progress.show(&format!("deriving and emitting {}", robot.name));
    let (flavour, functions) = (arguments.flavour.flavour(), arguments.functions.wanted());
    let code = CodeOptions { flavour, fused: arguments.fused, functions };
    let options = SourceOptions { language, code };
    let sources = Sources::new(&robot, &options, &arguments.output)?;
    drop(progress);
    let found = sources.lowered.program.routines.iter().map(|routine| routine.name);
    arguments.functions.refuse_missing(&robot.name, found)?;
    write_files(&sources.files)?;
    if is_answered {
        return Ok(Answer::Done);
    }
    if arguments.json {
        write_json(out, &sources_json(&robot, &options, &sources))?;
    } else {
        write!(out, "{}", sources_text(&robot, &options, &sources))?;
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
