//! `denavit base`: what can be identified, exactly.

mod given;
mod json;
mod markdown;
mod text;

use super::Answer;
use super::failure::Failure;
use super::files::read_input;
use super::options::{EffectsOption, Term, terms};
use super::outputs::{check_outputs, on_stdout, write_whole};
use clap::{Args, ValueEnum};
use denavit::emit::latex::base_document;
use denavit::expr::ExprId;
use denavit::model::{Robot, bake_geometry};
use denavit::regressor::functions::modelled;
use denavit::regressor::{
    BaseParameter, BaseParameters, Certificate, JointParameter, Part, RegressorOptions,
    base_parameters, joint_basis,
};
use denavit::report::{Values, short};
use denavit::workflow::EffectUse;
use denavit::workflow::Input;
use serde::Serialize;
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

/// What was checked, and modulo which prime.
#[derive(Serialize)]
struct CertificateJson {
    verified: bool,
    prime: u64,
}

/// Base parameters with all that is shown of them.
pub(crate) struct Found<'a> {
    robot: &'a Robot,
    base: &'a BaseParameters,
    /// Those on the joint axes, if they are asked for.
    joints: Option<&'a [JointParameter]>,
    /// The values of what is listed; none where the model gives none.
    values: Vec<Option<f64>>,
    /// What becomes of the model's effects.
    effects: Vec<EffectUse>,
    verified: bool,
}

/// A base parameter as it is listed.
struct Listed<'a> {
    name: &'a str,
    unit: &'a str,
    members: &'a [(usize, ExprId)],
    parts: &'a [Part],
    /// What it is of the base parameters of kept columns, where it is none of them.
    of_kept: Option<OfKept<'a>>,
}

/// A sum of base parameters of kept columns.
struct OfKept<'a> {
    /// Their places, with factors.
    members: &'a [(usize, ExprId)],
    parts: &'a [Part],
}

impl<'a> Found<'a> {
    pub(crate) fn new(
        robot: &'a Robot,
        base: &'a BaseParameters,
        joints: Option<&'a [JointParameter]>,
        verified: bool,
    ) -> Self {
        let listed: Vec<ExprId> = match joints {
            Some(joints) => joints.iter().map(|parameter| parameter.value).collect(),
            None => base.parameters.iter().map(|parameter| parameter.value).collect(),
        };
        let mut values = Values::in_graph(&base.regressor.dag, robot);
        let values = listed.into_iter().map(|value| values.number(value));
        Self { robot, base, joints, values: values.collect(), effects: Vec::new(), verified }
    }

    /// What is listed, in order.
    fn listed(&self) -> Vec<Listed<'a>> {
        let base = self.base;
        let of_kept_column = |parameter: &'a BaseParameter| Listed {
            name: base.name(parameter.column),
            unit: &base.regressor.columns[parameter.column].unit,
            members: &parameter.members,
            parts: &parameter.parts,
            of_kept: None,
        };
        let on_axis = |parameter: &'a JointParameter| Listed {
            name: &parameter.name,
            unit: &parameter.unit,
            members: &parameter.members,
            parts: &parameter.parts,
            of_kept: Some(OfKept { members: &parameter.of_kept, parts: &parameter.parts_of_kept }),
        };
        match self.joints {
            Some(joints) => joints.iter().map(on_axis).collect(),
            None => base.parameters.iter().map(of_kept_column).collect(),
        }
    }

    /// What is said of the list in its title.
    fn place(&self) -> &'static str {
        if self.joints.is_some() { ", on the joint axes" } else { "" }
    }

    /// The values as a person writes them; none at all if the model gives only zeros.
    pub(super) fn shown_values(&self) -> Vec<String> {
        let says = |value: &Option<f64>| value.is_some_and(|value| value != 0.0);
        match self.values.iter().any(says) {
            true => self.values.iter().map(|value| value.map_or(String::new(), short)).collect(),
            false => Vec::new(),
        }
    }

    fn names(&self, columns: Vec<usize>) -> Vec<&str> {
        columns.into_iter().map(|column| self.base.name(column)).collect()
    }

    /// What is listed in the base parameters of kept columns; none of these.
    fn in_kept(&self) -> Vec<(&'a str, &'a [Part])> {
        let listed = self.listed().into_iter();
        listed.filter_map(|one| one.of_kept.map(|sum| (one.name, sum.parts))).collect()
    }

    /// The columns that are sums of others, with their relations.
    fn sums(&self) -> impl Iterator<Item = (&'a str, &'a [Part])> {
        let base = self.base;
        let sums = base.dependent.iter().filter(|one| !one.relation.is_empty());
        sums.map(|one| (base.name(one.column), &one.parts[..]))
    }
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let files = [&arguments.certificate, &arguments.latex, &arguments.markdown];
    let files = files.map(Option::as_ref);
    let is_answered = on_stdout(&files, arguments.json)?;
    check_outputs(&files)?;
    let model = match read_input(&arguments.model, arguments.effects.effects.as_deref())? {
        Input::Model(model) => model,
        Input::Equations(equations) => return given::run(arguments, &equations, is_answered, out),
    };
    let effects = model.left_out();
    let mut robot = model.apart.robot;
    if let Some(list) = &arguments.terms {
        robot.terms = terms(list);
    }
    if !robot.terms.inertia && !robot.terms.gravity {
        return Err(Failure::NoMotionTerms(robot.name));
    }
    if arguments.numeric {
        robot = bake_geometry(&robot).map_err(Failure::Bake)?;
    }
    let options = regressor_options(&robot, &arguments.with)?;
    let failure = |error| Failure::Base(arguments.model.display().to_string(), Box::new(error));
    let mut base = base_parameters(&robot, options, &arguments.keep).map_err(failure)?;
    let joints = match arguments.basis {
        ListedBasis::Kept => None,
        ListedBasis::Joints => Some(joint_basis(&mut base, &robot)),
    };
    let joints = joints.transpose().map_err(failure)?;
    let certificate = Certificate::new(&robot, options, &base, arguments.numeric);
    let verified = certificate.verify(&robot).is_verified();
    if let Some(path) = &arguments.certificate {
        let mut bytes = serde_json::to_vec_pretty(&certificate)?;
        bytes.push(b'\n');
        write_whole(path, &bytes)?;
    }
    let found = Found { effects, ..Found::new(&robot, &base, joints.as_deref(), verified) };
    if let Some(path) = &arguments.latex {
        write_whole(path, latex(&found).as_bytes())?;
    }
    if let Some(path) = &arguments.markdown {
        write_whole(path, markdown::document(&found).as_bytes())?;
    }
    match (arguments.json, is_answered) {
        (true, _) => json::write(out, &found)?,
        (false, true) => {}
        (false, false) => text::write(out, &found)?,
    }
    Ok(if verified { Answer::Done } else { Answer::Negative })
}

/// The base parameters as a LaTeX document.
pub(crate) fn latex(found: &Found<'_>) -> String {
    base_document(found.robot, found.base, found.joints, &found.shown_values())
        .expect("our template has a place for each value")
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
