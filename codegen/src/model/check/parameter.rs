//! Entries of bodies, joints and drives: each becomes a parameter symbol with a default value, or,
//! where it is written in declared names, stands for itself.

use super::Check;
use crate::expr::{ExprId, SymbolClass};
use crate::model::entry::Entry;
use crate::model::fault::Cause;
use crate::model::parameter::{Parameter, Role};
use crate::model::unit::Unit;

/// What an entry is, apart from what the file says.
pub(super) struct EntryKind<'n> {
    /// What belongs where.
    pub(super) role: Role,
    /// Prefix of the symbol.
    pub(super) prefix: &'static str,
    /// Name of the link.
    pub(super) link: &'n str,
    /// How a message calls it.
    pub(super) what: &'static str,
    /// Its unit, which the role fixes.
    pub(super) unit: &'static str,
    /// Whether it is taken as given unless the file says otherwise.
    pub(super) known: bool,
}

impl Check<'_> {
    /// The expression of an entry: the file's own if it names something, else the symbol, whose
    /// default is the file's number (0 if there is none).
    pub(super) fn entry(&mut self, entry: Option<&Entry>, kind: &EntryKind) -> ExprId {
        let written = self.entry_expression(entry, kind);
        match written {
            Some(expr) if self.scope.has_symbols(expr) => {
                self.refuse_parameter_keys(entry);
                expr
            }
            default => self.parameter(entry, kind, default),
        }
    }

    /// What the file writes for an entry, checked for its dimension.
    pub(super) fn entry_expression(
        &mut self,
        entry: Option<&Entry>,
        kind: &EntryKind,
    ) -> Option<ExprId> {
        let scalar = entry?.value.as_ref()?;
        let expr = self.scope.try_expression(scalar, self.report)?;
        if let Ok(unit) = Unit::parse(kind.unit) {
            self.scope.expect(expr, kind.what, unit.dimension(), scalar.at, self.report);
        }
        Some(expr)
    }

    /// Notes `std` and `known` at an entry that is no parameter of its own.
    pub(super) fn refuse_parameter_keys(&mut self, entry: Option<&Entry>) {
        if let Some(entry) = entry.filter(|entry| entry.std.is_some() || entry.known.is_some()) {
            self.push(entry.at, Cause::NotAParameter);
        }
    }

    /// Makes the parameter symbol of an entry; 0 is its default if none is given.
    pub(super) fn parameter(
        &mut self,
        entry: Option<&Entry>,
        kind: &EntryKind,
        default: Option<ExprId>,
    ) -> ExprId {
        let name = format!("{}_{}", kind.prefix, kind.link);
        let class = match kind.role {
            Role::Body(..) => SymbolClass::Inertia,
            _ => SymbolClass::Drive,
        };
        let std = entry.and_then(|entry| entry.std.as_ref()).and_then(|std| {
            let value = self.scope.number(std, self.report)?;
            self.require_not_negative(value, "a standard deviation", std.at);
            Some(value)
        });
        let symbol = self.scope.generate(&name, class);
        self.parameters.push(Parameter {
            name,
            symbol,
            role: kind.role,
            known: entry.and_then(|entry| entry.known).unwrap_or(kind.known),
            default: Some(default.unwrap_or(self.scope.dag.zero())),
            std,
            unit: Unit::parse(kind.unit).ok(),
            doc: String::new(),
        });
        symbol
    }
}
