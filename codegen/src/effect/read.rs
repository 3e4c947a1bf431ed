//! From the text of a file to an [`Effect`].

use super::law::{LawFile, LawReader};
use super::linear::{depends, linear};
use super::spelling::JointUnit;
use super::{
    Confusion, Effect, EffectKind, EffectParameter, EffectSite, EffectState, FORMAT, Law, Measured,
    Occurrence, Property, SHIPPED, Transmission, beyond,
};
use crate::expr::text::nearest;
use crate::expr::{Dag, ExprId, SymbolClass, substitute};
use crate::model::check::Scope;
use crate::model::entry::{Name, Scalar};
use crate::model::file::SPRING_SIDES;
use crate::model::json::Value;
use crate::model::reader::{Fields, Node, Word, read_document};
use crate::model::spelling::{is_identifier, reserved_by};
use crate::model::{Cause, Dimension, JointKind, ModelError, Report};
use crate::number::{Rational, decimal_text};
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

const KEYS: &[&str] = &[
    "format",
    "name",
    "title",
    "description",
    "source",
    "kind",
    "at",
    "occurrence",
    "side",
    "parameters",
    "states",
    "torque",
    "torque_2",
    "measured",
    "moves",
    "term",
    "refines",
    "confused_with",
];

const KINDS: Word<'_, EffectKind> = Word {
    what: "kind of effect",
    known: &["torque", "state", "measurement", "parameter", "term", "mode"],
    values: &EffectKind::ALL,
};

const SITES: Word<'_, EffectSite> = Word {
    what: "place",
    known: &["joint", "spring", "joint_pair", "link", "contact", "model"],
    values: &[
        EffectSite::Joint,
        EffectSite::Spring,
        EffectSite::JointPair,
        EffectSite::Link,
        EffectSite::Contact,
        EffectSite::Model,
    ],
};

const OCCURRENCES: Word<'_, Occurrence> = Word {
    what: "occurrence",
    known: &["standard", "common", "uncommon", "rare"],
    values: &Occurrence::ALL,
};

/// Reads a file of an effect from its bytes. `file` is its name, for messages alone. Names of
/// `confused_with` are checked where all effects are known.
pub fn read(file: &str, source: &[u8]) -> Result<Effect, ModelError> {
    read_document(file, source, |root, report| {
        let effect = read_root(root, JointKind::Revolute, report);
        if report.is_empty() {
            // units of a joint that turns are not those of one that slides: laws must fit both
            read_root(root, JointKind::Prismatic, report);
        }
        effect
    })
}

fn read_root(root: Node<'_>, joint: JointKind, report: &mut Report) -> Option<Effect> {
    let fields = root.fields(KEYS, report)?;
    fields.format(FORMAT, report);
    let name = fields.required_name("name", report);
    if !name.text.is_empty() && !is_identifier(&name.text) {
        report.push(name.at, Cause::NotIdentifier(name.text.clone().into_owned()));
    }
    let kind = fields.required_word("kind", &KINDS, report);
    let at = fields.required_word("at", &SITES, report);
    let occurrence = fields.word("occurrence", &OCCURRENCES, report).unwrap_or_default();
    let side = fields.word("side", &SPRING_SIDES, report).unwrap_or_default();
    let names = ["parameters", "states"].iter().filter_map(|key| fields.get(key));
    let names: BTreeSet<String> =
        names.flat_map(|node| node.0.entries()).map(|(name, _)| name.to_string()).collect();
    let scope = Scope::new(names, "parameters");
    let mut reading = Reading { law: LawReader::new(scope, joint, at), report };
    let mut parameters = reading.parameters(&fields);
    let states = reading.states(&fields);
    let law = LawFile::read(&fields, kind, reading.report);
    let law = law.and_then(|law| reading.law.law(&law, reading.report));
    let torque_2 = reading.law.on_second(&fields, kind, at, reading.report);
    let refines = reading.refines(&fields);
    let confused_with = reading.confused_with(&fields);
    let texts = ["title", "description", "source"]
        .map(|key| fields.required_name(key, reading.report).text.into_owned());
    let mut dag = reading.law.scope.dag;
    let law = law?;
    let mut exprs = law.expressions();
    exprs.extend(torque_2);
    note_linear(&mut dag, &mut parameters, &states, &law, &exprs);
    if !vanishes(&mut dag, &parameters, &law, &exprs) {
        report.push(fields.at(), Cause::NeverVanishes);
    }
    let [title, description, source] = texts;
    let name = name.text.into_owned();
    Some(Effect {
        name,
        title,
        description,
        source,
        kind,
        at,
        occurrence,
        side,
        parameters,
        states,
        law,
        torque_2,
        refines,
        confused_with,
        dag,
    })
}

