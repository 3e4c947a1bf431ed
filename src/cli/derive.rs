//! `denavit derive`: the equations of motion as text.

mod equations;

use super::Answer;
use super::failure::Failure;
use super::files::read_model_with_effects;
use super::json::{Ordered, write_json};
use super::options::{EffectsOption, ModelArgument, function_names};
use super::outputs::{on_stdout, write_whole};
use super::progress::Progress;
use clap::{Args, ValueEnum};
use denavit::dynamics::methods::Method;
use denavit::expr::text::{print, print_with_intermediates};
use denavit::expr::{ExprId, Operations};
use denavit::function::FunctionName;
use denavit::model::{JointLaw, Robot};
use denavit::report::{Align, Table};
use equations::{Equations, Part};
use serde::Serialize;
use std::io::Write;
use std::path::PathBuf;

/// Equations with more nodes than this are not multiplied out, which would take long and come to
/// much: the first is for robots of few joints, whose equations may be long and come to little.
const MULTIPLIED_OUT_NODES: [usize; 2] = [3000, 700];

/// So many joints are few.
const FEW_JOINTS: usize = 4;

/// Equations of at most so many terms, multiplied out, are written so.
const READABLE_TERMS: usize = 500;

/// Others of at most so many nodes are written with intermediates; what is larger is not read by
/// people and gets a summary.
const READABLE_NODES: usize = 300;

/// Entries that are longer than this altogether, in nodes, are written with intermediates.
const PLAIN_NODES: u64 = 200;

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

#[derive(Serialize)]
struct DeriveJson<'a> {
    model: &'a str,
    method: &'static str,
    joints: &'a [String],
    functions: Ordered<PartJson<'a>>,
    intermediates: Vec<IntermediateJson<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    effects: Vec<LawJson<'a>>,
}

#[derive(Serialize)]
struct LawJson<'a> {
    effect: &'a str,
    title: &'a str,
    joint: &'a str,
    torque: String,
    states: Ordered<String>,
}

#[derive(Serialize)]
struct PartJson<'a> {
    symbol: &'static str,
    shape: &'a [usize],
    entries: &'a [String],
}

#[derive(Serialize)]
struct IntermediateJson<'a> {
    name: &'a str,
    expression: &'a str,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let is_answered = on_stdout(&[arguments.latex.as_ref()], arguments.json)?;
    let robot =
        read_model_with_effects(&arguments.model.model, arguments.effects.effects.as_deref())?;
    let progress = Progress::new();
    progress.show(&format!("deriving {}", robot.name));
    if let (Some(law), Some(_)) = (robot.laws.first(), arguments.method.method()) {
        return Err(Failure::Effect(robot.name.clone(), law.effect.clone()));
    }
    let mut equations = match arguments.method.method() {
        None => Equations::recursive(&robot, &arguments.functions),
        Some(method) => Equations::by_method(&robot, method),
    };
    let missing = arguments.functions.iter().filter(|name| !equations.has(**name));
    let missing: Vec<String> = missing.map(|name| name.to_string()).collect();
    if !missing.is_empty() {
        return Err(Failure::NoFunction { model: robot.name.clone(), asked: missing });
    }
    if let Some(file) = &arguments.latex {
        progress.show(&format!("setting the equations of {}", robot.name));
        write_whole(file, equations.latex(&robot).as_bytes())?;
    }
    drop(progress);
    if is_answered {
        return Ok(Answer::Done);
    }
    if arguments.json {
        write_answer(out, &robot, &equations)?;
    } else {
        write_for_people(out, &mut equations)?;
        write_effects(out, &robot)?;
        if let Some(file) = &arguments.latex {
            writeln!(out, "\nwrote {}", file.display())?;
        }
    }
    Ok(Answer::Done)
}

/// In full where that can be read, else a summary.
fn write_for_people(out: &mut dyn Write, equations: &mut Equations) -> Result<(), Failure> {
    writeln!(out, "{}: {}, method {}", equations.model, equations.law(), equations.method)?;
    writeln!(out, "\njoints: {}", numbered(&equations.joints))?;
    let nodes = equations.nodes();
    let most = MULTIPLIED_OUT_NODES[usize::from(equations.joints.len() > FEW_JOINTS)];
    let multiplied_out = match nodes <= most {
        true => equations.written_out(READABLE_TERMS),
        false => None,
    };
    match multiplied_out {
        Some(entries) => write_in_full(out, equations, &entries, u64::MAX),
        None if nodes <= READABLE_NODES => {
            write_in_full(out, equations, &equations.entries_of_terms(), PLAIN_NODES)
        }
        None => write_summary(out, equations),
    }
}

fn numbered(joints: &[String]) -> String {
    let named = joints.iter().enumerate().map(|(index, name)| format!("{} {name}", index + 1));
    named.collect::<Vec<_>>().join(", ")
}

