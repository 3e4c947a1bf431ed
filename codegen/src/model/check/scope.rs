//! Names and expressions: what is declared, and the reading of everything that refers to it.

use super::angle::{nearly_aligned, rounded_decimal};
use super::measure::{Facts, Measure, NodeFault, approximate, near_pi};
use crate::expr::text::nearest;
use crate::expr::text::{self, ParseCause};
use crate::expr::{Dag, ExprId, SymbolClass, free_symbols};
use crate::model::entry::Scalar;
use crate::model::fault::Cause;
use crate::model::report::Report;
use crate::model::unit::Dimension;
use crate::number::{DecimalError, Rational, parse_decimal};
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// All expressions of a file together are read up to this length in bytes; TUlip needs 400.
const MAX_TEXT_BYTES: usize = 1 << 20;

/// The graph with the declared names.
pub(crate) struct Scope {
    pub(crate) dag: Dag,
    facts: Facts,
    declared: FxHashMap<String, ExprId>,
    /// Every name that the file declares, now or later.
    names: BTreeSet<String>,
    section: &'static str,
    text_bytes: usize,
}

impl Scope {
    /// A scope in which nothing is declared yet; `names` are those that the file will declare.
    /// `section` is the key of the file under which a known quantity is declared.
    pub(crate) fn new(names: BTreeSet<String>, section: &'static str) -> Self {
        Self {
            dag: Dag::new(),
            facts: Facts::default(),
            declared: FxHashMap::default(),
            names,
            section,
            text_bytes: 0,
        }
    }

    /// Declares a symbol that expressions may use from here on.
    pub(crate) fn declare(
        &mut self,
        name: &str,
        class: SymbolClass,
        dimension: Option<Dimension>,
        value: Option<ExprId>,
    ) -> ExprId {
        let symbol = self.dag.symbol(name, class);
        self.facts.declare(symbol, dimension, value);
        self.declared.insert(name.to_owned(), symbol);
        self.facts.update(&mut self.dag);
        symbol
    }

    /// Lets expressions use a name that was refused, so that one fault does not become many.
    pub(crate) fn tolerate(&mut self, name: &str) {
        let one = self.dag.one();
        self.declared.insert(name.to_owned(), one);
    }

    /// Whether expressions may use the name.
    pub(crate) fn is_declared(&self, name: &str) -> bool {
        self.declared.contains_key(name)
    }

    /// Makes a symbol that no expression of the file can name.
    pub(crate) fn generate(&mut self, name: &str, class: SymbolClass) -> ExprId {
        self.dag.symbol(name, class)
    }

    /// Reads an expression; 0 stands in for one that is at fault.
    pub(crate) fn expression(&mut self, scalar: &Scalar, report: &mut Report) -> ExprId {
        self.read(scalar, false, report).unwrap_or(self.dag.zero())
    }

    /// Reads an expression; none if it is at fault.
    pub(crate) fn try_expression(
        &mut self,
        scalar: &Scalar,
        report: &mut Report,
    ) -> Option<ExprId> {
        self.read(scalar, false, report)
    }

    /// Reads an entry of a row, which is the constant part of a joint.
    pub(crate) fn row_entry(&mut self, scalar: &Scalar, report: &mut Report) -> ExprId {
        self.read(scalar, true, report).unwrap_or(self.dag.zero())
    }

    /// Reads an expression that must have a value, of the given dimension if one is given, and
    /// returns the value, free of symbols.
    pub(crate) fn value(
        &mut self,
        scalar: &Scalar,
        expected: Option<(&str, Dimension)>,
        report: &mut Report,
    ) -> Option<ExprId> {
        let expr = self.read(scalar, false, report)?;
        if let Some((what, dimension)) = expected {
            self.expect(expr, what, dimension, scalar.at, report);
        }
        let value = self.facts.value(expr);
        if value.is_none() {
            self.note_missing_value(scalar, expr, report);
        }
        value
    }

    /// Reads an expression without symbols.
    pub(crate) fn number(&mut self, scalar: &Scalar, report: &mut Report) -> Option<ExprId> {
        let expr = self.read(scalar, false, report)?;
        if !self.has_symbols(expr) {
            return Some(expr);
        }
        self.refuse_symbols(scalar, expr, report);
        None
    }

    /// Checks that an expression has the dimension that its place asks for.
    pub(crate) fn expect(
        &mut self,
        expr: ExprId,
        what: &str,
        expected: Dimension,
        at: usize,
        report: &mut Report,
    ) {
        self.facts.update(&mut self.dag);
        if let Measure::Quantity(found) = self.facts.measure(expr)
            && found != expected
        {
            let what = what.to_owned();
            report.push(at, Cause::WrongDimension { what, expected, found });
        }
    }

    /// The value of an expression as the file gives it: exact, but for pi.
    pub(crate) fn approximate(&mut self, expr: ExprId) -> Option<Rational> {
        self.facts.update(&mut self.dag);
        approximate(&self.dag, self.facts.value(expr)?)
    }

    /// The fault of an angle that is almost a multiple of a quarter turn.
    pub(crate) fn rounded_angle(&mut self, scalar: &Scalar, angle: ExprId) -> Option<Cause> {
        self.facts.update(&mut self.dag);
        let by_value = || {
            let value = self.dag.as_constant(self.facts.value(angle)?)?;
            nearly_aligned(&scalar.text, value, &near_pi())
        };
        rounded_decimal(&scalar.text, &near_pi()).or_else(by_value)
    }

