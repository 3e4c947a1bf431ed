//! `denavit count`: what each function of a model costs.

use super::Answer;
use super::failure::Failure;
use super::files::read_model_with_effects;
use super::json::write_json;
use super::options::{EffectsOption, FlavourOption, FunctionList, ModelArgument, Term, terms};
use super::remarks::print_size;
use clap::Args;
use denavit::function::FunctionName;
use denavit::program::{CodeOptions, Lowered};
use denavit::report::symbolic::{counts_json, counts_text};
use std::io::Write;

/// Count the operations of each function
///
/// Multiplications, additions (subtractions among them) and so on of one call. `prelude` is what a
/// function needs of operations on parameters alone, which are done once.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit count puma560
  denavit count tulip --baked --json
  denavit count puma560 --terms inertia,coriolis,gravity   without friction and rotors")]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    #[command(flatten)]
    effects: EffectsOption,
    #[command(flatten)]
    functions: FunctionList,
    #[command(flatten)]
    flavour: FlavourOption,
    /// Count with these terms instead of those of the model, separated by commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_enum)]
    terms: Option<Vec<Term>>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let mut robot =
        read_model_with_effects(&arguments.model.model, arguments.effects.effects.as_deref())?;
    if let Some(list) = &arguments.terms {
        robot.terms = terms(list);
    }
    let flavour = arguments.flavour.flavour();
    let wanted = arguments.functions.wanted_with_walking();
    print_size(&robot, wanted.contains(&FunctionName::ForwardDynamicsDerivatives));
    let options = CodeOptions { flavour, functions: wanted, ..CodeOptions::default() };
    let functions = Lowered::new(&robot, &options)?.counts();
    arguments.functions.refuse_missing(&robot.name, functions.iter().map(|row| row.name))?;
    if arguments.json {
        write_json(out, &counts_json(&robot.name, flavour, &functions))?;
    } else {
        write!(out, "{}", counts_text(&robot.name, flavour, &functions))?;
    }
    Ok(Answer::Done)
}
