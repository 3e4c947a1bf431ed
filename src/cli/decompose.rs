//! `denavit decompose`: the regressor as fundamental functions and a matrix of known parameters.

use super::Answer;
use super::failure::Failure;
use super::files::{Input, read_input};
use super::json::write_json;
use super::options::Term;
use super::progress::Progress;
use clap::{Args, ValueEnum};
use denavit::expr::text::print;
use denavit::expr::{Dag, ExprId};
use denavit::fundamental::{Basis, Decomposition, Expansion, Progress as Expanded, smallest};
use denavit::model::Robot;
use denavit::model::equations::Equations;
use denavit::regressor::equations::equations_regressor;
use denavit::regressor::{MotionTerms, decompose_robot};
use denavit::report::{Align, Table};
use serde::Serialize;
use std::io::Write;
use std::path::PathBuf;

/// More functions than this are not read by people: they get the sizes alone.
const READABLE_FUNCTIONS: usize = 60;

/// Decompose the regressor: R0_ij = f^T b_ij
///
/// f holds the fundamental functions of the motion, B what is known. A model has ten columns a
/// link; equations have one column for each product of unknowns. A floating base is written in the
/// coordinates of its torso.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit decompose planar_2r
  denavit decompose puma560 --terms inertia,gravity --json
  denavit decompose double_pendulum_drives --basis product")]
pub(crate) struct Arguments {
    /// Path of a model or of a file of equations, name of a shipped one, or - for standard input
    #[arg(value_name = "MODEL|EQUATIONS")]
    input: PathBuf,
    /// What the functions are made of; if nothing is said, what makes the fewest
    #[arg(long, value_enum)]
    basis: Option<BasisName>,
    /// Terms of a model, separated by commas: inertia, coriolis, gravity (all, if none is named)
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_enum)]
    terms: Option<Vec<Term>>,
    /// Memory for terms on the way [MiB]
    #[arg(long, value_name = "MIB", default_value_t = 2048)]
    memory: usize,
    /// Print JSON: f and B in full
    #[arg(long)]
    json: bool,
}

/// A basis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum BasisName {
    /// cos(k.q) and sin(k.q)
    Fourier,
    /// Products of 1, c, s, c^2, c s of single angles
    Product,
    /// The same of cumulated angles of parallel axes
    Cumulated,
}

impl BasisName {
    fn basis(self) -> Basis {
        match self {
            Self::Fourier => Basis::Fourier,
            Self::Product => Basis::Product,
            Self::Cumulated => Basis::Cumulated,
        }
    }
}

#[derive(Serialize)]
struct DecomposeJson {
    model: String,
    basis: &'static str,
    equations: Vec<String>,
    columns: Vec<String>,
    functions: Vec<String>,
    rows: usize,
    nonzeros: usize,
    entries: Vec<EntryJson>,
    left: Option<Vec<String>>,
}

/// An entry of B: rows are the functions, equation by equation.
#[derive(Serialize)]
struct EntryJson {
    equation: usize,
    function: usize,
    column: usize,
    value: String,
}

/// What was decomposed, ready to be printed.
struct Found {
    name: String,
    dag: Dag,
    equations: Vec<String>,
    columns: Vec<String>,
    /// The left side, where there is one.
    left: Option<Vec<ExprId>>,
    decomposition: Decomposition,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let input = read_input(&arguments.input)?;
    let progress = Progress::new();
    let mut show = |at: Expanded| {
        progress.show(&format!("writing out: {} of {}, {} terms", at.done, at.total, at.terms));
    };
    let memory_bytes = arguments.memory.saturating_mul(1 << 20);
    let mut expansion = Expansion { memory_bytes, progress: &mut show };
    let found = match &input {
        Input::Model(robot) => of_model(robot, arguments, &mut expansion)?,
        Input::Equations(equations) => of_equations(equations, arguments, &mut expansion)?,
    };
    progress.clear();
    let found = found.into_texts();
    match arguments.json {
        true => write_json(out, &found)?,
        false => write_texts(out, &found)?,
    }
    Ok(Answer::Done)
}