fn note_linear(
    dag: &mut Dag,
    parameters: &mut [EffectParameter],
    states: &[EffectState],
    law: &Law,
    exprs: &[ExprId],
) {
    let symbols: Vec<ExprId> = parameters.iter().map(|parameter| parameter.symbol).collect();
    // a state, and what is late, answer to their parameters in a way that no expression says
    let mut hidden: Vec<ExprId> =
        states.iter().flat_map(|state| [state.rate, state.initial]).collect();
    // torques bend where a joint stands elsewhere, however that place depends on parameters
    if let Law::Moves(moves) = law {
        let zeros = moves.iter().filter(|(property, _)| *property == Property::Zero);
        hidden.extend(zeros.map(|(_, by)| *by));
    }
    if let Law::Measured(Measured { transmission, delay_s, lag_s, .. }) = law {
        hidden.extend([*delay_s, *lag_s]);
        let of =
            |one: &Transmission| [one.swing_s, one.damping, one.play, one.drag, one.joint_friction];
        hidden.extend(transmission.iter().flat_map(of));
    }
    let is_linear = linear(dag, exprs, &symbols);
    for (parameter, is_linear) in parameters.iter_mut().zip(is_linear) {
        parameter.linear = is_linear && !depends(dag, &hidden, parameter.symbol);
    }
}

/// Whether nothing is left of the law where the parameters have their nominal values.
fn vanishes(dag: &mut Dag, parameters: &[EffectParameter], law: &Law, exprs: &[ExprId]) -> bool {
    let mut nominal: FxHashMap<ExprId, ExprId> = FxHashMap::default();
    for parameter in parameters {
        if let Some(value) = &parameter.nominal {
            nominal.insert(parameter.symbol, dag.constant(value.clone()));
        }
    }
    let left = substitute(dag, exprs, &nominal);
    let nothing = match law {
        Law::Measured(measured) => {
            let symbol = dag.find_symbol(measured.channel.as_str());
            let value = symbol.map(|symbol| dag.symbol_expr(symbol));
            // no delay, no lag, no swing and no play; what shapes nothing is nothing
            std::iter::once(value).chain([Some(dag.zero()); 4]).collect()
        }
        _ => vec![Some(dag.zero()); left.len()],
    };
    left.iter().zip(nothing).all(|(&left, nothing)| Some(left) == nothing)
}

struct Reading<'r> {
    law: LawReader,
    report: &'r mut Report,
}

