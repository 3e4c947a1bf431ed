//! `denavit count`: what each function of a model costs.

use super::Answer;
use super::failure::Failure;
use super::files::read_model_with_effects;
use super::json::{Ordered, write_json};
use super::options::{EffectsOption, FlavourOption, FunctionList, ModelArgument, Term, terms};
use super::remarks::print_size;
use clap::Args;
use denavit::derive::{Flavour, derive};
use denavit::function::FunctionName;
use denavit::model::Robot;
use denavit::program::{Counts, counts, lower};
use denavit::report::{Align, Table};
use serde::Serialize;
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

/// The counts of one function.
pub(crate) struct FunctionCount {
    pub(crate) name: FunctionName,
    pub(crate) link: Option<String>,
    pub(crate) counts: Counts,
}

impl FunctionCount {
    fn full_name(&self) -> String {
        match &self.link {
            Some(link) => format!("{}_{link}", self.name),
            None => self.name.to_string(),
        }
    }
}

#[derive(Serialize)]
struct CountJson<'a> {
    model: &'a str,
    flavour: String,
    functions: Ordered<CountsJson>,
}

#[derive(Serialize)]
struct CountsJson {
    mul: usize,
    add: usize,
    neg: usize,
    div: usize,
    sqrt: usize,
    sincos: usize,
    select: usize,
    function: usize,
    prelude: usize,
}

impl From<&Counts> for CountsJson {
    fn from(counts: &Counts) -> Self {
        let Counts { mul, add, neg, div, sqrt, sincos, select, function, prelude } = *counts;
        Self { mul, add, neg, div, sqrt, sincos, select, function, prelude }
    }
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
    let functions = function_counts(&robot, flavour, &wanted)?;
    arguments.functions.refuse_missing(&robot.name, functions.iter().map(|row| row.name))?;
    if arguments.json {
        let flavour = flavour.to_string();
        let counts = functions.iter().map(|row| (row.full_name(), (&row.counts).into()));
        let functions = Ordered(counts.collect());
        let json = CountJson { model: &robot.name, flavour, functions };
        write_json(out, &json)?;
    } else {
        writeln!(out, "{}: operations of one call, {flavour} parameters\n", robot.name)?;
        write!(out, "{}", table(&functions))?;
    }
    Ok(Answer::Done)
}

/// Derives the functions and counts them.
pub(crate) fn function_counts(
    robot: &Robot,
    flavour: Flavour,
    wanted: &[FunctionName],
) -> Result<Vec<FunctionCount>, Failure> {
    let derivation = derive(robot, flavour, wanted).map_err(Failure::Bake)?;
    let program = lower(&derivation.dag, &derivation.functions)
        .map_err(|error| Failure::Lower(robot.name.clone(), error))?;
    let rows = program.routines.iter().map(|routine| FunctionCount {
        name: routine.name,
        link: routine.link.clone(),
        counts: counts(&program, routine),
    });
    let functions: Vec<FunctionCount> = rows.collect();
    if functions.is_empty() {
        let asked = wanted.iter().map(|name| name.to_string()).collect();
        return Err(Failure::NoFunction { model: robot.name.clone(), asked });
    }
    Ok(functions)
}

/// One row for each function; of functions of links, the dearest one.
fn table(functions: &[FunctionCount]) -> Table {
    let mut columns = vec![("function", Align::Left)];
    let kinds = kinds(&Counts::default()).map(|(name, _)| name);
    let is_used = |column: usize| {
        column < 2 || functions.iter().any(|row| self::kinds(&row.counts)[column].1 > 0)
    };
    let used: Vec<usize> = (0..kinds.len()).filter(|&column| is_used(column)).collect();
    columns.extend(used.iter().map(|&column| (kinds[column], Align::Right)));
    let mut table = Table::new(&columns);
    for row in shown(functions) {
        let mut cells = vec![row.0];
        let counts = self::kinds(&row.1.counts);
        cells.extend(used.iter().map(|&column| counts[column].1.to_string()));
        table.push(cells);
    }
    table
}

fn shown(rows: &[FunctionCount]) -> Vec<(String, &FunctionCount)> {
    let mut shown: Vec<(String, &FunctionCount)> = Vec::new();
    for row in rows {
        if row.link.is_none() {
            shown.push((row.name.to_string(), row));
            continue;
        }
        if shown.last().is_some_and(|(_, last)| last.name == row.name) {
            continue;
        }
        let links: Vec<_> = rows.iter().filter(|other| other.name == row.name).collect();
        let Some(dearest) = links.iter().rev().max_by_key(|other| other.counts.total()) else {
            continue;
        };
        let link = dearest.link.as_deref().unwrap_or_default();
        shown.push((format!("{} (of {link}, the dearest of {})", row.name, links.len()), dearest));
    }
    shown
}

/// The kinds of operations with their numbers.
fn kinds(counts: &Counts) -> [(&'static str, usize); 9] {
    let Counts { mul, add, neg, div, sqrt, sincos, select, function, prelude } = *counts;
    [
        ("mul", mul),
        ("add", add),
        ("neg", neg),
        ("div", div),
        ("sqrt", sqrt),
        ("sincos", sincos),
        ("select", select),
        ("function", function),
        ("prelude", prelude),
    ]
}
