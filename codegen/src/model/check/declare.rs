//! Constants and unknowns: their names, values and units.

use super::Check;
use crate::expr::SymbolClass;
use crate::model::entry::Name;
use crate::model::fault::Cause;
use crate::model::file::{Declaration, ModelFile};
use crate::model::parameter::{BodyEntry, JointEntry, Parameter, Role};
use crate::model::spelling::{is_identifier, reserved_by};
use crate::model::unit::{Unit, UnitError};
use rustc_hash::FxHashSet;
use std::collections::BTreeSet;

/// Prefixes of generated symbols that belong to no parameter: joint variables and first moments.
const OTHER_PREFIXES: [&str; 7] = ["q", "qd", "qdd", "tau", "mx", "my", "mz"];

/// The names that the file declares.
pub(super) fn declared_names(file: &ModelFile) -> BTreeSet<String> {
    let declarations = file.constants.iter().chain(&file.unknowns);
    declarations.map(|declaration| declaration.name.text.clone().into_owned()).collect()
}

impl Check<'_> {
    /// Declares constants, then unknowns, each in file order.
    pub(super) fn declare(&mut self, file: &ModelFile) {
        let links: FxHashSet<&str> =
            file.links.iter().map(|link| link.name.text.as_ref()).collect();
        for declaration in &file.constants {
            self.declare_one(declaration, Role::Constant, &links);
        }
        for declaration in &file.unknowns {
            self.declare_one(declaration, Role::Unknown, &links);
        }
    }

    fn declare_one(&mut self, declaration: &Declaration, role: Role, links: &FxHashSet<&str>) {
        let name = &declaration.name;
        let unit = declaration.unit.as_ref().and_then(|unit| self.unit(unit));
        let dimension = unit.as_ref().map(Unit::dimension);
        let value = declaration.value.as_ref().and_then(|scalar| {
            let expected = dimension.map(|dimension| ("the value", dimension));
            self.scope.value(scalar, expected, self.report)
        });
        if let (Some(scalar), Some(unit)) = (&declaration.value, &declaration.unit)
            && unit.text.trim() == "rad"
            && let Some(value) = value
            && let Some(cause) = self.scope.rounded_angle(scalar, value)
        {
            self.push(scalar.at, cause);
        }
        let std = declaration.std.as_ref().and_then(|std| {
            let std_value = self.scope.number(std, self.report)?;
            self.require_not_negative(std_value, "a standard deviation", std.at);
            Some(std_value)
        });
        if let Some(cause) = self.name_fault(name, role, links) {
            self.push(name.at, cause);
            if !self.scope.is_declared(&name.text) {
                self.scope.tolerate(&name.text);
            }
            return;
        }
        if self.scope.is_declared(&name.text) {
            return; // a duplicate key, noted with the form
        }
        let class =
            if role == Role::Constant { SymbolClass::Geometry } else { SymbolClass::Inertia };
        // a value at fault was noted; what depends on it is not at fault, too
        let stand_in = declaration.value.as_ref().map(|_| self.scope.dag.one());
        let symbol = self.scope.declare(&name.text, class, dimension, value.or(stand_in));
        self.parameters.push(Parameter {
            name: name.text.clone().into_owned(),
            symbol,
            role,
            known: role == Role::Constant,
            default: value,
            std,
            unit,
            doc: declaration.doc.clone(),
        });
    }

    fn name_fault(&self, name: &Name, role: Role, links: &FxHashSet<&str>) -> Option<Cause> {
        let text = name.text.clone().into_owned();
        if !is_identifier(&text) {
            return Some(Cause::NotIdentifier(text));
        }
        if let Some(by) = reserved_by(&text) {
            return Some(Cause::ReservedName(text, by));
        }
        let is_constant = |parameter: &Parameter| parameter.name == text;
        if role == Role::Unknown
            && self.scope.is_declared(&text)
            && self.parameters.values().any(|p| p.role == Role::Constant && is_constant(p))
        {
            return Some(Cause::DuplicateName(text, "a constant"));
        }
        let (prefix, link) = text.split_once('_')?;
        let is_generated = BodyEntry::ALL.into_iter().any(|entry| entry.prefix() == prefix)
            || JointEntry::ALL.into_iter().any(|entry| entry.prefix() == prefix)
            || OTHER_PREFIXES.contains(&prefix);
        let clashes = is_generated && (links.contains(link) || link.starts_with("base_"));
        clashes.then(|| Cause::NameClash { link: link.to_owned(), name: text.clone() })
    }

    fn unit(&mut self, unit: &Name) -> Option<Unit> {
        match Unit::parse(&unit.text) {
            Ok(unit) => Some(unit),
            Err(error) => {
                // the text of a unit is short, and so is what is wrong with it
                let error = match error {
                    UnitError::Unknown(name) => UnitError::Unknown(name.chars().take(32).collect()),
                    other => other,
                };
                self.push(unit.at, Cause::Unit(unit.text.clone().into_owned(), error));
                None
            }
        }
    }
}
