//! Base parameters as a LaTeX document.

use super::expression::write_expression;
use super::nomenclature;
use super::notation::{Notation, base_and_words, escape, with_subscript, word};
use crate::emit::layout::{TemplateError, fill};
use crate::expr::ExprId;
use crate::model::{LinkId, Robot};
use crate::number::Residue;
use crate::regressor::{BaseParameters, Dependent, JointParameter, Part, signed};

const TEMPLATE: &str = include_str!("../../../templates/latex/base_parameters.tex.in");

/// What the parameters of links are here: about the origin, whatever the model's file says.
const PARAMETERS: &str = "Link $j$ has the mass $m_j$ [kg], the first moment $(m_{x,j}, m_{y,j}, \
    m_{z,j})$ [kg\\,m], which is its mass times its centre of mass, and the inertia tensor with \
    the entries $I_{xx,j}$, $I_{yy,j}$, $I_{zz,j}$, $I_{xy,j}$, $I_{xz,j}$, $I_{yz,j}$ \
    [kg\\,m$^2$], all about the origin of the link frame. Joint $j$ has viscous and Coulomb \
    friction $f_{v,j}$, $f_{c,j}$, the rotor inertia $I_{a,j}$ and the offset torque \
    $\\mathrm{off}_j$, where they are asked for.\n";

/// What the parameters on the axes are.
const ON_AXES: &str = "On the axis of joint $j$, in the frame with that axis as $z$ that turns \
    with the joint, body $j$ keeps the first moments $s_{x,j}$, $s_{y,j}$ [kg\\,m] and the second \
    moments $K_{xx,j} = \\int x^2\\,dm$, $K_{xy,j} = \\int x y\\,dm$ and so on [kg\\,m$^2$]; where \
    it turns about one axis only, $J_{zz,j} = K_{xx,j} + K_{yy,j}$. What its carrier feels alike \
    is the carrier's; $M_j$, $s_{z,j}$, $K_{zz,j}$ are where none does.\n";

/// The section of relations among columns.
const DEPENDENT: &str = "\n\\section{Columns that depend on others}\nEach parameter stands for its \
    column of $R_0$.\n";

/// The section of the change of basis.
const OF_KEPT: &str = "\n\\section{In the base parameters of kept columns}\nOn the right each \
    parameter stands for the base parameter of its column, as they are where columns of $R_0$ are \
    kept.\n";

