//! `denavit base`: what can be identified, exactly.

mod given;

use super::Answer;
use super::failure::Failure;
use super::files::{Input, read_input, write_whole};
use super::json::{Ordered, write_json};
use super::options::{Term, terms};
use clap::{Args, ValueEnum};
use denavit::model::Robot;
use denavit::number::Residue;
use denavit::regressor::{BaseParameters, Certificate, RegressorOptions, base_parameters};
use denavit::report::{Align, Table};
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
  denavit base double_pendulum_drives
  denavit base tulip_leg --terms inertia,gravity --certificate leg.certificate.json")]
pub(crate) struct Arguments {
    /// Path of a model or of a file of equations, name of a shipped one, or - for standard input
    #[arg(value_name = "MODEL|EQUATIONS")]
    model: PathBuf,
    /// Joint parameters to add to those of the bodies, separated by commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_enum)]
    with: Vec<With>,
    /// The terms of the equations, instead of those of the model, separated by commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_enum)]
    terms: Option<Vec<Term>>,
    /// Parameters to keep before others, separated by commas, most wanted first
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    keep: Vec<String>,
    /// Write a certificate that `denavit verify` checks
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
}

#[derive(Serialize)]
struct BaseJson<'a> {
    model: &'a str,
    columns: Vec<&'a str>,
    rank: usize,
    zero: Vec<&'a str>,
    dependent: Vec<DependentJson<'a>>,
    parameters: Vec<ParameterJson<'a>>,
    certificate: CertificateJson,
}

#[derive(Serialize)]
struct DependentJson<'a> {
    name: &'a str,
    relation: String,
}

#[derive(Serialize)]
struct ParameterJson<'a> {
    name: &'a str,
    expression: String,
    latex: String,
    unit: &'a str,
    members: Ordered<String>,
    alone: bool,
}

/// What was checked, and modulo which prime.
#[derive(Serialize)]
struct CertificateJson {
    verified: bool,
    prime: u64,
}

/// What a list of joint parameters asks for.
pub(crate) fn regressor_options(with: &[With]) -> RegressorOptions {
    let has = |one| with.contains(&one);
    RegressorOptions {
        friction: has(With::Friction),
        rotor: has(With::Rotor),
        offset: has(With::Offset),
        ..RegressorOptions::default()
    }
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let mut robot = match read_input(&arguments.model)? {
        Input::Model(robot) => robot,
        Input::Equations(equations) => return given::run(arguments, &equations, out),
    };
    if let Some(list) = &arguments.terms {
        robot.terms = terms(list);
    }
    let options = regressor_options(&arguments.with);
    let base = base_parameters(&robot, options, &arguments.keep)
        .map_err(|error| Failure::Base(Box::new(error)))?;
    let certificate = Certificate::new(&robot, options, &base);
    let verified = certificate.verify(&robot).is_verified();
    if let Some(path) = &arguments.certificate {
        let mut bytes = serde_json::to_vec_pretty(&certificate)?;
        bytes.push(b'\n');
        write_whole(path, &bytes)?;
    }
    if arguments.json {
        write_json(out, &json(&robot, &base, verified))?;
    } else {
        print(out, &robot, &base, verified)?;
    }
    Ok(if verified { Answer::Done } else { Answer::Negative })
}

fn json<'a>(robot: &'a Robot, base: &'a BaseParameters, verified: bool) -> BaseJson<'a> {
    let dependent = base.dependent.iter().filter(|dependent| !dependent.relation.is_empty());
    let parameters = base.parameters.iter().map(|parameter| ParameterJson {
        name: base.name(parameter.column),
        expression: base.text(parameter.expression),
        latex: latex(&base.text(parameter.expression)),
        unit: &base.regressor.columns[parameter.column].unit,
        members: Ordered(
            parameter
                .members
                .iter()
                .map(|&(column, factor)| (base.name(column).to_owned(), base.text(factor)))
                .collect(),
        ),
        alone: parameter.is_alone(),
    });
    BaseJson {
        model: &robot.name,
        columns: base.regressor.columns.iter().map(|column| column.name.as_str()).collect(),
        rank: base.rank(),
        zero: base.zero().into_iter().map(|column| base.name(column)).collect(),
        dependent: dependent
            .map(|dependent| DependentJson {
                name: base.name(dependent.column),
                relation: base.relation_text(dependent),
            })
            .collect(),
        parameters: parameters.collect(),
        certificate: CertificateJson { verified, prime: Residue::MODULUS },
    }
}

/// A formula of names, whole numbers and `+ - * / ^ ( )` as LaTeX: names upright.
fn latex(formula: &str) -> String {
    let mut result = String::new();
    let mut rest = formula;
    while let Some(first) = rest.chars().next() {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let length = match first {
            c if is_word(c) => rest.find(|c| !is_word(c)).unwrap_or(rest.len()),
            c => c.len_utf8(),
        };
        let (token, after) = rest.split_at(length);
        match token {
            "*" => result.push_str("\\,"),
            "sin" | "cos" | "tan" => result.push_str(&format!("\\{token}")),
            "pi" => result.push_str("\\pi"),
            _ if first.is_ascii_alphabetic() => {
                let name = token.replace('_', "\\_");
                result.push_str(&format!("\\mathrm{{{name}}}"));
            }
            _ if result.ends_with('^') => result.push_str(&format!("{{{token}}}")),
            _ => result.push_str(token),
        }
        rest = after;
    }
    result
}

fn print(
    out: &mut dyn Write,
    robot: &Robot,
    base: &BaseParameters,
    verified: bool,
) -> Result<(), Failure> {
    let columns = base.regressor.columns.len();
    writeln!(out, "{}: {} base parameters of {columns} columns\n", robot.name, base.rank())?;
    let mut table = Table::new(&[
        ("kept", Align::Left),
        ("unit", Align::Left),
        ("base parameter", Align::Left),
    ]);
    for parameter in &base.parameters {
        table.push(vec![
            base.name(parameter.column).to_owned(),
            base.regressor.columns[parameter.column].unit.clone(),
            base.text(parameter.expression),
        ]);
    }
    write!(out, "{table}")?;
    let zero: Vec<&str> = base.zero().into_iter().map(|column| base.name(column)).collect();
    if !zero.is_empty() {
        writeln!(out, "\nwithout any effect: {}", zero.join(", "))?;
    }
    let dependent = base.dependent.iter().filter(|dependent| !dependent.relation.is_empty());
    let dependent: Vec<_> = dependent.collect();
    if !dependent.is_empty() {
        writeln!(out, "\ncolumns that are sums of kept columns:")?;
    }
    for dependent in dependent {
        let relation = base.relation_text(dependent);
        writeln!(out, "  {} = {relation}", base.name(dependent.column))?;
    }
    let verdict = if verified { "verified" } else { "NOT verified" };
    Ok(writeln!(out, "\ncertificate {verdict} (exact; rank modulo {})", Residue::MODULUS)?)
}
