//! `denavit decompose`: the regressor as fundamental functions and a matrix of known parameters.

use super::Answer;
use super::base::{With, regressor_options};
use super::failure::Failure;
use super::files::read_input;
use super::json::write_json;
use super::options::{EffectsOption, Term, terms};
use super::outputs::{on_stdout, write_whole};
use super::progress::Progress;
use clap::{Args, ValueEnum};
use denavit::emit::latex::decomposition_document;
use denavit::fundamental::{Basis, Expansion, Progress as Expanded};
use denavit::regressor::Decomposed;
use denavit::report::symbolic::DecompositionTexts;
use denavit::workflow::Input;
use std::io::Write;
use std::path::PathBuf;

/// Decompose the regressor: zeta = R0 theta0, R0_ij = f^T b_ij
///
/// f holds the fundamental functions of the motion, B what is known. The columns of a model are
/// those of `denavit base`; equations have one column for each product of unknowns. A floating base
/// is written in the coordinates of its torso.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit decompose planar_2r
  denavit decompose puma560 --terms inertia,gravity --json
  denavit decompose double_pendulum_drives --basis product --echelon
  denavit decompose tulip_leg --terms inertia,gravity --latex leg.tex")]
pub(crate) struct Arguments {
    /// Path of a model or of a file of equations, name of a shipped one, or - for standard input
    #[arg(value_name = "MODEL|EQUATIONS")]
    input: PathBuf,
    #[command(flatten)]
    effects: EffectsOption,
    /// What the functions are made of; by default, what makes the fewest
    #[arg(long, value_enum)]
    basis: Option<BasisName>,
    /// Joint parameters of a model to add to those of its bodies, separated by commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_enum)]
    with: Vec<With>,
    /// The terms of the equations, instead of those of the model, separated by commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_enum)]
    terms: Option<Vec<Term>>,
    /// Eliminate B, too: theta = B_E theta0, the base parameters
    #[arg(long)]
    echelon: bool,
    /// With --echelon: columns to keep before others, separated by commas, most wanted first
    #[arg(long, value_name = "LIST", value_delimiter = ',', requires = "echelon")]
    keep: Vec<String>,
    /// Memory for terms on the way [MiB]
    #[arg(long, value_name = "MIB", default_value_t = 2048)]
    memory: usize,
    /// Write f and B as a LaTeX document; - is standard output
    #[arg(long, value_name = "FILE")]
    latex: Option<PathBuf>,
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

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let is_answered = on_stdout(&[arguments.latex.as_ref()], arguments.json)?;
    let input = read_input(&arguments.input, arguments.effects.effects.as_deref())?;
    let mut effects = Vec::new();
    let progress = Progress::new();
    let mut show = |at: Expanded| {
        let share = at.done as f64 / at.total.max(1) as f64;
        progress.show_part("writing out", Some(share), &format!("{} terms", at.terms));
    };
    let memory_bytes = arguments.memory.saturating_mul(1 << 20);
    let mut expansion = Expansion { memory_bytes, progress: &mut show };
    let basis = arguments.basis.map(BasisName::basis);
    let mut found = match input {
        Input::Model(model) => {
            effects = model.left_out();
            let mut robot = model.apart.robot;
            if let Some(list) = &arguments.terms {
                robot.terms = terms(list);
            }
            let options = regressor_options(&robot, &arguments.with)?;
            Decomposed::of_model(robot, options, basis, &mut expansion)?
        }
        Input::Equations(equations) => Decomposed::of_equations(*equations, basis, &mut expansion)?,
    };
    if arguments.echelon {
        progress.show("eliminating");
        found.eliminate(&arguments.keep)?;
    }
    progress.show("writing f and B");
    if let Some(file) = &arguments.latex {
        write_whole(file, decomposition_document(&found)?.as_bytes())?;
    }
    if is_answered {
        return Ok(Answer::Done);
    }
    let texts = DecompositionTexts::new(found, effects);
    progress.clear();
    if arguments.json {
        write_json(out, &texts)?;
        return Ok(Answer::Done);
    }
    write!(out, "{}", texts.text())?;
    if let Some(file) = &arguments.latex {
        writeln!(out, "\nwrote {}", file.display())?;
    }
    Ok(Answer::Done)
}