/// How the formulas of base parameters are written: `m_{x,2}` is the first moment of the link of
/// joint 2 along x.
pub fn base_notation(robot: &Robot, base: &BaseParameters) -> Notation {
    let dag = &base.regressor.dag;
    let mut notation = Notation::of_robot(dag, robot);
    for (index, column) in base.regressor.columns.iter().enumerate() {
        let Some((link, prefix)) = column.owner else { continue };
        let owner = owner(robot, link);
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

/// The base parameters of `robot` as a document, those on the joint axes if they are given.
/// `values` are those of the base parameters, in their order, as text; empty if the model has none.
pub fn base_document(
    robot: &Robot,
    base: &BaseParameters,
    joints: Option<&[JointParameter]>,
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
    let rows: Vec<Row> = match joints {
        Some(joints) => {
            joints.iter().map(|one| Row::on_axis(robot, base, one, &notation)).collect()
        }
        None => (0..base.rank()).map(|row| Row::kept(base, row, &notation)).collect(),
    };
    sections.push_str(&equations(base, joints, &rows, &notation));
    let on_axes = if joints.is_some() { ON_AXES } else { "" };
    let table = nomenclature::known_symbols(robot, &base.regressor.dag, &notation);
    let (rank, columns) = (base.rank(), base.regressor.columns.len());
    let of_base = match joints {
        Some(_) => format!("R \\text{{ with {rank} columns on the joint axes}}"),
        None => format!("R \\text{{ with the {rank} columns kept}}"),
    };
    let law = format!(
        "\\[ \\tau = R_0\\,\\theta_0 = R\\,\\pi, \\qquad R_0 \\text{{ with {columns} columns, }} \
         {of_base} \\]\n\
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
            ("nomenclature", &format!("{table}{PARAMETERS}{on_axes}")),
            ("law", &law),
            ("parameters", &parameters(&rows, joints.is_some(), values)),
            ("sections", &sections),
        ],
    )
}

/// The relations among columns; of parameters on the axes, the change of basis.
fn equations(
    base: &BaseParameters,
    joints: Option<&[JointParameter]>,
    rows: &[Row],
    notation: &Notation,
) -> String {
    let (heading, equations): (&str, Vec<(String, String)>) = match joints {
        None => {
            let sums = base.dependent.iter().filter(|one| !one.relation.is_empty());
            let sum = |one: &Dependent| {
                let symbol = base.symbol(one.column);
                let left = write_expression(&base.regressor.dag, symbol, notation);
                (left, base_sum(base, &one.parts, notation))
            };
            (DEPENDENT, sums.map(sum).collect())
        }
        Some(joints) => {
            let sum = |(row, one): (&Row, &JointParameter)| {
                (row.symbol.clone(), base_sum(base, &one.parts_of_kept, notation))
            };
            (OF_KEPT, rows.iter().zip(joints).map(sum).collect())
        }
    };
    if equations.is_empty() {
        return String::new();
    }
    let mut section = heading.to_owned();
    section.push_str("\\begin{longtable}{r@{${}={}$}F{130mm}}\n");
    for (left, right) in equations {
        section.push_str(&format!("${left}$ & ${right}$ \\\\\n"));
    }
    section.push_str("\\end{longtable}\n");
    section
}

/// A line of the table.
struct Row {
    symbol: String,
    sum: String,
    unit: String,
}

impl Row {
    fn kept(base: &BaseParameters, row: usize, notation: &Notation) -> Self {
        let parameter = &base.parameters[row];
        let symbol = base.symbol(parameter.column);
        Self {
            symbol: write_expression(&base.regressor.dag, symbol, notation),
            sum: base_sum(base, &parameter.parts, notation),
            unit: base.regressor.columns[parameter.column].unit.clone(),
        }
    }

    fn on_axis(
        robot: &Robot,
        base: &BaseParameters,
        parameter: &JointParameter,
        notation: &Notation,
    ) -> Self {
        let (letter, words) = base_and_words(parameter.prefix);
        let owner = owner(robot, parameter.link);
        let subscript = if words.is_empty() { owner } else { format!("{words},{owner}") };
        Self {
            symbol: with_subscript(&letter, &subscript),
            sum: base_sum(base, &parameter.parts, notation),
            unit: parameter.unit.clone(),
        }
    }
}

/// The number of a link's joint; its name, if it has none.
fn owner(robot: &Robot, link: LinkId) -> String {
    match robot.joints().position(|(other, _)| other == link) {
        Some(row) => (row + 1).to_string(),
        None => word(&robot.links[link].name),
    }
}

/// The table of base parameters.
fn parameters(rows: &[Row], is_on_axes: bool, values: &[String]) -> String {
    let head = if is_on_axes { "name" } else { "kept" };
    let (width, last, value) = match values.is_empty() {
        true => (112, "l", ""),
        false => (90, "lr", " & value"),
    };
    let heads = format!("$k$ & {head} & $\\pi_k$ & unit{value}");
    let mut text = format!("\\begin{{longtable}}{{rlF{{{width}mm}}{last}}}\n{heads} \\\\\n");
    text.push_str("\\hline\n\\endhead\n");
    for (row, Row { symbol, sum, unit }) in rows.iter().enumerate() {
        let unit = escape(unit).replace(' ', "\\,");
        text.push_str(&format!("{} & ${symbol}$ & ${sum}$ & {unit}", row + 1));
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
