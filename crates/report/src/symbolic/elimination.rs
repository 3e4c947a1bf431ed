//! theta = B_E theta0 as text and JSON.

use crate::{Align, Ordered, Table};
use denavit_codegen::emit::latex::{Notation, write_expression};
use denavit_codegen::expr::text::print;
use denavit_codegen::expr::{Dag, ExprId};
use denavit_codegen::regressor::Theta;
use serde::Serialize;
use std::fmt::{self, Write};

/// A column of R0 by the text of its parameter.
pub(super) struct Named {
    pub(super) name: String,
    unit: String,
}

/// The columns of theta0, with their units.
pub(super) fn columns(dag: &Dag, parameters: &[ExprId], units: Vec<String>) -> Vec<Named> {
    let names = parameters.iter().map(|&parameter| print(dag, parameter));
    names.zip(units).map(|(name, unit)| Named { name, unit }).collect()
}

/// What elimination leaves, in the keys of `denavit base`.
#[derive(Debug, Serialize)]
pub(super) struct Elimination {
    rank: usize,
    zero: Vec<String>,
    dependent: Vec<Dependent>,
    parameters: Vec<Parameter>,
}

#[derive(Debug, Serialize)]
struct Dependent {
    name: String,
    relation: String,
}

#[derive(Debug, Serialize)]
struct Parameter {
    name: String,
    expression: String,
    latex: String,
    unit: String,
    members: Ordered<String>,
    alone: bool,
}

impl Elimination {
    /// Of columns in the order of `theta`.
    pub(super) fn new(dag: &mut Dag, theta: &Theta, columns: &[Named]) -> Self {
        let (mut zero, mut dependent, mut parameters) = (Vec::new(), Vec::new(), Vec::new());
        for column in theta.dependent() {
            let name = columns[column].name.clone();
            let relation = theta.relation(dag, column);
            match relation == dag.zero() {
                true => zero.push(name),
                false => dependent.push(Dependent { name, relation: print(dag, relation) }),
            }
        }
        let notation = Notation::of_equations(dag);
        for (row, &expression) in theta.parameters.iter().enumerate() {
            let pivot = &columns[theta.echelon.pivots[row]];
            let members: Vec<(String, String)> = theta
                .members(dag, row)
                .into_iter()
                .map(|(member, factor)| (columns[member].name.clone(), print(dag, factor)))
                .collect();
            parameters.push(Parameter {
                name: pivot.name.clone(),
                expression: print(dag, expression),
                latex: write_expression(dag, expression, &notation),
                unit: pivot.unit.clone(),
                alone: members.len() == 1,
                members: Ordered(members),
            });
        }
        Self { rank: theta.rank(), zero, dependent, parameters }
    }

    pub(super) fn rank(&self) -> usize {
        self.rank
    }

    /// As tables and lists in Markdown.
    pub(super) fn markdown(&self) -> String {
        let mut text = String::from("| | kept | unit | base parameter |\n|---:|---|---|---|\n");
        for (row, Parameter { name, expression, unit, .. }) in self.parameters.iter().enumerate() {
            text.push_str(&format!("| {} | `{name}` | {unit} | `{expression}` |\n", row + 1));
        }
        if !self.zero.is_empty() {
            let names = self.zero.join("`, `");
            text.push_str(&format!("\n## Without any effect\n\n`{names}`\n"));
        }
        if !self.dependent.is_empty() {
            text.push_str("\n## Columns that are sums of kept columns\n\n");
        }
        for Dependent { name, relation } in &self.dependent {
            text.push_str(&format!("- `{name} = {relation}`\n"));
        }
        text
    }

    /// For people.
    pub(super) fn write(&self, out: &mut dyn Write) -> fmt::Result {
        let mut table = Table::new(&[
            ("kept", Align::Left),
            ("unit", Align::Left),
            ("base parameter", Align::Left),
        ]);
        for Parameter { name, expression, unit, .. } in &self.parameters {
            table.push(vec![name.clone(), unit.clone(), expression.clone()]);
        }
        write!(out, "{table}")?;
        if !self.zero.is_empty() {
            writeln!(out, "\nwithout any effect: {}", self.zero.join(", "))?;
        }
        if !self.dependent.is_empty() {
            writeln!(out, "\ncolumns that are sums of kept columns:")?;
        }
        for Dependent { name, relation } in &self.dependent {
            writeln!(out, "  {name} = {relation}")?;
        }
        Ok(())
    }
}
