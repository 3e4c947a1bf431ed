//! f and B as texts.

use super::elimination::{Elimination, columns};
use super::{Intermediate, PLAIN_NODES, intermediates, text_of};
use crate::{Align, Table};
use denavit_codegen::expr::text::print_with_intermediates;
use denavit_codegen::expr::{Dag, ExprId};
use denavit_codegen::regressor::equations::EquationsRegressor;
use denavit_codegen::regressor::{Decomposed, DecomposedSubject};
use serde::Serialize;
use std::fmt::{self, Display, Write};

/// More functions than this are not read by people: they get the sizes alone.
const READABLE_FUNCTIONS: usize = 60;

/// f and B as texts, with what becomes of each of the model's effects; serialised, they are the
/// JSON document.
#[derive(Debug, Serialize)]
pub struct DecompositionTexts<E> {
    /// What becomes of the model's effects.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    effects: Vec<E>,
    model: String,
    basis: &'static str,
    /// Names of joints, or the equations themselves.
    equations: Vec<String>,
    /// zeta.
    left: Vec<String>,
    /// What is named in the left sides.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    intermediates: Vec<Intermediate>,
    columns: Vec<String>,
    functions: Vec<String>,
    rows: usize,
    nonzeros: usize,
    entries: Vec<Entry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    echelon: Option<Elimination>,
}

/// An entry of B, by equation, function and column, from 0.
#[derive(Debug, Serialize)]
struct Entry {
    equation: usize,
    function: usize,
    column: usize,
    value: String,
}

impl<E> DecompositionTexts<E> {
    /// Everything as text.
    pub fn new(found: Decomposed, effects: Vec<E>) -> Self {
        let name = found.name().to_owned();
        let Decomposed { subject, decomposition, theta } = found;
        let (mut dag, equations, columns, left) = match subject {
            DecomposedSubject::Model(_, mut found) => {
                let parameters = found.parameters();
                let units = found.columns.iter().map(|column| column.unit.clone()).collect();
                let columns = columns(&found.dag, &parameters, units);
                (found.dag, found.equations, columns, found.left)
            }
            DecomposedSubject::Equations(given, found) => {
                let EquationsRegressor { dag, parameters, units, left, .. } = *found;
                let texts = given.equations.iter().map(|one| one.text.clone()).collect();
                let columns = columns(&dag, &parameters, units);
                (dag, texts, columns, left)
            }
        };
        let echelon = theta.map(|theta| Elimination::new(&mut dag, &theta, &columns));
        let functions: Vec<ExprId> =
            decomposition.functions.iter().map(|function| function.to_expr(&mut dag)).collect();
        let coefficients: Vec<ExprId> =
            decomposition.coefficients.iter().map(|value| value.to_expr(&mut dag)).collect();
        let coefficients = plain(&dag, &coefficients);
        let mut entries = Vec::new();
        for (column, of_column) in decomposition.columns.iter().enumerate() {
            entries.extend(of_column.iter().map(|entry| Entry {
                equation: entry.equation as usize,
                function: entry.function as usize,
                column,
                value: coefficients[entry.coefficient as usize].clone(),
            }));
        }
        let left = print_with_intermediates(&dag, &left, PLAIN_NODES);
        Self {
            effects,
            model: name,
            basis: decomposition.basis.as_str(),
            equations,
            left: left.outputs,
            intermediates: intermediates(left.bindings),
            columns: columns.into_iter().map(|column| column.name).collect(),
            rows: decomposition.shape().0,
            nonzeros: decomposition.nonzeros(),
            functions: plain(&dag, &functions),
            entries,
            echelon,
        }
    }
}

/// Short expressions as text.
fn plain(dag: &Dag, exprs: &[ExprId]) -> Vec<String> {
    print_with_intermediates(dag, exprs, u64::MAX).outputs
}

impl<E: Display> DecompositionTexts<E> {
    /// For people: in full if it can be read.
    pub fn text(&self) -> String {
        text_of(|out| self.write(out))
    }

    fn write(&self, out: &mut dyn Write) -> fmt::Result {
        writeln!(
            out,
            "{}: {} functions in the {} basis; B is {} x {} with {} entries",
            self.model,
            self.functions.len(),
            self.basis,
            self.rows,
            self.columns.len(),
            self.nonzeros
        )?;
        for effect in &self.effects {
            writeln!(out, "{effect}")?;
        }
        if self.functions.len() > READABLE_FUNCTIONS {
            writeln!(out, "too many to be read here: JSON lists f and B, LaTeX sets them")?;
        } else {
            self.write_in_full(out)?;
        }
        if let Some(echelon) = &self.echelon {
            writeln!(out, "\nGauss-Jordan on B: rank {}\n", echelon.rank())?;
            echelon.write(out)?;
        }
        Ok(())
    }

    fn write_in_full(&self, out: &mut dyn Write) -> fmt::Result {
        writeln!(out)?;
        for (index, side) in self.left.iter().enumerate() {
            writeln!(out, "zeta[{}] = {side}", index + 1)?;
        }
        for Intermediate { name, expression } in &self.intermediates {
            writeln!(out, "{name} = {expression}")?;
        }
        writeln!(out)?;
        for (index, function) in self.functions.iter().enumerate() {
            writeln!(out, "f[{}] = {function}", index + 1)?;
        }
        let mut table = Table::new(&[
            ("column", Align::Left),
            ("equation", Align::Right),
            ("f", Align::Right),
            ("B", Align::Left),
        ]);
        for entry in &self.entries {
            table.push(vec![
                self.columns[entry.column].clone(),
                (entry.equation + 1).to_string(),
                (entry.function + 1).to_string(),
                entry.value.clone(),
            ]);
        }
        write!(out, "\n{table}")
    }
}
