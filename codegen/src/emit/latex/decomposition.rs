//! zeta = R0 theta0 with R0_ij = f^T b_ij as a complete LaTeX document: theta0, f and B, and theta
//! where B was eliminated.

use super::document::{LINE, TEMPLATE, abbreviations, broken};
use super::expression::{Extent, width, write_expressions};
use super::nomenclature;
use super::notation::{Notation, escape, with_subscript};
use crate::emit::layout::{TemplateError, fill};
use crate::expr::{Dag, ExprId};
use crate::fundamental::{Basis, Decomposition};
use crate::model::Robot;
use crate::model::equations::Equations;
use crate::regressor::equations::EquationsRegressor;
use crate::regressor::{Decomposed, DecomposedSubject, RobotDecomposition, Theta};
use std::fmt;

/// A matrix of at most so many rows and columns is set as one.
const MATRIX: [usize; 2] = [30, 12];

/// Only what is longer than a line is named.
const EXTENT: Extent = Extent { shared: u32::MAX, longest: LINE - 100 };

/// More functions and entries than this are not set: a hundred of them fill a page.
const MOST_FORMULAS: usize = 20_000;

/// A document would be too long to be read, or set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TooLongToSet {
    name: String,
    formulas: usize,
}

impl fmt::Display for TooLongToSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}: {} formulas are too many for a document\n  hint: leave out terms \
             (`robot.terms=inertia,gravity`), or take JSON",
            self.name, self.formulas
        )
    }
}

impl std::error::Error for TooLongToSet {}

/// f and B of whatever was decomposed, and theta if B was eliminated.
pub fn decomposition_document(found: &Decomposed) -> Result<String, TooLongToSet> {
    let Decomposed { subject, decomposition, theta } = found;
    let formulas = decomposition.functions.len() + decomposition.nonzeros();
    if formulas > MOST_FORMULAS {
        return Err(TooLongToSet { name: found.name().to_owned(), formulas });
    }
    let document = match subject {
        DecomposedSubject::Model(robot, found) => {
            robot_decomposition(robot, found, decomposition, theta.as_ref())
        }
        DecomposedSubject::Equations(equations, found) => {
            equations_decomposition(equations, found, theta.as_ref())
        }
    };
    Ok(document.expect("our template has a place for each value"))
}

/// A robot's f and B, in one of the bases of `found`.
pub fn robot_decomposition(
    robot: &Robot,
    found: &RobotDecomposition,
    decomposition: &Decomposition,
    theta: Option<&Theta>,
) -> Result<String, TemplateError> {
    let mut found = found.clone();
    let parameters = found.parameters();
    let mut notation = Notation::of_robot(&found.dag, robot);
    notation.name_columns(&found.dag, robot, &parameters);
    let contents = Contents {
        dag: &found.dag,
        notation: &notation,
        equations: &found.equations,
        left: &found.left,
        parameters: &parameters,
        decomposition,
        theta,
    };
    let description =
        nomenclature::description(&robot.description, &robot.source, &robot.assumptions);
    let table = nomenclature::nomenclature(robot, &found.dag, &notation);
    let hash = format!("{:016x}", robot.hash);
    contents.document(&robot.name, &hash, &description, &table)
}

/// f and B of given equations.
pub fn equations_decomposition(
    equations: &Equations,
    found: &EquationsRegressor,
    theta: Option<&Theta>,
) -> Result<String, TemplateError> {
    let notation = Notation::of_equations(&found.dag);
    let contents = Contents {
        dag: &found.dag,
        notation: &notation,
        equations: &[],
        left: &found.left,
        parameters: &found.parameters,
        decomposition: &found.decomposition,
        theta,
    };
    let description = nomenclature::description(
        &equations.description,
        &equations.source,
        &equations.assumptions,
    );
    let table = nomenclature::names(equations, &notation);
    contents.document(&equations.name, "of equations", &description, &table)
}

struct Contents<'a> {
    dag: &'a Dag,
    notation: &'a Notation,
    /// What each equation balances, where that has a name.
    equations: &'a [String],
    left: &'a [ExprId],
    parameters: &'a [ExprId],
    decomposition: &'a Decomposition,
    theta: Option<&'a Theta>,
}

