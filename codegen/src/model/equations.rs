//! Equations as text: `denavit-equations/1`.
//!
//! For systems that are given by their equations and not by a table (thesis, appendix B): names of
//! variables, knowns and unknowns, and equations `left = right` in them.
//! docs/reference/equations.md describes the format; faults are reported as those of models are.

use super::check::Scope;
use super::entry::{Name, Scalar};
use super::fault::{Cause, ModelError};
use super::file::{Declaration, read_declarations};
use super::json;
use super::parameter::{Parameter, Role};
use super::reader::{Fields, Node, read_document};
use super::report::Report;
use super::spelling::{is_identifier, reserved_by};
use super::unit::Unit;
use crate::expr::{Dag, ExprId, SymbolClass};
use std::borrow::Cow;
use std::collections::BTreeSet;

/// The tag of a file of equations.
pub const FORMAT: &str = "denavit-equations/1";

/// The JSON Schema (draft 2020-12) of a file of equations: its form, not its content.
pub fn schema() -> &'static str {
    include_str!("equations-schema.json")
}

/// One equation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Equation {
    /// As it is written.
    pub text: String,
    /// The left side.
    pub left: ExprId,
    /// The right side.
    pub right: ExprId,
}

/// Checked equations.
#[derive(Clone, Debug)]
pub struct Equations {
    /// The name, an identifier.
    pub name: String,
    /// What they describe.
    pub description: String,
    /// Where they come from.
    pub source: String,
    /// What was assumed.
    pub assumptions: Vec<String>,
    /// Holds all symbols and expressions.
    pub dag: Dag,
    /// What changes in time: positions, rates, accelerations, torques, in file order.
    pub variables: Vec<Parameter>,
    /// Constants that are known, in file order.
    pub knowns: Vec<Parameter>,
    /// Constants that are not, in file order.
    pub unknowns: Vec<Parameter>,
    /// The equations, in file order.
    pub equations: Vec<Equation>,
}

const KEYS: &[&str] = &[
    "format",
    "name",
    "description",
    "source",
    "assumptions",
    "variables",
    "knowns",
    "unknowns",
    "equations",
];

/// Reads a file of equations from its bytes. `file` is its name, for messages alone.
pub fn read(file: &str, source: &[u8]) -> Result<Equations, ModelError> {
    read_document(file, source, |root, report| {
        let fields = root.fields(KEYS, report)?;
        Some(read_fields(&fields, report))
    })
}

/// Whether a text is JSON that says it is a file of equations, so that a command can tell the two
/// kinds of file apart.
pub fn is_equations_file(source: &[u8]) -> bool {
    let Ok(root) = json::parse(source) else { return false };
    let mut unheard: Report = Report::default();
    let format = Node(&root)
        .fields(KEYS, &mut unheard)
        .and_then(|fields| fields.text("format", &mut unheard));
    format.is_some_and(|tag| tag.starts_with("denavit-equations/"))
}

fn read_fields(fields: &Fields<'_>, report: &mut Report) -> Equations {
    fields.format(FORMAT, report);
    let name = fields.required_name("name", report);
    let variables = read_declarations(fields, "variables", &["unit", "doc"], report);
    let knowns = read_declarations(fields, "knowns", &["value", "unit", "doc"], report);
    let unknowns = read_declarations(fields, "unknowns", &["value", "std", "unit", "doc"], report);
    let texts = fields.required_items("equations", report, Node::scalar);
    if !name.text.is_empty() && !is_identifier(&name.text) {
        report.push(name.at, Cause::NotIdentifier(name.text.clone().into_owned()));
    }
    let declared = [&variables, &knowns, &unknowns];
    let names: BTreeSet<String> =
        declared.into_iter().flatten().map(|one| one.name.text.clone().into_owned()).collect();
    let mut reading = Reading { scope: Scope::new(names, "knowns"), report };
    for variable in &variables {
        if let Some(value) = &variable.value {
            let (expected, found) = ("an object", "a number or an expression");
            reading.report.push(value.at, Cause::WrongKind { expected, found });
        }
    }
    let positions: BTreeSet<&str> = variables.iter().map(|one| &*one.name.text).collect();
    let variables = reading.declare(&variables, Role::Constant, |name| motion(name, &positions));
    let knowns = reading.declare(&knowns, Role::Constant, |_| SymbolClass::Geometry);
    let unknowns = reading.declare(&unknowns, Role::Unknown, |_| SymbolClass::Inertia);
    if texts.is_empty() {
        let at = fields.place("equations");
        reading.report.push(at, Cause::NoEquations);
    }
    let equations = texts.iter().filter_map(|text| reading.equation(text)).collect();
    Equations {
        name: name.text.into_owned(),
        description: fields.text_or_empty("description", reading.report),
        source: fields.text_or_empty("source", reading.report),
        assumptions: fields.texts("assumptions", reading.report),
        dag: reading.scope.dag,
        variables,
        knowns,
        unknowns,
        equations,
    }
}

