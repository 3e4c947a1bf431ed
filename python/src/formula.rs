//! Functions as formulas.

use crate::failure::internal;
use crate::failure::{Failure, Wrong};
use denavit::derive::{Flavour, derive};
use denavit::emit::latex::{Extent, Notation, Written, write_expressions};
use denavit::expr::ExprId;
use denavit::function::{Function, FunctionName, Output};
use denavit::fundamental::written_out;
use denavit::model::Robot;
use pyo3::prelude::*;

/// What is written out in full has at most so many terms.
const MOST_TERMS: usize = 160;

/// Of larger functions what is wider than this is named first, in tenths of a digit.
const NAMED: Extent = Extent { shared: 60, longest: 320 };

/// A function as LaTeX: arrays as matrices, named parts before them.
pub(crate) fn latex(robot: &Robot, name: FunctionName) -> PyResult<String> {
    let derivation = derive(robot, Flavour::Tunable, &[name]).map_err(internal)?;
    let Some(function) = derivation.functions.first() else {
        let cause = format!("{} has no {name}", robot.name);
        return Err(Failure::one("FunctionMissing", Wrong::new(cause)).into());
    };
    let mut dag = derivation.dag.clone();
    let notation = Notation::of_robot(&dag, robot);
    let entries: Vec<ExprId> = function.entries();
    let written = match written_out(&mut dag, &entries, MOST_TERMS) {
        Some(full) => write_expressions(&dag, &full, &notation, Extent::FULL),
        None => write_expressions(&dag, &entries, &notation, NAMED),
    };
    Ok(set(function, &written))
}

fn set(function: &Function, written: &Written) -> String {
    let mut lines: Vec<String> =
        written.definitions.iter().map(|(name, value)| format!("{name} &= {value}")).collect();
    let mut rest = &written.outputs[..];
    for output in &function.outputs {
        let (own, others) = rest.split_at(output.entries.len());
        rest = others;
        lines.push(format!("{} &= {}", symbol(output.name), matrix(output, own)));
    }
    format!("\\begin{{aligned}}{}\\end{{aligned}}", lines.join(r" \\ "))
}

/// An array: rows of its last dimension.
fn matrix(output: &Output, entries: &[Vec<String>]) -> String {
    let texts: Vec<String> = entries.iter().map(|terms| terms.join(" ")).collect();
    let columns = match output.shape[..] {
        [] => return texts.concat(),
        [_] => 1,
        [.., last] => last.max(1),
    };
    let rows: Vec<String> = texts.chunks(columns).map(|row| row.join(" & ")).collect();
    format!("\\begin{{bmatrix}}{}\\end{{bmatrix}}", rows.join(r" \\ "))
}

/// The letter of an array, or its name.
fn symbol(name: &str) -> String {
    match name {
        "mass_matrix" => "D".to_owned(),
        "coriolis_matrix" => "C".to_owned(),
        "gravity_vector" => "G".to_owned(),
        "tau" | "inverse_dynamics" => r"\tau".to_owned(),
        name => format!(r"\mathrm{{{}}}", name.replace('_', r"\_")),
    }
}
