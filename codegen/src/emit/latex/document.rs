//! The equations of motion of a robot as a complete LaTeX document.

use super::expression::{Extent, Written, width, write_expression, write_expressions};
use super::nomenclature;
use super::notation::{Notation, escape, with_subscript};
use crate::derive::MotionEquations;
use crate::emit::layout::{TemplateError, fill};
use crate::expr::{Dag, ExprId};
use crate::function::{Form, Function, FunctionName, Output};
use crate::fundamental::written_out;
use crate::model::Robot;

pub(super) const TEMPLATE: &str = include_str!("../../../templates/latex/document.tex.in");

/// Equations of at most so many nodes may be written out in full, if they come to so few terms.
const FULL_NODES: usize = 600;
const FULL_TERMS: usize = 160;

/// The width of a line, in tenths of a digit: 170 mm of 10 pt type.
pub(super) const LINE: u32 = 960;

/// What is wider than a third of a line, or shared and wider than half a dozen digits, is named:
/// then each definition fits on its line, and few are needed.
const NAMED: Extent = Extent { shared: 60, longest: LINE / 3 };

/// D, C, G and W of equations of motion, however they were derived, and functions for walking.
pub fn motion_document(
    robot: &Robot,
    equations: &MotionEquations,
) -> Result<String, TemplateError> {
    let mut functions: Vec<Function> = Vec::new();
    for part in equations.parts.iter().filter(|part| equations.is_named || part.symbol != "tau") {
        let Some(name) = part.function else { continue };
        let output = Output {
            name: part.output,
            shape: part.shape.clone(),
            entries: part.entries.clone(),
            doc: part.doc.clone(),
            details: Vec::new(),
        };
        let link = part.link.clone();
        match functions.last_mut().filter(|last| last.name == name && last.link == link) {
            Some(same) => same.outputs.push(output),
            None => {
                let (arguments, outputs, form) = (Vec::new(), vec![output], Form::Plain);
                functions.push(Function { name, link, arguments, outputs, form });
            }
        }
    }
    document(robot, &equations.dag, &functions)
}

/// The equations of `functions`, all of `robot` and in `dag`, as a document. Small equations are
/// written in full; of large ones the intermediates are named first.
pub fn document(robot: &Robot, dag: &Dag, functions: &[Function]) -> Result<String, TemplateError> {
    let mut dag = dag.clone();
    let notation = Notation::of_robot(&dag, robot);
    let entries: Vec<ExprId> = functions.iter().flat_map(Function::entries).collect();
    let full = match dag.topological(&entries).len() <= FULL_NODES {
        true => written_out(&mut dag, &entries, FULL_TERMS),
        false => None,
    };
    let written = match &full {
        Some(full) => write_expressions(&dag, full, &notation, Extent::FULL),
        None => write_expressions(&dag, &entries, &notation, NAMED),
    };
    let mut sections = abbreviations(&written);
    let mut rest = written.outputs.as_slice();
    for function in functions {
        for output in &function.outputs {
            let (own, others) = rest.split_at(output.entries.len());
            rest = others;
            sections.push_str(&section(function, output, own));
        }
    }
    sections.push_str(&effects(robot, &dag, &notation));
    let description =
        nomenclature::description(&robot.description, &robot.source, &robot.assumptions);
    let table = nomenclature::nomenclature(robot, &dag, &notation);
    fill(
        TEMPLATE,
        &[
            ("heading", "Equations of motion"),
            ("name", &robot.name),
            ("version", env!("CARGO_PKG_VERSION")),
            ("hash", &format!("{:016x}", robot.hash)),
            ("title", &escape(&robot.name)),
            ("description", &description),
            ("nomenclature", &table),
            ("law", nomenclature::LAW),
            ("sections", &sections),
        ],
    )
}

/// The laws of added effects, each with its title: what they add to the torque of their joints.
fn effects(robot: &Robot, dag: &Dag, notation: &Notation) -> String {
    if robot.laws.is_empty() {
        return String::new();
    }
    let mut text = "\n\\subsection{Added effects}\nEach adds to the torque that its joint needs; \
                    $\\tau_{\\mathrm{load}}$ is the torque of the rigid bodies alone.\\par\n\
                    {\\small\\raggedright\n"
        .to_owned();
    for law in &robot.laws {
        let left = format!(r"\tau_{{\mathrm{{{}}}}}", escape(&law.effect));
        let mut rows = vec![(left, law.torque)];
        rows.extend(law.states.iter().map(|state| {
            (format!(r"\dot{{{}}}", write_expression(dag, state.symbol, notation)), state.rate)
        }));
        let joint = escape(&robot.links[law.joint].name);
        text.push_str(&format!("{} at {joint}:\\par\n", escape(&capitalised(&law.title))));
        for (left, right) in &rows {
            let written = write_expressions(dag, &[*right], notation, Extent::FULL);
            let terms = &written.outputs[0];
            let formula = terms.join(" ");
            if width(&formula) + 80 <= LINE {
                text.push_str(&format!("\\formula{{{left} = {formula}}}\n"));
            } else {
                text.push_str(&broken(left, terms));
            }
        }
    }
    text.push_str("\\par}\n");
    text
}

/// The table of intermediates.
pub(super) fn abbreviations(written: &Written) -> String {
    if written.definitions.is_empty() {
        return String::new();
    }
    let mut text = "\n\\subsection{Abbreviations}\nEach is defined before it is used.\\par\n\
                    {\\small\\raggedright\n"
        .to_owned();
    for (name, formula) in &written.definitions {
        text.push_str(&format!("\\formula{{{name} = {formula}}}\n"));
    }
    text.push_str("\\par}\n");
    text
}