    /// Whether an expression depends on a symbol.
    pub(crate) fn has_symbols(&self, expr: ExprId) -> bool {
        !self.dag.classes(expr).is_empty()
    }

    /// Notes that an expression depends on a symbol where it may not.
    pub(crate) fn refuse_symbols(&self, scalar: &Scalar, expr: ExprId, report: &mut Report) {
        let symbols = if report.wants_hints() { free_symbols(&self.dag, &[expr]) } else { vec![] };
        let name = symbols.first().map(|&symbol| self.dag.symbols()[symbol].name.clone());
        let text = scalar.text.clone().into_owned();
        report.push(scalar.at, Cause::SymbolInValue(text, name.unwrap_or_default()));
    }

    /// Notes the symbol without value that leaves an expression without one. Where no symbol
    /// does, the fault (a division by 0, a huge number) was noted with its node.
    fn note_missing_value(&mut self, scalar: &Scalar, expr: ExprId, report: &mut Report) {
        // a file with very many faults is not worth the search for every name
        let symbols = if report.wants_hints() { free_symbols(&self.dag, &[expr]) } else { vec![] };
        for symbol in symbols {
            let symbol_expr = self.dag.symbol_expr(symbol);
            if self.facts.value(symbol_expr).is_none() {
                let name = self.dag.symbols()[symbol].name.clone();
                let text = scalar.text.clone().into_owned();
                return report.push(scalar.at, Cause::ValueNotKnown(text, name));
            }
        }
        if report.is_empty() || !report.wants_hints() {
            let text = scalar.text.clone().into_owned();
            report.push(scalar.at, Cause::ValueNotKnown(text, String::new()));
        }
    }

    fn read(&mut self, scalar: &Scalar, in_row: bool, report: &mut Report) -> Option<ExprId> {
        match parse_decimal(scalar.text.trim()) {
            Ok(number) => {
                let constant = self.dag.constant(number);
                self.note_node_faults(scalar, report);
                return Some(constant);
            }
            Err(DecimalError::TooLong) => {
                report.push(scalar.at, Cause::HugeNumber);
                return None;
            }
            Err(DecimalError::Malformed) => {}
        }
        self.text_bytes += scalar.text.len();
        if self.text_bytes > MAX_TEXT_BYTES {
            if self.text_bytes - scalar.text.len() <= MAX_TEXT_BYTES {
                report.push(scalar.at, Cause::TooMuchText(MAX_TEXT_BYTES));
            }
            return None;
        }
        let declared = &self.declared;
        let parsed =
            text::parse(&mut self.dag, &scalar.text, &mut |_, name| declared.get(name).copied());
        let expr = match parsed {
            Ok(expr) => expr,
            Err(error) => {
                let text = scalar.text.clone().into_owned();
                let cause = match error.cause {
                    ParseCause::UnknownName(name) => self.unknown_name(text, name, in_row, report),
                    ParseCause::Number(DecimalError::TooLong) => Cause::HugeNumber,
                    _ => Cause::Expression(text, error),
                };
                report.push(scalar.at, cause);
                self.facts.update(&mut self.dag);
                return None;
            }
        };
        self.note_node_faults(scalar, report);
        Some(expr)
    }

    fn note_node_faults(&mut self, scalar: &Scalar, report: &mut Report) {
        for fault in self.facts.update(&mut self.dag) {
            let text = scalar.text.clone().into_owned();
            let cause = match fault {
                NodeFault::MixedSum(left, right) => Cause::MixedSum(text, left, right),
                NodeFault::FunctionOfQuantity(found) => Cause::FunctionOfQuantity(text, found),
                NodeFault::DivisionByZero => Cause::DivisionByZero(text),
                NodeFault::NotReal => Cause::NotReal(text),
                NodeFault::HugeValue => Cause::HugeNumber,
            };
            report.push(scalar.at, cause);
        }
    }

    fn unknown_name(&self, text: String, name: String, in_row: bool, report: &Report) -> Cause {
        if ["nan", "inf", "infinity"].contains(&name.to_lowercase().as_str()) {
            return Cause::NotFinite(text);
        }
        if self.names.contains(&name) {
            return Cause::ValueNotKnown(text, name);
        }
        if in_row && is_joint_variable(&name) {
            return Cause::VariableInRow(name);
        }
        let names = self.names.iter().map(String::as_str);
        let nearest = if report.wants_hints() { nearest(&name, names) } else { None };
        let nearest = nearest.map(str::to_owned);
        Cause::UnknownSymbol { text, nearest, name, section: self.section }
    }
}

/// Whether a name is one that people give to joint variables: `q1`, `q_knee`, `theta2`, `d3`.
fn is_joint_variable(name: &str) -> bool {
    let is_index = |rest: &str| rest.bytes().all(|byte| byte.is_ascii_digit());
    ["q_", "qd_", "qdd_"].into_iter().any(|prefix| name.starts_with(prefix))
        || ["q", "th", "theta", "d"]
            .into_iter()
            .any(|word| name.strip_prefix(word).is_some_and(is_index))
}
