//! `denavit derive`: the equations of motion as text.

use super::Answer;
use super::failure::Failure;
use super::files::read_model_with_effects;
use super::json::write_json;
use super::options::{EffectsOption, ModelArgument, function_names};
use super::outputs::{on_stdout, write_whole};
use super::progress::Progress;
use clap::{Args, ValueEnum};
use denavit::derive::{EquationOptions, MotionEquations};
use denavit::dynamics::methods::Method;
use denavit::emit::latex::motion_document;
use denavit::function::FunctionName;
use denavit::report::symbolic::{equations_json, equations_text};
use std::io::Write;
use std::path::PathBuf;

/// Derive the equations of motion: D qdd + C qd + G = tau
///
/// Small robots are printed in full, large ones as a summary. Parameters stay symbols.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit derive double_pendulum
  denavit derive double_pendulum --method lagrange
  denavit derive tulip --latex tulip.tex
  denavit derive planar_biped --functions zero_moment_point --latex biped.tex
  denavit derive scara --json")]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    #[command(flatten)]
    effects: EffectsOption,
    /// How: by the recursions that emitted code uses, or in one of the thesis's four ways
    #[arg(long, value_enum, value_name = "METHOD", default_value = "recursive")]
    method: MethodName,
    /// What goes into the answer and the document, separated by commas; if nothing is named, the
    /// equations: mass_matrix, coriolis_matrix, gravity_vector, inverse_dynamics, contact_jacobian
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        value_parser = function_names(),
        conflicts_with = "method"
    )]
    functions: Vec<FunctionName>,
    /// Write the equations as a LaTeX document; - is standard output
    #[arg(long, value_name = "FILE")]
    latex: Option<PathBuf>,
    /// Print JSON: every entry as text, with intermediates where they are long
    #[arg(long)]
    json: bool,
}

/// A way to derive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MethodName {
    /// Recursions over the bodies, regrouped parameters
    Recursive,
    /// Lagrange-Euler on Denavit-Hartenberg frames (thesis 2.2.4)
    DhLagrange,
    /// Lagrange-Euler from energies (2.2.2)
    Lagrange,
    /// Newton-Euler with explicit joint constraints (2.2.1)
    NewtonEuler,
    /// TMT with the geometric Jacobian (2.2.3)
    Tmt,
}

impl MethodName {
    /// The thesis's method; none for the recursions.
    fn method(self) -> Option<Method> {
        match self {
            Self::Recursive => None,
            Self::DhLagrange => Some(Method::DhLagrange),
            Self::Lagrange => Some(Method::Lagrange),
            Self::NewtonEuler => Some(Method::NewtonEuler),
            Self::Tmt => Some(Method::Tmt),
        }
    }
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let is_answered = on_stdout(&[arguments.latex.as_ref()], arguments.json)?;
    let robot =
        read_model_with_effects(&arguments.model.model, arguments.effects.effects.as_deref())?;
    let progress = Progress::new();
    progress.show(&format!("deriving {}", robot.name));
    let method = arguments.method.method();
    let options = EquationOptions { method, functions: arguments.functions.clone() };
    let equations = MotionEquations::derive(&robot, &options)?;
    if let Some(file) = &arguments.latex {
        progress.show(&format!("setting the equations of {}", robot.name));
        let document =
            motion_document(&robot, &equations).expect("our template has a place for each value");
        write_whole(file, document.as_bytes())?;
    }
    drop(progress);
    if is_answered {
        return Ok(Answer::Done);
    }
    if arguments.json {
        write_json(out, &equations_json(&robot, &equations))?;
    } else {
        write!(out, "{}", equations_text(&robot, &equations))?;
        if let Some(file) = &arguments.latex {
            writeln!(out, "\nwrote {}", file.display())?;
        }
    }
    Ok(Answer::Done)
}
