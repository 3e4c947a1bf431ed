//! What stands above an emitted module: the model, the flavour, the operations of each function.

use super::context::Context;
use super::wording::{columns, wrapped};
use crate::program::{Counts, counts};

/// How a language's comments hold what a model says.
pub(super) struct Heading {
    /// Text of a model on one line, so that it ends no comment and hides nothing.
    pub(super) text: fn(&str) -> String,
    /// What holds parameters that are set at run time.
    pub(super) tunable: &'static str,
    /// When products are fused, in lines of a comment.
    pub(super) fused: &'static str,
    /// What functions beyond sine and cosine need.
    pub(super) transcendental: &'static str,
}

impl Heading {
    /// The first line of all.
    pub(super) fn title(&self, context: &Context<'_>) -> String {
        format!("Dynamics of the robot `{}`.", (self.text)(&context.robot.name))
    }

    /// Comment lines about the model and the flavour.
    pub(super) fn about(&self, context: &Context<'_>) -> String {
        let (robot, program) = (context.robot, context.program);
        let flavour = match context.has_parameters() {
            true => self.tunable,
            false => "none: the functions hold all values",
        };
        let name = (self.text)(&robot.name);
        let mut lines = format!("// model: {name}, hash {:016x}\n", robot.hash);
        lines += &format!("// parameters: {flavour}\n");
        if program.routines.iter().any(|routine| routine.code.is_fused()) {
            lines += self.fused;
        }
        let routines = program.routines.iter().map(|routine| &routine.code);
        if routines.chain([&program.prelude]).any(|code| code.is_transcendental()) {
            lines += self.transcendental;
        }
        for (label, text) in [("description", &robot.description), ("source", &robot.source)] {
            if !text.trim().is_empty() {
                lines += &wrapped("// ", &format!("{label}: {}", (self.text)(text)));
            }
        }
        for assumption in &robot.assumptions {
            lines += &wrapped("// ", &format!("assumed: {}", (self.text)(assumption)));
        }
        lines
    }
}

/// The table of operations: a line for each function, the columns that have an entry.
pub(super) fn operations_table(context: &Context<'_>) -> String {
    let program = context.program;
    let rows: Vec<(String, Counts)> = program
        .routines
        .iter()
        .map(|routine| (routine.full_name(), counts(program, routine)))
        .collect();
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0).max(8);
    let titles = columns(&Counts::default()).map(|(title, _)| title);
    let shown: Vec<usize> = (0..titles.len())
        .filter(|&column| rows.iter().any(|(_, counts)| columns(counts)[column].1 > 0))
        .collect();
    let line = |name: &str, cells: Vec<String>| {
        let cells: String = cells.iter().map(|cell| format!(" {cell:>8}")).collect();
        format!("//     {name:width$}{cells}\n")
    };
    let cells = |counts: &Counts| {
        shown.iter().map(|&column| columns(counts)[column].1.to_string()).collect()
    };
    let head = line("function", shown.iter().map(|&column| titles[column].to_owned()).collect());
    rows.iter().map(|(name, counts)| line(name, cells(counts))).fold(head, |all, row| all + &row)
}