fn write_answer(out: &mut dyn Write, robot: &Robot, equations: &Equations) -> Result<(), Failure> {
    let entries: Vec<_> =
        equations.parts.iter().flat_map(|part| part.entries.iter().copied()).collect();
    let printed = print_with_intermediates(&equations.dag, &entries, PLAIN_NODES);
    let mut texts = &printed.outputs[..];
    let mut functions = Vec::new();
    for part in &equations.parts {
        let (own, rest) = texts.split_at(part.entries.len());
        let json = PartJson { symbol: part.symbol, shape: &part.shape, entries: own };
        functions.push((part.key.clone(), json));
        texts = rest;
    }
    let bindings = printed.bindings.iter();
    let json = DeriveJson {
        model: &equations.model,
        method: equations.method,
        joints: &equations.joints,
        functions: Ordered(functions),
        intermediates: bindings
            .map(|(name, expression)| IntermediateJson { name, expression })
            .collect(),
        effects: robot.laws.iter().map(|law| law_json(robot, law)).collect(),
    };
    write_json(out, &json)
}

fn law_json<'a>(robot: &'a Robot, law: &'a JointLaw) -> LawJson<'a> {
    let rates = law.states.iter();
    LawJson {
        effect: &law.effect,
        title: &law.title,
        joint: &robot.links[law.joint].name,
        torque: print(&robot.dag, law.torque),
        states: Ordered(
            rates.map(|state| (state.name.clone(), print(&robot.dag, state.rate))).collect(),
        ),
    }
}

/// The laws of added effects, which are part of the joints' own torques.
fn write_effects(out: &mut dyn Write, robot: &Robot) -> Result<(), Failure> {
    if !robot.laws.is_empty() {
        writeln!(out, "\nadded effects, part of the joints' own torques:")?;
    }
    for law in &robot.laws {
        let row = robot.joints().position(|(link, _)| link == law.joint).map_or(0, |row| row + 1);
        let torque = print(&robot.dag, law.torque);
        writeln!(out, "tau[{row}] += {torque}    ({})", law.title)?;
        for state in &law.states {
            writeln!(out, "  d/dt {} = {}", state.name, print(&robot.dag, state.rate))?;
        }
    }
    Ok(())
}

/// D, C, G and the drives' torque, of which tau is the sum, or what was named. `entries` are those
/// of them; longer ones than `threshold` nodes are written with intermediates.
fn write_in_full(
    out: &mut dyn Write,
    equations: &Equations,
    entries: &[ExprId],
    threshold: u64,
) -> Result<(), Failure> {
    let terms: Vec<&Part> = equations.written().collect();
    let zero = equations.dag.zero();
    let printed = print_with_intermediates(&equations.dag, entries, threshold);
    let mut texts = printed.outputs.iter();
    for part in terms {
        let own: Vec<&String> = texts.by_ref().take(part.entries.len()).collect();
        writeln!(out)?;
        if part.entries.iter().all(|&entry| entry == zero) {
            writeln!(out, "{} = 0", part.label())?;
            continue;
        }
        for (index, text) in own.iter().enumerate() {
            if let Some(left) = left_side(part, &own, index) {
                writeln!(out, "{left} = {text}")?;
            }
        }
    }
    if !printed.bindings.is_empty() {
        writeln!(out, "\nwhere")?;
    }
    for (name, text) in &printed.bindings {
        writeln!(out, "{name} = {text}")?;
    }
    Ok(())
}

/// The name of an entry; of equal ones across the diagonal of D both names, none for the second.
fn left_side(part: &Part, texts: &[&String], index: usize) -> Option<String> {
    let symbol = part.label();
    let [_, columns] = part.shape[..] else {
        return Some(format!("{symbol}[{}]", index + 1));
    };
    let (row, column) = (index / columns, index % columns);
    let name = |row: usize, column: usize| format!("{symbol}[{},{}]", row + 1, column + 1);
    let mirrored = column * columns + row;
    if symbol != "D" || row == column || texts.get(mirrored) != texts.get(index) {
        return Some(name(row, column));
    }
    (row < column).then(|| format!("{} = {}", name(row, column), name(column, row)))
}

fn write_summary(out: &mut dyn Write, equations: &Equations) -> Result<(), Failure> {
    use Align::{Left, Right};
    let mut table = Table::new(&[
        ("function", Left),
        ("form", Left),
        ("mul", Right),
        ("add", Right),
        ("sincos", Right),
        ("nodes", Right),
        ("time", Right),
    ]);
    for part in &equations.parts {
        let Operations { mul, add, sincos, .. } = Operations::count(&equations.dag, &part.entries);
        let nodes = equations.dag.topological(&part.entries).len();
        let name = format!("{} {}", part.symbol, part.key);
        let mut row = vec![name.trim_start().to_owned(), part.form.to_owned()];
        row.extend([mul, add, sincos, nodes].map(|count| count.to_string()));
        row.push(part.time.map_or(String::new(), |time| format!("{:.1} ms", 1e3 * time)));
        table.push(row);
    }
    writeln!(out, "\n{table}")?;
    if let Some(total) = equations.time {
        writeln!(out, "derived in {:.1} ms", 1e3 * total)?;
    }
    Ok(writeln!(out, "too large to be read here: --latex FILE sets them, --json has every entry")?)
}