/// The letter of a function's output in the equations.
fn letter(function: &Function, output: &Output) -> String {
    match function.name {
        FunctionName::MassMatrix => "D".to_owned(),
        FunctionName::CoriolisMatrix => "C".to_owned(),
        FunctionName::GravityVector => "G".to_owned(),
        FunctionName::ContactJacobian => r"W^{\mathsf T}".to_owned(),
        FunctionName::CentroidalMomentumMatrix => "A".to_owned(),
        _ => format!(r"\mathrm{{{}}}", escape(output.name)),
    }
}

/// One output: as a matrix if that fits the page, else entry by entry.
fn section(function: &Function, output: &Output, texts: &[Vec<String>]) -> String {
    let letter = letter(function, output);
    let title = match function.outputs.len() {
        1 => function.full_name(),
        _ => output.name.to_owned(),
    };
    let title = title.replace('_', " ");
    let formulas: Vec<String> = texts.iter().map(|terms| terms.join(" ")).collect();
    let mut text =
        format!("\n\\subsection{{{}}}\n{}\n", escape(&capitalised(&title)), escape(&output.doc));
    match as_matrix(&letter, output, &formulas) {
        Some(matrix) => text.push_str(&format!("\\[ {letter} = {matrix} \\]\n")),
        None => text.push_str(&entry_by_entry(&letter, output, texts, &formulas)),
    }
    text
}

fn capitalised(text: &str) -> String {
    let mut characters = text.chars();
    characters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}

/// The whole array in one display, if it is a vector or a matrix that fits on a line.
fn as_matrix(letter: &str, output: &Output, formulas: &[String]) -> Option<String> {
    let columns = match output.shape[..] {
        [rows] if rows <= 20 => 1,
        [rows, columns] if rows <= 20 && (1..=10).contains(&columns) => columns,
        _ => return None,
    };
    let mut widest = vec![0; columns];
    for (index, formula) in formulas.iter().enumerate() {
        widest[index % columns] = width(formula).max(widest[index % columns]);
    }
    let total: u32 = widest.iter().map(|width| width + 20).sum();
    let rows: Vec<String> = formulas.chunks(columns).map(|row| row.join(" & ")).collect();
    (total + left_side(letter) <= LINE)
        .then(|| format!("\\begin{{bmatrix}} {} \\end{{bmatrix}}", rows.join(" \\\\ ")))
}

/// The width of a name with its indices and the sign of equality.
fn left_side(letter: &str) -> u32 {
    (width(letter) + 50).max(80)
}

fn entry_by_entry(
    letter: &str,
    output: &Output,
    texts: &[Vec<String>],
    formulas: &[String],
) -> String {
    let symmetric = is_symmetric(output);
    let index = |row: usize| indices(&output.shape, row);
    let mut text = match (symmetric, formulas.iter().any(|formula| formula == "0")) {
        (true, true) => format!("${letter}$ is symmetric; entries not listed are 0.\\par\n"),
        (true, false) => format!("${letter}$ is symmetric.\\par\n"),
        (false, true) => "Entries not listed are 0.\\par\n".to_owned(),
        (false, false) => "\\par\n".to_owned(),
    };
    text.push_str("{\\small\\raggedright\n");
    for (row, (terms, formula)) in texts.iter().zip(formulas).enumerate() {
        let indices = index(row);
        if formula == "0" || (symmetric && indices[0] > indices[1]) {
            continue;
        }
        let comma = if output.shape.iter().any(|&size| size > 9) { "," } else { "" };
        let subscript: Vec<String> = indices.iter().map(|i| (i + 1).to_string()).collect();
        let name = match letter.contains('^') {
            true => format!("{{{letter}}}_{{{}}}", subscript.join(comma)),
            false => with_subscript(letter, &subscript.join(comma)),
        };
        if width(formula) + left_side(letter) <= LINE {
            text.push_str(&format!("\\formula{{{name} = {formula}}}\n"));
        } else {
            text.push_str(&broken(&name, terms));
        }
    }
    text.push_str("\\par}\n");
    text
}

/// A formula of several lines.
pub(super) fn broken(name: &str, terms: &[String]) -> String {
    let mut lines = vec![String::new()];
    let mut used = 0;
    for term in terms {
        let wide = width(term) + 20;
        if used > 0 && used + wide + 100 > LINE {
            lines.push(String::new());
            used = 0;
        }
        used += wide;
        let line = lines.last_mut().expect("there is a line");
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(term);
    }
    let body = lines.join(" \\\\\n& ");
    format!("\\[ \\begin{{aligned}} {name} = {{}} & {body} \\end{{aligned}} \\]\n")
}

fn is_symmetric(output: &Output) -> bool {
    let [rows, columns] = output.shape[..] else { return false };
    let entry = |i: usize, j: usize| output.entries[i * columns + j];
    rows == columns && rows > 1 && (0..rows).all(|i| (0..i).all(|j| entry(i, j) == entry(j, i)))
}

/// The indices of the row-th entry of an array.
fn indices(shape: &[usize], mut row: usize) -> Vec<usize> {
    let mut indices: Vec<usize> = shape
        .iter()
        .rev()
        .map(|size| {
            let index = row % size;
            row /= size;
            index
        })
        .collect();
    indices.reverse();
    indices
}
