//! Base parameters as a LaTeX document.

use super::expression::write_expression;
use super::nomenclature;
use super::notation::{Notation, base_and_words, escape, with_subscript, word};
use crate::emit::layout::{TemplateError, fill};
use crate::expr::ExprId;
use crate::model::Robot;
use crate::number::Residue;
use crate::regressor::{BaseParameters, Part, signed};

const TEMPLATE: &str = include_str!("../../../templates/latex/base_parameters.tex.in");

/// What the parameters of links are here: about the origin, whatever the model's file says.
const PARAMETERS: &str = "Link $j$ has the mass $m_j$ [kg], the first moment $(m_{x,j}, m_{y,j}, \
    m_{z,j})$ [kg\\,m], which is its mass times its centre of mass, and the inertia tensor with \
    the entries $I_{xx,j}$, $I_{yy,j}$, $I_{zz,j}$, $I_{xy,j}$, $I_{xz,j}$, $I_{yz,j}$ \
    [kg\\,m$^2$], all about the origin of the link frame. Joint $j$ has viscous and Coulomb \
    friction $f_{v,j}$, $f_{c,j}$, the rotor inertia $I_{a,j}$ and the offset torque \
    $\\mathrm{off}_j$, where they are asked for.\n";

/// How the formulas of base parameters are written: `m_{x,2}` is the first moment of the link of
/// joint 2 along x.
pub fn base_notation(robot: &Robot, base: &BaseParameters) -> Notation {
    let dag = &base.regressor.dag;
    let mut notation = Notation::of_robot(dag, robot);
    for (index, column) in base.regressor.columns.iter().enumerate() {
        let Some((link, prefix)) = column.owner else { continue };
        let number = robot.joints().position(|(other, _)| other == link);
        let owner = match number {
            Some(row) => (row + 1).to_string(),
            None => word(&robot.links[link].name),
        };
        let (letter, words) = base_and_words(prefix);
        let subscript = if words.is_empty() { owner } else { format!("{words},{owner}") };
        notation.set(dag, base.symbol(index), with_subscript(&letter, &subscript));
    }
    notation
}

/// A sum of parameters: a line may end between any two of them.
pub fn base_sum(base: &BaseParameters, parts: &[Part], notation: &Notation) -> String {
    let dag = &base.regressor.dag;
    let name = |column: usize| write_expression(dag, base.symbol(column), notation);
    let terms = parts.iter().flat_map(|part| {
        let members = part.members.iter().map(|&(column, is_negative)| (is_negative, name(column)));
        let Some((factor, _)) = part.factor else {
            let own = part.is_negative;
            return members.map(|(sign, name)| (sign != own, name)).collect::<Vec<_>>();
        };
        let mut factor = write_expression(dag, factor, notation);
        if part.is_sum {
            factor = format!("\\left({factor}\\right)");
        }
        let sum = match part.members.len() {
            1 => signed(members),
            _ => format!("({})", signed(members)),
        };
        vec![(part.is_negative, format!("{factor}\\,{sum}"))]
    });
    signed(terms)
}

/// The base parameters of `robot` as a document. `values` are those of the base parameters, in
/// their order, as text; empty if the model has none.
pub fn base_document(
    robot: &Robot,
    base: &BaseParameters,
    values: &[String],
) -> Result<String, TemplateError> {
    let notation = base_notation(robot, base);
    let formula = |expr: ExprId| write_expression(&base.regressor.dag, expr, &notation);
    let mut sections = String::new();
    let names = |columns: Vec<usize>| -> String {
        let texts = columns.into_iter().map(|column| format!("${}$", formula(base.symbol(column))));
        texts.collect::<Vec<_>>().join(", ")
    };
    for (title, columns, text) in [
        ("Parameters that can be identified alone", base.alone(), ""),
        ("Parameters without any effect", base.zero(), "Their columns are 0.\\par\n"),
    ] {
        if !columns.is_empty() {
            sections.push_str(&format!(
                "\n\\section{{{title}}}\n{text}{{\\raggedright {}\\par}}\n",
                names(columns)
            ));
        }
    }
    let mut dependent = base.dependent.iter().filter(|one| !one.relation.is_empty()).peekable();
    if dependent.peek().is_some() {
        sections.push_str(
            "\n\\section{Columns that depend on others}\nEach parameter stands for its column of \
             $R_0$.\n\\begin{longtable}{r@{${}={}$}F{130mm}}\n",
        );
        for one in dependent {
            let left = formula(base.symbol(one.column));
            let right = base_sum(base, &one.parts, &notation);
            sections.push_str(&format!("${left}$ & ${right}$ \\\\\n"));
        }
        sections.push_str("\\end{longtable}\n");
    }
    let table = nomenclature::known_symbols(robot, &base.regressor.dag, &notation);
    let (rank, columns) = (base.rank(), base.regressor.columns.len());
    let law = format!(
        "\\[ \\tau = R_0\\,\\theta_0 = R\\,\\pi, \\qquad R_0 \\text{{ with {columns} columns, }} \
         R \\text{{ with the {rank} columns kept}} \\]\n\
         Exact for every value of the symbols but those that make a denominator 0. The rank is \
         that of $R_0$ modulo ${}$ at random points; the relations are identities.",
        Residue::MODULUS
    );
    fill(
        TEMPLATE,
        &[
            ("name", &robot.name),
            ("version", env!("CARGO_PKG_VERSION")),
            ("hash", &format!("{:016x}", robot.hash)),
            ("title", &escape(&robot.name)),
            (
                "description",
                &nomenclature::description(&robot.description, &robot.source, &robot.assumptions),
            ),
            ("nomenclature", &format!("{table}{PARAMETERS}")),
            ("law", &law),
            ("parameters", &parameters(base, &notation, values)),
            ("sections", &sections),
        ],
    )
}

/// The table of base parameters.
fn parameters(base: &BaseParameters, notation: &Notation, values: &[String]) -> String {
    let (columns, width, heads) = match values.is_empty() {
        true => ("rlF{", 112, "$k$ & kept & $\\pi_k$ & unit"),
        false => ("rlF{", 90, "$k$ & kept & $\\pi_k$ & unit & value"),
    };
    let last = if values.is_empty() { "l" } else { "lr" };
    let mut text = format!("\\begin{{longtable}}{{{columns}{width}mm}}{last}}}\n{heads} \\\\\n");
    text.push_str("\\hline\n\\endhead\n");
    for (row, parameter) in base.parameters.iter().enumerate() {
        let kept = write_expression(&base.regressor.dag, base.symbol(parameter.column), notation);
        let sum = base_sum(base, &parameter.parts, notation);
        let unit = &base.regressor.columns[parameter.column].unit;
        let unit = escape(unit).replace(' ', "\\,");
        text.push_str(&format!("{} & ${kept}$ & ${sum}$ & {unit}", row + 1));
        if let Some(value) = values.get(row) {
            let value = value.split_once('e').map_or_else(
                || value.clone(),
                |(digits, exponent)| format!("{digits}\\cdot 10^{{{exponent}}}"),
            );
            text.push_str(&format!(" & ${value}$"));
        }
        text.push_str(" \\\\\n");
    }
    text.push_str("\\end{longtable}\n");
    text
}