fn of_model(
    robot: &Robot,
    arguments: &Arguments,
    expansion: &mut Expansion<'_>,
) -> Result<Found, Failure> {
    let has = |term| arguments.terms.as_ref().is_none_or(|terms| terms.contains(&term));
    let terms = MotionTerms {
        rates: robot.terms.coriolis && has(Term::Coriolis),
        accelerations: robot.terms.inertia && has(Term::Inertia),
        gravity: robot.terms.gravity && has(Term::Gravity),
    };
    let bases = arguments.basis.map_or(Basis::ALL.to_vec(), |basis| vec![basis.basis()]);
    let found = decompose_robot(robot, terms, &bases, expansion)
        .map_err(|error| Failure::Decompose(robot.name.clone(), error))?;
    let decomposition = smallest(found.decompositions)
        .ok_or_else(|| Failure::NoParallelAxes(robot.name.clone()))?;
    Ok(Found {
        name: robot.name.clone(),
        dag: found.dag,
        equations: found.equations,
        columns: found.columns,
        left: None,
        decomposition,
    })
}

fn of_equations(
    equations: &Equations,
    arguments: &Arguments,
    expansion: &mut Expansion<'_>,
) -> Result<Found, Failure> {
    let bases = match arguments.basis {
        Some(BasisName::Cumulated) => {
            return Err(Failure::NoParallelAxes(equations.name.clone()));
        }
        Some(basis) => vec![basis.basis()],
        None => vec![Basis::Fourier, Basis::Product],
    };
    let mut least = None;
    for basis in bases {
        let found = equations_regressor(equations, basis, expansion).map_err(Failure::Equations)?;
        let size = found.decomposition.functions.len();
        if least.as_ref().is_none_or(|(known, _)| size < *known) {
            least = Some((size, found));
        }
    }
    let (_, found) = least.expect("there is a basis");
    Ok(Found {
        name: equations.name.clone(),
        equations: equations.equations.iter().map(|equation| equation.text.clone()).collect(),
        columns: found.column_names(),
        left: Some(found.left),
        dag: found.dag,
        decomposition: found.decomposition,
    })
}

impl Found {
    fn into_texts(self) -> DecomposeJson {
        let Self { name, mut dag, equations, columns, left, decomposition } = self;
        let text = |dag: &Dag, expr: ExprId| print(dag, expr).to_string();
        let mut functions = Vec::new();
        for function in &decomposition.functions {
            let expr = function.to_expr(&mut dag);
            functions.push(text(&dag, expr));
        }
        let mut coefficients = Vec::new();
        for coefficient in &decomposition.coefficients {
            let expr = coefficient.to_expr(&mut dag);
            coefficients.push(text(&dag, expr));
        }
        let mut entries = Vec::new();
        for (column, of_column) in decomposition.columns.iter().enumerate() {
            entries.extend(of_column.iter().map(|entry| EntryJson {
                equation: entry.equation as usize,
                function: entry.function as usize,
                column,
                value: coefficients[entry.coefficient as usize].clone(),
            }));
        }
        DecomposeJson {
            model: name,
            basis: decomposition.basis.as_str(),
            equations,
            columns,
            rows: decomposition.shape().0,
            nonzeros: decomposition.nonzeros(),
            functions,
            entries,
            left: left.map(|sides| sides.into_iter().map(|side| text(&dag, side)).collect()),
        }
    }
}

fn write_texts(out: &mut dyn Write, found: &DecomposeJson) -> Result<(), Failure> {
    writeln!(
        out,
        "{}: {} functions in the {} basis; B is {} x {} with {} entries",
        found.model,
        found.functions.len(),
        found.basis,
        found.rows,
        found.columns.len(),
        found.nonzeros
    )?;
    for (index, side) in found.left.iter().flatten().enumerate() {
        writeln!(out, "  zeta {}: {side}", index + 1)?;
    }
    if found.functions.len() > READABLE_FUNCTIONS {
        writeln!(out, "more than {READABLE_FUNCTIONS} functions: --json lists f and B")?;
        return Ok(());
    }
    writeln!(out, "\nf:")?;
    for (index, function) in found.functions.iter().enumerate() {
        writeln!(out, "  {:>2}  {function}", index + 1)?;
    }
    let mut table = Table::new(&[
        ("column", Align::Left),
        ("equation", Align::Right),
        ("f", Align::Right),
        ("B", Align::Left),
    ]);
    for entry in &found.entries {
        table.push(vec![
            found.columns[entry.column].clone(),
            (entry.equation + 1).to_string(),
            (entry.function + 1).to_string(),
            entry.value.clone(),
        ]);
    }
    writeln!(out, "\n{table}")?;
    Ok(())
}