impl Reading<'_> {
    fn parameters(&mut self, fields: &Fields<'_>) -> Vec<EffectParameter> {
        const KEYS: &[&str] = &["unit", "description", "nominal", "bounds", "start"];
        let declared = fields.members("parameters", self.report, |key, node, report| {
            Some((Name::of_key(key, node), node.fields(KEYS, report)?))
        });
        declared.iter().filter_map(|(name, fields)| self.parameter(name, fields)).collect()
    }

    fn parameter(&mut self, name: &Name, fields: &Fields<'_>) -> Option<EffectParameter> {
        let unit = self.unit(fields);
        let description = fields.required_name("description", self.report).text.into_owned();
        let nominal = fields.scalar("nominal", self.report);
        let nominal = nominal.and_then(|nominal| self.rational(&nominal));
        let bounds = self.bounds(fields);
        let starts = fields
            .items("start", self.report, |node, report| Some((node.scalar(report)?, node.at())));
        let mut start = Vec::new();
        for (scalar, at) in starts {
            start.extend(self.rational(&scalar).inspect(|value| self.inside(value, &bounds, at)));
        }
        if let (Some(value), Some(node)) = (&nominal, fields.get("nominal")) {
            self.inside(value, &bounds, node.at());
        }
        if nominal.is_none() && start.is_empty() {
            self.report.push(fields.at(), Cause::MissingKey("start"));
        }
        let Some(unit) = unit else {
            // what depends on it is not at fault, too
            self.law.scope.tolerate(&name.text);
            return None;
        };
        let symbol = self.declare(name, SymbolClass::Drive, &unit)?;
        let name = name.text.clone().into_owned();
        let linear = false;
        Some(EffectParameter { name, symbol, unit, description, nominal, bounds, start, linear })
    }

    fn inside(&mut self, value: &Rational, bounds: &[Option<Rational>; 2], at: usize) {
        if let Some(beyond) = beyond(value, bounds) {
            self.report.push(at, Cause::OutOfBounds(None, decimal_text(value), beyond));
        }
    }

    /// Both ends; `null` is no end.
    fn bounds(&mut self, fields: &Fields<'_>) -> [Option<Rational>; 2] {
        let Some(node) = fields.require("bounds", self.report) else { return [None, None] };
        let Some(ends) = node.array::<2, _>(self.report) else { return [None, None] };
        let bounds = ends.map(|end| {
            if matches!(end.0.value, Value::Null) {
                return None;
            }
            let scalar = end.scalar(self.report)?;
            self.rational(&scalar)
        });
        if let [Some(low), Some(high)] = &bounds
            && low > high
        {
            let cause = Cause::ReversedRange(low.to_string(), high.to_string());
            self.report.push(node.at(), cause);
            return [None, None];
        }
        bounds
    }

    fn states(&mut self, fields: &Fields<'_>) -> Vec<EffectState> {
        let declared = fields.members("states", self.report, |key, node, report| {
            Some((Name::of_key(key, node), node.fields(&["unit", "rate", "initial"], report)?))
        });
        let mut states = Vec::new();
        // rates may name every state: all are declared before one is read
        for (name, fields) in declared {
            let Some(unit) = self.unit(&fields) else {
                self.law.scope.tolerate(&name.text);
                continue;
            };
            let symbol = self.declare(&name, SymbolClass::State, &unit);
            states.extend(symbol.map(|symbol| (name.text.into_owned(), unit, symbol, fields)));
        }
        let seconds = Dimension::NONE.per(Dimension::RATE).unwrap_or(Dimension::NONE);
        states
            .into_iter()
            .map(|(name, unit, symbol, fields)| {
                let dimension = unit.of(self.law.joint).dimension();
                let per_second = dimension.per(seconds).unwrap_or(Dimension::NONE);
                let rate = fields.require("rate", self.report);
                let rate = rate.and_then(|node| node.scalar(self.report));
                let rate = self.law.quantity(rate, "the derivative", per_second, self.report);
                let initial = fields.scalar("initial", self.report);
                let initial =
                    self.law.quantity(initial, "the initial value", dimension, self.report);
                EffectState { name, symbol, unit, rate, initial }
            })
            .collect()
    }

    fn unit(&mut self, fields: &Fields<'_>) -> Option<JointUnit> {
        let node = fields.require("unit", self.report)?;
        let unit = node.text(self.report)?;
        let parsed = JointUnit::parse(unit);
        if let Err(error) = &parsed {
            self.report.push(node.at(), Cause::Unit(unit.to_owned(), error.clone()));
        }
        parsed.ok()
    }

    fn declare(&mut self, name: &Name, class: SymbolClass, unit: &JointUnit) -> Option<ExprId> {
        let text = name.text.clone().into_owned();
        let scope = &mut self.law.scope;
        let fault = if !is_identifier(&text) {
            Some(Cause::NotIdentifier(text.clone()))
        } else if let Some(by) = reserved_by(&text) {
            Some(Cause::ReservedName(text.clone(), by))
        } else {
            let taken = scope.is_declared(&text) || super::VARIABLES.contains(&&*text);
            taken.then(|| Cause::DuplicateName(text.clone(), "another quantity"))
        };
        if let Some(cause) = fault {
            self.report.push(name.at, cause);
            if !scope.is_declared(&text) {
                scope.tolerate(&text);
            }
            return None;
        }
        let dimension = unit.of(self.law.joint).dimension();
        Some(scope.declare(&text, class, Some(dimension), None))
    }

    fn rational(&mut self, scalar: &Scalar) -> Option<Rational> {
        let number = self.law.scope.number(scalar, self.report)?;
        let value = self.law.scope.dag.as_constant(number).cloned();
        if value.is_none() {
            let text = scalar.text.clone().into_owned();
            self.report.push(scalar.at, Cause::NotRational(text));
        }
        value
    }

    fn refines(&mut self, fields: &Fields<'_>) -> Vec<String> {
        fields.items("refines", self.report, |node, report| {
            let name = node.text(report)?;
            let known = || SHIPPED.iter().map(|(known, _)| *known);
            if !known().any(|known| known == name) {
                let hint = nearest(name, known()).map(str::to_owned);
                report.push(node.at(), Cause::UnknownEffect(name.to_owned(), hint));
            }
            Some(name.to_owned())
        })
    }

    fn confused_with(&mut self, fields: &Fields<'_>) -> Vec<Confusion> {
        let own = fields.text("name", &mut Report::<Cause>::default());
        fields.members("confused_with", self.report, |name, node, report| {
            if own == Some(name) {
                report.push(node.at(), Cause::DuplicateName(name.to_owned(), "this effect"));
            }
            let reason = node.scalar(report)?.text.into_owned();
            Some(Confusion { effect: name.to_owned(), reason })
        })
    }
}