/// The texts of formulas, each as its terms.
type Formulas<'a> = &'a [Vec<String>];

impl Contents<'_> {
    fn document(
        &self,
        name: &str,
        hash: &str,
        description: &str,
        table: &str,
    ) -> Result<String, TemplateError> {
        let mut dag = self.dag.clone();
        let found = self.decomposition;
        let mut outputs = self.left.to_vec();
        outputs.extend(self.parameters);
        outputs.extend(found.functions.iter().map(|function| function.to_expr(&mut dag)));
        outputs.extend(found.coefficients.iter().map(|value| value.to_expr(&mut dag)));
        outputs.extend(self.theta.iter().flat_map(|theta| &theta.parameters));
        let written = write_expressions(&dag, &outputs, self.notation, EXTENT);
        let mut rest = written.outputs.as_slice();
        let mut next = |count: usize| {
            let (first, others) = rest.split_at(count);
            rest = others;
            first
        };
        let left = next(self.left.len());
        let parameters = next(self.parameters.len());
        let functions = next(found.functions.len());
        let coefficients = next(found.coefficients.len());
        let theta = next(self.theta.map_or(0, Theta::rank));
        let sections = [
            abbreviations(&written),
            self.left_side(left),
            section("Parameters", "", &list(r"\vartheta", parameters)),
            section("Fundamental functions", "", &list("f", functions)),
            self.matrix(coefficients),
            self.base(theta),
        ];
        fill(
            TEMPLATE,
            &[
                ("heading", "Fundamental functions"),
                ("name", name),
                ("version", env!("CARGO_PKG_VERSION")),
                ("hash", hash),
                ("title", &escape(name)),
                ("description", description),
                ("nomenclature", table),
                ("law", &self.law()),
                ("sections", &sections.concat()),
            ],
        )
    }

    fn law(&self) -> String {
        let found = self.decomposition;
        let (rows, columns) = found.shape();
        let basis = match found.basis {
            Basis::Fourier => "cosines and sines of combinations of the angles",
            Basis::Product => "products of powers of single cosines and sines",
            Basis::Cumulated => {
                "products of powers of the cosines and sines of angles that are cumulated along \
                 parallel axes"
            }
        };
        format!(
            "\\section{{Decomposition}}\n\\[ \\zeta = R_0\\,\\vartheta, \\qquad (R_0)_{{ij}} = \
             f^{{\\mathsf T}} b_{{ij}} \\]\n$\\vartheta$ are the {columns} parameters, the \
             $\\theta_0$ of the thesis. $f$ are {} functions of the motion, made of {basis}. $B$ \
             has the columns $b_{{ij}}$ of equation $i$ below those of the equation before: it is \
             ${rows} \\times {columns}$ with {} entries.",
            found.functions.len(),
            found.nonzeros()
        )
    }

    /// zeta, with the names of the equations.
    fn left_side(&self, left: Formulas<'_>) -> String {
        let mut text = String::new();
        for (row, terms) in left.iter().enumerate() {
            if let Some(name) = self.equations.get(row) {
                text.push_str(&format!("Equation {}: {}\\par\n", row + 1, escape(name)));
            }
            text.push_str(&formula(&numbered(r"\zeta", row), terms));
        }
        section("Left side", "", &text)
    }

    fn matrix(&self, coefficients: Formulas<'_>) -> String {
        let found = self.decomposition;
        let texts: Vec<String> = coefficients.iter().map(|terms| terms.join(" ")).collect();
        let blocks: Option<Vec<String>> =
            (0..found.equations).map(|equation| self.block(equation, &texts)).collect();
        let says = "Row $k$ of $B_i$ belongs to $f_k$ in equation $i$, column $j$ to \
                    $\\vartheta_j$; entries not shown are 0.";
        if let Some(blocks) = blocks {
            return section("Matrix $B$", says, &blocks.concat());
        }
        let says = "$b^{(i)}_{k,j}$ is the coefficient of $f_k\\,\\vartheta_j$ in equation $i$; \
                    entries not listed are 0.";
        let mut text = String::new();
        for (column, entries) in found.columns.iter().enumerate() {
            if entries.is_empty() {
                continue;
            }
            text.push_str(&format!("${}$:\\par\n", numbered(r"\vartheta", column)));
            for entry in entries {
                let indices = format!("{},{}", entry.function + 1, column + 1);
                let name = with_subscript(&format!("b^{{({})}}", entry.equation + 1), &indices);
                text.push_str(&formula(&name, &coefficients[entry.coefficient as usize]));
            }
            text.push_str("\\par\n");
        }
        section("Matrix $B$", says, &text)
    }

    /// The rows of B of one equation as a matrix, if that fits the page.
    fn block(&self, equation: usize, coefficients: &[String]) -> Option<String> {
        let found = self.decomposition;
        let [rows, columns] = [found.functions.len(), found.columns.len()];
        let mut entries = vec![r"\cdot".to_owned(); rows * columns];
        for (column, own) in found.columns.iter().enumerate() {
            for entry in own.iter().filter(|entry| entry.equation as usize == equation) {
                entries[entry.function as usize * columns + column] =
                    coefficients[entry.coefficient as usize].clone();
            }
        }
        matrix(&format!("B_{{{}}}", equation + 1), &entries, columns)
    }

    /// theta and B_Eu.
    fn base(&self, formulas: Formulas<'_>) -> String {
        let Some(theta) = self.theta else { return String::new() };
        let mut dag = self.dag.clone();
        let columns = theta.columns.len();
        let mut factors = vec![r"\cdot".to_owned(); theta.rank() * columns];
        for parameter in 0..theta.rank() {
            for (column, factor) in theta.members(&mut dag, parameter) {
                let written = write_expressions(&dag, &[factor], self.notation, Extent::FULL);
                factors[parameter * columns + column] = written.outputs[0].join(" ");
            }
        }
        let says = format!(
            "$B$ has the rank {}. Gauss-Jordan elimination leaves the rows $B_{{Eu}}$, and \
             $\\theta = B_{{Eu}}\\,\\vartheta$.",
            theta.rank()
        );
        let mut text = matrix("B_{Eu}", &factors, columns).unwrap_or_default();
        text.push_str(&list(r"\theta", formulas));
        section("Base parameters", &says, &text)
    }
}

