//! What was decomposed, and how it is shown.

use super::super::elimination::{Elimination, columns};
use super::super::failure::Failure;
use denavit::emit::latex::{equations_decomposition, robot_decomposition};
use denavit::expr::text::print_with_intermediates;
use denavit::expr::{Dag, ExprId};
use denavit::fundamental::{Basis, Decomposition, Expansion, smallest};
use denavit::model::Robot;
use denavit::model::equations::Equations;
use denavit::regressor::equations::{EquationsRegressor, equations_regressor};
use denavit::regressor::{RegressorOptions, RobotDecomposition, Theta, decompose_robot};
use denavit::report::{Align, Table};
use denavit::workflow::EffectUse;
use serde::Serialize;
use std::io::Write;

/// More functions than this are not read by people: they get the sizes alone.
const READABLE_FUNCTIONS: usize = 60;

/// More functions and entries than this are not set: a hundred of them fill a page.
const MOST_FORMULAS: usize = 20_000;

/// A left side of more nodes is written with intermediates.
const PLAIN_NODES: u64 = 200;

/// f and B.
pub(in crate::cli) struct Found {
    subject: Subject,
    decomposition: Decomposition,
    theta: Option<Theta>,
}

enum Subject {
    Model(Box<Robot>, Box<RobotDecomposition>),
    Equations(Box<Equations>, Box<EquationsRegressor>),
}

impl Found {
    /// Of a model; in the basis that makes the fewest functions if none is named.
    pub(in crate::cli) fn of_model(
        robot: Box<Robot>,
        options: RegressorOptions,
        basis: Option<Basis>,
        expansion: &mut Expansion<'_>,
    ) -> Result<Self, Failure> {
        let bases = basis.map_or(Basis::ALL.to_vec(), |basis| vec![basis]);
        let mut found =
            decompose_robot(&robot, options, &bases, expansion).map_err(Failure::Decompose)?;
        let decomposition = smallest(std::mem::take(&mut found.decompositions))
            .ok_or_else(|| Failure::NoParallelAxes(robot.name.clone()))?;
        let subject = Subject::Model(robot, Box::new(found));
        Ok(Self { subject, decomposition, theta: None })
    }

    /// Of equations, likewise.
    pub(in crate::cli) fn of_equations(
        equations: Box<Equations>,
        basis: Option<Basis>,
        expansion: &mut Expansion<'_>,
    ) -> Result<Self, Failure> {
        let bases = match basis {
            Some(Basis::Cumulated) => {
                return Err(Failure::NoParallelAxes(equations.name.clone()));
            }
            Some(basis) => vec![basis],
            None => vec![Basis::Fourier, Basis::Product],
        };
        let mut least: Option<EquationsRegressor> = None;
        for basis in bases {
            let found =
                equations_regressor(&equations, basis, expansion).map_err(Failure::Equations)?;
            let functions = found.decomposition.functions.len();
            if least.as_ref().is_none_or(|known| functions < known.decomposition.functions.len()) {
                least = Some(found);
            }
        }
        let found = least.expect("there is a basis");
        let decomposition = found.decomposition.clone();
        let subject = Subject::Equations(equations, Box::new(found));
        Ok(Self { subject, decomposition, theta: None })
    }

    /// Eliminates B, the columns of `keep` being kept before others.
    pub(in crate::cli) fn eliminate(&mut self, keep: &[String]) -> Result<(), Failure> {
        self.theta = Some(match &mut self.subject {
            Subject::Model(_, found) => {
                found.theta(&self.decomposition, keep).map_err(Failure::Decompose)?
            }
            Subject::Equations(_, found) => found.theta(keep).map_err(Failure::Equations)?,
        });
        Ok(())
    }

    /// A LaTeX document.
    pub(in crate::cli) fn latex(&self) -> Result<String, Failure> {
        let formulas = self.decomposition.functions.len() + self.decomposition.nonzeros();
        if formulas > MOST_FORMULAS {
            return Err(Failure::TooLongToSet { name: self.name().to_owned(), formulas });
        }
        let document = match &self.subject {
            Subject::Model(robot, found) => {
                robot_decomposition(robot, found, &self.decomposition, self.theta.as_ref())
            }
            Subject::Equations(equations, found) => {
                equations_decomposition(equations, found, self.theta.as_ref())
            }
        };
        Ok(document.expect("our template has a place for each value"))
    }

    /// f and B.
    pub(in crate::cli) fn decomposition(&self) -> &Decomposition {
        &self.decomposition
    }

    /// The rank of B, once it is eliminated.
    pub(in crate::cli) fn rank(&self) -> Option<usize> {
        self.theta.as_ref().map(Theta::rank)
    }

    fn name(&self) -> &str {
        match &self.subject {
            Subject::Model(robot, _) => &robot.name,
            Subject::Equations(equations, _) => &equations.name,
        }
    }

    /// Everything as text.
    pub(in crate::cli) fn texts(self, effects: Vec<EffectUse>) -> Texts {
        let name = self.name().to_owned();
        let Self { subject, decomposition, theta } = self;
        let (mut dag, equations, columns, left) = match subject {
            Subject::Model(_, mut found) => {
                let parameters = found.parameters();
                let units = found.columns.iter().map(|column| column.unit.clone()).collect();
                let columns = columns(&found.dag, &parameters, units);
                (found.dag, found.equations, columns, found.left)
            }
            Subject::Equations(given, found) => {
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
        let intermediates = left.bindings.into_iter();
        Texts {
            effects,
            model: name,
            basis: decomposition.basis.as_str(),
            equations,
            left: left.outputs,
            intermediates: intermediates
                .map(|(name, expression)| Intermediate { name, expression })
                .collect(),
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

/// f and B as texts.
#[derive(Serialize)]
pub(in crate::cli) struct Texts {
    /// What becomes of the model's effects.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    effects: Vec<EffectUse>,
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

#[derive(Serialize)]
struct Intermediate {
    name: String,
    expression: String,
}

/// An entry of B, by equation, function and column, from 0.
#[derive(Serialize)]
struct Entry {
    equation: usize,
    function: usize,
    column: usize,
    value: String,
}

impl Texts {
    /// For people: in full if it can be read.
    pub(in crate::cli) fn write(&self, out: &mut dyn Write) -> Result<(), Failure> {
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
            writeln!(
                out,
                "too many to be read here: --json lists f and B, --latex FILE sets them"
            )?;
        } else {
            self.write_in_full(out)?;
        }
        if let Some(echelon) = &self.echelon {
            writeln!(out, "\nGauss-Jordan on B: rank {}\n", echelon.rank())?;
            echelon.write(out)?;
        }
        Ok(())
    }

    fn write_in_full(&self, out: &mut dyn Write) -> Result<(), Failure> {
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
        Ok(write!(out, "\n{table}")?)
    }
}
