//! What the symbols of a document stand for.

use super::expression::write_expression;
use super::notation::{Notation, escape};
use super::term::decimal_text;
use crate::expr::Dag;
use crate::model::equations::Equations;
use crate::model::{About, JointKind, Parameter, Robot, Role};

/// What holds between the arrays of the document.
pub(super) const LAW: &str = r"\section{Equations of motion}
\[ D(q)\,\ddot q + C(q, \dot q)\,\dot q + G(q) = \tau \]
The torques $\tau$ are those of rigid-body motion with the rotors; what springs, friction and
offsets of the joints take is added to them. $C$ is made of Christoffel symbols: $\dot D - 2 C$ is
skew.";

/// What a model or a system of equations is, where it comes from, and what it assumes.
pub(super) fn description(description: &str, source: &str, assumptions: &[String]) -> String {
    let mut text = String::new();
    for (label, value) in [("", description), ("Source: ", source)] {
        if !value.is_empty() {
            text.push_str(&format!("{label}{}\n\n", escape(value)));
        }
    }
    if !assumptions.is_empty() {
        text.push_str("Assumptions:\n\\begin{itemize}\n");
        for assumption in assumptions {
            text.push_str(&format!("  \\item {}\n", escape(assumption)));
        }
        text.push_str("\\end{itemize}\n");
    }
    text
}

/// The tables of joints and parameters.
pub(super) fn nomenclature(robot: &Robot, dag: &Dag, notation: &Notation) -> String {
    [joints(robot), angles(robot, notation), bodies(robot), parameters(robot, dag, notation)]
        .into_iter()
        .filter(|part| !part.is_empty())
        .collect::<Vec<String>>()
        .join("\n")
}

/// The tables of joints and of the parameters that the file declares, for a document whose bodies
/// are explained otherwise.
pub(super) fn known_symbols(robot: &Robot, dag: &Dag, notation: &Notation) -> String {
    format!("{}{}", joints(robot), parameters(robot, dag, notation))
}

fn joints(robot: &Robot) -> String {
    let mut text = "Joint $j$ has the position $q_j$ [rad, m], the velocity $\\dot{q}_j$, the \
                    acceleration $\\ddot{q}_j$ and the torque or force $\\tau_j$ [N\\,m, \
                    N]:\n\\begin{longtable}{rlll}\n$j$ & link & joint & carried by \\\\\n\\hline\n"
        .to_owned();
    for (row, (id, _)) in robot.joints().enumerate() {
        let link = &robot.links[id];
        let kind = match link.joint.kind {
            JointKind::Revolute => "revolute",
            JointKind::Prismatic => "prismatic",
            JointKind::Fixed => "fixed",
        };
        let parent = match link.parent {
            Some(parent) => robot.links[parent].name.as_str(),
            None => "frame 0",
        };
        let (name, parent) = (escape(&link.name), escape(parent));
        text.push_str(&format!("{} & {name} & {kind} & {parent} \\\\\n", row + 1));
    }
    text.push_str("\\end{longtable}\n");
    text
}

fn angles(robot: &Robot, notation: &Notation) -> String {
    let joints = robot.degrees_of_freedom();
    if !notation.abbreviates() || joints < 2 {
        return String::new();
    }
    let sum = if joints > 9 { "1,2" } else { "12" };
    format!(
        "Sines and cosines of joint angles: $s_1 = \\sin q_1$, $c_1 = \\cos q_1$, \
         $s_{{{sum}}} = \\sin(q_1 + q_2)$, and so on.\n"
    )
}

/// The scheme of the parameters that belong to links.
fn bodies(robot: &Robot) -> String {
    let is_named = |role: &Role| matches!(role, Role::Body(..));
    if !robot.parameters.values().any(|parameter| is_named(&parameter.role)) {
        return String::new();
    }
    let about = |wanted: About| {
        robot.links.values().any(|link| link.body.is_some_and(|body| body.about == wanted))
    };
    let point = match (about(About::Com), about(About::Origin)) {
        (true, false) => "its centre of mass",
        (false, true) => "the origin of its frame",
        _ => "the point that the model names",
    };
    format!(
        "Link $j$, the one that joint $j$ moves, has the mass $m_j$ [kg], the centre of mass \
         $(r_{{x,j}}, r_{{y,j}}, r_{{z,j}})$ [m] in the link frame, and the inertia tensor with \
         the entries $I_{{xx,j}}$, $I_{{yy,j}}$, $I_{{zz,j}}$, $I_{{xy,j}}$, $I_{{xz,j}}$, \
         $I_{{yz,j}}$ [kg\\,m$^2$] about {point}, unless the table below says otherwise.\n"
    )
}

/// The parameters that the file declares by name.
fn parameters(robot: &Robot, dag: &Dag, notation: &Notation) -> String {
    let declared: Vec<_> = robot
        .parameters
        .values()
        .filter(|parameter| {
            matches!(parameter.role, Role::Constant | Role::Unknown | Role::Effect(_))
        })
        .collect();
    table(&declared, dag, notation)
}

/// The names of a system of equations.
pub(super) fn names(equations: &Equations, notation: &Notation) -> String {
    let dag = &equations.dag;
    let mut text = String::new();
    for (title, list) in [
        ("Variables", &equations.variables),
        ("Known constants", &equations.knowns),
        ("Unknown constants", &equations.unknowns),
    ] {
        let list: Vec<&Parameter> = list.iter().collect();
        if !list.is_empty() {
            text.push_str(&format!("{title}:\n{}", table(&list, dag, notation)));
        }
    }
    text
}

fn table(declared: &[&Parameter], dag: &Dag, notation: &Notation) -> String {
    if declared.is_empty() {
        return String::new();
    }
    let mut text = "\\begin{longtable}{lrlp{90mm}}\nsymbol & value & unit & meaning \\\\\n\
                    \\hline\n"
        .to_owned();
    for parameter in declared {
        let symbol = write_expression(dag, parameter.symbol, notation);
        let value = match parameter.default {
            Some(value) => {
                let number = dag.as_constant(value).and_then(decimal_text);
                let text = number.unwrap_or_else(|| write_expression(dag, value, notation));
                format!("${text}$")
            }
            None => String::new(),
        };
        let unit = parameter
            .unit
            .as_ref()
            .map_or_else(String::new, |unit| escape(unit.text()).replace(' ', "\\,"));
        let doc = escape(&parameter.doc);
        text.push_str(&format!("${symbol}$ & {value} & {unit} & {doc} \\\\\n"));
    }
    text.push_str("\\end{longtable}\n");
    text
}