fn section(title: &str, says: &str, text: &str) -> String {
    format!(
        "\n\\subsection{{{title}}}\n{says}\\par\n{{\\small\\raggedright\n{text}\\par}}\n",
        title = title
    )
}

fn numbered(letter: &str, index: usize) -> String {
    with_subscript(letter, &(index + 1).to_string())
}

/// `letter_1 = .., letter_2 = ..`.
fn list(letter: &str, formulas: Formulas<'_>) -> String {
    let rows = formulas.iter().enumerate();
    rows.map(|(row, terms)| formula(&numbered(letter, row), terms)).collect()
}

fn formula(name: &str, terms: &[String]) -> String {
    let text = terms.join(" ");
    match width(&text) + 100 <= LINE {
        true => format!("\\formula{{{name} = {text}}}\n"),
        false => broken(name, terms),
    }
}

/// A display of a matrix, if it fits the page.
fn matrix(name: &str, entries: &[String], columns: usize) -> Option<String> {
    let rows: Vec<&[String]> = entries.chunks(columns.max(1)).collect();
    let widest =
        (0..columns).map(|column| rows.iter().map(|row| width(&row[column])).max().unwrap_or(0));
    let total: u32 = widest.map(|width| width + 20).sum();
    if rows.len() > MATRIX[0] || columns > MATRIX[1] || total + 120 > LINE {
        return None;
    }
    let lines: Vec<String> = rows.iter().map(|row| row.join(" & ")).collect();
    let body = lines.join(" \\\\\n");
    Some(format!("\\[ {name} = \\begin{{bmatrix}}\n{body}\n\\end{{bmatrix}} \\]\n"))
}
