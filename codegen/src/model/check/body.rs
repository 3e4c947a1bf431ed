//! Bodies: their entries, and whether their numbers can be those of a body.

use super::Check;
use super::parameter::EntryKind;
use crate::expr::{ExprId, SymbolClass};
use crate::model::fault::Cause;
use crate::model::file::{BodyFile, ModelFile};
use crate::model::inertia::{Violation, about_com, find_fault};
use crate::model::parameter::{BodyEntry, Role};
use crate::model::robot::{About, Base, Body, LinkId};
use crate::number::{Rational, decimal_text};
use num_traits::{Signed, Zero};

impl Check<'_> {
    /// Gives the links their bodies, and a floating base its own.
    pub(super) fn bodies(&mut self, file: &ModelFile) {
        let generated = self.links.len() - file.links.len();
        if let Some(body) = &file.base.body {
            match (file.base.kind, self.base_tip()) {
                (Base::Fixed, _) | (_, None) => self.push(body.at, Cause::BodyOnFixedBase),
                (_, Some(tip)) => self.body(tip, body),
            }
        }
        for (index, link) in file.links.iter().enumerate() {
            if let Some(body) = &link.body {
                self.body(crate::arena::Handle::from_index(generated + index), body);
            }
        }
    }

    fn body(&mut self, link: LinkId, file: &BodyFile) {
        let before = self.report.count();
        let name = self.links[link].name.clone();
        let kinds = BodyEntry::ALL.map(|entry| kind(entry, link, &name));
        let written: [Option<ExprId>; 10] = std::array::from_fn(|entry| {
            self.entry_expression(file.entries[entry].as_ref(), &kinds[entry])
        });
        // Bodies in the user's own unknowns are read as they are written: what is not written is 0.
        let uses_unknowns =
            |expr: ExprId| self.scope.dag.classes(expr).contains(SymbolClass::Inertia);
        let is_own = written.iter().flatten().any(|&expr| uses_unknowns(expr));
        let entries: [ExprId; 10] = std::array::from_fn(|entry| {
            let given = file.entries[entry].as_ref();
            match written[entry] {
                written if is_own => {
                    self.refuse_parameter_keys(given);
                    written.unwrap_or(self.scope.dag.zero())
                }
                Some(expr) if self.scope.has_symbols(expr) => {
                    self.refuse_parameter_keys(given);
                    expr
                }
                written => self.parameter(given, &kinds[entry], written),
            }
        });
        if self.report.count() == before {
            self.check_values(file, &written);
        }
        let [mass, x, y, z, inertia @ ..] = entries;
        self.links[link].body = Some(Body { mass, com: [x, y, z], inertia, about: file.about });
    }

    /// Checks the numbers that the file gives; entries that it leaves out could be anything.
    fn check_values(&mut self, file: &BodyFile, written: &[Option<ExprId>; 10]) {
        let before = self.report.count();
        let values = written.map(|expr| expr.and_then(|expr| self.scope.approximate(expr)));
        let at = |entry: usize| file.entries[entry].as_ref().map_or(file.at, |given| given.at);
        let [mass, com_and_inertia @ ..] = &values;
        if let Some(mass) = mass.as_ref().filter(|mass| mass.is_negative()) {
            self.push(at(0), Cause::NotPositive("the mass", decimal_text(mass)));
        }
        for (entry, what) in [(4, "Ixx"), (5, "Iyy"), (6, "Izz")] {
            if let Some(moment) = values[entry].as_ref().filter(|moment| moment.is_negative()) {
                self.push(at(entry), Cause::Negative(what, decimal_text(moment)));
            }
        }
        if self.report.count() > before {
            return;
        }
        let or_zero = |value: &Option<Rational>| value.clone().unwrap_or_else(Rational::zero);
        // what is written without a known value (a function, a symbol without one) decides nothing
        let is_known = |entry: usize| written[entry].is_none() || values[entry].is_some();
        let is_complete = mass.is_some() && values[4..7].iter().all(Option::is_some);
        if !is_complete || !(0..10).all(is_known) {
            return self.nothing_to_accept(file);
        }
        let [x, y, z, tensor @ ..] = com_and_inertia.each_ref().map(or_zero);
        let mass = or_zero(mass);
        let tensor = match file.about {
            About::Com => tensor,
            About::Origin => about_com(&mass, &[x, y, z], tensor),
        };
        match find_fault(&mass, &tensor) {
            None => self.nothing_to_accept(file),
            Some(fault) => {
                if !fault.can_be_accepted() || file.violation == Violation::Refused {
                    self.push(file.at, Cause::Unphysical(fault));
                }
            }
        }
    }

    fn nothing_to_accept(&mut self, file: &BodyFile) {
        if let Violation::Accepted(at) = file.violation {
            self.push(at, Cause::NothingToAccept);
        }
    }
}

fn kind(entry: BodyEntry, link: LinkId, name: &str) -> EntryKind<'_> {
    let (what, unit) = match entry {
        BodyEntry::Mass => ("the mass", "kg"),
        BodyEntry::ComX | BodyEntry::ComY | BodyEntry::ComZ => ("the centre of mass", "m"),
        _ => ("the inertia", "kg m^2"),
    };
    EntryKind {
        role: Role::Body(link, entry),
        prefix: entry.prefix(),
        link: name,
        what,
        unit,
        known: false,
    }
}
