//! Equations of motion for people.

use super::{PLAIN_NODES, text_of};
use crate::{Align, Table};
use denavit_codegen::derive::{EquationPart, MotionEquations};
use denavit_codegen::expr::text::{print, print_with_intermediates};
use denavit_codegen::expr::{ExprId, Operations};
use denavit_codegen::model::Robot;
use std::fmt::{self, Write};

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

/// The equations of motion of a robot and its added effects: in full where that can be read, else
/// a summary.
pub fn equations_text(robot: &Robot, equations: &MotionEquations) -> String {
    text_of(|out| {
        write_equations(out, &mut equations.clone())?;
        write_effects(out, robot)
    })
}

fn write_equations(out: &mut dyn Write, equations: &mut MotionEquations) -> fmt::Result {
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

/// The laws of added effects, which are part of the joints' own torques.
fn write_effects(out: &mut dyn Write, robot: &Robot) -> fmt::Result {
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

/// D, C, G and the drives' torque; tau is what they add up to. `entries` are those of the terms;
/// longer ones than `threshold` nodes are written with intermediates.
fn write_in_full(
    out: &mut dyn Write,
    equations: &MotionEquations,
    entries: &[ExprId],
    threshold: u64,
) -> fmt::Result {
    let terms: Vec<&EquationPart> = equations.written().collect();
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
fn left_side(part: &EquationPart, texts: &[&String], index: usize) -> Option<String> {
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

fn write_summary(out: &mut dyn Write, equations: &MotionEquations) -> fmt::Result {
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
        row.push(
            part.time.map_or(String::new(), |time| format!("{:.1} ms", 1e3 * time.as_secs_f64())),
        );
        table.push(row);
    }
    writeln!(out, "\n{table}")?;
    if let Some(total) = equations.time {
        writeln!(out, "derived in {:.1} ms", 1e3 * total.as_secs_f64())?;
    }
    writeln!(out, "too large to be read here: LaTeX sets them, JSON has every entry")
}
