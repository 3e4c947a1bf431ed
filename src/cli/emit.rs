//! `denavit emit`: a model as a module of Rust.

use super::Answer;
use super::failure::Failure;
use super::files::read_model_with_effects;
use super::json::write_json;
use super::options::{EffectsOption, FlavourOption, FunctionList, ModelArgument};
use super::outputs::{on_stdout, write_whole};
use super::progress::Progress;
use clap::Args;
use denavit::derive::{Derivation, Flavour, derive};
use denavit::dynamics::implicit_effects;
use denavit::emit::rust::module;
use denavit::function::FunctionName;
use denavit::model::Robot;
use denavit::program::{Program, fuse, lower};
use serde::Serialize;
use std::io::Write;
use std::path::PathBuf;

/// Write the functions of a model as Rust
///
/// The module needs the crate `denavit-runtime` and nothing else. The same model gives the same
/// bytes. In a crate of your own, let build.rs do this: denavit_codegen::build_script.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit emit puma560 -o puma560_dynamics.rs
  denavit emit tulip --baked --functions inverse_dynamics,mass_matrix -o tulip.rs
  denavit emit tulip_leg6 --baked --fused -o leg.rs
  denavit emit puma560 --sparse -o puma560.rs
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
    /// Fuse products with the sums that they go into: faster with the feature `fma` of
    /// denavit-runtime and -C target-cpu=native, but the last bits then depend on the processor
    #[arg(long)]
    fused: bool,
    /// The file to write; - is standard output
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Print JSON (about the file, which is Rust all the same)
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct EmitJson<'a> {
    model: &'a str,
    flavour: String,
    /// Whether products are fused with sums.
    fused: bool,
    file: String,
    bytes: usize,
    lines: usize,
    functions: Vec<String>,
    /// Effects that keep functions from being written in closed form.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    implicit_effects: Vec<String>,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let is_answered = on_stdout(&[Some(&arguments.output)], arguments.json)?;
    let robot =
        read_model_with_effects(&arguments.model.model, arguments.effects.effects.as_deref())?;
    let flavour = arguments.flavour.flavour();
    let progress = Progress::new();
    progress.show(&format!("deriving and emitting {}", robot.name));
    let emitted = Emitted::new(&robot, flavour, arguments.fused, &arguments.functions.wanted())?;
    drop(progress);
    let found = emitted.program.routines.iter().map(|routine| routine.name);
    arguments.functions.refuse_missing(&robot.name, found)?;
    let text = &emitted.text;
    write_whole(&arguments.output, text.as_bytes())?;
    if is_answered {
        return Ok(Answer::Done);
    }
    let (file, lines) = (arguments.output.display().to_string(), text.lines().count());
    let functions: Vec<String> =
        emitted.program.routines.iter().map(|routine| routine.full_name()).collect();
    let implicit_effects = implicit_effects(&robot);
    if arguments.json {
        let (flavour, bytes) = (flavour.to_string(), text.len());
        let (model, fused) = (&robot.name, arguments.fused);
        let json =
            EmitJson { model, flavour, fused, file, bytes, lines, functions, implicit_effects };
        write_json(out, &json)?;
    } else {
        let count = functions.len();
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

/// A model on its way to Rust.
pub(crate) struct Emitted {
    /// Its functions as expressions.
    pub(crate) derivation: Derivation,
    /// Its functions as code.
    pub(crate) program: Program,
    /// The module.
    pub(crate) text: String,
}

impl Emitted {
    /// Derives the functions of a robot and writes them as a module.
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
        let text = module(&derivation.robot, &program)
            .map_err(|error| Failure::Emit(robot.name.clone(), error))?;
        Ok(Self { derivation, program, text })
    }
}
