//! `denavit base`: what can be identified, exactly.

use super::Answer;
use super::failure::Failure;
use super::files::read_input;
use super::options::{EffectsOption, Term, terms};
use super::outputs::{check_outputs, on_stdout, print_answer, write_given};
use super::progress::Progress;
use clap::{Args, ValueEnum};
use denavit::fundamental::{DEFAULT_MEMORY_BYTES, Expansion};
use denavit::model::Robot;
use denavit::model::equations::Equations;
use denavit::regressor::functions::modelled;
use denavit::regressor::{
    BaseOptions, DecomposedError, EquationsBase, ProvenBase, RegressorOptions,
};
use denavit::report::symbolic::{BaseReport, GivenBaseReport};
use denavit::workflow::Input;
use std::io::Write;
use std::path::PathBuf;

/// Find the base parameters: the combinations of parameters that the torques depend on
///
/// Rank, relations and factors are exact, with lengths as symbols. Columns are kept from the left
/// unless --keep names others: m, mx, my, mz, Ixx, Iyy, Izz, Ixy, Ixz, Iyz of each link about the
/// origin of its frame (or the products of the model's own unknowns), then fv, fc, Ia, off.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit base double_pendulum
  denavit base puma560 --with friction,rotor --json
  denavit base double_pendulum_drives --markdown -
  denavit base tulip --numeric
  denavit base puma560 --with modelled --basis joints
  denavit base tulip --latex tulip.tex --markdown tulip.md
  denavit base tulip_leg --terms inertia,gravity --certificate leg.certificate.json")]
pub(crate) struct Arguments {
    /// Path of a model or of a file of equations, name of a shipped one, or - for standard input
    #[arg(value_name = "MODEL|EQUATIONS")]
    model: PathBuf,
    #[command(flatten)]
    effects: EffectsOption,
    /// Joint parameters to add to those of the bodies, separated by commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_enum)]
    with: Vec<With>,
    /// Which parameters to list: as many, and of the same information
    #[arg(long, value_enum, default_value_t)]
    basis: ListedBasis,
    /// The terms of the equations, instead of those of the model, separated by commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_enum)]
    terms: Option<Vec<Term>>,
    /// Take the model's numbers for lengths, angles and gravity, in place of their symbols
    #[arg(long)]
    numeric: bool,
    /// Parameters to keep before others, separated by commas, most wanted first: names, or
    /// prefixes for those of all links (Izz,mx)
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    keep: Vec<String>,
    /// Write the base parameters as a LaTeX document; - is standard output
    #[arg(long, value_name = "FILE")]
    latex: Option<PathBuf>,
    /// Write them as Markdown; - is standard output
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Write a certificate that `denavit verify` checks; - is standard output
    #[arg(long, value_name = "FILE")]
    certificate: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Joint parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum With {
    /// Viscous and Coulomb friction
    Friction,
    /// Reflected rotor inertia
    Rotor,
    /// A constant torque
    Offset,
    /// Those that the model has, as in the emitted functions
    Modelled,
}

/// Bases of the space that the columns of R0 span.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ListedBasis {
    /// Columns of R0 that are kept, each with its own parameter and those that go with it
    #[default]
    Kept,
    /// What each body keeps, in the frame on its joint's axis, when its carrier has all that it
    /// feels alike: the columns of the emitted base regressor
    Joints,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let files = [&arguments.certificate, &arguments.latex, &arguments.markdown];
    let files = files.map(Option::as_ref);
    let is_answered = on_stdout(&files, arguments.json)?;
    check_outputs(&files)?;
    let model = match read_input(&arguments.model, arguments.effects.effects.as_deref())? {
        Input::Model(model) => model,
        Input::Equations(equations) => {
            return of_equations(arguments, &equations, is_answered, out);
        }
    };
    let effects = model.left_out();
    let mut robot = model.apart.robot;
    if let Some(list) = &arguments.terms {
        robot.terms = terms(list);
    }
    let options = BaseOptions {
        parameters: regressor_options(&robot, &arguments.with)?,
        numeric: arguments.numeric,
        keep: arguments.keep.clone(),
        on_joint_axes: arguments.basis == ListedBasis::Joints,
    };
    let found = ProvenBase::find(robot, &options)
        .map_err(|error| Failure::Base(arguments.model.display().to_string(), Box::new(error)))?;
    write_given(&arguments.certificate, || found.certificate.to_text())?;
    let report = BaseReport::new(&found);
    write_given(&arguments.latex, || report.latex())?;
    write_given(&arguments.markdown, || report.markdown())?;
    let how = (is_answered, arguments.json);
    print_answer(out, how, || report.json(&effects), || report.text(&effects), &[])?;
    Ok(answer(found.verified))
}

/// The base parameters of given equations.
fn of_equations(
    arguments: &Arguments,
    equations: &Equations,
    is_answered: bool,
    out: &mut dyn Write,
) -> Result<Answer, Failure> {
    let is_of_models = !arguments.with.is_empty()
        || arguments.terms.is_some()
        || arguments.numeric
        || arguments.basis == ListedBasis::Joints
        || arguments.certificate.is_some();
    if is_of_models {
        return Err(Failure::NotOfEquations(equations.name.clone()));
    }
    let progress = Progress::new();
    let mut show = |_| progress.show("writing the equations out");
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut show };
    let found = EquationsBase::find(equations, &arguments.keep, &mut expansion)
        .map_err(DecomposedError::Equations)?;
    progress.clear();
    let report = GivenBaseReport::new(equations, &found);
    write_given(&arguments.latex, || report.latex())?;
    write_given(&arguments.markdown, || report.markdown())?;
    let how = (is_answered, arguments.json);
    print_answer(out, how, || report.json(), || report.text(), &[])?;
    Ok(answer(found.verified))
}

fn answer(verified: bool) -> Answer {
    if verified { Answer::Done } else { Answer::Negative }
}

/// What a list of joint parameters asks for.
pub(crate) fn regressor_options(robot: &Robot, with: &[With]) -> Result<RegressorOptions, Failure> {
    let has = |one| with.contains(&one);
    if has(With::Modelled) {
        let alone = with.iter().all(|&one| one == With::Modelled);
        return if alone { Ok(modelled(robot)) } else { Err(Failure::ModelledAndMore) };
    }
    Ok(RegressorOptions {
        friction: has(With::Friction),
        rotor: has(With::Rotor),
        offset: has(With::Offset),
        ..RegressorOptions::default()
    })
}