/// Whether a variable is a position, or by its name the rate `xd` or acceleration `xdd` of a
/// variable x. It decides how they are set, in order and as letters.
fn motion(name: &str, variables: &BTreeSet<&str>) -> SymbolClass {
    let is_of = |ending: &str| name.strip_suffix(ending).is_some_and(|x| variables.contains(x));
    match (is_of("dd"), is_of("d")) {
        (true, _) => SymbolClass::Acceleration,
        (_, true) => SymbolClass::Rate,
        _ => SymbolClass::Configuration,
    }
}

struct Reading<'r> {
    scope: Scope,
    report: &'r mut Report,
}

impl Reading<'_> {
    fn declare(
        &mut self,
        declarations: &[Declaration],
        role: Role,
        class_of: impl Fn(&str) -> SymbolClass,
    ) -> Vec<Parameter> {
        let mut parameters = Vec::new();
        for declaration in declarations {
            let class = class_of(&declaration.name.text);
            parameters.extend(self.declare_one(declaration, role, class));
        }
        parameters
    }

    fn declare_one(
        &mut self,
        declaration: &Declaration,
        role: Role,
        class: SymbolClass,
    ) -> Option<Parameter> {
        let unit = declaration.unit.as_ref().and_then(|unit| self.unit(unit));
        let dimension = unit.as_ref().map(Unit::dimension);
        let expected = dimension.map(|dimension| ("the value", dimension));
        let value = declaration.value.as_ref();
        let default = value.and_then(|value| self.scope.value(value, expected, self.report));
        let std = declaration.std.as_ref();
        let std = std.and_then(|std| self.scope.number(std, self.report));
        let name = &declaration.name;
        let text = name.text.clone().into_owned();
        let fault = if !is_identifier(&text) {
            Some(Cause::NotIdentifier(text.clone()))
        } else if let Some(by) = reserved_by(&text) {
            Some(Cause::ReservedName(text.clone(), by))
        } else {
            let taken = self.scope.is_declared(&text);
            taken.then(|| Cause::DuplicateName(text.clone(), "another symbol"))
        };
        if let Some(cause) = fault {
            self.report.push(name.at, cause);
            if !self.scope.is_declared(&text) {
                self.scope.tolerate(&text);
            }
            return None;
        }
        // A value at fault was noted; what depends on it is not at fault, too.
        let stand_in = value.map(|_| self.scope.dag.one());
        let symbol = self.scope.declare(&text, class, dimension, default.or(stand_in));
        Some(Parameter {
            name: text,
            symbol,
            role,
            known: role == Role::Constant,
            default,
            std,
            unit,
            doc: declaration.doc.clone(),
        })
    }

    fn unit(&mut self, unit: &Name) -> Option<Unit> {
        let parsed = Unit::parse(&unit.text);
        if let Err(error) = &parsed {
            let text = unit.text.clone().into_owned();
            self.report.push(unit.at, Cause::Unit(text, error.clone()));
        }
        parsed.ok()
    }

    fn equation(&mut self, scalar: &Scalar) -> Option<Equation> {
        let Some((left, right)) = split(&scalar.text) else {
            let text = scalar.text.clone().into_owned();
            self.report.push(scalar.at, Cause::NotAnEquation(text));
            return None;
        };
        let mut side = |text: &str| {
            let side = Scalar { text: Cow::Owned(text.to_owned()), at: scalar.at };
            self.scope.try_expression(&side, self.report)
        };
        let (left, right) = (side(left), side(right));
        let text = scalar.text.clone().into_owned();
        Some(Equation { text, left: left?, right: right? })
    }
}

/// The sides of the only = that is no part of ==, <= or >=.
fn split(text: &str) -> Option<(&str, &str)> {
    let bytes = text.as_bytes();
    let is_sign = |at: usize| {
        let before = at.checked_sub(1).map(|before| bytes[before]);
        let after = bytes.get(at + 1);
        bytes[at] == b'='
            && !matches!(before, Some(b'=' | b'<' | b'>'))
            && !matches!(after, Some(b'='))
    };
    let mut signs = (0..bytes.len()).filter(|&at| is_sign(at));
    let at = signs.next()?;
    signs.next().is_none().then(|| (text[..at].trim(), text[at + 1..].trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_equation_has_one_sign_between_two_sides() {
        assert_eq!(split("a = b"), Some(("a", "b")));
        assert_eq!(split("select(a == b, 1, 2) = c"), Some(("select(a == b, 1, 2)", "c")));
        assert_eq!(split("x = select(a <= b, 1, 2)"), Some(("x", "select(a <= b, 1, 2)")));
        assert_eq!([split("a"), split("a = b = c"), split("a == b")], [None, None, None]);
    }
}
